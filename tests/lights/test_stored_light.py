"""A file of what engines store of irradiance opens as the light that its formula decodes to."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harmonics.independent import random_directions
from viewer.overlay.written import texts_of

import shviewer
from shviewer.analysis.information import describe
from shviewer.analysis.projected import Projected
from shviewer.cli.info import as_text
from shviewer.cli.options.modes import PARSERS
from shviewer.cli.options.states import state_from
from shviewer.coefficients.writing import FORMATS
from shviewer.errors import LightError
from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.lights.reading import Reading
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import state_of

NORMALS = np.concatenate([random_directions(40), np.eye(3), -np.eye(3)])


@cache
def made(name: str) -> Projected:
    return shviewer.project("venice_sunset", encode=name)


def opened(folder: Path, name: str, kind: str = "json", convention: str = "shviewer") -> CoefficientLight:
    made(name).save(folder / f"a.{kind}", convention)
    light = find_light(str(folder / f"a.{kind}"))
    assert isinstance(light, CoefficientLight)
    return light


@pytest.mark.parametrize("axes", ["shviewer", "shviewer,y-up", "shviewer,+x+z+y"])
@pytest.mark.parametrize("name", ENCODINGS)
def test_its_irradiance_is_that_of_the_formula_in_whichever_axes_the_file_is(
    tmp_path: Path, name: str, axes: str
) -> None:
    shaded = opened(tmp_path, name, convention=axes).through("irradiance")
    wanted = made(name).stored.irradiance(NORMALS)
    np.testing.assert_allclose(shaded.radiance(NORMALS), wanted, rtol=0, atol=1e-14 * wanted.max())
    bands = ENCODINGS[name].bands
    np.testing.assert_allclose(shaded.coefficients(bands), made(name).coefficients, rtol=0, atol=1e-13 * wanted.max())
    assert not shaded.coefficients(bands + 1)[bands**2 :].any()
    assert shaded.map is not None
    np.testing.assert_allclose(shaded.map.sample(NORMALS), wanted, rtol=0, atol=2e-5 * wanted.max())  # bilinear


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("name", ["l1", "zh3-shared", "ambient-cube-fitted"])
def test_every_format_is_read_with_all_digits(tmp_path: Path, kind: str, name: str) -> None:
    np.testing.assert_array_equal(opened(tmp_path, name, kind).stored.numbers, made(name).stored.numbers)


@pytest.mark.parametrize("name", ENCODINGS)
def test_an_encoding_of_the_radiance_it_tells_of_is_the_same_again(tmp_path: Path, name: str) -> None:
    """But of what is made by searching, or of more than the three bands that are left."""
    light, wanted = opened(tmp_path, name), made(name).stored.numbers
    again = shviewer.project(light, encode=name).stored.numbers
    searched = {"zh3-solved": 1e-4, "l2-deringed": 1e-4, "ambient-cube": 0.2, "ambient-cube-fitted": 0.2}
    np.testing.assert_allclose(again, wanted, rtol=0, atol=searched.get(name, 1e-13) * np.abs(wanted).max())
    assert light.irradiance_up() == pytest.approx(made(name).stored.irradiance(np.eye(3)[2:])[0])


def test_it_is_shown_as_its_irradiance_under_its_name_as_in_the_window_it_is_dropped_on(tmp_path: Path) -> None:
    light = opened(tmp_path, "geomerics")
    picture = prepare(state_of(light, quantity="irradiance", n_bands=32))
    texts = {text.text for text in texts_of(draw_overlay(picture, compose(1280, 640)))}
    assert any("L1, Geomerics" in said and "irradiance" in said for said in texts)
    assert picture.figures.relative_l2 < 1e-7
    options = PARSERS["screenshot"]().parse_args([str(tmp_path / "p.png"), str(tmp_path / "a.json")])
    recipe = state_from(options, all_lights=False).recipe
    assert (recipe.quantity, recipe.n_bands) == ("irradiance", 32)
    session = Session(state_of("green"))
    session.drop(str(tmp_path / "a.json"))
    session.prepare()
    recipe = session.picture.state.recipe
    assert (recipe.quantity, recipe.light) == ("irradiance", str(tmp_path / "a.json"))
    assert session.state.view.message == "a.json holds irradiance, which is shown"


def test_info_says_what_it_holds_and_the_formula(tmp_path: Path) -> None:
    made("zh3").save(tmp_path / "a.csv", "shviewer,y-up")
    text = as_text(describe(str(tmp_path / "a.csv"), Reading()))
    assert "  encoding          5 numbers a channel, zh3, irradiance\n  formula           E(n) = " in text
    assert "note              holds irradiance, as zh3; the radiance is recovered from its first 3 bands" in text


def _set(**values: object) -> Callable[[dict[str, Any]], None]:
    return lambda said: said.update(values)


def _cut(said: dict[str, Any]) -> None:
    said["coefficients"] = said["coefficients"][:-1]


SPOILT: dict[str, tuple[Callable[[dict[str, Any]], None], str]] = {
    "unknown": (_set(encoding="zh5"), "encoding 'zh5': "),
    "too few": (_cut, r"numbers of shape \(4, 3\); zh3 has 5 rows of three"),
    "radiance": (_set(quantity="radiance"), "encoding zh3 is of irradiance, but quantity says radiance"),
    "another's": (_set(encoding="ambient-cube"), "numbers says 'c0 c1 c2 c3 z'; those of ambient-cube are "),
    "phase": (
        _set(convention="shviewer,no-phase", phase="no Condon-Shortley phase"),
        "leave --convention out, and name the axes|phase says",
    ),
    "huge": (_set(coefficients=[[1e200] * 3] * 5), r"a coefficient of 1e\+200; at most 1e\+100 is read"),
    "empty": (_set(coefficients=[]), "coefficients must be rows of three numbers"),
}


@pytest.mark.parametrize("spoilt", SPOILT)
def test_a_file_that_contradicts_itself_is_one_line(tmp_path: Path, spoilt: str) -> None:
    change, said = SPOILT[spoilt]
    made("zh3").save(tmp_path / "a.json")
    held = json.loads((tmp_path / "a.json").read_text())
    change(held)
    (tmp_path / "a.json").write_text(json.dumps(held))
    with pytest.raises(LightError, match=said):
        find_light(str(tmp_path / "a.json"))
