"""Time against error: how long each way to project the light has taken in this session, and how good it was, on log axes.

All errors are those with the bands shown, neither muted nor windowed, so that points differ by their method alone. A point
that lies lower and further left is better.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from PIL import Image

from shviewer.analysis.projections import BEST, Measurement, measurements, way_of
from shviewer.harmonics.metrics import pareto_front
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.lettering import ACCENT, FAINT, GREY, INK, RULE
from shviewer.viewer.overlay.plots.log_axis import Axis, padded_axis
from shviewer.viewer.overlay.plots.markers import LOOKS, Place
from shviewer.viewer.overlay.plots.sheet import Entry, Sheet, Size, place
from shviewer.viewer.picture import Picture
from shviewer.words import counted, grouped_number, percent, round_percent, short_count

MOST, LEAST = Size(440, 270), Size(380, 190)
"""Largest and smallest size of the sheet; a smaller one would not hold its legend."""

SHORTEST = 1e-4
"""The least time, in milliseconds: a log axis has no place for the 0 that a coarse clock may measure."""

MORE = "M changes the method, S the samples"

Sampling = tuple[str, int, int]
"""A way to project: method, samples, seed."""


@dataclass
class Plane:
    """The places of a drawn plane, in pixels: the sheet, its axes, the middle of each point, and the boxes of all texts."""

    box: Box
    milliseconds: Axis
    error: Axis
    floor: float
    """The error of the best way, which no samples get below."""
    present: Sampling
    places: dict[Sampling, Place]
    front: list[Sampling]
    boxes: dict[str, Box] = field(default_factory=dict)


def measured(picture: Picture) -> tuple[Measurement, ...]:
    """The measurements that a picture's plane shows."""
    return measurements(picture.light, picture.projection.n_bands)


def draw_plane(image: Image.Image, picture: Picture, composition: Composition, taken: Iterable[Box]) -> Plane | None:
    """Draw the plane clear of the boxes that are taken; None, and nothing drawn, where it does not fit."""
    box = place(composition, taken, MOST, LEAST)
    known = measured(picture)
    if box is None or not known:
        return None
    drawing = _Drawing(Sheet(image, composition, box, "plane"), picture, known)
    drawing.axes()
    drawing.legend()
    drawing.lines()
    drawing.points()
    drawing.labels()
    return drawing.plane


class _Drawing:
    """One plane being drawn."""

    def __init__(self, sheet: Sheet, picture: Picture, known: Sequence[Measurement]) -> None:
        self.sheet, self.picture = sheet, picture
        self.known = {found.sampling: found for found in known}
        box, unit = sheet.box, sheet.unit
        n_bands = picture.state.recipe.n_bands
        least = picture.figures.floor  # a smaller error is rounding, and has no place on a log axis
        self.errors = {key: max(float(found.errors[n_bands - 1]), least) for key, found in self.known.items()}
        finite = [error for error in self.errors.values() if math.isfinite(error)]
        floor = self.errors.get(BEST, min(finite))
        top, bottom = box.top + 58 * unit, box.bottom - 46 * unit
        below = sheet.radius + 7 + sheet.face.size
        error = padded_axis(floor, max(finite), 2.0, bottom, top, below, 14 * unit, centred=False)
        self.error_ticks = sheet.level_ticks(error)
        shares = [sheet.width_of(round_percent(value)) for value in self.error_ticks]
        left, right = box.left + 24 * unit + max(shares, default=0), box.right - 18 * unit
        self.times = {key: max(found.milliseconds, SHORTEST) for key, found in self.known.items()}
        times, pad = self.times.values(), 18 * unit
        milliseconds = padded_axis(min(times), max(times), 10.0, left, right, pad, pad, centred=True)
        self.area = Box(round(left), round(top), round(right), round(bottom))
        places = {
            key: (milliseconds.at(time), error.at(self.errors[key]))
            for key, time in self.times.items()
            if math.isfinite(self.errors[key])
        }
        keys = list(places)
        best = pareto_front([(self.times[key], self.errors[key]) for key in keys])
        present = way_of(picture.state.recipe)
        front = [keys[i] for i in best]
        self.plane = Plane(box, milliseconds, error, floor, present, places, front, sheet.boxes)

    def axes(self) -> None:
        """Draw title, captions, and a faint grid with round values."""
        sheet, area, unit, state = self.sheet, self.area, self.sheet.unit, self.picture.state
        title = f"time against error, {counted(state.recipe.n_bands, 'band')}"
        apart = [
            words
            for words, so in (("none muted", state.recipe.muted_shown), ("no window", state.recipe.window != "none"))
            if so
        ]
        self.caption = sheet.title([", ".join([title, *apart]), title], "relative L2 error")
        words = f"ms to project {self.picture.projection.n_bands} bands"
        sheet.write("milliseconds", area.right, sheet.box.bottom - 15 * unit, words, FAINT, "rm")
        for number, value in enumerate(self.plane.milliseconds.ticks(4 * sheet.face.size)):
            x = round(self.plane.milliseconds.at(value))
            sheet.rule(Box(x, area.top, x + sheet.line, area.bottom + 1), RULE)
            sheet.write(f"time_{number}", x, area.bottom + 13 * unit, _time(value), GREY, "mm")
        sheet.levels("share", self.plane.error, self.error_ticks, area)

    def legend(self) -> None:
        """Write right of the caption what each mark stands for, unless there is only one; name the best way if that fits."""
        words = {found.method: found.words.partition("; ")[0] for found in self.known.values()}
        if len(words) < 2:
            return
        room = self.caption._replace(left=self.caption.right + 14 * self.sheet.unit, right=self.area.right)
        for names in (words, words | {"best": "best"}):
            entries = [Entry(key, shape, names[key], ink) for key, (shape, ink) in LOOKS.items() if key in names]
            if self.sheet.legend(room, entries):
                break

    def lines(self) -> None:
        """Draw the floor, dashed, and the front as steps down to it: the best way is the last point of any front."""
        area, plane, sheet = self.area, self.plane, self.sheet
        sheet.dashes(area.left, area.right, plane.error.at(plane.floor), FAINT)
        corners = [(round(x), round(y)) for x, y in (plane.places[key] for key in plane.front)]
        for (left, high), (right, low) in pairwise(corners):
            sheet.bar(Box(left, high, right + sheet.line, high + sheet.line), GREY)
            sheet.bar(Box(right, high, right + sheet.line, low + sheet.line), GREY)

    def points(self) -> None:
        """Draw the points, slow ones first, so that the front stays on top; the present choice last, in a ring."""
        plane, sheet = self.plane, self.sheet
        order = sorted(plane.places, key=lambda key: (key == plane.present, -self.times[key]))
        for key in order:
            shape, ink = LOOKS[key[0]]
            sheet.point(shape, sheet.radius, plane.places[key], ink)
        if plane.present in plane.places:
            sheet.stamp("ring", sheet.ring, plane.places[plane.present], ACCENT)

    def labels(self) -> None:
        """Write the present choice and the floor in as many words as fit, then the samples of the others."""
        plane, area, sheet = self.plane, self.area, self.sheet
        if plane.present in plane.places:
            found = self.known[plane.present]
            name = found.words if plane.present == BEST else f"{found.words} {short_count(found.samples)}"
            figures = f"{name}: {grouped_number(found.milliseconds)} ms, {self._percent(self.errors[plane.present])}"
            again = [f"{figures}, best of {found.repetitions}"] if found.repetitions > 1 else []
            texts = (*again, figures, name)
            spot, reach = plane.places[plane.present], sheet.ring + sheet.gap + 1
            any(sheet.label("present", spot, text, INK, reach, area) for text in texts) or any(
                sheet.label("present", spot, text, INK, reach, area, away=True, over_lines=True) for text in texts
            )
        below = plane.error.at(plane.floor) + sheet.radius + sheet.gap
        n_bands, share = self.picture.state.recipe.n_bands, self._percent(plane.floor)
        left_out = f"{n_bands} band{' leaves' if n_bands == 1 else 's leave'} out {share}"
        for text in (f"no samples get below: {left_out}", left_out, share):
            if sheet.put("floor", text, GREY, sheet.row(text, below, area), area):
                break
        if len(plane.places) == 1:
            width, height = sheet.size_of(MORE)
            rows = sorted(map(plane.error.at, (*self.error_ticks, plane.floor)))
            lower = max(range(len(rows)), key=lambda i: rows[i] - (rows[i - 1] if i else area.top))
            middle = (rows[lower] + (rows[lower - 1] if lower else area.top)) / 2  # of the widest gap
            sheet.put("more", MORE, GREY, [((area.left + area.right - width) / 2, middle - height / 2)], area)
        for key in sorted(plane.places, key=lambda key: -self.times[key]):
            if key not in (plane.present, BEST):
                name, reach = "_".join(map(str, key)), sheet.radius + sheet.gap + 1
                sheet.label(name, plane.places[key], short_count(key[1]), LOOKS[key[0]][1], reach, area)

    def _percent(self, share: float) -> str:
        return percent(share, floor=self.picture.figures.floor * (1 + 1e-9))


def _time(milliseconds: float) -> str:
    return f"{milliseconds:,g}".replace(",", " ")
