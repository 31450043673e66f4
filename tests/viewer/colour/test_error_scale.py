"""The error as one number, the range of its colours, and the round numbers under them."""

from __future__ import annotations

import numpy as np
import pytest
from harmonics.independent import random_directions
from helpers import picture_of

from shviewer.viewer.colour.error_scale import QUIET, SPIKE, automatic_range, error_values
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.overlay.colour_bar import colour_bar_pieces, round_ticks, tick_text
from shviewer.viewer.overlay.drawing import layer_of

ORIGINAL = np.array([[1.0, 2.0, 0.5], [0.0, 0.0, 4.0]])
RECONSTRUCTION = np.array([[1.1, 1.5, 0.5], [0.3, -0.1, 4.2]])


def test_the_error_is_that_of_the_channel_where_it_is_largest() -> None:
    np.testing.assert_allclose(error_values("signed", ORIGINAL, RECONSTRUCTION, 0.0), [-0.5, 0.3], atol=1e-15)
    np.testing.assert_allclose(error_values("absolute", ORIGINAL, RECONSTRUCTION, 0.0), [0.5, 0.3], atol=1e-15)


def test_the_relative_error_is_of_the_original_or_of_the_floor_where_that_is_darker() -> None:
    found = error_values("relative", ORIGINAL, RECONSTRUCTION, 0.2)
    np.testing.assert_allclose(found, [0.25, 1.5], atol=1e-15)  # 0.5 of 2, and 0.3 of the floor


def test_the_largest_error_in_any_pixel_is_the_figure_of_that_name() -> None:
    shown = picture_of("studio", n_bands=6)
    rng = np.random.default_rng(0)
    directions = rng.normal(size=(20_000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    errors = error_values("absolute", shown.light.radiance(directions), shown.rest_at(directions), 0.0)
    assert 0.9 * shown.figures.extremes.max_error < errors.max() <= shown.figures.extremes.max_error * (1 + 1e-9)


@pytest.mark.parametrize("error", ["signed", "absolute", "relative"])
def test_no_pixel_has_a_larger_error_than_the_one_that_is_marked(error: str) -> None:
    shown = picture_of("studio", n_bands=7, error=error)
    scale = shown.error_scale
    assert scale is not None
    directions = random_directions(20_000, seed=1)

    def errors(at: np.ndarray) -> np.ndarray:
        return error_values(error, shown.light.radiance(at), shown.rest_at(at), scale.floor)

    assert errors(scale.direction[None])[0] == pytest.approx(scale.largest, rel=1e-9)
    assert 0.9 * abs(scale.largest) < np.abs(errors(directions)).max() <= abs(scale.largest) * (1 + 1e-3)


def test_the_colours_end_at_the_largest_error_unless_it_is_a_spike() -> None:
    shares = np.full(1000, 1e-3)
    even = np.linspace(-1, 1, 1000)
    assert automatic_range("signed", even, shares, 1.0) == 1.0
    spiky = np.append(even[1:], 500.0)
    end = automatic_range("signed", spiky, shares, 500.0)
    assert end == pytest.approx(2.5 * 0.95, rel=0.01)
    weighted = np.where(np.abs(even) > 0.5, 1e-9, 1.0)  # cells at a pole count for nothing
    assert automatic_range("signed", even, weighted / weighted.sum(), 9.0) == pytest.approx(2.5 * 0.475, rel=0.01)


def test_relative_errors_end_at_all_of_it_and_no_error_has_a_range_all_the_same() -> None:
    shares = np.full(10, 0.1)
    assert automatic_range("relative", np.full(10, 7.0), shares, 7.0) == 1.0
    assert automatic_range("relative", np.full(10, 0.2), shares, 0.2) == 0.2
    assert automatic_range("absolute", np.zeros(10), shares, 0.0) == 1.0


@pytest.mark.parametrize("light", ["green", "hemisphere", "cosine"])
def test_a_light_without_spikes_is_coloured_up_to_its_largest_error(light: str) -> None:
    shown = picture_of(light, n_bands=5, error="signed")
    assert shown.error_scale.end == pytest.approx(shown.figures.extremes.max_error, rel=1e-9)
    assert not shown.error_scale.beyond


def test_a_sun_does_not_leave_the_rest_without_colours() -> None:
    shown = picture_of("venice_sunset", n_bands=9, error="signed")
    assert shown.error_scale.beyond
    assert shown.error_scale.end < 0.01 * shown.figures.extremes.max_error


@pytest.mark.parametrize(
    ("low", "high", "most", "ticks"),
    [
        (-0.266, 0.266, 7, [-0.2, -0.1, 0.0, 0.1, 0.2]),
        (0.0, 1.0, 7, [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]),
        (0.0, 1.0, 3, [0.0, 0.5, 1.0]),
        (-7.4, 7.4, 9, [-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0]),
        (0.0, 2.6e-7, 4, [0.0, 1e-7, 2e-7]),
        (0.0, 1.9e5, 5, [0.0, 5e4, 1e5, 1.5e5]),
        (1.0, 1.0, 5, []),
    ],
)
def test_ticks_are_round_and_hold_zero(low: float, high: float, most: int, ticks: list[float]) -> None:
    np.testing.assert_allclose(round_ticks(low, high, most), ticks, rtol=1e-12, atol=0)


def test_ticks_have_as_many_decimals_as_the_finest_of_them() -> None:
    assert [tick_text(tick, [0.0, 0.05, 0.1], percent=False) for tick in (0.0, 0.05, 0.1)] == ["0", "0.05", "0.10"]
    assert [tick_text(tick, [0.0, 0.025, 0.05], percent=True) for tick in (0.0, 0.025)] == ["0 %", "2.5 %"]
    assert tick_text(1.5e5, [0.0, 1.5e5], percent=False) == "1.5e5"
    assert tick_text(2e-7, [0.0, 2e-7], percent=False) == "2e-7"


@pytest.mark.parametrize("error", ["signed", "absolute", "relative"])
@pytest.mark.parametrize("size", [(640, 320), (1280, 640), (900, 1200), (2560, 1440)])
def test_a_tick_stands_under_its_colour(error: str, size: tuple[int, int]) -> None:
    shown = picture_of(error=error)
    pieces = colour_bar_pieces(shown, compose(*size, n_spheres=3))
    layer, boxes = layer_of(tuple(pieces)), {piece.name: piece.box for piece in pieces}
    assert layer is not None
    bar = boxes["colour_bar"]
    ticks = [box for name, box in boxes.items() if name.startswith("error_tick")]
    assert len(ticks) >= 2
    middle = (bar.left + bar.right) / 2
    if error == "signed":  # zero is in the middle
        assert min(abs((box.left + box.right) / 2 - middle) for box in ticks) < 2
    row = layer.image[int(bar.top) - layer.top + 2]
    luminance = row[:, :3] @ [0.2126, 0.7152, 0.0722]
    inside = luminance[int(bar.left) - layer.left : int(bar.right) - layer.left]
    assert inside.argmin() == pytest.approx(len(inside) / 2 if error == "signed" else 0, abs=0.1 * len(inside))


@pytest.mark.parametrize("seed", range(4))
def test_what_is_quiet_is_the_same_as_by_sorting_all_of_the_sphere(seed: int) -> None:
    """Where the largest errors are on rows next to a pole, many of them are little of the sphere."""
    random = np.random.default_rng(seed)
    rows = np.sin(np.pi * (np.arange(64) + 0.5) / 64)
    shares = np.repeat(rows / rows.sum() / 128, 128)
    errors = random.lognormal(sigma=2, size=shares.size) / (shares if seed % 2 else 1)
    order = np.argsort(errors)
    wanted = errors[order][np.searchsorted(np.cumsum(shares[order]), QUIET)]
    assert automatic_range("absolute", errors, shares, np.inf) == SPIKE * wanted
