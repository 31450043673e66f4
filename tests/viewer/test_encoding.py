"""Encodings of irradiance are looked at in place of bands, with their own figures; bands and quantities take them away."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from places import kernels
from viewer.overlay.written import texts_of

import shviewer
from shviewer.cli.main import main
from shviewer.cli.options.modes import PARSERS
from shviewer.cli.options.states import state_from
from shviewer.errors import UsageError
from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.quantities.encodings import ENCODINGS, Stored
from shviewer.harmonics.quantities.names import CUBES, ENCODED_BANDS
from shviewer.lights.find import find_light
from shviewer.viewer.camera import towards
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.control.keys import press
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import State, changed, state_of

IRRADIANCE = state_of("green", quantity="irradiance", n_bands=3)
NAMES = {"l1": "L1 linear", "geomerics": "L1 Geomerics (Hazel)", "zh3": "ZH3, own axis", "l2": "L2 linear"}


def encoding(name: str) -> State:
    return changed(IRRADIANCE, encode=name, n_bands=ENCODED_BANDS[name])


def pressed(state: State, *keys: str) -> State:
    for key in keys:
        done = press(state, key)
        assert isinstance(done, State)
        state = done
    return state


@pytest.mark.parametrize("name", NAMES)
def test_figures_are_the_published_ones_and_coefficients_those_of_the_encoding(name: str) -> None:
    picture = prepare(encoding(name))
    wanted = kernels()["B"]["green"]["figures"][NAMES[name]]
    assert picture.figures.relative_l2 == pytest.approx(wanted["rel_l2"], abs=2e-5)
    figures = picture.figures
    assert figures.irradiance_relative_l2 == figures.relative_l2
    extremes = picture.extremes
    assert extremes.max_error / extremes.peak == pytest.approx(wanted["max_abs_over_max"], abs=2e-3)
    assert extremes.minimum / extremes.peak == pytest.approx(wanted["min_over_max"], abs=1e-3)
    made = ENCODINGS[name].make(find_light("green").coefficients(3))
    np.testing.assert_allclose(picture.coefficients, made, rtol=0, atol=1e-14)


def test_the_picture_says_which_and_how_many_numbers() -> None:
    texts = {text.text for text in texts_of(draw_overlay(prepare(encoding("geomerics")), compose(1280, 640)))}
    assert {"L1, Geomerics", "4 numbers a channel"} <= texts


def test_C_goes_through_all_of_them_and_back_to_three_bands() -> None:
    shown = [pressed(IRRADIANCE, *["C"] * count) for count in range(1, len(ENCODED_BANDS) + 2)]
    assert [state.view.encode for state in shown] == [*ENCODED_BANDS, ""]
    assert [state.recipe.n_bands for state in shown] == [*ENCODED_BANDS.values(), 3]
    for state in shown:
        state.check()
    away = pressed(state_of("green"), "C")
    assert (away.view.encode, away.view.message) == ("", "encodings are of irradiance: I shows it")


@pytest.mark.parametrize("key", ["Up", "Home", "I", "K", "Shift+K"])
def test_bands_and_other_quantities_take_an_encoding_away(key: str) -> None:
    state = pressed(encoding("zh3"), key)
    assert state.view.encode == ""
    state.check()


def test_an_encoding_is_made_of_the_samples_that_are_in_use() -> None:
    sampled = prepare(changed(encoding("zh3"), method="jittered", samples=400))
    own = shviewer.project("green", 3, method="jittered", samples=400).coefficients
    np.testing.assert_allclose(sampled.coefficients, ENCODINGS["zh3"].make(own), rtol=0, atol=1e-13)


def test_geomerics_is_drawn_where_its_formula_has_it() -> None:
    picture, axis = prepare(encoding("geomerics")), np.array([[0.6, 0.0, 0.8]])
    radiance = find_light("green").coefficients(3)[:, 0]
    v = radiance[[3, 1, 2]] * [-1, -1, 1]
    r = np.linalg.norm(v) / (np.sqrt(3) * radiance[0])
    q = (1 + axis[0] @ v / np.linalg.norm(v)) / 2
    a = (1 - r) / (1 + r)
    wanted = np.pi * radiance[0] / (2 * np.sqrt(np.pi)) * (a + (1 - a) * (2 + 2 * r) * q ** (1 + 2 * r))
    found = evaluate_basis(axis, 32) @ picture.coefficients
    np.testing.assert_allclose(found, wanted, rtol=1e-6)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ("--encode", "zh3", "--for", "radiance"),
            "encode zh3: engines store it of irradiance; give --for irradiance",
        ),
        (
            ("--encode", "zh3", "--for", "glossy:0.4"),
            "encode zh3: engines store it of irradiance; give --for irradiance",
        ),
        (("--encode", "cube", "--for", "irradiance"), "encode 'cube': it must be one of l1, geomerics"),
        (("--encode", "zh3", "--for", "irradiance", "--bands", "5"), "--encode zh3: it takes the place of bands"),
    ],
)
def test_what_cannot_be_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], said: str
) -> None:
    assert main(["screenshot", str(tmp_path / "p.png"), "green", *arguments]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


@pytest.mark.parametrize("name", ENCODINGS)
def test_Ctrl_E_writes_the_numbers_that_are_shown_turned_as_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    session = Session(changed(encoding(name), light_rotation=towards(30.0, 20.0)))
    session.press("Ctrl+E")
    session.saving.finish()
    floats, said = ENCODINGS[name].floats, session.state.view.message
    assert said == f"saved shviewer-green-001.json ({floats} numbers a channel, {name}) in {tmp_path}"
    written = json.loads((tmp_path / "shviewer-green-001.json").read_text())
    normals = np.concatenate([np.eye(3), np.full((1, 3), 3**-0.5)])
    found = Stored(name, np.array(written["coefficients"])).irradiance(normals)
    picture = session.picture
    wanted = picture.rest_at(normals @ picture.light_from_world.T)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-12)
    assert main(["project", "green", "--encode", name, "--rotate-light", "30", "20", "-o", "by-command.json"]) == 0
    assert json.loads((tmp_path / "by-command.json").read_text())["encoding"] == name


@pytest.mark.parametrize("name", CUBES)
def test_a_cube_is_made_anew_while_the_light_turns_and_shown_as_it_stands(name: str) -> None:
    session = Session(encoding(name))
    session.prepare()
    still = session.picture
    session.state = changed(session.state, light_rotation=towards(40.0, 30.0))
    seen = still.seen(session.state)  # until the new one is there, the old light with its cube
    assert seen.light_from_world is still.light_from_world or (seen.light_from_world == still.light_from_world).all()
    session.prepare()
    picture = session.picture
    assert picture.state.view.light_rotation == towards(40.0, 30.0)
    assert picture.stored is not None
    wanted = shviewer.project("green", encode=name).turned(picture.light_from_world.T)
    np.testing.assert_allclose(picture.stored.numbers, wanted.stored.numbers, rtol=0, atol=1e-12)
    assert picture.figures.relative_l2 == pytest.approx(wanted.sums.relative_l2, rel=1e-9)
    assert picture.figures.relative_l2 != pytest.approx(still.figures.relative_l2, rel=1e-3)


def test_Ctrl_E_writes_the_bands_that_are_shown_where_a_window_leaves_no_formula(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    session = Session(changed(encoding("zh3"), window="hann"))
    session.press("Ctrl+E")
    session.saving.finish()
    said = session.state.view.message
    assert said.startswith(
        "saved shviewer-green-001.json (3 bands, as zh3 has no numbers with a window or muted bands) in "
    )
    written = json.loads((tmp_path / "shviewer-green-001.json").read_text())
    np.testing.assert_array_equal(written["coefficients"], session.picture.coefficients)
    assert (written["through"], "encoding" in written) == ("zh3", False)


def test_an_encoding_is_of_irradiance_without_saying_so(tmp_path: Path) -> None:
    options = PARSERS["screenshot"]().parse_args([str(tmp_path / "p.png"), "green", "--encode", "geomerics"])
    recipe = state_from(options, all_lights=False).recipe
    assert (recipe.quantity, recipe.n_bands) == ("irradiance", 32)


def test_python_names_the_encoding_alone() -> None:
    with pytest.raises(UsageError, match="encode zh3: it stands for 3 bands, not 5"):
        shviewer.screenshot("green", 5, encode="zh3")
