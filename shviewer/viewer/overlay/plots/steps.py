"""The steps: the fewest bands within the tolerance against roughness, in place of the curve.

A bar under the axis is lit where the bands in use are enough.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from shviewer.analysis.figures import Pending
from shviewer.analysis.roughness import ROUGHNESS, Staircase, staircase
from shviewer.harmonics.quantities.names import IRRADIANCE, roughness_of
from shviewer.limits import MAX_BANDS
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import ACCENT, BAR, FAINT, GREY, GROUND, INK, RULE, UNUSED
from shviewer.viewer.overlay.letters.lettering import SEMIBOLD
from shviewer.viewer.overlay.pieces import Curve, Disc, Fill, Piece
from shviewer.viewer.overlay.plots.curve import RING
from shviewer.viewer.overlay.setting import centred, ended, sentence
from shviewer.viewer.picture import Picture
from shviewer.words import counted

COUNTS = (1, 2, 3, 5, 9, 16, 32, 64, MAX_BANDS)
TICKS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
LABELS = 72.0
"""Room for the labels of the axes at the left, pixels of the design."""

LANE = 5.0
"""The height of the bar under the axis, pixels of the design."""


def steps_of(picture: Picture) -> Staircase | None:
    """The steps of a picture's light; None while figures are pending."""
    return None if isinstance(picture.needs, Pending) else staircase(picture.state.recipe)


def steps_pieces(steps: Staircase | None, picture: Picture, at: Composition) -> list[Piece]:
    """Grid, steps, the line of the bands in use, and what they serve."""
    box, recipe = at.numbers.curve, picture.state.recipe
    assert box is not None
    n_bands, size, line, thick = recipe.n_bands, at.small, at.hair, max(2, round(at.px(LANE)))
    left, right, top, base = box.left + at.px(LABELS), box.right, box.top, box.bottom - thick
    counts = [count for count in steps.counts if count is not None] if steps else []
    most = next(count for count in COUNTS if count >= max([16, n_bands, *counts]))

    def x(roughness: float) -> float:
        return left + (roughness - ROUGHNESS[0]) / (ROUGHNESS[-1] - ROUGHNESS[0]) * (right - left)

    def y(count: float) -> float:
        return base - math.log(count) / math.log(most) * (base - top)

    pieces: list[Piece] = []
    written = [y(n_bands)]
    for count in (count for count in reversed(COUNTS) if count <= most and count != n_bands):
        pieces.append(Fill(Box(left, round(y(count)), right, round(y(count)) + line), RULE))
        if all(abs(y(count) - other) > 1.1 * size for other in written):
            said = f"{count} bands" if count == most else str(count)  # the name of the axis
            written.append(y(count))
            pieces.append(ended(f"count_{count}", left - at.px(8), y(count) + 0.36 * size, said, size, FAINT))
    pieces.append(Fill(Box(left, round(y(n_bands)), right, round(y(n_bands)) + line), ACCENT, "bands_in_use"))
    in_use = counted(n_bands, "band") if n_bands == most else str(n_bands)
    pieces.append(ended("in_use", left - at.px(8), y(n_bands) + 0.36 * size, in_use, size, INK, SEMIBOLD))
    lane = round(base + line)
    pieces.append(Fill(Box(left, lane, right, lane + thick), UNUSED))
    if steps is not None:
        for low, high in steps.served(n_bands):
            served = Box(round(x(low)), lane, max(round(x(high)), round(x(low)) + 2), lane + thick)
            pieces.append(Fill(served, BAR, f"served_{low:g}"))
        for run in _runs(steps):
            points = [(x(ROUGHNESS[run[0]]), y(steps.counts[run[0]] or 1))]
            for number in run[1:]:
                at_x, count = x(ROUGHNESS[number]), steps.counts[number] or 1
                points += [(at_x, points[-1][1])] if y(count) != points[-1][1] else []
                points.append((at_x, y(count)))
            clip = Box(left - 2, top - at.px(4), right + 2, base + 2)
            pieces.append(Curve(tuple(points), at.px(1.8), INK, clip, at.px(1.2), GROUND, name="steps"))
        pieces += _shown(picture, x, y, at)
    baseline = lane + thick + size
    step = next(step for step in (1, 3, 9) if step * (x(0.2) - x(0.1)) >= 3.4 * size or step == 9)
    for roughness in TICKS[::step]:
        name, text = f"roughness_{roughness:g}", f"{roughness:g}"
        pieces.append(centred(name, x(roughness), (left, right), baseline, text, size, GREY))
    pieces.append(ended("roughness_axis", left - at.px(8), baseline, "roughness", size, FAINT))
    return pieces


def steps_legend(steps: Staircase | None, picture: Picture, line: Line, at: Composition) -> list[Piece]:
    """The sentence: what serves shading, and what the bands in use serve."""
    if steps is None:
        return []
    n_bands = picture.state.recipe.n_bands
    said = steps.sentence(n_bands)
    wordings = (said, said.partition(": ")[2], f"{counted(n_bands, 'band')} for {steps.words(n_bands)}")
    return sentence("steps_sentence", line, wordings, at.px(12.0), INK)


def _runs(steps: Staircase) -> list[list[int]]:
    """The numbers of neighbouring roughnesses that have a count."""
    runs: list[list[int]] = [[]]
    for number, count in enumerate(steps.counts):
        if count is not None:
            runs[-1].append(number)
        elif runs[-1]:
            runs.append([])
    return [run for run in runs if run]


def _shown(picture: Picture, x: Callable[[float], float], y: Callable[[float], float], at: Composition) -> list[Piece]:
    """A dot where the quantity shown stands, if it is glossy or irradiance."""
    quantity = picture.state.recipe.quantity
    roughness = 1.0 if quantity == IRRADIANCE else roughness_of(quantity)
    needs = picture.needs
    if roughness is None or isinstance(needs, Pending) or needs.shown is None:
        return []
    return [Disc(x(roughness), y(needs.shown), at.px(RING + 0.6), ACCENT, at.px(1.2), GROUND, "roughness_shown")]
