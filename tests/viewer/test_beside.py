"""Two reconstructions side by side: the third pane is the second pane of the picture without that choice."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from helpers import frame_of, picture_of

from shviewer.analysis.recipe import Recipe
from shviewer.cli.main import main
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.viewer.beside import besides_of, recipe_beside
from shviewer.viewer.composing.panes import Sphere
from shviewer.viewer.control.actions import next_third
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.screenshot import render_linear, render_rgb
from shviewer.viewer.state import State, state_of

GIVEN = CoefficientLight(np.random.default_rng(0).normal(size=(36, 3)), "given")

SUN = {"light": "sun-sky", "split_sun": True, "n_bands": 6}

PAIRS: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = {
    "window": ("no-window", {"window": "hann", "muted": frozenset({1})}, {"window": "none", "muted": frozenset({1})}),
    "dering": ("no-window", {"window": "dering"}, {"window": "none"}),
    "jittered": ("method", {"samples": 100, "seed": 2}, {"method": "jittered", "samples": 100, "seed": 2}),
    "best": ("method", {"method": "gauss-legendre", "samples": 50}, {"method": "best"}),
    "own": ("own", {"compare": GIVEN}, {}),
    "map": ("no-window", {"window": "gauss", "window_width": 9.0, "n_bands": 40}, {"n_bands": 40}),
    "by map": ("own", {"compare": GIVEN, "evaluate": "map"}, {"evaluate": "map"}),
    "suns": ("no-window", SUN | {"window": "lanczos"}, SUN),
    "irradiance": ("no-window", {"quantity": "irradiance", "window": "hann"}, {"quantity": "irradiance"}),
    "surfaces": ("no-window", {"lobe_view": True, "window": "hann"}, {"lobe_view": True}),
}  # fmt: skip


def pane(pixels: np.ndarray, sphere: Sphere) -> np.ndarray:
    """The square of pixels within a sphere."""
    x, y, reach = int(sphere.x), int(sphere.y), int(sphere.radius * 0.7)
    return pixels[y - reach : y + reach, x - reach : x + reach]


@pytest.mark.parametrize("name", PAIRS)
def test_the_third_pane_is_the_reconstruction_without_that_choice(renderer: Renderer, name: str) -> None:
    """Seen in the third pane of a picture of the same size, whose second pane has the other one."""
    beside, with_it, without = PAIRS[name]
    seen: dict[str, Any] = {"camera": (30.0, -10.0), "marks": False}  # no lines, which stand still while panes do not
    picture, plain = picture_of(**with_it, **seen, beside=beside), picture_of(**without, **seen, error="signed")
    frame = frame_of(picture, 960, 320)
    third = pane(render_rgb(renderer, picture, frame, overlay=False), frame.spheres[2])
    second = pane(render_rgb(renderer, plain, frame, overlay=False), frame.spheres[1])
    first = pane(render_rgb(renderer, picture, frame, overlay=False), frame.spheres[1])
    different = (np.abs(third.astype(int) - first).max(axis=2) > 4).mean()
    if name == "surfaces":  # they have one unit, which is that of the picture's own reconstruction
        assert different > 0.02
        return
    step = np.abs(third.astype(int) - second).max()
    assert step <= (1 if "map" in name else 0)  # of maps the widths may differ
    assert different > 0.02 or name == "suns"  # the rest of that sky is constant, and no window changes it


def test_of_radiance_the_third_pane_of_an_exr_is_the_second_reconstruction(renderer: Renderer) -> None:
    picture = picture_of(window="hann", beside="no-window")
    frame = frame_of(picture, 960, 320)
    pixels = render_linear(renderer, picture, frame)
    x, y = round(frame.spheres[2].x), round(frame.spheres[2].y)
    assert picture.beside is not None
    plain = picture_of(error="signed")
    np.testing.assert_array_equal(pixels[y, x], render_linear(renderer, plain, frame)[y, round(frame.spheres[1].x)])
    assert picture.beside.found.sums.relative_l2 == plain.figures.relative_l2


@pytest.mark.parametrize(
    ("recipe", "wanted"),
    [
        (Recipe(), ["method"]),
        (Recipe(window="hann"), ["no-window", "method"]),
        (Recipe(compare=GIVEN, window="hann"), ["no-window", "own"]),
    ],
)
def test_only_what_differs_is_gone_through(recipe: Recipe, wanted: list[str]) -> None:
    assert list(besides_of(recipe)) == wanted
    assert all(recipe_beside(recipe, beside) != recipe for beside in wanted)
    state, seen = State(recipe), []
    for _ in range(4 + len(wanted)):
        state = next_third(state)
        state.check()
        seen.append(state.view.error if state.view.beside == "off" else state.view.beside)
    assert seen == ["signed", "absolute", "relative", *wanted, "off"]


def test_what_is_shown_no_more_is_left_by_d() -> None:
    state = state_of(beside="no-window")  # the window was taken away meanwhile
    assert next_third(state).view.error == "off"
    assert next_third(state).view.beside == "off"


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--beside", "no-window"], "give --window, too"),
        (["--beside", "own"], "give --compare, too"),
        (["--beside", "method", "--error", "signed"], "a third sphere shows one of them"),
        (["--beside", "all"], "it must be one of off, no-window, method, own"),
    ],
)
def test_what_there_is_not_is_refused(arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["screenshot", "never.png", *arguments]) == 2
    assert says in capsys.readouterr().err
