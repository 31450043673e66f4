"""The curve against figures that are computed apart from it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from helpers import picture_of

from shviewer.analysis.figures import errors_of, load_light
from shviewer.analysis.projections import BEST
from shviewer.analysis.recipe import Recipe
from shviewer.viewer.composing.composition import Composition, compose
from shviewer.viewer.overlay.inks import ACCENT, BAR, GREY, GROUND, INK, UNUSED
from shviewer.viewer.overlay.pieces import Curve, Disc, Fill, Piece
from shviewer.viewer.overlay.plots.band_series import BandSeries, band_series, band_slots
from shviewer.viewer.overlay.plots.curve import Axes, axes_of, curve_blocks, least_slots
from shviewer.viewer.overlay.plots.legend import band_words
from shviewer.viewer.picture import Picture, prepare

AT = compose(1280, 640)


def drawn(shown: Picture, at: Composition = AT) -> tuple[BandSeries, Axes, list[Piece]]:
    series = band_series(shown, least_slots(at))
    return series, axes_of(series, at), [piece for block in curve_blocks(series, shown.state, at) for piece in block]


def bars(pieces: list[Piece], axes: Axes, band: int) -> list[Fill]:
    """The fills in a band's slot that stand on the base."""
    slot = axes.slot(band, 1.0)
    return [
        piece
        for piece in pieces
        if isinstance(piece, Fill) and piece.box.bottom == round(axes.base) and slot.left < piece.box.left < slot.right
    ]


def test_a_bar_is_the_error_with_that_band_alone_left_out() -> None:
    """Muting the band, by the figures: without a window the rest is exact, so nothing else is missing but what is above."""
    whole = picture_of(n_bands=32)
    series, axes, pieces = drawn(whole)
    for band in (0, 1, 4):
        without = picture_of(n_bands=32, muted=frozenset({band}))
        missing = np.sqrt(without.figures.relative_l2**2 - whole.figures.relative_l2**2)
        assert series.worth[band] == pytest.approx(missing, rel=1e-6)
        (bar,) = bars(pieces, axes, band)
        assert bar.box.top == round(axes.y(missing))


@pytest.mark.parametrize("light", ["green", "venice_sunset"])
def test_the_lines_are_the_errors_of_radiance_and_shading_with_bands_0_to_there(light: str) -> None:
    series, axes, pieces = drawn(picture_of(light, n_bands=9))
    for band in (0, 3, 8):
        assert series.errors[band] == pytest.approx(picture_of(light, n_bands=band + 1).figures.relative_l2, rel=1e-6)
        shading = picture_of(light, n_bands=band + 1, quantity="irradiance").figures
        assert series.shading[band] == pytest.approx(max(shading.relative_l2, shading.floor), rel=1e-6)
    (white,) = (piece for piece in pieces if isinstance(piece, Curve) and piece.ink == INK)
    for band in (0, 3, 8):
        assert white.points[band] == pytest.approx((axes.x(band), axes.y(series.errors[band])))


def test_inks_tell_what_is_in_use_muted_and_unused() -> None:
    _, axes, pieces = drawn(picture_of(muted=frozenset({1})))
    assert [(bar.ink, bar.hollow > 0) for bar in bars(pieces, axes, 0)] == [(BAR, False)]
    assert [(bar.ink, bar.hollow > 0) for bar in bars(pieces, axes, 1)] == [(BAR, True)]
    assert [(bar.ink, bar.hollow > 0) for bar in bars(pieces, axes, 5)] == [(UNUSED, False)]


def test_under_a_window_a_bar_is_filled_to_its_factor() -> None:
    shown = picture_of("studio", n_bands=9, window="hann")
    series, axes, pieces = drawn(shown)
    frame, filled = sorted(bars(pieces, axes, 4), key=lambda bar: bar.box.top)
    assert frame.hollow
    assert filled.box.top == round(axes.y(series.worth[4] * shown.figures.factors[4]))


def rings(pieces: list[Piece]) -> list[Disc]:
    return [piece for piece in pieces if isinstance(piece, Disc) and piece.inside == GROUND]


def test_rings_are_where_each_line_first_meets_the_tolerance() -> None:
    shown = picture_of()
    series, axes, pieces = drawn(shown)
    exact = errors_of(load_light(Recipe("green")), BEST)
    first = int(np.flatnonzero(exact <= 0.05)[0]) + 1
    assert series.needed == first == 15
    assert {(ring.x, ring.ink) for ring in rings(pieces)} == {(axes.x(14), INK), (axes.x(2), GREY)}


def dot(pieces: list[Piece]) -> Disc:
    return next(piece for piece in pieces if isinstance(piece, Disc) and piece.ink == ACCENT)


def test_the_dot_is_what_is_shown_on_its_line_or_off_it_with_a_stem() -> None:
    for changes, stem in (
        ({}, False),
        ({"muted": frozenset({1})}, True),
        ({"quantity": "irradiance", "n_bands": 2}, False),
    ):
        shown = picture_of(**changes)
        _, axes, pieces = drawn(shown)
        found = dot(pieces)
        assert (found.x, found.y) == pytest.approx(
            (axes.x(shown.state.recipe.n_bands - 1), axes.y(shown.figures.relative_l2)), abs=1e-9
        )
        assert any(isinstance(piece, Fill) and piece.ink == ACCENT for piece in pieces) == stem


@pytest.mark.parametrize(
    ("error", "low", "high"), [(0.3, 0.01, 1.0), (0.004, 0.001, 1.0), (2.5, 0.01, 10.0), (1e-9, 1e-4, 1.0)]
)
def test_the_axis_is_100_to_1_percent_and_further_where_the_error_is(error: float, low: float, high: float) -> None:
    axes = axes_of(replace(band_series(picture_of()), shown=error), AT)
    assert (axes.low, axes.high) == pytest.approx((low, high))
    assert axes.y(axes.high) == AT.numbers.curve.top
    assert axes.y(axes.low) == AT.numbers.curve.bottom


@pytest.mark.parametrize(
    ("n_bands", "answer", "slots"),
    [(5, 15, 18), (9, None, 18), (16, None, 24), (5, 60, 36), (40, 60, 48), (128, None, 128)],
)
def test_there_is_room_for_a_few_bands_more_and_for_the_answer(n_bands: int, answer: int | None, slots: int) -> None:
    assert band_slots(n_bands, answer) == slots


@pytest.mark.parametrize("light", ["constant", "hemisphere"])
@pytest.mark.parametrize("n_bands", [1, 128])
def test_one_band_and_128_have_a_curve(light: str, n_bands: int) -> None:
    series, axes, pieces = drawn(picture_of(light, n_bands=n_bands))
    assert series.slots >= n_bands
    for piece in pieces:
        assert piece.box.right <= 1280
        assert piece.box.bottom <= axes.base + 30


def test_the_values_of_a_band_are_said_in_words() -> None:
    said = ",  ".join(band_words(band_series(picture_of()), 4)).replace("\u202f", " ")
    assert said.startswith("band 4:  43 % error with it alone left out")
    assert "with bands 0 to 4: 28.3 %" in said
    assert "shading" in said


def test_what_is_compared_has_a_curve_as_far_as_it_goes() -> None:
    from shviewer.lights.coefficient_light import CoefficientLight

    given = CoefficientLight(prepare(picture_of(n_bands=3).state).coefficients, name="mine")
    series, _, pieces = drawn(picture_of(n_bands=3, compare=given))
    assert len(series.errors) == 3
    assert pieces
