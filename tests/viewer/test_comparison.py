"""--compare: the light's original beside coefficients that somebody else made of it, and what is wrong with them."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
from harmonics.peer_cases import spoiled

from shviewer.cli import main
from shviewer.harmonics.basis import Array
from shviewer.harmonics.conventions.programs import CONVENTIONS
from shviewer.lights.coefficients.light import CoefficientLight
from shviewer.lights.light import find_light
from shviewer.lights.radiance_files import Reading
from shviewer.viewer.actions import next_method, reset, with_bands
from shviewer.viewer.comparison import as_the_file_holds, caption, suspicion
from shviewer.viewer.composition import compose
from shviewer.viewer.overlay import draw_overlay
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.picture_files import metadata
from shviewer.viewer.renderer import Renderer
from shviewer.viewer.state import ViewState
from shviewer.viewer.subjects import load_light

VENICE = find_light("venice_sunset")


def given(coefficients: Array, name: str = "theirs.txt") -> CoefficientLight:
    return CoefficientLight(coefficients, name)


def compared(file: CoefficientLight, **changes: object) -> Picture:
    state = ViewState(lights=(VENICE,), compare=file, **changes)  # type: ignore[arg-type]
    return prepare(as_the_file_holds(state, quantity="quantity" not in changes, bands="n_bands" not in changes))


def test_the_lights_own_coefficients_fit_and_have_its_own_figures() -> None:
    picture = compared(given(VENICE.coefficients(4)))
    plain = prepare(ViewState(lights=(VENICE,), n_bands=4))
    np.testing.assert_allclose(picture.coefficients, plain.coefficients, rtol=0, atol=1e-14)
    assert picture.figures.relative_l2 == pytest.approx(plain.figures.relative_l2, rel=1e-9)
    assert picture.suspicion == ""


def test_the_figures_are_those_of_the_given_coefficients() -> None:
    exact = VENICE.coefficients(3)
    picture = compared(given(1.5 * exact))
    norm = np.sqrt(np.trace(VENICE.products()))
    assert picture.figures.channels["all"].added == pytest.approx(0.5 * np.linalg.norm(exact) / norm, rel=1e-9)
    np.testing.assert_array_equal(picture.coefficients, 1.5 * exact)


def test_mutes_and_windows_work_on_the_given_coefficients() -> None:
    file = given(VENICE.coefficients(4))
    assert not compared(file, muted=frozenset({1})).coefficients[1:4].any()
    hann = compared(file, window="hann").coefficients
    np.testing.assert_allclose(hann[1:4], file.given[1:4] * (1 + np.cos(np.pi / 4)) / 2, rtol=1e-14)


def test_irradiance_is_compared_with_irradiance(tmp_path: Path) -> None:
    path = tmp_path / "probe.json"
    path.write_text(json.dumps(np.asarray(CONVENTIONS["unity"].from_ours(VENICE.coefficients(3))).tolist()))
    file = CoefficientLight.read(path, Reading(convention="unity"))
    picture = compared(file)
    assert (picture.state.quantity, picture.state.n_bands, picture.suspicion) == ("irradiance", 3, "")
    own = prepare(ViewState(lights=(VENICE,), n_bands=3, quantity="irradiance"))
    np.testing.assert_allclose(picture.coefficients, own.coefficients, rtol=0, atol=1e-13)
    assert picture.figures.relative_l2 == pytest.approx(own.figures.relative_l2, rel=1e-9)


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (("phase",), "without the Condon-Shortley phase"),
        (("y-up", "pi"), "in axes +x+z-y (y-up) and divided by pi"),
        (("order", "4pi"), "with m and -m swapped and divided by sqrt(4 pi)"),
        (("A",), "multiplied by A(l), as irradiance"),
    ],
)
def test_the_usual_mistakes_are_named_in_one_line(names: tuple[str, ...], words: str) -> None:
    picture = compared(given(spoiled(VENICE.coefficients(3), *names)))
    assert picture.suspicion.startswith("theirs.txt is ")
    assert picture.suspicion.endswith(f" % off, but not at all if its numbers are {words}")
    assert "\n" not in picture.suspicion


def test_another_programs_file_is_recognised_by_its_numbers(tmp_path: Path) -> None:
    for name in ("filament", "three", "unity"):
        path = tmp_path / f"{name}.json"
        path.write_text(json.dumps(np.asarray(CONVENTIONS[name].from_ours(VENICE.coefficients(3))).tolist()))
        file = CoefficientLight.read(path, Reading(convention="shviewer"))
        for quantity in ("radiance", "irradiance"):
            light = load_light(ViewState(lights=(VENICE,), quantity=quantity))
            assert suspicion(light, file).endswith(f"not at all if its numbers are in the convention of {name}")


def test_what_nothing_explains_is_said_to_be_so() -> None:
    stranger = given(np.random.default_rng(0).normal(size=(9, 3)))
    assert compared(stranger).suspicion.endswith(" % off, which no usual mistake explains")
    black = given(np.zeros((4, 3)))
    assert compared(black).suspicion == "theirs.txt is 100 % off, which no usual mistake explains"


def test_no_more_bands_are_shown_than_the_file_has() -> None:
    file = given(VENICE.coefficients(3))
    picture = compared(file, n_bands=9)
    assert picture.state.n_bands == 3
    assert picture.state.message == "theirs.txt has 3 bands"
    more = with_bands(picture.state, 4)
    assert (more.n_bands, more.message) == (3, "theirs.txt has 3 bands")
    assert with_bands(picture.state, 2).n_bands == 2


def test_keys_keep_the_comparison() -> None:
    state = ViewState(lights=(VENICE,), compare=given(VENICE.coefficients(3)), n_bands=3)
    assert reset(state).compare is state.compare
    assert "those of theirs.txt" in next_method(state).message
    assert next_method(state).method == state.method


def test_the_picture_says_whose_coefficients_they_are() -> None:
    picture = compared(given(spoiled(VENICE.coefficients(3), "phase")))
    overlay = draw_overlay(picture, compose(1280, 640, 1.0))
    own = draw_overlay(prepare(ViewState(lights=(VENICE,), n_bands=3)), compose(1280, 640, 1.0))
    longer, shorter = (sheet.boxes["reconstruction"] for sheet in (overlay, own))
    assert longer.right - longer.left > 1.2 * (shorter.right - shorter.left)
    assert "message" in overlay.boxes
    said = json.loads(metadata(picture, compose(1280, 640, 1.0), "none"))
    assert said["compare"] == {"name": "theirs.txt", "convention": "shviewer"}
    assert said["suspicion"] == picture.suspicion


def test_a_long_name_is_shortened_in_the_caption() -> None:
    file = given(VENICE.coefficients(1), "environment-of-the-second-courtyard-at-noon.json")
    assert caption(ViewState(lights=(VENICE,), compare=file)) == "environment...d-at-noon.json: "
    assert caption(ViewState(lights=(VENICE,), compare=given(VENICE.coefficients(1)))) == "theirs.txt: "
    assert "reconstruction" in draw_overlay(compared(file), compose(640, 320, 1.0)).boxes


def test_the_command_compares_and_says_what_is_wrong(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, renderer: Renderer
) -> None:
    monkeypatch.setattr("shviewer.viewer.screenshot.headless_renderer", lambda: nullcontext(renderer))
    numbers = np.asarray(CONVENTIONS["three"].from_ours(VENICE.coefficients(3)))
    (tmp_path / "theirs.json").write_text(json.dumps(numbers.tolist()))
    command = ["screenshot", str(tmp_path / "out.png"), "venice_sunset", "--compare", str(tmp_path / "theirs.json")]
    assert main([*command, "--convention", "three", "--size", "320", "160"]) == 0
    assert capsys.readouterr().err == ""
    assert main([*command, "--convention", "unreal", "--size", "320", "160"]) == 0
    assert "theirs.json is " in (error := capsys.readouterr().err)
    assert "not at all if its numbers are in the convention of three" in error
    assert main(command) == 3
    assert "name its convention" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "kind"), [("own.hdr", "an image"), ("venice_sunset", "a built-in light"), ("own.toml", "a scene")]
)
def test_only_coefficients_are_compared(text: str, kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["screenshot", "out.png", "green", "--compare", text]) == 3
    assert f"{text} is {kind}; --compare takes coefficients (.json, .csv, .txt" in capsys.readouterr().err
