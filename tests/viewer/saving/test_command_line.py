"""The command line of a state makes that state again."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers import frame_of, picture_of

from shviewer.analysis.comparing.compared_files import compared_with
from shviewer.analysis.projected import project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.cli.options.modes import PARSERS
from shviewer.cli.options.states import size_of, state_from
from shviewer.coefficients.programs import OURS
from shviewer.errors import UsageError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.function import FunctionLight
from shviewer.lights.reading import Reading
from shviewer.limits import Limits
from shviewer.viewer import camera
from shviewer.viewer.saving.command_line import arguments_of, command_line
from shviewer.viewer.saving.picture_files import write_exr, write_png
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.state import State, state_of


def made_again(state: State) -> State:
    """The state that the arguments ask for, once they have been through a shell."""
    words = shlex.split(shlex.join(arguments_of(state, (640, 320))))
    options = PARSERS["screenshot"]().parse_intermixed_args(["out.png", *words])
    found = state_from(options, all_lights=False)
    assert size_of(options) == (640, 320)
    return found


def turned(seed: int) -> camera.Quaternion:
    x, y, z, w = np.random.default_rng(seed).normal(size=4)
    size = float(np.linalg.norm([x, y, z, w]))
    return float(x) / size, float(y) / size, float(z) / size, float(w) / size


STATES: dict[str, dict[str, Any]] = {
    "plain": {},
    "numbers": {
        "camera": (1e-7, -1e-5),
        "zoom": 1 / 3,
        "exposure_stops": -1e-9,
        "exposure_offset": -0.5,
        "error_range": 1e-12,
    },
    "bands": {"n_bands": 9, "muted": frozenset({1, 3}), "tolerance": 0.01, "window": "hann", "window_width": 3.5},
    "sampled": {"method": "jittered", "samples": 500, "seed": 3, "evaluate": "map", "n_bands": 40},
    "sun": {"light": "sun-sky", "split_sun": True, "suns": 2, "quantity": "irradiance", "window": "dering"},
    "surfaces": {"lobe_view": True, "marks": False, "tone": "aces", "error": "absolute"},
    "moved": {"zoom": 2.0, "pan": (-0.5, 1e-9), "beside": "method"},
    "map": {"whole_sphere": True, "map_centre": (-30.0, 10.0)},
    "glossy": {"quantity": "glossy:0.4"},
    "basis": {"lobe_view": True, "basis": (3, -2)},
    "image": {"light": "a sky's $HOME.exr", "reading": Reading(True, "lat-long", Limits(77, 2**20 + 1, 3 * 2**19))},
    "layer": {"light": "a sky's $HOME.exr:under"},
    "given": {"light": "-probe.json", "n_bands": 2, "quantity": "irradiance"},
    "bare": {"light": "bare.txt", "reading": Reading(convention="shviewer,no-phase")},
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    write_exr(Path("a sky's $HOME.exr"), np.ones((16, 32, 3), np.float32), "")
    projected = project_recipe(Recipe("green", n_bands=4))
    Path("-probe.json").write_bytes(projected.encode(OURS, "json"))
    np.savetxt("bare.txt", projected.coefficients)
    return tmp_path


def absolute(state: State, folder: Path) -> State:
    """The state with its light named by its whole path, as in the arguments."""
    light = state.recipe.light
    if not isinstance(light, str) or light in ("green", "sun-sky"):
        return state
    return replace(state, recipe=replace(state.recipe, light=str(folder / light)), lights=(str(folder / light),))


@pytest.mark.parametrize("name", STATES)
def test_the_arguments_of_a_state_make_it_again(folder: Path, name: str) -> None:
    state = state_of(**STATES[name])
    assert made_again(state) == absolute(state, folder)


def test_a_compared_file_is_named(folder: Path) -> None:
    compare = compared_with(Recipe(n_bands=3), "-probe.json")[0].compare
    again = made_again(state_of(n_bands=3, compare=compare)).recipe
    assert (again.compare and again.compare.name, again.n_bands) == ("-probe.json", 3)


@pytest.mark.parametrize("seed", range(8))
def test_any_turn_of_the_light_is_told_by_three_angles(seed: int) -> None:
    rotation = turned(seed)
    again = made_again(state_of(light_rotation=rotation)).view.light_rotation
    np.testing.assert_allclose(camera.matrix(again), camera.matrix(rotation), rtol=0, atol=1e-14)


@pytest.mark.parametrize("elevation", [90.0, -90.0])
def test_a_turn_to_a_pole_too(elevation: float) -> None:
    rotation = camera.rolled_towards(30.0, elevation, 20.0)
    again = camera.rolled_towards(*camera.azimuth_elevation_roll(rotation))
    np.testing.assert_allclose(camera.matrix(again), camera.matrix(rotation), rtol=0, atol=1e-14)


def test_the_command_is_quoted_and_a_picture_that_is_an_image_stays_one(folder: Path) -> None:
    text = command_line(picture_of("a sky's $HOME.exr"), (640, 320))
    assert shlex.split(text)[:4] == [
        "shviewer",
        "screenshot",
        "shviewer-a-sky-s-HOME.png",
        str(folder / "a sky's $HOME.exr"),
    ]
    assert "--as-image" not in text
    write_png(folder / "p.png", np.zeros((16, 32, 3), np.uint8), metadata(picture_of(), frame_of(picture_of()), "none"))
    assert made_again(state_of("p.png")).recipe.light == str(folder / "p.png")


@pytest.mark.parametrize(
    "changes",
    [{"light": FunctionLight(np.exp, "mine")}, {"compare": CoefficientLight(np.ones((36, 3)), "mine")}],
)
def test_what_no_text_can_name_is_said(changes: dict[str, Any]) -> None:
    with pytest.raises(UsageError, match=r"mine.*P saves the picture"):
        arguments_of(state_of(**changes), (640, 320))
