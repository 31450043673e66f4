"""A picture is a session: opened again, it is drawn byte for byte, and what it names is found, named as gone, or never run."""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers import frame_of, picture_of
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from shviewer.analysis.comparing.compared_files import compared_with
from shviewer.analysis.projected import project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.cli.main import main
from shviewer.coefficients.programs import OURS
from shviewer.errors import LightError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.function import FunctionLight
from shviewer.lights.reading import Reading
from shviewer.limits import DEFAULT_LIMITS, Limits
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import prepare
from shviewer.viewer.saving.file_marks import has_mark
from shviewer.viewer.saving.picture_files import write_exr, write_png
from shviewer.viewer.saving.restoring import Restored, restored
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.saving.stamps_in_files import stamp_in
from shviewer.viewer.state import State

PIXELS = np.zeros((4, 4, 3), np.uint8)
pytestmark = pytest.mark.usefixtures("fresh_memory")  # a light is known by its relative path


def image(path: Path, seed: int = 0) -> Path:
    """A lat-long image of 16 x 32 texels."""
    write_exr(path, np.random.default_rng(seed).random((16, 32, 3)).astype(np.float32), "")
    return path


def saved(path: Path, **changes: Any) -> State:
    """Write a PNG with the stamp of a state, and nothing to be seen; return the state."""
    picture = picture_of(**changes)
    write_png(path, PIXELS, metadata(picture, frame_of(picture), "none"))
    return picture.state


def opened(path: Path, limits: Limits = DEFAULT_LIMITS) -> Restored:
    found = restored(path, limits)
    assert found is not None
    return found


def edited(path: Path, change: Callable[[dict[str, Any]], object]) -> Path:
    """The picture with another stamp."""
    said = json.loads(str(stamp_in(path)))
    change(said)
    write_png(path, PIXELS, json.dumps(said))
    return path


# --- byte for byte

KINDS: dict[str, list[str]] = {
    "scene": ["green", "--camera", "10", "20", "--zoom", "1.5"],
    "environment": ["studio", "--bands", "9", "--mute", "1,3", "--exposure", "-1", "--exposure-offset", "0.25"],
    "error": ["hemisphere", "--bands", "33", "--error", "relative", "--error-range", "20%", "--tone", "aces"],
    "image": ["sky.exr", "--layout", "lat-long", "--sanitize", "--no-marks", "--max-side", "100"],
    "layer": ["sky.exr:under", "--method", "jittered", "--samples", "500", "--seed", "3"],
    "given": ["probe.json", "--convention", "shviewer"],
    "compared": ["green", "--compare", "probe.json", "--error", "signed"],
    "bare": ["green", "--compare", "bare.txt"],
    "message": ["green", "--compare", "probe.json", "--bands", "9"],
    "beside": ["green", "--compare", "probe.json", "--window", "hann", "--beside", "own"],
    "moved": ["green", "--zoom", "2", "--pan", "0.5", "-1"],
    "whole sphere": ["green", "--map", "--tone", "log"],
    "glossy": ["green", "--for", "glossy:0.4"],
    "sun": ["sun-sky", "--split-sun", "--for", "irradiance", "--window", "hann:4", "--tolerance", "10%"],
    "surfaces": ["green", "--lobes", "--rotate-light", "30", "40", "--roll-light", "50"],
    "basis": ["green", "--basis", "2", "-1"],
    "map": ["green", "--evaluate", "map", "--no-overlay"],
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The present folder, with files of every kind."""
    monkeypatch.chdir(tmp_path)
    import OpenEXR

    pixels = np.random.default_rng(0).random((16, 32, 3)).astype(np.float32)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    under = {f"under.{name}": 1 - pixels[..., place] for place, name in enumerate("RGB")}
    OpenEXR.File(header, {"RGB": pixels, **under}).write("sky.exr")
    projected = project_recipe(Recipe("green", n_bands=4))
    Path("probe.json").write_bytes(projected.encode(OURS, "json"))
    np.savetxt("bare.txt", projected.coefficients)
    return tmp_path


@pytest.fixture
def one_context(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    """Screenshots by the renderer of all tests: two contexts in a thread mix."""
    monkeypatch.setattr("shviewer.viewer.screenshot.headless_renderer", lambda: nullcontext(renderer))


@pytest.mark.usefixtures("one_context", "folder")
@pytest.mark.parametrize("kind", KINDS)
def test_a_picture_opened_again_is_drawn_byte_for_byte(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    for suffix in ("png", "exr") if kind in ("error", "layer") else ("png",):
        first, second = f"first.{suffix}", f"second.{suffix}"
        assert main(["screenshot", first, *KINDS[kind], "--size", "320", "160"]) == 0
        capsys.readouterr()
        assert main(["screenshot", second, first]) == 0
        assert "note: first" not in capsys.readouterr().err
        assert Path(second).read_bytes() == Path(first).read_bytes()


@pytest.mark.usefixtures("one_context", "folder")
def test_options_come_on_top_of_a_picture_and_like_takes_all_but_the_light(capsys: pytest.CaptureFixture[str]) -> None:
    main(
        ["screenshot", "a.png", "green", "--bands", "7", "--camera", "1", "2", "--tone", "log", "--size", "320", "160"]
    )
    main(["screenshot", "b.png", "a.png", "--bands", "3", "--size", "200", "100"])
    main(
        ["screenshot", "c.png", "green", "--bands", "3", "--camera", "1", "2", "--tone", "log", "--size", "200", "100"]
    )
    assert Path("b.png").read_bytes() == Path("c.png").read_bytes()
    main(["screenshot", "d.png", "hemisphere", "--like", "a.png"])
    main(
        [
            "screenshot",
            "e.png",
            "hemisphere",
            "--bands",
            "7",
            "--camera",
            "1",
            "2",
            "--tone",
            "log",
            "--size",
            "320",
            "160",
        ]
    )
    assert Path("d.png").read_bytes() == Path("e.png").read_bytes()
    capsys.readouterr()
    assert main(["screenshot", "f.png", "--like", "sky.exr"]) == 2
    assert "--like sky.exr: no picture that shviewer saved" in capsys.readouterr().err


@pytest.mark.usefixtures("one_context", "folder")
def test_neither_a_picture_nor_the_light_that_it_names_is_written_over() -> None:
    main(["screenshot", "a.png", "sky.exr", "--size", "320", "160"])
    before = Path("a.png").read_bytes(), Path("sky.exr").read_bytes()
    assert main(["screenshot", "a.png", "a.png", "--force"]) == 4
    assert main(["screenshot", "sky.exr", "a.png", "--force"]) == 4
    assert before == (Path("a.png").read_bytes(), Path("sky.exr").read_bytes())


def test_every_state_of_a_session_comes_out_of_the_file_again(tmp_path: Path) -> None:
    state = saved(tmp_path / "p.png", n_bands=6, cursor=2, cursor_visible=True, help_visible=True, sweep_to=9)
    found = opened(tmp_path / "p.png")
    assert (found.state, found.size, found.overlay, found.said) == (state, (1280, 640), True, "")


# --- where the light is


def test_the_light_is_looked_for_beside_the_picture_and_then_in_the_present_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "here").mkdir()
    (tmp_path / "there").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    image(Path("sky.exr"))
    saved(tmp_path / "there" / "p.png", light="sky.exr")
    found = opened(tmp_path / "there" / "p.png")
    assert (found.state.recipe.light, found.said) == ("sky.exr", "")
    beside = image(tmp_path / "there" / "sky.exr", seed=1)
    found = opened(tmp_path / "there" / "p.png")
    assert (found.state.recipe.light, found.said) == ("sky.exr", "")  # the one with the same bytes
    Path("sky.exr").unlink()
    found = opened(tmp_path / "there" / "p.png")
    assert found.state.recipe.light == str(beside)
    assert found.said == "sky.exr is no longer the file that it was"
    image(beside)
    assert opened(tmp_path / "there" / "p.png").said == ""


def test_a_light_with_its_whole_path_is_found_beside_a_picture_that_was_moved_with_it(tmp_path: Path) -> None:
    for name in ("old", "new"):
        (tmp_path / name).mkdir()
    saved(tmp_path / "new" / "p.png", light=str(image(tmp_path / "old" / "sky.exr")))
    (tmp_path / "old" / "sky.exr").rename(tmp_path / "new" / "sky.exr")
    assert opened(tmp_path / "new" / "p.png").state.recipe.light == str(tmp_path / "new" / "sky.exr")


@pytest.mark.parametrize("quantity", ["radiance", "irradiance", "glossy:0.6"])
def test_where_the_light_is_gone_its_coefficients_are_shown(tmp_path: Path, quantity: str) -> None:
    light = image(tmp_path / "sky.exr")
    state = saved(tmp_path / "p.png", light=str(light), n_bands=3, muted=frozenset({1}), quantity=quantity, tone="log")
    before = prepare(state)
    light.unlink()
    found = opened(tmp_path / "p.png")
    assert found.said == (
        "sky.exr is gone: it is neither beside p.png nor where it was; the coefficients that the picture kept are shown in "
        "its place"
    )
    after = prepare(found.state)
    assert (after.state.view.tone, after.light.name) == ("log", "sky (kept coefficients)")
    size = float(np.abs(before.coefficients).max())
    np.testing.assert_allclose(after.coefficients, before.coefficients, rtol=0, atol=1e-8 * size)  # nine digits


def test_an_object_of_python_and_code_are_named_and_not_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    saved(tmp_path / "object.png", light=FunctionLight(lambda d: 1 + d[:, 2], "mine"))
    assert opened(tmp_path / "object.png").said.startswith("mine was an object of Python; the coefficients")
    Path("code.py").write_text("def f(d):\n    return 1 + d[:, 2]\n")
    saved(tmp_path / "code.png", light="code.py:f")
    Path("code.py").write_text("raise SystemExit('ran')\n")
    found = opened(tmp_path / "code.png")
    assert found.said.startswith(
        "code.py:f is code, and no picture runs code: shviewer code.py:f --like code.png does; "
    )
    assert isinstance(found.state.recipe.light, CoefficientLight)
    prepare(found.state)


@pytest.mark.parametrize("text", ["code.py:f", "sub/code.py:f"])
def test_no_place_where_a_file_is_looked_for_is_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str
) -> None:
    """A file with a colon in its name, beside the picture or not, does not make the function of that name be run."""
    monkeypatch.chdir(tmp_path)
    saved(tmp_path / "p.png")
    (tmp_path / "sub").mkdir()
    for place in ("code.py:f", "sub/code.py:f"):
        Path(place).write_text("")
    for place in ("code.py", "sub/code.py"):
        Path(place).write_text("raise SystemExit('ran')\n")
    edited(tmp_path / "p.png", lambda said: said["state"]["recipe"].update(light=text))
    (tmp_path / "other").mkdir()
    moved = (tmp_path / "p.png").rename(tmp_path / "other" / "p.png")
    with pytest.raises(LightError):  # found, and no light
        prepare(opened(moved).state)


@pytest.mark.parametrize("text", ["//evil/share/x.hdr", "\\\\evil\\share\\x.hdr"])
def test_no_other_machine_is_asked_for_a_light(tmp_path: Path, text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    saved(tmp_path / "p.png")
    edited(tmp_path / "p.png", lambda said: said["state"]["recipe"].update(light=text))
    looked: list[str] = []
    monkeypatch.setattr("shviewer.viewer.saving.restoring.os.path.isfile", lambda path: looked.append(str(path)))
    assert "is gone" in opened(tmp_path / "p.png").said
    assert looked == []


def test_a_pipe_that_a_picture_names_is_not_waited_for(tmp_path: Path) -> None:
    import os

    os.mkfifo(tmp_path / "sky.hdr")
    saved(tmp_path / "p.png")
    edited(tmp_path / "p.png", lambda said: said["state"]["recipe"].update(light="sky.hdr"))
    assert "is gone" in opened(tmp_path / "p.png").said


def test_a_picture_raises_no_limits(tmp_path: Path) -> None:
    saved(tmp_path / "p.png", reading=Reading(limits=Limits(side=99, texels=2**40)))
    limits = opened(tmp_path / "p.png", Limits(side=200)).state.recipe.reading.limits
    assert (limits.side, limits.texels, limits.pipe_seconds) == (99, Limits().texels, 0)


def test_compared_coefficients_that_are_gone_are_those_that_the_picture_kept(tmp_path: Path) -> None:
    path = tmp_path / "probe.json"
    path.write_bytes(project_recipe(Recipe("hemisphere", n_bands=4)).encode(OURS, "json"))
    recipe = compared_with(Recipe(n_bands=3), str(path))[0]
    saved(tmp_path / "p.png", n_bands=3, compare=recipe.compare)
    assert opened(tmp_path / "p.png").said == ""
    path.unlink()
    found = opened(tmp_path / "p.png")
    assert found.said == "probe.json is gone: what the picture kept of it is compared"
    kept = found.state.recipe.compare
    assert recipe.compare is not None
    assert kept is not None
    np.testing.assert_allclose(kept.given, recipe.compare.given[:9], rtol=1e-8, atol=1e-9)


def test_a_file_that_was_edited_after_it_was_read_has_no_mark(tmp_path: Path) -> None:
    light = image(tmp_path / "sky.exr")
    picture = picture_of(light=str(light))
    image(light, seed=1)
    assert "light" not in json.loads(metadata(picture, frame_of(picture), "none"))["files"]


def test_a_file_of_another_size_is_told_without_reading_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").write_bytes(b"123")
    monkeypatch.setattr("shviewer.viewer.saving.file_marks._digest", lambda *_: pytest.fail("read"))
    assert not has_mark(tmp_path / "a", {"bytes": 4, "sha256": "0"})


# --- files that are none


def test_pictures_of_other_programs_stay_lights(tmp_path: Path) -> None:
    foreign = PngInfo()
    foreign.add_itxt("shviewers", "{}")
    foreign.add_text("shviewer", "{}")
    Image.new("RGB", (32, 16)).save(tmp_path / "foreign.png", pnginfo=foreign)
    image(tmp_path / "unstamped.exr")
    (tmp_path / "short.png").write_bytes((tmp_path / "foreign.png").read_bytes()[:40])
    (tmp_path / "text.png").write_text("shviewer\0")
    for name in ("foreign.png", "unstamped.exr", "short.png", "text.png", "gone.png", "."):
        assert restored(tmp_path / name) is None, name


def test_the_radiance_of_a_whole_sphere_is_a_light_although_it_is_stamped(tmp_path: Path) -> None:
    said = json.loads(metadata(picture_of(), frame_of(picture_of()), "none")) | {"spheres": {}}
    write_exr(tmp_path / "map.exr", np.ones((16, 32, 3), np.float32), json.dumps(said))
    assert restored(tmp_path / "map.exr") is None


def test_a_stamp_that_another_program_has_compressed_is_read(tmp_path: Path) -> None:
    saved(tmp_path / "p.png", n_bands=7)
    text = zlib.compress(str(stamp_in(tmp_path / "p.png")).encode())
    content = b"shviewer\0\1\0\0\0" + text
    data = (tmp_path / "p.png").read_bytes()
    at = data.index(b"iTXt") - 4
    (length,) = struct.unpack(">I", data[at : at + 4])
    chunk = struct.pack(">I", len(content)) + b"iTXt" + content + struct.pack(">I", zlib.crc32(b"iTXt" + content))
    (tmp_path / "p.png").write_bytes(data[:at] + chunk + data[at + 12 + length :])
    assert opened(tmp_path / "p.png").state.recipe.n_bands == 7


BAD: dict[str, tuple[Callable[[dict[str, Any]], object], str]] = {
    "later": (lambda said: said.update(schema=99), "a picture of schema 99"),
    "bands": (lambda said: said["state"]["recipe"].update(n_bands=500), "500 bands"),
    "tone": (lambda said: said["state"]["view"].update(tone="film"), "tone 'film'"),
    "rows": (lambda said: said.update(coefficients=[[1, 2]]), "coefficients in its stamp are damaged"),
    "numbers": (lambda said: said.update(coefficients=[[1, 2, "x"]]), "coefficients in its stamp are damaged"),
    "bright": (lambda said: said.update(coefficients=[[1e300, 2, 2]]), "coefficients in its stamp are damaged"),
    "state": (lambda said: said.update(state=3), "stamp"),
    "empty": (lambda said: said.clear(), "keeps no coefficients"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_stamp_that_asks_for_what_there_is_not_is_one_line_and_says_how_to_open_the_image(
    tmp_path: Path, name: str
) -> None:
    change, says = BAD[name]
    saved(tmp_path / "p.png")
    with pytest.raises(LightError) as raised:
        restored(edited(tmp_path / "p.png", change))
    assert says in str(raised.value)
    assert str(raised.value).startswith(f"{tmp_path / 'p.png'}: ")
    assert str(raised.value).endswith("; --as-image opens it as an image")


@pytest.mark.parametrize("text", ["{", "[]", "3", "[" * 10**5])
def test_a_text_that_is_no_stamp_is_damaged(tmp_path: Path, text: str) -> None:
    write_png(tmp_path / "p.png", PIXELS, text)
    with pytest.raises(LightError, match="its stamp is damaged"):
        restored(tmp_path / "p.png")


def test_bytes_that_were_changed_are_seen_and_nothing_is_inflated_without_end(tmp_path: Path) -> None:
    saved(tmp_path / "p.png")
    data = (tmp_path / "p.png").read_bytes()
    (tmp_path / "p.png").write_bytes(data.replace(b'"n_bands": 5', b'"n_bands": 6', 1))
    with pytest.raises(LightError, match="does not match its checksum"):
        restored(tmp_path / "p.png")
    content = b"shviewer\0\1\0\0\0" + zlib.compress(b" " * 2**26)
    chunk = struct.pack(">I", len(content)) + b"iTXt" + content + struct.pack(">I", zlib.crc32(b"iTXt" + content))
    (tmp_path / "bomb.png").write_bytes(data[:8] + chunk)
    assert len(str(stamp_in(tmp_path / "bomb.png"))) == 2**22


@pytest.mark.parametrize(
    "files", [3, {"light": 3}, {"light": {"sha256": 5, "bytes": "x"}}, {"light": {"sha256": "0"}}, None]
)
def test_marks_that_are_none_are_no_fault(tmp_path: Path, files: object) -> None:
    saved(tmp_path / "p.png")
    found = opened(edited(tmp_path / "p.png", lambda said: said.update(files=files)))
    assert found.state.recipe.light == "green"


@pytest.mark.usefixtures("one_context", "folder")
def test_a_picture_is_an_image_only_where_that_is_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    main(["screenshot", "p.png", "green", "--size", "320", "160"])
    edited(Path("p.png"), lambda said: said.update(schema=99))
    Image.open("p.png").resize((32, 16)).save("plain.png")
    assert main(["screenshot", "q.png", "p.png"]) == 3
    assert "update shviewer; --as-image opens it as an image" in capsys.readouterr().err
    assert main(["screenshot", "q.png", "p.png", "--as-image", "--layout", "lat-long", "--size", "320", "160"]) in (
        0,
        3,
    )
