"""The border: what gets in is looked at first, and said safely."""

from __future__ import annotations

import io
import json
import os
import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import shviewer
from shviewer.analysis import projections
from shviewer.analysis.cache import MEMORY
from shviewer.analysis.comparing.compared_files import compared_with
from shviewer.analysis.comparing.comparison import verdict
from shviewer.analysis.information import describe
from shviewer.analysis.projected import Projected
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import load_light
from shviewer.benchmark.page.changes import lines
from shviewer.benchmark.rows.comparing import compare
from shviewer.benchmark.rows.report import Report, read_report
from shviewer.cli import project
from shviewer.cli.main import main
from shviewer.cli.options.inputs import reading_from
from shviewer.cli.options.modes import PARSERS
from shviewer.coefficients.lists.scan import plain_numbers
from shviewer.coefficients.numbers import as_table
from shviewer.coefficients.reading import read_coefficients
from shviewer.errors import LightError, OutputError, ShviewerError, UsageError
from shviewer.files import DEBUG
from shviewer.lights.find import find_light
from shviewer.lights.reading import Reading
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.message import WARNING, kind_of
from shviewer.viewer.saving.reference import compare_with_reference
from shviewer.viewer.saving.stamp_reading import state_of_stamp
from shviewer.viewer.state import state_of
from shviewer.words import MOST_CHARACTERS, one_line

NINE = np.arange(27.0).reshape(9, 3)
POSIX = pytest.mark.skipif(os.name != "posix", reason="modes, links and pipes as POSIX has them")


def npy(array: np.ndarray) -> bytes:
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


# --- code runs only when asked


@POSIX
def test_a_name_that_a_folder_holds_is_not_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("evil.py").write_text("open('ran', 'w').close()\ndef f(d): return d[:, 2]\n")
    Path("evil.py:f").symlink_to("nowhere")
    with pytest.raises(LightError):
        shviewer.find_light("evil.py:f")
    assert not Path("ran").exists()
    Path("evil.py:f").unlink()
    shviewer.find_light("evil.py:f")
    assert Path("ran").exists()


@pytest.mark.parametrize("name", ["evil.py", "evil.py:f"])
def test_code_that_is_dropped_is_not_run(tmp_path: Path, name: str) -> None:
    (tmp_path / "evil.py").write_text("raise SystemExit('ran')\n")
    session = Session(state_of())
    session.drop(str(tmp_path / name))
    session.prepare()
    assert session.state.recipe.light == "green"
    assert "code runs only when the command line names it" in session.state.view.message
    assert kind_of(session.state.view.message) == WARNING


def test_a_batch_says_which_lights_are_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.py").write_text("def f(d): return d[:, 2]\n")
    assert main(["project", "mine.py:f", "green", "-o", "."]) == 0
    assert "note: mine.py:f: runs the code in mine.py" in capsys.readouterr().err


# --- a fault of this program


def test_a_fault_of_this_program_keeps_the_last_picture(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    session = Session(state_of())
    monkeypatch.setattr("shviewer.viewer.desktop.behind.making.stages", lambda *_, **__: 1 // 0)
    session.press("Up")
    session.prepare()
    assert session.picture.light.name == "green"
    assert session.state.view.message.startswith("internal error, see the terminal")
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_a_fault_of_this_program_fails_one_light_of_a_batch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    right = project.project_recipe
    monkeypatch.setattr(project, "project_recipe", lambda recipe, *_: 1 // (recipe.light != "cosine") and right(recipe))
    assert main(["project", "cosine", "green", "-o", "out"]) == 1
    assert [path.name for path in Path("out").iterdir()] == ["green.json"]
    assert "cosine: internal error, ZeroDivisionError" in capsys.readouterr().err


@pytest.mark.parametrize(("fault", "says"), [(ZeroDivisionError, "internal error"), (MemoryError, "not enough memory")])
def test_what_fails_as_one_light_of_a_batch_is_written_fails_it_alone(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    fault: type[Exception],
    says: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    right = Projected.encode

    def encode(self: Projected, *arguments: Any) -> bytes:
        if self.name == "cosine":
            raise fault
        return right(self, *arguments)

    monkeypatch.setattr(Projected, "encode", encode)
    assert main(["project", "cosine", "green", "-o", "out"]) == 1
    assert [path.name for path in Path("out").iterdir()] == ["green.json"]
    said = capsys.readouterr()
    assert f"cosine: {says}" in said.err
    assert "1 of 2 written" in said.out


@pytest.mark.parametrize("kind", ["BMP", "EPS"])
def test_a_reference_is_opened_as_what_it_is_named(tmp_path: Path, kind: str) -> None:
    """Pillow hands PostScript to Ghostscript, whatever its name is."""
    path = tmp_path / "reference.png"
    Image.new("RGB", (2, 2)).save(path, kind)
    with pytest.raises(UsageError, match="not a readable picture"):
        compare_with_reference(np.zeros((2, 2, 3), np.uint8), path, tmp_path / "d.png", 0)


# --- coefficient files


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("dates.npy", npy(np.array(["2020-01-01"] * 9, dtype="M8[D]"))),
        ("texts.npy", npy(np.array(["a"] * 9))),
        ("fields.npy", npy(np.zeros(9, dtype=[("a", "f8")]))),
        ("header.npy", b"\x93NUMPY\x01\x00\x10\x00{'descr': (((((\n"),
        ("digits.json", b'{"coefficients": [[' + b"1" * 5000 + b", 0, 0]]}"),
        ("large.json", b"[[1" + b"0" * 400 + b", 0, 0]]"),
        ("true.json", b"[[true, 0.5, 0.5]]"),
        ("twice.json", b'{"coefficients": [[1, 1, 1]], "coefficients": [[2, 2, 2]]}'),
        ("deep.json", b"[" * 100_000),
        ("underscore.txt", b"1_0 2 3"),
        ("arabic.txt", "\u0661 2 3".encode()),
    ],
)
def test_a_strange_coefficient_file_is_one_line(tmp_path: Path, name: str, data: bytes) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(LightError) as refused:
        read_coefficients(path, "shviewer")
    assert str(refused.value).startswith(str(path))
    assert str(refused.value).isprintable()


def test_a_parser_shows_its_traceback_on_request(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "bad.json"
    path.write_bytes(b"{")
    monkeypatch.setenv(DEBUG, "1")
    with pytest.raises(ValueError, match="Expecting"):
        read_coefficients(path, "shviewer")


def test_comments_take_time_in_proportion_to_their_length() -> None:
    """A pattern that looks for the end of each comment took 5 s for 60 kB of comments that never end."""
    with pytest.raises(LightError, match="is no number"):
        plain_numbers("/*x" * 2**20)
    assert plain_numbers("1 /* 2 */ 3 // 4\n5 # 6\n/* 7\n8 */ 9").tolist() == [1, 3, 5, 9]


def test_many_keys_take_time_in_proportion_to_their_number(tmp_path: Path) -> None:
    path = tmp_path / "keys.json"
    path.write_text("{" + ", ".join(f'"k{number}": 0' for number in range(200_000)) + ', "k199999": 0}')
    with pytest.raises(LightError, match="'k199999' stands there twice"):
        read_coefficients(path, "shviewer")


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no /dev/zero")
def test_a_device_is_no_report_to_compare_with() -> None:
    with pytest.raises(UsageError, match="only a regular file is read"):
        read_report(Path("/dev/zero"))


# --- text from outside


def test_text_from_outside_is_one_short_line_without_escapes() -> None:
    assert one_line("a\x1b[2Jb\nc") == "a\\x1b[2Jb c"
    assert len(one_line("x" * 300_000)) <= MOST_CHARACTERS
    assert str(ShviewerError("\x1b]0;title\x07")).isprintable()


# --- the Python face


@pytest.mark.parametrize(
    ("array", "says"),
    [
        (np.zeros((4, 8, 3), np.uint8), "divide by 255"),
        (np.ma.masked_less(np.ones((4, 8, 3)), 0), "masked"),
        (np.ones((4, 8, 3), complex), "complex"),
        (np.ones((4, 8, 3), object), "object"),
        (np.full((4, 8, 3), 1e39), "largest radiance"),
        (np.zeros((9, 3), "M8[D]"), "datetime64"),
    ],
)
def test_an_array_that_is_no_radiance_is_refused_in_words(array: np.ndarray, says: str) -> None:
    with pytest.raises(ShviewerError, match=says):
        shviewer.project(array)


def test_a_light_that_is_forgotten_meanwhile_is_projected_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another thread may read it again, which makes the memory forget what was measured."""
    right = projections._measure

    def measured_and_forgotten(*arguments: Any) -> None:
        right(*arguments)
        MEMORY.clear()

    monkeypatch.setattr(projections, "_measure", measured_and_forgotten)
    MEMORY.clear()
    assert shviewer.project("green", 4).coefficients.shape == (16, 3)


def test_sixteen_threads_project_what_one_does() -> None:
    names = ["green", "hemisphere", "cosine", "sun-sky"] * 16
    alone = {name: shviewer.project(name, 5).coefficients for name in names}
    with ThreadPoolExecutor(16) as pool:
        together = list(pool.map(lambda name: shviewer.project(name, 5).coefficients, names))
    assert all(np.array_equal(found, alone[name]) for name, found in zip(names, together, strict=True))


# --- what a file says is told safely, and of the file that says it


HOSTILE = "a\x1b[2J\u202e\nb"


def json_file(path: Path, numbers: object, **stamp: object) -> Path:
    known = {"shviewer-coefficients": 1, "convention": "shviewer", "quantity": "radiance"} if stamp else {}
    path.write_text(json.dumps({**known, **stamp, "coefficients": numbers}))
    return path


def test_what_a_stamp_a_scene_or_a_file_name_says_is_one_line_without_control_characters(tmp_path: Path) -> None:
    stamped = json_file(tmp_path / f"{HOSTILE}.json", NINE.tolist(), light=HOSTILE)
    scene = tmp_path / f"{HOSTILE}.toml"
    scene.write_text(f'description = {json.dumps(HOSTILE)}\n[[lobe]]\nprofile = "constant"\nradiance = 1\n')
    image = tmp_path / f"{HOSTILE}.png"
    Image.new("RGB", (4, 2)).save(image)
    for path in (stamped, scene, image):
        light = find_light(str(path))
        assert light.name.isprintable()
        assert light.description.isprintable()
    recipe, said = compared_with(Recipe(), str(json_file(tmp_path / f"{HOSTILE}-bare.json", NINE.tolist())))
    assert said.isprintable()
    assert recipe.compare is not None
    assert recipe.compare.name.isprintable()


def test_an_argument_is_repeated_without_its_control_characters(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["screenshot", "o.png", "--\x1b[2J\udcff" + "x" * 5000])
    line = capsys.readouterr().err
    assert line.endswith("\n")
    assert line[:-1].isprintable()
    assert len(line) < 1.1 * MOST_CHARACTERS


@pytest.mark.parametrize(("name", "text"), [
    ("sky.json", json.dumps([[1e35] * 3])),
    ("sky.toml", '[[lobe]]\nprofile = "gaussian"\nsharpness = 1\naxis = [1, 0, 0]\nradiance = 1e30\n' * 2),
    ("sky.txt", "1e-40 1e-40 1e-40"),
])  # fmt: skip
def test_a_light_that_cannot_be_shown_is_named_by_its_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, text: str
) -> None:
    (tmp_path / name).write_text(text)
    assert main(["info", str(tmp_path / name), "--convention", "shviewer"]) in (2, LightError.exit_code)
    with pytest.raises(LightError, match=re.escape(f"{tmp_path / name}: ")):
        describe(str(tmp_path / name), Reading(convention="shviewer"))


def test_a_compared_file_whose_other_readings_are_too_bright_has_its_verdict(tmp_path: Path) -> None:
    """In the convention of scipy, or channel by channel, numbers just below the limit would be above it."""
    path = json_file(tmp_path / "bright.json", (NINE * 1e29 / 3).tolist())
    recipe, _ = compared_with(Recipe(), str(path))
    assert recipe.compare is not None
    assert "off" in verdict(load_light(recipe), recipe.compare)


def test_infinite_imaginary_parts_and_longer_floats_are_refused_in_silence() -> None:
    with pytest.raises(LightError, match="not finite"):
        as_table(np.full((1, 3), np.longdouble("1e400")))
    with pytest.raises(LightError, match="not finite"):
        as_table(np.array([[1, np.inf] * 3]), complex_pairs=True)


def test_an_older_report_tells_finite_numbers_and_printable_texts(tmp_path: Path) -> None:
    page = json.loads(Report(0, "shviewer report", {"processor": HOSTILE}, {}).as_json())
    path = tmp_path / "old.json"
    path.write_text(json.dumps(page))
    assert all(line.isprintable() for line in lines(compare(read_report(path), read_report(path)), "old.json"))
    assert str(read_report(path).machine["processor"]).isprintable()
    path.write_text(json.dumps(page | {"machine": {"processor": ["x" * 900] * 900}}))
    assert max(map(len, lines(compare(read_report(path), Report(0, "", {"processor": ""}, {})), "old.json"))) < 1000
    for value, says in ((float("nan"), "nan"), (10**400, "beyond 1e308"), ("nan", "no number")):
        path.write_text(json.dumps(page | {"yardstick_milliseconds": {"median": value}}))
        with pytest.raises(UsageError, match=says):
            read_report(path)


def test_a_name_too_long_for_a_file_is_one_line_wherever_it_stands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    name = "x" * 5000
    assert main([name]) == LightError.exit_code
    assert main(["info", f"{name}.json"]) == LightError.exit_code
    assert main(["project", "green", "-o", f"{name}.json"]) == OutputError.exit_code
    assert len(capsys.readouterr().err.splitlines()) == 3
    with pytest.raises(UsageError, match="no such reference"):
        compare_with_reference(np.zeros((8, 8, 3), np.uint8), Path(f"{name}.png"), Path("d.png"), 0)


def test_a_stamp_that_is_no_text_of_an_object_is_refused(tmp_path: Path) -> None:
    """Among them code points that Unicode has not, at which Python itself ends with a SystemError."""
    beyond = np.frombuffer(b"\xff\xff\xff\x7f" * 3, "<U3").reshape(())
    for stamp in (beyond, np.array(["{}", "{}"]), np.array(5), np.array(b"{}")):
        np.savez(tmp_path / "a.npz", coefficients=NINE, stamp=stamp)
        with pytest.raises(LightError, match="no JSON object of a coefficient file"):
            read_coefficients(tmp_path / "a.npz")
    for said in ("[]", '{"compare": 1.5}', '{"compare": {"convention": "three"}}'):
        with pytest.raises(UsageError, match="no stamp of a picture"):
            state_of_stamp(said)


@pytest.mark.parametrize("flag", ["--max-megatexels", "--max-file-mib", "--max-memory-mib", "--max-side"])
def test_a_limit_may_be_any_finite_number(flag: str) -> None:
    limits = reading_from(PARSERS["info"]().parse_args(["green", flag, "1e308"])).limits
    assert max(filter(None, astuple(limits))) >= 2**63
