"""Time against error: what each way to project the light has cost in this session, and how good it was, on log axes.

A sheet over the space between the spheres, where it covers least. All errors are of the bands shown, neither muted nor
windowed, so that points differ by their method alone. What lies lower and further left is better.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise

from PIL import Image, ImageDraw, ImageFont

from shviewer.harmonics.metrics import pareto_front
from shviewer.viewer.analysis import BEST, Measurement, measurements, way_of
from shviewer.viewer.composition import Box, Composition
from shviewer.viewer.lettering import ACCENT, FAINT, GREY, INK, MIN_TYPE, RULE, Ink, font, grouped_number, percent
from shviewer.viewer.log_axis import Axis, padded_axis
from shviewer.viewer.picture import Picture

GROUND: Ink = (14, 14, 16, 236)
LOOKS: dict[str, tuple[str, Ink]] = {
    "best": ("diamond", INK),
    "jittered": ("disc", (240, 164, 66, 255)),
    "gauss-legendre": ("square", (60, 190, 150, 255)),
}
"""Shape and colour of each method: told apart by either alone, and by any kind of colour vision."""

WIDTH, HEIGHT = 440, 270
LEAST_WIDTH, LEAST_HEIGHT = 380, 190
"""Of the sheet, in pixels of the design; a smaller one would not hold its legend."""

SHORTEST = 1e-4
"""Milliseconds: a step of a coarse clock, so that a log axis can show what takes no time on it."""

MORE = "M changes the method, S the samples"

Sampling = tuple[str, int, int]
"""Method, samples, seed."""


@dataclass
class Plane:
    """What was drawn where: the sheet, its axes, the middle of each point, and the boxes of all texts."""

    box: Box
    milliseconds: Axis
    error: Axis
    floor: float
    """The error of the best way, which no samples get below."""
    present: Sampling
    places: dict[Sampling, tuple[float, float]]
    front: list[Sampling]
    boxes: dict[str, Box] = field(default_factory=dict)


def measured(picture: Picture) -> tuple[Measurement, ...]:
    """What the plane of a picture shows."""
    return measurements(picture.light, picture.projection.n_bands)


def draw_plane(sheet: Image.Image, picture: Picture, composition: Composition, taken: Iterable[Box]) -> Plane | None:
    """Draw it low between the spheres, clear of the boxes that are taken; None, and nothing drawn, where it does not fit."""
    box = _place(composition, taken)
    known = measured(picture)
    if box is None or not known:
        return None
    drawing = _Drawing(sheet, picture, composition, box, known)
    drawing.axes()
    drawing.legend()
    drawing.lines()
    drawing.points()
    drawing.labels()
    return drawing.plane


def _place(composition: Composition, taken: Iterable[Box]) -> Box | None:
    """The sheet: in the middle, just above the hairline, as high as what is written above it allows."""
    gap = composition.px(10)
    unit = _unit(composition)
    width = min(WIDTH * unit, composition.width - 2 * composition.margin)
    left = (composition.width - width) / 2
    bottom = composition.hairline_y - gap
    above = [
        box.bottom
        for box in taken
        if box.top < composition.hairline_y and box.right > left - gap and box.left < left + width + gap
    ]
    top = max(bottom - HEIGHT * unit, max(above, default=0.0) + gap)
    if width < LEAST_WIDTH * unit or bottom - top < LEAST_HEIGHT * unit:
        return None
    return Box(round(left), round(top), round(left + width), round(bottom))


def _unit(composition: Composition) -> float:
    """A pixel of the design, but not less than the smallest type makes it."""
    return max(composition.px(1), MIN_TYPE / 12)


class _Drawing:
    """One plane being drawn: first what is behind, then what is in front, and labels where there is room."""

    def __init__(
        self,
        sheet: Image.Image,
        picture: Picture,
        composition: Composition,
        box: Box,
        known: Sequence[Measurement],
    ) -> None:
        self.sheet, self.draw = sheet, ImageDraw.Draw(sheet)
        self.picture = picture
        self.unit = _unit(composition)
        self.known = {found.sampling: found for found in known}
        n_bands = picture.state.n_bands
        least = picture.figures.floor  # a smaller error is rounding, and has no place on a log axis
        self.errors = {key: max(float(found.errors[n_bands - 1]), least) for key, found in self.known.items()}
        finite = [error for error in self.errors.values() if math.isfinite(error)]
        floor = self.errors.get(BEST, min(finite))
        self.radius = max(round(4.5 * self.unit), 3)
        self.ring = round(2 * self.radius)
        self.face = font(max(round(12 * self.unit), MIN_TYPE))
        top, bottom = box.top + 58 * self.unit, box.bottom - 46 * self.unit
        error = padded_axis(
            floor, max(finite), 2.0, bottom, top, self.radius + 7 + self.face.size, 14 * self.unit, centred=False
        )
        self.error_ticks = error.ticks(1.6 * self.face.size)
        left = box.left + 24 * self.unit + max((self.face.getlength(_share(t)) for t in self.error_ticks), default=0)
        right = box.right - 18 * self.unit
        self.times = {key: max(found.milliseconds, SHORTEST) for key, found in self.known.items()}
        times = self.times.values()
        milliseconds = padded_axis(
            min(times), max(times), 10.0, left, right, 18 * self.unit, 18 * self.unit, centred=True
        )
        self.area = Box(round(left), round(top), round(right), round(bottom))
        places = {
            key: (milliseconds.at(time), error.at(self.errors[key]))
            for key, time in self.times.items()
            if math.isfinite(self.errors[key])
        }
        keys = list(places)
        best = pareto_front([(self.times[key], self.errors[key]) for key in keys])
        present = way_of(picture.state)
        self.plane = Plane(box, milliseconds, error, floor, present, places, [keys[i] for i in best])
        self.obstacles = [self._around(*place, self.radius + 1) for place in places.values()]
        self.thin: list[Box] = []
        self.draw.rectangle((box.left, box.top, box.right - 1, box.bottom - 1), fill=GROUND)

    def write(
        self, name: str, x: float, y: float, text: str, face: ImageFont.FreeTypeFont, ink: Ink, anchor: str
    ) -> None:
        """Where nothing else can be."""
        self.draw.text((x, y), text, ink, face, anchor=anchor)
        self.plane.boxes[f"plane_{name}"] = Box(*self.draw.textbbox((x, y), text, font=face, anchor=anchor))

    def axes(self) -> None:
        """Title, captions, and a light grid with round values."""
        box, area, unit, state = self.plane.box, self.area, self.unit, self.picture.state
        left, room = box.left + 16 * unit, box.right - box.left - 32 * unit
        title = f"time against error, {state.n_bands} band{'' if state.n_bands == 1 else 's'}"
        apart = [
            words for words, so in (("none muted", state.muted_shown), ("no window", state.window != "none")) if so
        ]
        face = font(max(round(15 * unit), MIN_TYPE))
        titles = [", ".join([title, *apart]), title]
        fitting = next((text for text in titles if face.getlength(text) <= room), title)
        self.write("title", left, box.top + 20 * unit, fitting, face, INK, "lm")
        self.write("error", left, box.top + 41 * unit, "relative L2 error", self.face, FAINT, "lm")
        bands = self.picture.projection.n_bands
        self.write(
            "milliseconds", area.right, box.bottom - 15 * unit, f"ms to project {bands} bands", self.face, FAINT, "rm"
        )
        line = max(1, round(self.unit))
        time_ticks = self.plane.milliseconds.ticks(4 * self.face.size)
        for number, value in enumerate(time_ticks):
            x = round(self.plane.milliseconds.at(value))
            self.draw.rectangle((x, area.top, x + line - 1, area.bottom), fill=RULE)
            self.write(f"time_{number}", x, area.bottom + 13 * unit, _time(value), self.face, GREY, "mm")
        for number, value in enumerate(self.error_ticks):
            y = round(self.plane.error.at(value))
            self.draw.rectangle((area.left, y, area.right, y + line - 1), fill=RULE)
            self.write(f"share_{number}", area.left - 8 * unit, y, _share(value), self.face, GREY, "rm")

    def legend(self) -> None:
        """Right of the caption what each mark stands for, unless there is but one; the best way by its own name if it fits."""
        words = {found.method: found.words for found in self.known.values()}
        if len(words) < 2:
            return
        y, gap = self.plane.box.top + 41 * self.unit, 14 * self.unit
        room = self.area.right - self.plane.boxes["plane_error"].right - gap
        step = 2 * self.radius + 4 + gap
        for names in (words, words | {"best": "best"}):
            if sum(self.face.getlength(name) + step for name in names.values()) <= room:
                break
        else:
            return
        x = self.area.right
        for method in reversed([method for method in LOOKS if method in names]):
            self.write(f"legend_{method}", x, y, names[method], self.face, LOOKS[method][1], "rm")
            x -= self.face.getlength(names[method]) + self.radius + 4
            self._stamp(LOOKS[method][0], self.radius, (x, y), LOOKS[method][1])
            x -= self.radius + gap

    def lines(self) -> None:
        """The floor, dashed, and the front as steps down to it: the best way is the last point of any front."""
        area, plane, line = self.area, self.plane, max(1, round(self.unit))
        y = round(plane.error.at(plane.floor))
        dash = 5 * self.unit
        for i in range(math.ceil((area.right - area.left) / (2 * dash))):
            x = area.left + 2 * i * dash
            self.draw.rectangle((x, y, min(x + dash, area.right), y + line - 1), fill=FAINT)
        self.thin.append(Box(area.left, y - 1, area.right, y + line + 1))
        corners = [(round(x), round(y)) for x, y in (plane.places[key] for key in plane.front)]
        for (left, high), (right, low) in pairwise(corners):
            for piece in (Box(left, high, right, high), Box(right, high, right, low)):
                self.draw.rectangle((piece.left, piece.top, piece.right + line - 1, piece.bottom + line - 1), fill=GREY)
                self.thin.append(Box(piece.left - 1, piece.top - 1, piece.right + line + 1, piece.bottom + line + 1))

    def points(self) -> None:
        """Slow ones first, so that the front stays on top; the present choice last, in a ring."""
        plane = self.plane
        order = sorted(plane.places, key=lambda key: (key == plane.present, -self.times[key]))
        for key in order:
            shape, ink = LOOKS[key[0]]
            self._stamp(shape, self.radius + max(1, round(self.unit)), plane.places[key], (*GROUND[:3], 255))
            self._stamp(shape, self.radius, plane.places[key], ink)
        if plane.present in plane.places:
            self._stamp("ring", self.ring, plane.places[plane.present], ACCENT)
            self.obstacles.append(self._around(*plane.places[plane.present], self.ring))

    def labels(self) -> None:
        """The present choice and the floor, in as many words as there is room for; then the samples of the others."""
        plane, area = self.plane, self.area
        if plane.present in plane.places:
            found = self.known[plane.present]
            name = found.words if plane.present == BEST else f"{found.words} {_count(found.samples)}"
            figures = f"{name}: {grouped_number(found.milliseconds)} ms, {self._percent(self.errors[plane.present])}"
            again = [f"{figures}, best of {found.repetitions}"] if found.repetitions > 1 else []
            texts = (*again, figures, name)
            any(self._label("present", plane.present, text, INK, self.ring + 4) for text in texts) or any(
                self._label("present", plane.present, text, INK, self.ring + 4, anywhere=True) for text in texts
            )
        below = plane.error.at(plane.floor) + self.radius + 4
        n_bands, share = self.picture.state.n_bands, self._percent(plane.floor)
        left_out = f"{n_bands} band{' leaves' if n_bands == 1 else 's leave'} out {share}"
        for text in (f"no samples get below: {left_out}", left_out, share):
            first, last = area.left + 4, area.right - self._size(text)[0] - 4
            if self._put("floor", text, GREY, [(first + k / 20 * (last - first), below) for k in range(21)]):
                break
        if len(plane.places) == 1:
            width, height = self._size(MORE)
            rows = sorted(map(plane.error.at, (*self.error_ticks, plane.floor)))
            lower = max(range(len(rows)), key=lambda i: rows[i] - (rows[i - 1] if i else area.top))
            middle = (rows[lower] + (rows[lower - 1] if lower else area.top)) / 2  # of the widest gap
            self._put("more", MORE, GREY, [((area.left + area.right - width) / 2, middle - height / 2)])
        for key in sorted(plane.places, key=lambda key: -self.times[key]):
            if key not in (plane.present, BEST):
                name = "_".join(map(str, key))
                self._label(name, key, _count(key[1]), LOOKS[key[0]][1], self.radius + 5)

    def _percent(self, share: float) -> str:
        return percent(share, floor=self.picture.figures.floor * (1 + 1e-9))

    def _size(self, text: str) -> tuple[float, float]:
        box = self.draw.textbbox((0, 0), text, font=self.face, anchor="lt")
        return box[2], box[3]

    def _label(self, name: str, key: Sampling, text: str, ink: Ink, reach: float, *, anywhere: bool = False) -> bool:
        """Beside a point, if there is room. anywhere: over lines too, or a little away."""
        x, y = self.plane.places[key]
        width, height = self._size(text)
        above, below = y - reach - height, y + reach
        lefts = [x - share * width for share in (0.5, 0.1, 0.9, 0.3, 0.7)]
        lefts.append(min(max(lefts[0], self.area.left + 4), self.area.right - width - 4))
        tops = (above, below, *(above - k * height for k in (1, 2, 3, 4) if anywhere))
        spots = [(x + reach, y - height / 2), (x - reach - width, y - height / 2)]
        return self._put(name, text, ink, spots + [(left, top) for top in tops for left in lefts], anywhere)

    def _put(
        self, name: str, text: str, ink: Ink, spots: Iterable[tuple[float, float]], over_lines: bool = False
    ) -> bool:
        """Write at the first spot (left, top) where the text is within the axes and touches nothing."""
        obstacles = self.obstacles + list(self.plane.boxes.values()) + ([] if over_lines else self.thin)
        for spot in spots:
            place = round(spot[0]), round(spot[1])
            box = Box(*self.draw.textbbox(place, text, font=self.face, anchor="lt"))
            wide = Box(box.left - 3, box.top - 2, box.right + 3, box.bottom + 2)
            within = (
                wide.left >= self.area.left
                and wide.right <= self.area.right
                and wide.top >= self.area.top
                and wide.bottom <= self.area.bottom
            )
            if within and not any(_overlap(wide, other) for other in obstacles):
                self.draw.rectangle((box.left - 2, box.top - 1, box.right + 1, box.bottom), fill=GROUND)  # off the grid
                self.draw.text(place, text, ink, self.face, anchor="lt")
                self.plane.boxes[f"plane_{name}"] = box
                return True
        return False

    def _around(self, x: float, y: float, reach: float) -> Box:
        return Box(x - reach, y - reach, x + reach, y + reach)

    def _stamp(self, shape: str, radius: int, place: tuple[float, float], ink: Ink) -> None:
        mask = _mask(shape, radius, max(1.5, 0.35 * self.radius))
        corner = round(place[0] - mask.width / 2), round(place[1] - mask.height / 2)
        self.sheet.paste(ink, (*corner, corner[0] + mask.width, corner[1] + mask.height), mask)


@lru_cache(maxsize=64)
def _mask(shape: str, radius: int, thickness: float) -> Image.Image:
    """Coverage of a marker, drawn large and averaged."""
    fine, side = 8, 2 * radius + 3
    image = Image.new("L", (fine * side, fine * side))
    draw = ImageDraw.Draw(image)
    middle, reach = fine * side / 2, float(fine * radius)
    disc, square = ((middle - r, middle - r, middle + r, middle + r) for r in (reach, 0.88 * reach))
    if shape == "diamond":
        near, far = middle - 1.25 * reach, middle + 1.25 * reach
        draw.polygon([(middle, near), (far, middle), (middle, far), (near, middle)], 255)
    elif shape == "square":
        draw.rectangle(square, 255)
    elif shape == "ring":
        draw.ellipse(disc, outline=255, width=round(fine * thickness))
    else:
        draw.ellipse(disc, 255)
    return image.resize((side, side), Image.Resampling.BOX)


def _overlap(one: Box, other: Box) -> bool:
    return one.left < other.right and other.left < one.right and one.top < other.bottom and other.top < one.bottom


def _count(samples: int) -> str:
    """625, 2.5k, 160k, 1M."""
    for size, letter in ((1_000_000, "M"), (1000, "k")):
        if samples >= size:
            return f"{samples / size:.3g}{letter}"
    return str(samples)


def _time(milliseconds: float) -> str:
    return f"{milliseconds:,g}".replace(",", " ")


def _share(share: float) -> str:
    return f"{100 * share:.10f}".rstrip("0").rstrip(".") + " %"
