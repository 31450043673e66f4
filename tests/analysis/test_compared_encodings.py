"""--compare with a file of an encoding: whether its numbers are what the encoding makes of the light."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from viewer.overlay.written import texts_of

import shviewer
from shviewer.analysis.comparing.compared_files import compared_with
from shviewer.analysis.comparing.comparison import agrees, as_the_file_holds, verdict_of
from shviewer.analysis.projected import Projected
from shviewer.analysis.recipe import Recipe
from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.harmonics.rotation import turn
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import State

VENICE = Recipe("venice_sunset")


@cache
def made(name: str, light: str = "venice_sunset") -> Projected:
    return shviewer.project(light, encode=name)


def told(file: Path) -> str:
    return verdict_of(compared_with(VENICE, str(file))[0])


def written(file: Path, name: str, change: Callable[[dict[str, Any]], None]) -> Path:
    """A file of an encoding, changed."""
    made(name).save(file, force=True)
    held = json.loads(file.read_text())
    change(held)
    file.write_text(json.dumps(held))
    return file


def turned(held: dict[str, Any]) -> None:
    """Numbers of other axes than the file says."""
    held |= {"convention": "shviewer,+y+x-z", "axes": "x y z are our +y +x -z; -z up, right-handed"}


def doubled(held: dict[str, Any]) -> None:
    held["coefficients"] = (2 * np.array(held["coefficients"])).tolist()


def both(held: dict[str, Any]) -> None:
    turned(held)
    doubled(held)


@pytest.mark.parametrize("name", ENCODINGS)
def test_what_the_encoding_makes_of_the_light_agrees_and_what_is_wrong_is_named(name: str, tmp_path: Path) -> None:
    words = ENCODINGS[name].words
    right = told(written(tmp_path / "a.json", name, lambda held: None))
    assert agrees(right)
    assert right.startswith(f"a.json agrees with the light's own {words} to 0.0001 %")
    axes, factor = "in axes +x+y+z (z-up)", "times 2"
    for change, causes in ((turned, [axes]), (doubled, [factor]), (both, [axes, factor])):
        said = told(written(tmp_path / "b.json", name, change))
        assert f"off the light's own {words}, but not at all if its numbers are " in said
        assert all(cause in said for cause in causes)
        assert (axes in said, factor in said) == (axes in causes, factor in causes)


@pytest.mark.parametrize("light", ["green", "studio", "sun-sky"])
def test_what_is_of_another_light_is_not_explained(light: str, tmp_path: Path) -> None:
    for name in ENCODINGS:
        made(name, light).save(tmp_path / "a.json", force=True)
        assert told(tmp_path / "a.json").endswith("which no usual mistake explains")


@pytest.mark.parametrize("name", ENCODINGS)
def test_numbers_of_nothing_are_never_explained(name: str, tmp_path: Path) -> None:
    """12 lists of each encoding: were one in a thousand explained, all together would be so with a chance of 1 %."""
    rng = np.random.default_rng(len(name))

    def drawn(held: dict[str, Any]) -> None:
        held["coefficients"] = rng.normal(size=(ENCODINGS[name].floats, 3)).tolist()

    for _ in range(12):
        assert told(written(tmp_path / "a.json", name, drawn)).endswith("which no usual mistake explains")


def test_another_encoding_with_the_same_formula_is_named(tmp_path: Path) -> None:
    def solved(held: dict[str, Any]) -> None:
        held["coefficients"] = made("zh3-solved").stored.numbers.tolist()

    assert told(written(tmp_path / "a.json", "zh3", solved)).endswith("but not at all if they are those of zh3-solved")


def test_a_window_in_the_numbers_and_a_turn_of_the_light_are_named_where_these_are_coefficients(tmp_path: Path) -> None:
    windowed = shviewer.project("venice_sunset", encode="l2", window="hann", window_width=4)
    windowed.save(tmp_path / "a.json", "shviewer,y-up")
    assert told(tmp_path / "a.json").endswith(
        "but not at all if its bands are multiplied by 1, 0.854 and 0.5, by the window hann:4"
    )
    made("geomerics").turned(turn(30.0, 0.0)).save(tmp_path / "b.json")
    assert "but not at all if the light is turned by 30 degrees" in told(tmp_path / "b.json")


@pytest.mark.parametrize("name", ["geomerics", "ambient-cube"])
def test_it_is_shown_as_irradiance_with_the_figures_that_the_light_has_of_it(name: str, tmp_path: Path) -> None:
    made(name).save(tmp_path / "a.json")
    recipe, _ = as_the_file_holds(compared_with(VENICE, str(tmp_path / "a.json"))[0], quantity=True, bands=True)
    picture = prepare(State(recipe))
    assert (recipe.quantity, recipe.n_bands) == ("irradiance", 32)
    assert picture.figures.relative_l2 == pytest.approx(made(name).figures.relative_l2, abs=1e-9)
    np.testing.assert_allclose(picture.coefficients, made(name).coefficients, rtol=0, atol=1e-12)
    texts = {text.text for text in texts_of(draw_overlay(picture, compose(1280, 640)))}
    assert {f"a.json: {ENCODINGS[name].words}", f"{ENCODINGS[name].floats} numbers a channel"} <= texts
