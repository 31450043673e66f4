"""The command line: what it loads, what it writes, and one clear line with its own exit code for every mistake."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from shviewer.cli.main import main
from shviewer.cli.options.inputs import reading_from
from shviewer.cli.options.modes import PARSERS
from shviewer.cli.options.states import state_from
from shviewer.errors import (
    GraphicsError,
    LightError,
    OutputError,
    ShaderError,
    ShviewerError,
    UsageError,
)
from shviewer.lights.find import built_in_lights, find_light
from shviewer.version import __version__
from shviewer.viewer.control.keys import key_table

Run = Callable[..., subprocess.CompletedProcess[str]]
WITHOUT_DISPLAY = {"DISPLAY": None, "WAYLAND_DISPLAY": None, "XDG_SESSION_TYPE": None}


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """shviewer in an empty folder; `changes` to the environment, None removes."""

    def call(*arguments: object, **changes: str | None) -> subprocess.CompletedProcess[str]:
        environment = {**os.environ, **{key: value for key, value in changes.items() if value is not None}}
        for key in (key for key, value in changes.items() if value is None):
            environment.pop(key, None)
        command = [sys.executable, "-m", "shviewer", *map(str, arguments)]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

    return call


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """The same in this process, for what draws nothing: it takes no second to start."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments: object) -> subprocess.CompletedProcess[str]:
        code = main([*map(str, arguments)])
        return subprocess.CompletedProcess(arguments, code, *capsys.readouterr())

    return call


def failing(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str]:
    """The exit code of a command that must fail and its only line on stderr, in this process (nothing is drawn)."""
    try:
        code = main(list(arguments))
    except SystemExit as stopped:  # argparse
        code = int(str(stopped.code))
    said = capsys.readouterr()
    assert said.out == ""
    assert "Traceback" not in said.err
    lines = said.err.splitlines()
    if lines[0].startswith("usage:"):  # argparse's reminder stands above its line
        lines = lines[-1:]
    assert len(lines) == 1, lines
    return code, lines[0]


# --- what is loaded


@pytest.mark.parametrize(
    "option",
    [
        ["--version"],
        ["--help"],
        ["screenshot", "--help"],
        ["sweep", "--help"],
        ["info", "--help"],
        ["--list-keys", "--help"],
    ],
)
def test_asking_for_help_loads_neither_numpy_nor_opengl(option: list[str]) -> None:
    heavy = ("numpy", "moderngl", "glfw", "PIL", "pyrr", "OpenEXR")
    code = (
        "import sys\nfrom shviewer.cli.main import main\ntry:\n    main(sys.argv[1:])\n"
        f"except SystemExit as stopped:\n    print('LOADED', stopped.code, [n for n in {heavy} if n in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code, *option], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "LOADED 0 []"


def test_the_version_is_the_packages(run: Run) -> None:
    done = run("--version")
    assert (done.returncode, done.stdout) == (0, f"shviewer {__version__}\n")


def test_the_help_lists_the_exit_codes_that_the_errors_have(run: Run) -> None:
    text = run("--help").stdout
    for error in (UsageError, LightError, OutputError, GraphicsError, ShaderError):
        assert re.search(rf"^  {error.exit_code}  ", text, flags=re.MULTILINE)
    codes = [
        error.exit_code for error in (ShviewerError, UsageError, LightError, OutputError, GraphicsError, ShaderError)
    ]
    assert codes == [1, 2, 3, 4, 5, 6]


def test_the_lists_are_those_of_the_program(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--list-keys"]) == 0
    assert capsys.readouterr().out == key_table() + "\n"
    assert main(["--list-lights"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(built_in_lights())
    assert lines[0].split() == ["green", "two", "soft", "lobes", "(Green", "2003)"]


# --- mistakes


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["--bands", "0"], 2, ["0 bands", "1 to 128"]),
        (["--bands", "129"], 2, ["129 bands", "1 to 128"]),
        (["--bands", "five"], 2, ["--bands", "'five'"]),
        (["--mute", "1,x"], 2, ["'1,x'", "such as 1,3"]),
        (["--mute", "128"], 2, ["band 128", "0 to 127"]),
        (["--samples", "0"], 2, ["0 samples", "1 to 16000000"]),
        (["--seed", "-1"], 2, ["seed -1"]),
        (["--method", "magic"], 2, ["'magic'", "best, jittered, gauss-legendre"]),
        (["--exposure", "nan"], 2, ["'nan'", "finite"]),
        (["--exposure", "99"], 2, ["exposure 99", "-64 to 64"]),
        (["--size", "63", "640"], 2, ["size 63 x 640", "64 to 8192"]),
        (["--size", "640", "9000"], 2, ["size 640 x 9000", "64 to 8192"]),
        (["--camera", "10", "91"], 2, ["elevation 91", "-90 to 90"]),
        (["--camera", "inf", "1"], 2, ["'inf'", "finite"]),
        (["--rotate-light", "10", "-90.5"], 2, ["elevation -90.5", "-90 to 90"]),
        (["--zoom", "99"], 2, ["zoom 99", "0.25 to 16"]),
        (["--tone", "film"], 2, ["'film'", "none, reinhard, aces, log"]),
        (["--error", "some"], 2, ["'some'", "off, signed, absolute, relative"]),
        (["--error-range", "wide"], 2, ["error range", "'wide'", "finite"]),
        (["--error-range", "inf"], 2, ["error range", "'inf'", "finite"]),
        (["--error-range", "-1"], 2, ["error range -1", "1e-30 to 1e+30"]),
        (["--error", "signed", "--error-range", "20%"], 2, ["error range 20%", "--error relative"]),
        (["--evaluate", "gpu"], 2, ["'gpu'", "auto, direct, map"]),
        (["--evaluate", "direct", "--bands", "33"], 2, ["33 bands", "at most 32 are summed directly"]),
        (["--basis", "2", "3"], 2, ["(2, 3)", "m -l to l"]),
        (["--basis", "9", "0", "--bands", "5"], 2, ["(9, 0) of 5 bands", "l must be 0 to 4"]),
        (["--basis", "1", "x"], 2, ["--basis", "'x'"]),
        (["--max-side", "0"], 2, ["--max-side", "'0'", "not positive"]),
        (["--max-side", "1.5"], 2, ["--max-side", "'1.5'", "whole number"]),
        (["--max-megatexels", "-1"], 2, ["--max-megatexels", "'-1'", "not positive"]),
        (["--max-file-mib", "nan"], 2, ["--max-file-mib", "finite"]),
        (["--layout", "latlong"], 2, ["'latlong'", "did you mean lat-long?"]),
        (["--bogus"], 2, ["--bogus"]),
        (["gren"], 3, ["unknown light 'gren'", "did you mean green"]),
        (["nothing like it"], 3, ["unknown light", "there is: green, "]),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else str(value),
)
@pytest.mark.parametrize(
    "mode",
    [[], ["screenshot", "a.png"], ["sweep", "a.gif", "--turntable"]],
    ids=["window", "screenshot", "turntable"],
)
def test_a_bad_argument_is_one_line_with_its_value_and_the_rule(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    mode: list[str],
    arguments: list[str],
    code: int,
    words: list[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    found, line = failing(capsys, *mode, *arguments)
    assert found == code
    assert all(word in line for word in words), line
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["screenshot", "a.jpg"], ["a.jpg", ".png or .exr"]),
        (["screenshot", "a"], ["a: OUT must end in .png or .exr"]),
        (["screenshot", "green"], ["OUT comes before LIGHT: shviewer screenshot green.png green"]),
        (["screenshot", "a.jpg", "sky.exr"], ["a.jpg: OUT must end in .png or .exr, such as a.png"]),
        (["screenshot", "green", "a.png"], ["OUT comes before LIGHT: shviewer screenshot a.png green"]),
        (["screenshot", "a.exr", "--reference", "b.png"], ["a.exr", "PNG"]),
        (["screenshot", "a.png", "--size", "1920x960"], ["expected 2 arguments, as in --size W H"]),
        (["screenshot", "a.png", "--bands"], ["expected one argument, as in --bands N"]),
        (["screenshot", "a.png", "--threshold", "2"], ["'2'", "0 to 1"]),
        (["screenshot"], ["OUT"]),
    ],
)
def test_a_bad_screenshot_argument_exits_2(
    capsys: pytest.CaptureFixture[str], arguments: list[str], words: list[str]
) -> None:
    code, line = failing(capsys, *arguments)
    assert code == 2
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["a.mp4"], 2, ["a.mp4", ".gif or .webp"]),
        (["a"], 2, ["a: OUT must end in .gif or .webp"]),
        (["sky.hdr", "a.webp"], 2, ["sky.hdr: OUT must end in .gif or .webp, such as sky.gif"]),
        ([], 2, ["OUT"]),
        (["a.gif", "--from", "5", "--to", "4"], 2, ["--from 5 --to 4", "at most --to"]),
        (["a.gif", "--basis", "2", "0"], 2, ["--basis", "--turntable, or --lobes"]),
        (["a.gif", "--from", "17"], 2, ["--from 17 --to 16"]),
        (["a.gif", "--from", "0"], 2, ["--from 0", "1 to 128"]),
        (["a.gif", "--to", "129"], 2, ["--to 129", "1 to 128"]),
        (["a.gif", "--to", "few"], 2, ["--to", "'few'"]),
        (["a.gif", "--bands", "5"], 2, ["--bands 5", "--from and --to, or --turntable"]),
        (["a.gif", "--tolerance", "5%"], 2, ["--tolerance 0.05", "--from and --to, or --turntable"]),
        (["a.gif", "--frames", "9"], 2, ["--frames 9", "--from and --to"]),
        (["a.gif", "--turntable", "--from", "2"], 2, ["--from 2 with --turntable", "--bands"]),
        (["a.gif", "--turntable", "--to", "2"], 2, ["--to 2 with --turntable", "--bands"]),
        (["a.gif", "--turntable", "--frames", "1"], 2, ["--frames 1", "2 to 720"]),
        (["a.gif", "--turntable", "--frames", "721"], 2, ["--frames 721", "2 to 720"]),
        (["a.gif", "--seconds", "0.01"], 2, ["--seconds 0.01", "0.02 to 60"]),
        (["a.gif", "--seconds", "61"], 2, ["--seconds 61", "0.02 to 60"]),
        (["a.gif", "--seconds", "nan"], 2, ["'nan'", "finite"]),
        (["a.gif", "--seconds", "50"], 2, ["16 frames last 900 s", "at most 655", "--seconds"]),
        (["a.webp", "--size", "8192", "8192"], 2, ["16 frames of 8192 x 8192", "--size up to 5792 5792"]),
        (["a.webp", "--size", "99", "9000"], 2, ["size 99 x 9000"]),
        (["gone/a.gif"], 4, ["gone/a.gif", "no such folder"]),
        (["folder.gif"], 4, ["folder.gif", "s a directory"]),
        (["a.gif", "gren"], 3, ["unknown light 'gren'"]),
        (["a.gif", "--window", "dering", "--to", "40"], 2, ["dering"]),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else str(value),
)
def test_a_bad_sweep_is_one_line_before_anything_is_drawn(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    code: int,
    words: list[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("shviewer.viewer.animation.animation.headless_renderer", None)  # it would be called to draw
    (tmp_path / "folder.gif").mkdir()
    (tmp_path / "a.gif").write_text("kept")
    found, line = failing(capsys, "sweep", *arguments)
    assert found == code
    assert all(word in line for word in words), line
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gif", "folder.gif"]
    assert (tmp_path / "a.gif").read_text() == "kept"


@pytest.mark.parametrize("mode", [["screenshot", "a.png"], ["sweep", "a.gif"]])
def test_the_light_may_stand_behind_options(capsys: pytest.CaptureFixture[str], mode: list[str]) -> None:
    code, line = failing(capsys, *mode, "--zoom", "2", "gren", "--no-overlay")
    assert (code, "unknown light 'gren'" in line) == (3, True)


def write(path: Path, content: str | bytes) -> None:
    path.write_bytes(content.encode() if isinstance(content, str) else content)


LOBE = '[[lobe]]\nprofile = "gaussian"\naxis = [0, 0, 1]\nradiance = 1\n'


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("missing.hdr", None, ["no such file"]),
        ("missing.exr", None, ["no such file"]),
        ("missing.toml", None, ["no such file"]),
        ("missing.py:sky", None, ["missing.py", "no such file"]),
        ("folder.hdr", "FOLDER", ["directory"]),
        ("folder.toml", "FOLDER", ["folder.toml"]),
        ("empty.hdr", b"", ["empty"]),
        ("empty.exr", b"", ["empty"]),
        ("empty.toml", b"", ["empty file"]),
        ("text.hdr", b"hello there", ["no known image"]),
        ("cut.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n", ["cut.hdr"]),
        ("picture.exr", b"\x89PNG\r\n\x1a\n", ["holds PNG", "rename"]),
        ("picture.exr:layer", b"\x89PNG\r\n\x1a\n", ["picture.exr: ", "holds PNG"]),
        ("missing.exr:layer", None, ["missing.exr: ", "no such file"]),
        ("light.xyz", b"hello", ["must end in .toml"]),
        ("light.tif", b"hello", ["light.tif: ", "no known image"]),
        ("syntax.toml", "[[lobe]\n", ["not valid TOML"]),
        ("key.toml", LOBE + "sharpnes = 3\n", ["lobe 1", "sharpnes"]),
        ("number.toml", LOBE + 'sharpness = "high"\n', ["lobe 1", "sharpness", "'high'", "number"]),
        ("profile.toml", LOBE.replace("gaussian", "gauss"), ["lobe 1", "'gauss'", "did you mean gaussian?"]),
        ("broken.py:sky", "def sky(d):\n    return d[:, 7]\n", ["sky", "IndexError", "broken.py:2"]),
        ("names.py:sky", "def sea(d):\n    return d[:, 2]\n", ["no function 'sky'", "sea"]),
        ("shape.py:sky", "def sky(d):\n    return d[:3, 0]\n", ["sky", "shape"]),
        ("nan.py:sky", "def sky(d):\n    return d[:, 0] / 0\n", ["finite"]),
        ("import.py:sky", "import no_such_module_at_all\n", ["import.py", "no_such_module_at_all"]),
    ],
    ids=lambda value: value if isinstance(value, str) and len(value) < 20 else "",
)
@pytest.mark.filterwarnings("ignore:.*encountered in divide:RuntimeWarning")
def test_a_bad_light_is_one_line_with_its_name_and_exit_code_3(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    content: str | bytes | None,
    words: list[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / name.split(":")[0]
    if content == "FOLDER":
        file.mkdir()
    elif content is not None:
        write(file, content)
    code, line = failing(capsys, "screenshot", "a.png", name)
    assert code == 3
    assert line.startswith("shviewer: ")
    assert all(word in line for word in words), line
    assert not (tmp_path / "a.png").exists()


def write_exr(path: Path, pixels: Any) -> None:
    OpenEXR.File({}, {"RGB": np.asarray(pixels, dtype=np.float32)}).write(str(path))


def test_an_image_with_nan_is_refused_with_counts_and_repaired_on_request(run: Run, tmp_path: Path) -> None:
    pixels = np.ones((4, 8, 3))
    pixels[1, 2, 0], pixels[3, 7], pixels[2, 0, 1] = np.nan, np.inf, -1
    write_exr(tmp_path / "bad.exr", pixels)
    done = run("screenshot", "a.png", "bad.exr", "--size", 64, 64)
    assert done.returncode == 3
    assert len(done.stderr.splitlines()) == 1
    assert "1 NaN, 3 +Inf" in done.stderr
    assert "row 1, column 2" in done.stderr
    assert "--sanitize" in done.stderr
    assert not (tmp_path / "a.png").exists()

    done = run("screenshot", "a.png", "bad.exr", "--size", 320, 160, "--sanitize")
    assert done.returncode == 0, done.stderr
    assert all(line.startswith("shviewer: note: ") for line in done.stderr.splitlines())
    assert "1 NaN -> 0" in done.stderr
    assert "1 negative value" in done.stderr
    with Image.open(tmp_path / "a.png") as image:
        said = json.loads(image.info["shviewer"])
    assert (said["sanitize"], said["layout"]) == (True, "auto")
    assert len(said["light_notes"]) == len(done.stderr.splitlines())


def test_negative_texels_are_kept_and_counted_and_an_odd_shape_is_warned_of(run: Run, tmp_path: Path) -> None:
    pixels = np.ones((4, 4, 3))
    pixels[0, 0, 1] = -2
    write_exr(tmp_path / "odd.exr", pixels)
    done = run("screenshot", "a.png", "odd.exr", "--size", 320, 160)
    assert done.returncode == 0
    assert "1 negative value, minimum -2, kept" in done.stderr
    assert "4 x 4 is not 2:1" in done.stderr


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("--max-side", "7", ["8 x 4", "1 to 7"]),
        ("--max-megatexels", "3e-5", ["8 x 4 = 32 texels", "limit is 31"]),
        ("--max-file-mib", "1e-4", ["limit is 104"]),
    ],
)
@pytest.mark.parametrize("mode", [["screenshot", "a.png"], ["info"], []], ids=["screenshot", "info", "window"])
def test_the_limits_of_an_image_are_the_users(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, mode: list[str], option: str, value: str, words: list[str]
) -> None:
    write_exr(tmp_path / "small.exr", np.ones((4, 8, 3)))
    code, line = failing(capsys, *mode, str(tmp_path / "small.exr"), option, value)
    assert code == 3
    assert all(word in line for word in [*words, option]), line


def test_larger_limits_admit_what_is_refused_otherwise(tmp_path: Path) -> None:
    write_exr(tmp_path / "wide.exr", np.ones((1, 32769, 3)))
    wide = str(tmp_path / "wide.exr")
    assert main(["info", wide]) == 3
    options = PARSERS["info"]().parse_args([wide, "--max-side", "4e4", "--layout", "lat-long"])
    assert find_light(wide, reading_from(options)).about.size == (32769, 1)


def test_the_layout_and_the_layer_asked_for_are_taken(here: Run, tmp_path: Path) -> None:
    pixels = np.random.default_rng(0).random((2, 24, 4, 3)).astype(np.float32)
    channels = {
        f"{name}{channel}": pixels[part, ..., i]
        for part, name in ((0, ""), (1, "key."))
        for i, channel in enumerate("RGB")
    }
    OpenEXR.File({}, {name: np.ascontiguousarray(values) for name, values in channels.items()}).write(
        str(tmp_path / "two.exr")
    )
    done = here("info", "--json", "two.exr", "two.exr:key", "two.exr:none", "--layout", "lat-long", "--jobs", 1)
    beauty, key, missing = json.loads(done.stdout)
    assert (beauty["layout"], key["layout"]) == ("lat-long", "lat-long")  # not a strip of six faces
    assert beauty["peak"] in pixels[0]
    assert key["peak"] in pixels[1]
    assert key["file"] == "two.exr"
    assert "none" in missing["error"]
    assert done.returncode == 3


# --- info


def test_info_describes_every_light_it_can_read_and_exits_with_the_first_failure(here: Run, tmp_path: Path) -> None:
    write(tmp_path / "broken.toml", "[[lobe]\n")
    write_exr(tmp_path / "white.exr", np.ones((4, 8, 3)))
    done = here("info", "white.exr", "broken.toml", "gren", "green")
    assert done.returncode == 3
    blocks = done.stdout.split("\n\n")
    assert [block.split(":")[0] for block in blocks] == ["white", "green", "all 2 lights"]
    errors = done.stderr.splitlines()
    assert len(errors) == 2
    assert "broken.toml" in errors[0]
    assert "did you mean green" in errors[1]
    assert re.search(r"^  radiance +1 to 1 in any channel", blocks[0], flags=re.MULTILINE)
    assert re.search(r"^  mean +1 1 1, luminance 1$", blocks[0], flags=re.MULTILINE)
    assert re.search(r"^  irradiance up +3\.142 3\.142 3\.142$", blocks[0], flags=re.MULTILINE)
    assert re.search(r"^  dynamic range +0\.0 stops", blocks[0], flags=re.MULTILINE)


def test_info_tells_what_is_wrong_with_an_image_and_what_it_would_be_repaired(here: Run, tmp_path: Path) -> None:
    pixels = np.ones((4, 8, 3))
    pixels[1, 2, 0], pixels[3, 7] = np.nan, np.inf
    write_exr(tmp_path / "bad.exr", pixels)
    done = here("info", "bad.exr")
    assert done.returncode == 3
    assert len(done.stderr.splitlines()) == 1
    for text in (done.stdout, done.stderr):
        assert "1 NaN, 3 +Inf" in text
    assert "1 NaN -> 0" in done.stdout
    done = here("info", "bad.exr", "--sanitize")
    assert (done.returncode, done.stderr) == (0, "")
    assert "refused" not in done.stdout


def test_info_as_json_has_an_object_for_every_argument(here: Run, tmp_path: Path) -> None:
    write_exr(tmp_path / "grey.exr", np.full((4, 8, 3), 0.5))
    done = here("info", "--json", "grey.exr", "nothing.hdr", "hemisphere")
    assert done.returncode == 3
    said = json.loads(done.stdout)
    assert [about["light_argument"] for about in said] == ["grey.exr", "nothing.hdr", "hemisphere"]
    assert said[0]["mean"] == pytest.approx([0.5] * 3, rel=1e-9)
    assert (said[0]["size"], said[0]["refused"]) == ([8, 4], None)
    assert said[0]["file_bytes"] == (tmp_path / "grey.exr").stat().st_size
    assert "no such file" in said[1]["error"]
    assert f"shviewer: {said[1]['error']}\n" == done.stderr


def test_info_loads_no_opengl() -> None:
    code = (
        "import sys\nfrom shviewer.cli.main import main\nassert main(['info', 'green']) == 0\n"
        "print([name for name in ('moderngl', 'glfw') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


# --- where there is no display, or no OpenGL


@pytest.mark.usefixtures("session_renderer")
def test_without_a_display_the_picture_is_written_and_that_is_said(run: Run, tmp_path: Path) -> None:
    done = run("--size", 400, 300, **WITHOUT_DISPLAY)
    assert done.returncode == 0, done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert "no display" in done.stderr
    assert "wrote shviewer-green.png instead" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["shviewer-green.png"]
    with Image.open(tmp_path / "shviewer-green.png") as image:
        assert image.size == (400, 300)
        assert json.loads(image.info["shviewer"])["light"] == "green"


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere no EGL is needed")
@pytest.mark.parametrize("name", ["GLCONTEXT_LINUX_LIBEGL", "GLCONTEXT_LINUX_LIBGL"])
def test_without_egl_or_opengl_one_line_says_what_to_install(run: Run, tmp_path: Path, name: str) -> None:
    for arguments in (("screenshot", "a.png"), ()):
        done = run(*arguments, **WITHOUT_DISPLAY, **{name: "libmissing.so.9"})
        assert done.returncode == 5, done.stderr
        assert len(done.stderr.splitlines()) == 1
        assert "libegl1" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform != "linux", reason="Mesa's variable")
@pytest.mark.usefixtures("session_renderer")
def test_an_opengl_that_is_too_old_is_refused_with_what_was_found(run: Run, tmp_path: Path) -> None:
    old = {"MESA_GL_VERSION_OVERRIDE": "3.1", "MESA_GLSL_VERSION_OVERRIDE": "140"}
    done = run("screenshot", "a.png", **old)
    assert done.returncode == 5, done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert "OpenGL 3.3" in done.stderr


def test_ctrl_c_exits_130_without_a_traceback(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*arguments: object, **named: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("shviewer.cli.screenshot.prepare", interrupt)
    assert main(["screenshot", "a.png"]) == 130
    assert capsys.readouterr().err == ""


def test_a_programming_error_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*arguments: object, **named: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("shviewer.cli.screenshot.prepare", fail)
    with pytest.raises(ZeroDivisionError):
        main(["screenshot", "a.png"])


# --- lights of one's own


@pytest.mark.usefixtures("session_renderer")
def test_a_function_in_a_file_is_a_light(run: Run, tmp_path: Path) -> None:
    """1 + z: sqrt(4 pi) and sqrt(4 pi / 3) are its only coefficients, so two bands have no error."""
    write(tmp_path / "neighbour.py", "LEVEL = 1\n")
    write(
        tmp_path / "my.py", "from neighbour import LEVEL\n\ndef sky(directions):\n    return LEVEL + directions[:, 2]\n"
    )
    done = run("screenshot", "a.exr", "my.py:sky", "--bands", 2, "--size", 200, 100, "--camera", 0, 90)
    assert (done.returncode, done.stderr) == (0, "")
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        said = json.loads(file.header()["shviewer"])
        pixels = np.array(file.channels()["RGB"].pixels)
    assert said["light"] == "sky"
    assert said["figures"]["relative_l2"] < 1e-7
    energies = np.array([4 * np.pi, 4 * np.pi / 3])
    np.testing.assert_allclose(said["figures"]["energy_share"][:2], energies / energies.sum(), rtol=1e-12)
    for sphere in said["spheres"].values():  # seen from the pole: 1 + sqrt(1 - r^2)
        x, y = (int(part) for part in sphere["centre"])
        r = np.hypot(x + 0.5 - sphere["centre"][0], y + 0.5 - sphere["centre"][1]) / sphere["radius"]
        np.testing.assert_allclose(pixels[y, x], 1 + np.sqrt(1 - r * r), rtol=0, atol=1e-5)


@pytest.mark.usefixtures("session_renderer")
def test_a_scene_of_ones_own_is_a_light(run: Run, tmp_path: Path) -> None:
    write(tmp_path / "warm.toml", 'description = "warm"\n' + LOBE.replace("= 1\n", "= [3, 2, 1]\n") + "sharpness = 5\n")
    done = run("screenshot", "a.png", "warm.toml", "--size", 640, 320, "--camera", 0, 90)
    assert (done.returncode, done.stderr) == (0, "")
    with Image.open(tmp_path / "a.png") as image:
        said = json.loads(image.info["shviewer"])
        x, y = said["spheres"]["original"]["centre"]
        red, green, blue = np.asarray(image)[int(y), int(x)]
    assert said["light"] == "warm"
    assert red > green > blue


# --- what reviews found


def test_a_reference_is_never_overwritten_by_the_picture(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    reference = tmp_path / "same.png"
    reference.write_bytes(b"kept")
    code, line = failing(capsys, "screenshot", str(reference), "green", "--reference", str(reference))
    assert code == 2
    assert "same file" in line
    assert reference.read_bytes() == b"kept"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--bands", "x"), "argument --bands: 'x' is not a whole number, such as 5; see shviewer --help"),
        (("--size", "640", "3e2"), "argument --size: '3e2' is not a whole number"),
        (("sweep", "a.gif", "--to", "2.5"), "argument --to: '2.5' is not a whole number"),
        (("--tolerance", "5"), "did you mean 5%?"),
        (("--samples", "1.5"), "'1.5' is not a whole number"),
        (("--window", "dering:3"), "dering has no width"),
        (("screenshot",), "the following arguments are required: OUT"),
        (("report", "--budget", "soon"), "argument --budget: 'soon' is not a finite number"),
        (("info",), "the following arguments are required: LIGHT"),
        (("screenshot", "a.png", "--bnads", "3"), "unrecognized arguments: --bnads 3; did you mean --bands?"),
        (("project", "-o", "a.json", "--splitsun"), "did you mean --split-sun?"),
        (("info", "green", "--qqq"), "unrecognized arguments: --qqq; see shviewer info --help"),
    ],
)
def test_a_mistyped_command_is_one_line(
    capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], said: str
) -> None:
    with pytest.raises(SystemExit) if arguments[0] != "--window" else nullcontext():
        assert main(list(arguments)) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert said in lines[0]


def test_counts_may_be_written_with_a_power_of_ten() -> None:
    assert PARSERS["view"]().parse_args(["--samples", "1e6"]).samples == 1_000_000


def test_a_function_that_exits_or_gives_complex_numbers_is_refused(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "odd.py"
    path.write_text("import sys\ndef leaves(d): sys.exit(7)\ndef bent(d): return d[:, 0] * 1j\n")
    for name, said in (("leaves", "SystemExit"), ("bent", "complex")):
        code, line = failing(capsys, "screenshot", str(tmp_path / "out.png"), f"{path}:{name}")
        assert code == 3
        assert said in line


@pytest.mark.parametrize("radiance", ["1e-40", "1e300"])
def test_a_light_that_float32_cannot_show_is_refused(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, radiance: str
) -> None:
    path = tmp_path / "far.py"
    path.write_text(f"import numpy as np\ndef light(d): return np.full(len(d), {radiance})\n")
    for command in (
        ("screenshot", str(tmp_path / "out.png")),
        ("info",),
        ("project", "-o", str(tmp_path / "out.json")),
    ):
        code, line = failing(capsys, *command, f"{path}:light")
        assert code == 3
        assert "scale the light" in line
    assert not list(tmp_path.glob("out.*"))


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such names")
def test_a_file_name_that_is_no_text_can_be_drawn(run: Run, tmp_path: Path) -> None:
    scene = os.fsencode(tmp_path) + b"/bad\xff.toml"
    Path(os.fsdecode(scene)).write_text('[[lobe]]\nprofile = "constant"\nradiance = 1\n')
    done = run("screenshot", "out.png", os.fsdecode(scene), "--size", "64", "64")
    assert (done.returncode, done.stderr) == (0, "")


def test_nobody_reading_on_is_no_error() -> None:
    done = subprocess.run(
        f"{sys.executable} -m shviewer --list-lights | true", shell=True, capture_output=True, text=True, check=False
    )
    assert done.stderr == ""


def test_a_basis_function_may_be_in_the_bands_that_the_tolerance_asks_for(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["screenshot", "a.exr", "green", "--tolerance", "5%", "--basis", "14", "3"]) == 2
    told, wrong = capsys.readouterr().err.splitlines()
    assert "radiance 15" in told
    assert "surfaces hold no radiance" in wrong  # what is wrong is the file, and not the function
    assert list(tmp_path.iterdir()) == []


def test_a_misspelt_mode_is_no_light(capsys: pytest.CaptureFixture[str]) -> None:
    assert failing(capsys, "screnshot", "a.png") == (
        2,
        "shviewer: 'screnshot' is neither a mode nor a light; did you mean shviewer screenshot?",
    )


# --- several lights


def test_several_lights_and_folders_are_opened_and_bad_ones_are_named_and_skipped(run: Run, tmp_path: Path) -> None:
    """Without a display the first that can be opened is written."""
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "sky.toml").write_text('[[lobe]]\nprofile = "constant"\nradiance = 1\n')
    (tmp_path / "bad.hdr").write_text("no image")
    done = run("bad.hdr", "gone.exr", "folder", "green", "--size", 160, 80, **WITHOUT_DISPLAY)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "shviewer-sky.png").exists()
    lines = done.stderr.splitlines()
    assert [line.endswith("; skipped") for line in lines[:2]] == [True, True]
    assert ("bad.hdr" in lines[0], "gone.exr" in lines[1]) == (True, True)
    none = run("bad.hdr", "gone.exr", **WITHOUT_DISPLAY)
    assert none.returncode == 3
    assert none.stderr.splitlines()[-1].startswith("shviewer: gone.exr")
    (tmp_path / "empty").mkdir()
    empty = run("empty", **WITHOUT_DISPLAY)
    assert (empty.returncode, "no light in it" in empty.stderr) == (3, True)


def test_a_light_in_the_place_of_out_is_never_offered_to_be_overwritten(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """OUT is a map that somebody made and LIGHT a picture of ours: both names could be either."""
    light, picture = tmp_path / "my probe.exr", tmp_path / "ref.png"
    light.write_bytes(b"somebody's map")
    picture.write_bytes(b"shviewer\0")  # what `may_be_replaced` goes by
    code, line = failing(capsys, "screenshot", str(light), str(picture))
    assert code == 2
    assert line.endswith(f"OUT comes before LIGHT: shviewer screenshot {picture} '{light}'")
    assert "--force" not in line


@pytest.mark.parametrize(
    "arguments",
    [["--bands", "5", "info", "green"], ["--for", "irradiance", "screenshot", "a.png"], ["green", "report"]],
)
def test_a_mode_behind_options_or_lights_is_no_light(capsys: pytest.CaptureFixture[str], arguments: list[str]) -> None:
    code, line = failing(capsys, *arguments)
    assert code == 2
    assert "is a mode, and comes first: shviewer " in line


@pytest.mark.parametrize(
    ("text", "bands"), [("1,3", {1, 3}), ("2-4", {2, 3, 4}), ("0,2-3,7", {0, 2, 3, 7}), ("5-5", {5})]
)
def test_muted_bands_are_numbers_and_ranges_as_pictures_write_them(text: str, bands: set[int]) -> None:
    assert PARSERS["screenshot"]().parse_args(["a.png", "--mute", text]).muted == bands


@pytest.mark.parametrize("text", ["3-1", "-2", "2-", "a-b"])
def test_a_range_of_bands_that_is_none_is_refused(capsys: pytest.CaptureFixture[str], text: str) -> None:
    code, line = failing(capsys, "screenshot", "a.png", f"--mute={text}")
    assert code == 2
    assert f"'{text}'" in line
    assert "1,3 or 2-4" in line


def test_info_and_project_take_the_lights_of_a_folder(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "probes").mkdir()
    (tmp_path / "probes" / "notes.txt").write_text("no light")
    code, line = failing(capsys, "info", "probes")
    assert (code, line) == (3, "shviewer: probes: no light in it; name a file, or the convention of bare lists")
    (tmp_path / "probes" / "notes.txt").write_text("1 2 3")
    assert main(["info", "probes", "--convention", "three"]) == 0
    assert "three.js" in capsys.readouterr().out
    for name in ("a", "b"):
        (tmp_path / "probes" / f"{name}.toml").write_text('[[lobe]]\nprofile = "constant"\nradiance = [1, 2, 3]\n')
    assert main(["info", "probes", "--jobs", "1"]) == 0
    assert [line[0] for line in capsys.readouterr().out.splitlines() if line[1:2] == ":"] == ["a", "b"]
    assert main(["project", "probes", "-o", "out", "--jobs", "1"]) == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a.json", "b.json"]
    assert main(["project", "out", "-o", "out", "--jobs", "1"]) == 1, "its own inputs are never replaced"


IDLE = (
    ("--mute 9", "--mute 9: bands are counted from 0, and there are 5 bands"),
    ("--mute 1,9", "--mute 1,9: bands are counted from 0"),
    ("--samples 10", "--samples 10: the best method draws none; give --method jittered or gauss-legendre, too"),
    ("--seed 3 --method gauss-legendre", "--seed 3: jittered samples have one"),
    ("--suns 3", "--suns 3: it says what --split-sun takes; give that, too"),
    ("--sanitize", "--sanitize: it repairs images, and green is none"),
    ("--layout cube", "--layout cube: it is that of images, and green is none"),
)


@pytest.mark.parametrize(("words", "says"), IDLE)
@pytest.mark.parametrize(
    "mode", ["screenshot out.png green", "project green -o out.json", "sweep out.webp green --to 5"]
)
def test_an_option_that_changes_nothing_is_refused_with_what_is_missing(
    mode: str, words: str, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*mode.split(), *words.split()]) == 2
    assert capsys.readouterr().err.startswith(f"shviewer: {says}")


@pytest.mark.parametrize(
    "words", ["--mute 4", "--samples 9 --seed 2 --beside method", "--seed 3 --method jittered", "--error-range 0.3"]
)
def test_one_that_changes_something_or_waits_for_a_key_is_not(words: str) -> None:
    options = PARSERS["screenshot"]().parse_intermixed_args(["out.png", "green", *words.split()])
    state_from(options, all_lights=False)
    for given, _ in IDLE[:5]:
        state_from(PARSERS["view"]().parse_intermixed_args(["green", *given.split()]), all_lights=True)


def test_of_several_lights_it_is_said_how_many_bands_shade_them_all(capsys: pytest.CaptureFixture[str]) -> None:
    """As the table of the guide has it: 3, 5 and 3 within 5 %."""
    assert main(["info", "green", "sun-sky", "venice_sunset"]) == 0
    told = capsys.readouterr().out.splitlines()
    start = told.index("all 3 lights: bands that shade them, irradiance")
    assert [line.split(None, 3)[-1].strip() for line in told[start + 1 :]] == [
        "3 serve all",
        "3 serve 2, 5 serve all",
        "5 serve 2, 15 serve all",
    ]
    assert main(["info", "green"]) == 0
    assert "serve all" not in capsys.readouterr().out


INFO_KEYS = """
    schema light_argument light description file file_bytes encoding size layout refused notes values mean mean_luminance peak
    peak_direction peak_theta_phi_degrees irradiance_up method energy_share bands_needed roughness_served suns no_sun
    bands_needed_without_suns coefficients
"""
"""What programs may rely on under schema 1: keys may be added here, and none may go."""


def test_the_keys_of_info_are_those_of_their_schema(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "--json", "green", "nothing.hdr"]) == 3
    green, missing = json.loads(capsys.readouterr().out)
    assert green["schema"] == missing["schema"] == 1
    assert set(green) == set(INFO_KEYS.split())
    assert set(missing) == {"schema", "light_argument", "error"}
    assert {"tolerance", "radiance", "irradiance", "searched"} == set(green["bands_needed"][1])


def test_a_file_whose_name_begins_with_a_dash_is_a_light(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_exr(tmp_path / "-white.exr", np.ones((4, 8, 3)))
    monkeypatch.chdir(tmp_path)
    assert main(["info", "--json", "--", "-white.exr", "green"]) == 0
    assert [about["light"] for about in json.loads(capsys.readouterr().out)] == ["-white", "green"]
    assert main(["info", "-white.exr"]) == 2
    assert capsys.readouterr().err == "shviewer: -white.exr: a name that begins like an option; write ./-white.exr\n"
