"""Time against error, in place of the curve: how long each way to project the light took in this session, and how good it was.

All errors are those with the bands shown, neither muted nor windowed, so that points differ by their method alone. A point
that lies lower and further left is better.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from shviewer.analysis.projections import BEST, Measurement, Way, measurements, way_of
from shviewer.harmonics.metrics import pareto_front
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import ACCENT, FAINT, GREY, GROUND, INK, RULE, Ink
from shviewer.viewer.overlay.letters.lettering import MEDIUM, width_of
from shviewer.viewer.overlay.letters.numerals import share, typeset
from shviewer.viewer.overlay.pieces import Curve, Disc, Fill, Piece, Point, Text
from shviewer.viewer.overlay.plots.log_axis import Axis, padded_axis
from shviewer.viewer.overlay.setting import centred, dashes, ended, sentence
from shviewer.viewer.picture import Picture
from shviewer.words import grouped_number, round_percent, short_count

LOOKS: dict[str, tuple[str, Ink]] = {
    "best": ("diamond", INK),
    "jittered": ("disc", (240, 164, 66, 255)),
    "gauss-legendre": ("square", (60, 190, 150, 255)),
}
"""Shape and colour of each method: either alone tells them apart, to any kind of colour vision."""

LABELS, MARK, APART = 68.0, 4.5, 14.0
"""Room for the labels of the axis at its left, half a mark, and what is free beside the points; pixels of the design."""

SHORTEST, LEAST = 1e-4, 1e-5
"""The least time, in milliseconds, and the least error: a log axis has no place for 0, nor for what is only rounding."""

MORE = "M changes the method, S the samples"


@dataclass(frozen=True)
class Plane:
    """The axes in a frame, and the places of the points in pixels."""

    area: Box
    milliseconds: Axis
    error: Axis
    known: dict[Way, Measurement]
    errors: dict[Way, float]
    floor: float
    """The error of the best way, which no samples get below."""
    present: Way
    places: dict[Way, Point]
    front: list[Way]


def measured(picture: Picture) -> tuple[Measurement, ...]:
    """The measurements that a picture's plane shows."""
    return measurements(picture.light, picture.projection.n_bands)


def plane_of(picture: Picture, at: Composition) -> Plane | None:
    """The plane of a picture in the place of the curve; None where there is none, or nothing was measured."""
    box, known = at.numbers.curve, {found.way: found for found in measured(picture)}
    least = max(picture.figures.floor, LEAST)
    errors = {key: max(float(found.errors[picture.state.recipe.n_bands - 1]), least) for key, found in known.items()}
    times = {key: max(found.milliseconds, SHORTEST) for key, found in known.items()}
    keys = [key for key in known if math.isfinite(errors[key])]
    if box is None or not keys:
        return None
    floor = errors.get(BEST, min(errors[key] for key in keys))
    area, pad = box._replace(left=box.left + at.px(LABELS)), at.px(APART)
    highest = max(errors[key] for key in keys)
    error = padded_axis(floor, highest, 2.0, area.bottom, area.top, pad, pad, centred=False)
    every = times.values()
    milliseconds = padded_axis(min(every), max(every), 10.0, area.left, area.right, pad, pad, centred=True)
    places = {key: (milliseconds.at(times[key]), error.at(errors[key])) for key in keys}
    front = [keys[i] for i in pareto_front([(times[key], errors[key]) for key in keys])]
    return Plane(
        area, milliseconds, error, known, errors, floor, way_of(picture.state.recipe)._replace(turn=None), places, front
    )


def plane_pieces(plane: Plane, at: Composition) -> list[Piece]:
    """Grid, floor and front; the points, slow ones first, so that the front is on top, and the present choice in a ring."""
    pieces = [*_axes(plane, at), *_front(plane, at)]
    order = sorted(plane.places, key=lambda key: (key == plane.present, -plane.places[key][0]))
    for key in order:
        (x, y), (shape, ink) = plane.places[key], LOOKS[key.method]
        if key == plane.present:
            pieces.append(Disc(x, y, at.px(2 * MARK), ACCENT, at.px(1.5), GROUND, "plane_present"))
        pieces += [_mark(shape, x, y, at.px(MARK + 1), GROUND), _mark(shape, x, y, at.px(MARK), ink)]
    return [*pieces, *_samples(plane, at)]


def plane_legend(plane: Plane, picture: Picture, line: Line, at: Composition) -> list[Piece]:
    """What each mark stands for, unless there is one alone, and the figures of the present choice, whose room comes first."""
    size, n_bands = at.px(12.0), picture.state.recipe.n_bands
    said = [MORE] if len(plane.places) == 1 else [""]
    if plane.present in plane.places:
        found, error = plane.known[plane.present], share(plane.errors[plane.present], floor=picture.figures.floor)
        name = _words(found) if plane.present == BEST else f"{_words(found)} {short_count(found.way.samples)}"
        time = f"{name}: {grouped_number(found.milliseconds)} ms"
        full = f"{time} for {picture.projection.n_bands} bands, {error} in {n_bands}"
        said = [*(f"{full}; {MORE}" for _ in said if said[0]), full, f"{time}, {error}"]
    shown = {key.method for key in plane.places}
    for names in ([method for method in LOOKS if method in shown], []):
        pieces: list[Piece] = []
        x = line.left
        for method in names if len(names) > 1 else []:
            words = _words(next(found for found in plane.known.values() if found.way.method == method))
            shape, ink = LOOKS[method]
            pieces.append(_mark(shape, x + at.px(MARK), line.baseline - 0.36 * size, at.px(MARK), ink))
            name = "best" if method == "best" else words
            pieces.append(Text(f"plane_{method}", round(x + at.px(14)), line.baseline, name, size, GREY))
            x = pieces[-1].box.right + at.px(18)
        if x + width_of(typeset(said[-1]), size) <= line.right:
            break
    return [*pieces, *sentence("plane_sentence", line._replace(left=round(x)), said, size, INK)]


def _axes(plane: Plane, at: Composition) -> Iterator[Piece]:
    """Round errors and times with their lines, and the floor as a dashed line with its error."""
    area, size, line = plane.area, at.small, at.hair
    end, baseline = area.left - at.px(8), area.bottom + at.px(13 if at.compact else 17)
    level = round(plane.error.at(plane.floor))
    floor = ended("plane_floor", end, level + 0.36 * size, share(plane.floor), size, INK, MEDIUM)
    axis = ended("plane_milliseconds", end, baseline, "ms", size, FAINT)
    for number, value in enumerate(plane.error.ticks(1.6 * size)):
        y = round(plane.error.at(value))
        yield Fill(Box(area.left, y, area.right, y + line), RULE)
        label = ended(f"plane_share_{number}", end, y + 0.36 * size, round_percent(value), size, FAINT)
        if not (label.box.overlaps(floor.box) or label.box.overlaps(axis.box)):
            yield label
    for number, value in enumerate(plane.milliseconds.ticks(4 * size)):
        x, text = round(plane.milliseconds.at(value)), f"{value:,g}".replace(",", " ")
        yield Fill(Box(x, area.top, x + line, area.bottom), RULE)
        yield centred(f"plane_time_{number}", x, (area.left, area.right), baseline, text, size, GREY)
    yield from (axis, floor, *dashes(area.left, area.right, level, at))


def _front(plane: Plane, at: Composition) -> Iterator[Piece]:
    """The front as steps down: the best way is the last point of any front."""
    line = at.hair
    corners = [(round(x), round(y)) for x, y in (plane.places[key] for key in plane.front)]
    for (left, high), (right, low) in pairwise(corners):
        yield Fill(Box(left, high, right + line, high + line), GREY)
        yield Fill(Box(right, high, right + line, low + line), GREY)


def _samples(plane: Plane, at: Composition) -> Iterator[Piece]:
    """How many samples a point has, over or under it, where nothing else is."""
    size, reach = at.small, at.px(MARK)
    taken = [Box(x, y, x, y).grown(reach, reach) for x, y in plane.places.values()]
    for key in sorted(plane.places, key=lambda key: -plane.places[key][0]):
        x, y = plane.places[key]
        ring = reach if key == plane.present else 0.0
        for baseline in (y - reach - ring - at.px(3), y + reach + ring + at.px(3) + 0.76 * size) if key != BEST else ():
            text, name = short_count(key.samples), f"plane_{key.method}_{key.samples}_{key.seed}"
            left = x - width_of(text, size) / 2
            label = Text(
                name, round(left), round(baseline), text, size, LOOKS[key.method][1], casing=at.px(1.6), rim=GROUND
            )
            if label.box.inside(plane.area) and not any(label.box.overlaps(other) for other in taken):
                taken.append(label.box.grown(0.5 * size, 0))
                yield label
                break


def _mark(shape: str, x: float, y: float, reach: float, ink: Ink) -> Piece:
    around = Box(x, y, x, y).grown(reach, reach)
    if shape == "disc":
        return Disc(x, y, reach, ink)
    if shape == "square":
        return Fill(Box(*(float(round(side)) for side in around)), ink)
    corners = ((x, around.top), (around.right, y), (x, around.bottom), (around.left, y))
    return Curve(corners, 0.0, ink, around.grown(1, 1), closed=True)


def _words(found: Measurement) -> str:
    """The method, without what it may miss."""
    return found.words.partition("; ")[0]
