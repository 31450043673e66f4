"""The curve: how the error falls as bands are added, over what each band alone is worth, on one logarithmic axis.

A bar is the square root of the band's share of the energy, which is the error with that band alone left out. So bars and
lines have the same unit, and what is off the chart is never silent.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import ACCENT, BAR, FAINT, GREY, GROUND, INK, RULE, UNUSED, Ink
from shviewer.viewer.overlay.letters.lettering import MEDIUM, REGULAR, SEMIBOLD, width_of
from shviewer.viewer.overlay.pieces import Curve, Disc, Fill, Piece
from shviewer.viewer.overlay.plots.band_series import BandSeries
from shviewer.viewer.overlay.setting import centred, dashes, ended
from shviewer.viewer.state import State
from shviewer.words import round_percent

LABELS = 44.0
"""Room for the labels of the axis at its left, pixels of the design."""

BAR_SHARE, WIDEST_BAR, STUB = 0.62, 26.0, 1.5
"""A bar's share of its slot, its largest width, and its height where it is under the axis."""

RING, RING_WIDTH = 4.2, 1.6
LOWEST = 1e-4
"""The least error that the axis goes down to."""

LEAST_SLOTS, NARROW_SLOTS, COMPACT_SLOTS = 18, 16, 14


@dataclass(frozen=True)
class Axes:
    """The places of bands and of errors. Band l has its slot between `bar(l)` left and right."""

    left: float
    right: float
    top: float
    base: float
    slots: int
    high: float
    low: float

    @property
    def pitch(self) -> float:
        return (self.right - self.left) / self.slots

    def x(self, band: int) -> float:
        """The middle of a band's slot."""
        return self.left + (band + 0.5) * self.pitch

    def y(self, error: float) -> float:
        """The height of an error; under the axis for one below it."""
        down = math.log(max(error, self.low / 100) / self.low) / math.log(self.high / self.low)
        return self.base - down * (self.base - self.top)

    def within(self, error: float) -> float:
        """The height of an error, or the end of the axis that it lies beyond."""
        return min(max(self.y(error), self.top), self.base)

    def slot(self, band: int, below: float) -> Box:
        """Where a click means the band: its slot and its number."""
        return Box(self.x(band) - self.pitch / 2, self.top, self.x(band) + self.pitch / 2, self.base + below)


def least_slots(at: Composition) -> int:
    """The fewest bands that the axis of a frame shows."""
    curve = at.numbers.curve
    if at.compact:
        return COMPACT_SLOTS
    return LEAST_SLOTS if curve is None or curve.width >= at.px(500) else NARROW_SLOTS


def axes_of(series: BandSeries, at: Composition) -> Axes:
    """The axes of a frame that has room for the curve: 100 % to 1 %, and further where the error shown is further."""
    box = at.numbers.curve
    assert box is not None
    high, low = 1.0, 0.01
    if math.isfinite(series.shown):
        high = 10.0 if series.shown > 1.05 else 1.0
        while low > LOWEST and series.shown < low:
            low /= 10
    labels = at.px(LABELS if low >= 0.001 else LABELS + 6)
    return Axes(box.left + labels, box.right, box.top, box.bottom, series.slots, high, low)


def curve_blocks(series: BandSeries, state: State, at: Composition) -> list[list[Piece]]:
    """Grid, bars, lines, rings, and the dot of what is shown.

    In three blocks, the first at the bottom: of a band key the one between, lines and rings, stays as it is.
    """
    axes = axes_of(series, at)
    under = _grid(axes, series, at)
    for band, worth in enumerate(series.worth):
        under += _bar(axes, band, worth, series, at)
    lines: list[Piece] = []
    clip = Box(axes.left - at.px(8), axes.top - at.px(10), axes.right + at.px(8), axes.base)
    for errors, ink, width in ((series.shading, GREY, 1.6), (series.errors, INK, 1.8)):
        points = [(axes.x(band), axes.y(error)) for band, error in enumerate(errors) if math.isfinite(error)]
        if len(points) > 1 and min(y for _, y in points) < axes.base:
            last = max(number for number, (_, y) in enumerate(points) if y < axes.base + at.px(6))
            lines.append(Curve(tuple(points[: last + 2]), at.px(width), ink, clip, at.px(1.2), GROUND))
    for errors, needed, ink in ((series.shading, series.shading_needed, GREY), (series.errors, series.needed, INK)):
        if needed is not None and needed <= min(len(errors), axes.slots):
            lines += _ring(axes, needed - 1, errors[needed - 1], ink, at)
    n_bands = state.recipe.n_bands
    return [[*under, *_numbers(axes, state, at)], lines, _dot(axes, series, n_bands, at)]


def _grid(axes: Axes, series: BandSeries, at: Composition) -> list[Piece]:
    """The powers of ten, and the tolerance as a dashed line."""
    size, line, end = at.small, at.hair, axes.left - at.px(8)
    pieces: list[Piece] = []
    decades = round(math.log10(axes.high / axes.low))
    step = 1 if (axes.base - axes.top) / decades >= 1.2 * size else 2
    within, said, tolerance = axes.y(series.tolerance), round_percent(series.tolerance), None
    if axes.low <= series.tolerance <= axes.high:
        tolerance = ended("tolerance", end, within + 0.36 * size, said, size, INK, MEDIUM)
    for number in range(decades + 1):
        error = axes.high / 10**number
        y = round(axes.y(error))
        pieces.append(Fill(Box(axes.left, y, axes.right, y + line), RULE))
        baseline = y + line if number == decades else y + 0.36 * size
        label = ended(f"share_{number}", end, baseline, round_percent(error), size, FAINT)
        if number % step == 0 and not (tolerance and label.box.overlaps(tolerance.box)):
            pieces.append(label)
    return [*pieces, *dashes(axes.left, axes.right, round(within), at), tolerance] if tolerance else pieces


def _bar(axes: Axes, band: int, worth: float, series: BandSeries, at: Composition) -> list[Piece]:
    """The bar of a band: filled in use, to its part under a window, hollow if muted, grey above the bands in use."""
    if worth <= 0:
        return []
    half = max(min(BAR_SHARE * axes.pitch, at.px(WIDEST_BAR)), 1.0) / 2
    left, right = round(axes.x(band) - half), round(axes.x(band) + half)
    right, base = max(right, left + 1), round(axes.base)
    top = min(max(round(axes.y(worth)), axes.top), base - max(1, round(at.px(STUB))))
    bar = Box(left, top, right, base)
    if band >= len(series.factors):
        return [Fill(bar, UNUSED)]
    factor = min(max(series.factors[band], 0.0), 1.0)
    if factor >= 1.0:
        return [Fill(bar, BAR)]
    pieces: list[Piece] = [Fill(bar, BAR, hollow=at.scale)]
    kept = round(axes.y(worth * factor)) if factor > 0 else base
    return [*pieces, Fill(bar._replace(top=max(kept, top)), BAR)] if kept < base else pieces


def _numbers(axes: Axes, state: State, at: Composition) -> list[Piece]:
    """The numbers of the bands, as many as have room, the last one in use in bold; and the cursor."""
    size, n_bands = at.small, state.recipe.n_bands
    baseline = axes.base + at.px(13 if at.compact else 17)
    widest = width_of(str(axes.slots - 1), size) + at.px(6)
    step = next(step for step in (1, 2, 4, 8, 16, 32) if step * axes.pitch >= widest or step == 32)
    muted = state.recipe.muted_shown
    pieces: list[Piece] = [ended("band", axes.left - at.px(8), baseline, "band", size, FAINT)]
    here = n_bands - 1
    middle = min(axes.x(here), axes.right - widest / 2)
    for band in range(axes.slots):
        near = step > 1 and abs(axes.x(band) - middle) < widest
        if band != here and (band % step or near):
            continue
        weight = SEMIBOLD if band == here else REGULAR
        ink = INK if band == here else FAINT if band > here or band in muted else GREY
        pieces.append(centred(f"band_{band}", axes.x(band), (0, axes.right), baseline, str(band), size, ink, weight))
    if state.view.cursor_visible and state.view.cursor < n_bands:
        middle, half = axes.x(state.view.cursor), max(axes.pitch * BAR_SHARE / 2, 2.0)
        y, thick = round(axes.base + at.px(2)), max(2, round(at.px(2)))
        pieces.append(Fill(Box(round(middle - half), y, round(middle + half), y + thick), INK, "cursor"))
    return pieces


def _ring(axes: Axes, band: int, error: float, ink: Ink, at: Composition) -> list[Piece]:
    """The first band count within the tolerance, with its number over it."""
    x, y = axes.x(band), axes.within(error)
    name, above = f"ring_{ink is INK}_{band}", round(y - at.px(8))
    number = centred(name, x, (0, axes.right), above, str(band + 1), at.small, ink, SEMIBOLD)
    return [
        Disc(x, y, at.px(RING - 0.7), ink, at.px(RING_WIDTH), GROUND),
        replace(number, casing=at.px(1.6), rim=GROUND),
    ]


def _dot(axes: Axes, series: BandSeries, n_bands: int, at: Composition) -> list[Piece]:
    """What is shown now: on its line, or off it, joined by a stem, where bands are muted or windowed."""
    if not math.isfinite(series.shown) or n_bands > axes.slots:
        return []
    x, y = axes.x(n_bands - 1), axes.within(series.shown)
    line = series.shading if series.on_shading else series.errors
    pieces: list[Piece] = []
    if n_bands <= len(line) and math.isfinite(line[n_bands - 1]):
        whole = axes.within(line[n_bands - 1])
        if abs(whole - y) > at.px(2):
            high, low = sorted((round(whole), round(y)))
            left = round(x - at.scale / 2)
            pieces.append(Fill(Box(left, high, left + at.hair, low), ACCENT))
    rim = Disc(x, y, at.px(RING + 0.3), GROUND, at.px(1.0), ACCENT)  # dark, so that the dot is apart from its line
    return [*pieces, Disc(x, y, at.px(RING + 0.6), ACCENT, at.px(1.2), ACCENT), rim]
