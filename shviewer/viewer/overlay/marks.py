"""Marks of the original's peak, of the lowest radiance and of the largest error: a ring, with the value beside it.

What is on the far side of a sphere has a triangle outside the limb, so that nothing lies on what is in front. Marks move with
the spheres, so they are layers of their own: turning draws no text anew.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from math import atan2, cos, degrees, pi, radians, sin

import numpy as np

from shviewer.analysis.figures import Pending
from shviewer.harmonics.basis import Array
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box, Pane, Sphere
from shviewer.viewer.overlay.drawing import layer_of
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.lettering import GREY, INK, MEDIUM
from shviewer.viewer.overlay.numerals import share, value
from shviewer.viewer.overlay.pieces import Curve, Piece, Point, Text
from shviewer.viewer.picture import Picture

RING, COMPACT_RING, THICKNESS, CASING_WIDTH = 6.5, 5.2, 1.5, 1.4
"""Radius of a ring and in a compact frame, its line and the dark rim, in pixels of the design."""

TYPE, COMPACT_TYPE, GAP = 12.0, 11.0, 5.0
"""Sizes of the text, and the space before it."""

AWAY, BASE, HEIGHT = 3.0, 7.0, 10.0
"""The triangle: its distance from the limb, its base and its height."""

STEP = 3
"""Degrees in which triangles turn, and in which room for their text is sought along the limb."""

NEAR, FARTHEST = 30, 84
"""Degrees along the limb between a triangle and its text: up to NEAR all words are kept."""

CLEAR, OFF, ASIDE = 3.0, 8.0, 14.0
"""Pixels of the design between those words and a sphere; over and under them, and beside them, to other text, whose lines they
are not."""

ORIGINAL, RECONSTRUCTION, ERROR = 0, 1, 2
FAR = Box(-1e6, -1e6, 1e6, 1e6)


@dataclass(frozen=True, eq=False)
class Mark:
    """A marked direction of the light in one of the panes, and the text beside it."""

    name: str
    pane: int
    direction: Array
    text: str


@dataclass(frozen=True)
class Placed:
    """A mark in a frame: its pixel, the box of its text, and the layers that show both."""

    x: float
    y: float
    behind: bool
    """Whether it is on the far side: then x, y is where one would see it through the sphere."""
    label: Box | None
    """None where there is no room for words."""
    layers: tuple[Layer, ...]


def marks_of(picture: Picture) -> list[Mark]:
    """Marks of a peak, of the minimum, if it is negative, and of the largest error, if it is shown; surfaces have none."""
    state, extremes, peak = picture.state, picture.extremes, picture.peak
    marks: list[Mark] = []
    if not state.view.marks or state.view.lobe_view or state.view.help_visible:
        return marks
    if peak is not None:
        marks.append(Mark("peak", ORIGINAL, peak.direction, f"peak {value(peak.radiance, 0.0)}"))
    if isinstance(extremes, Pending):
        return marks
    lowest = value(extremes.minimum, extremes.peak)
    if extremes.minimum < 0 and lowest != "0":
        marks.append(Mark("minimum", RECONSTRUCTION, np.array(extremes.minimum_direction), f"minimum {lowest}"))
    scale = picture.error_scale
    if scale is not None and scale.worth_showing:
        said = share(scale.largest) if scale.kind == "relative" else value(scale.largest, extremes.peak)
        sign = "+" if scale.kind == "signed" and scale.largest > 0 else ""
        marks.append(Mark("largest", ERROR, scale.direction, f"largest {sign}{said}"))
    return marks


def place_marks(picture: Picture, composition: Composition, obstacles: Sequence[Box] = ()) -> dict[str, Placed]:
    """The marks in sight, by name. A mark that meets an obstacle is left out, and no text of a mark touches an obstacle."""
    placed = {}
    for mark in marks_of(picture):
        pane = composition.panes[mark.pane]
        x, y, behind = pane.place(picture.light_from_world.T @ mark.direction, picture.world_from_view)
        if behind and isinstance(pane, Sphere):
            found = _outside(mark, x, y, pane, composition, obstacles)
        elif pane.clip.contains(x, y) and _free(_around(x, y, composition), obstacles):
            found = _on(mark.text, x, y, pane, composition, obstacles)
        else:
            found = None
        if found is not None:
            placed[mark.name] = found
            obstacles = (*obstacles, found.label) if found.label else obstacles
    return placed


def mark_layers(picture: Picture, composition: Composition, obstacles: Sequence[Box] = ()) -> tuple[Layer, ...]:
    return tuple(layer for mark in place_marks(picture, composition, obstacles).values() for layer in mark.layers)


def _around(x: float, y: float, composition: Composition) -> Box:
    """The box of a ring and of its rim."""
    reach = _radius(composition) + composition.px(THICKNESS / 2 + CASING_WIDTH)
    return Box(x - reach, y - reach, x + reach, y + reach)


def _on(text: str, x: float, y: float, pane: Pane, composition: Composition, obstacles: Sequence[Box]) -> Placed:
    """A ring with its text at the right, or at the left, or without one where there is no room."""
    radius = _radius(composition)
    left, top = round(x - 0.5), round(y - 0.5)
    ring = _ring(radius, composition.scale)
    size, reach = _type(composition), radius + composition.px(GAP)
    baseline = 0.5 + 0.36 * size
    words = Text("", 0.0, baseline, text, size, INK, MEDIUM, composition.px(CASING_WIDTH))
    high, low = pane.clip.top + 2 - (top + words.box.top), pane.clip.bottom - 2 - (top + words.box.bottom)
    level = min(max(0.0, high), low)
    for start in (0.5 + reach, 0.5 - reach - words.right):
        moved = _moved(words, start, round(level) + baseline)
        box = _shifted(moved.box, left, top)
        if pane.clip.left + 2 <= box.left and box.right + 2 <= pane.clip.right and _free(box, obstacles):
            return Placed(x, y, False, box, _within_map(_layers((ring, moved), left, top), pane))
    return Placed(x, y, False, None, _within_map(_layers((ring,), left, top), pane))


def _within_map(layers: tuple[Layer, ...], pane: Pane) -> tuple[Layer, ...]:
    """Layers as far as they lie on a map, whose head stands close to it; on a sphere as they are."""
    if isinstance(pane, Sphere):
        return layers
    found = []
    for image, left, top in layers:
        above, under = max(round(pane.clip.top) - top, 0), max(round(pane.clip.bottom) - top, 0)
        found.append(
            Layer(image[above:under], left, top + above) if above or under < len(image) else Layer(image, left, top)
        )
    return tuple(found)


def _outside(
    mark: Mark, x: float, y: float, sphere: Sphere, composition: Composition, obstacles: Sequence[Box]
) -> Placed | None:
    """A triangle outside the limb that points away from the sphere, and its text where there is room; None without any.

    Where all words have none, near it or along the limb, the value alone has.
    """
    angle = STEP * round(degrees(atan2(sphere.y - y, x - sphere.x)) / STEP)
    away = sphere.radius + composition.px(AWAY + HEIGHT / 2)
    middle = sphere.x + away * cos(radians(angle)), sphere.y - away * sin(radians(angle))
    drawn = _triangle(angle, composition.scale)
    room = _room(composition)
    across, down = zip(*drawn.points, strict=True)
    around = _shifted(Box(min(across), min(down), max(across), max(down)), *middle)
    if not (_within(around, room) and sphere.clip.contains(*_limb(sphere, angle)) and _free(around, obstacles)):
        return None
    left, top = round(middle[0]), round(middle[1])
    triangle = _layers((drawn,), left, top)
    size = _type(composition)
    side = sphere.x - composition.captions[mark.pane].head.left
    cell = Box(sphere.x - side, room.top, sphere.x + side, room.bottom)
    wide, high_, aside = composition.px(CLEAR), composition.px(OFF), composition.px(ASIDE)
    whole, brief = ((mark.text, ", behind"), (mark.text,)), ((mark.text.partition(" ")[2],),)
    distances = (0, NEAR, FARTHEST)
    for within, words in (*product(distances, whole), *product(distances, brief)):
        pieces, long, high = _label(words, size)
        for offset, x_, y_ in _beside(sphere, angle, middle, long, high, composition):
            at = round(x_), round(y_)
            box = Box(at[0], at[1], at[0] + long, at[1] + high)
            apart = Box(box.left - wide, box.top - wide, box.right + wide, box.bottom + wide)
            clearing = Box(box.left - aside, box.top - high_, box.right + aside, box.bottom + high_)
            clear = abs(offset) <= within and not any(pane.touches(apart) for pane in composition.panes)
            if clear and _within(box, cell) and _free(clearing, obstacles) and _free(box, (around,)):
                arc = _arc(sphere, angle, offset, composition) if offset else ()
                if all(
                    _free(Box(right - wide, down - wide, right + wide, down + wide), obstacles) for right, down in arc
                ):
                    line = _layers((Curve(arc, composition.px(1.0), GREY, FAR),), 0, 0) if arc else ()
                    return Placed(x, y, True, box, (*line, *triangle, *_layers(pieces, *at)))
    return Placed(x, y, True, None, triangle)


def _beside(
    sphere: Sphere, angle: int, middle: tuple[float, float], long: float, high: float, composition: Composition
) -> Iterator[tuple[int, float, float]]:
    """Top left corners for a text, the best first: beside the triangle, over or under it, and farther along the limb.

    Each after the degrees between the two, counterclockwise.
    """
    x, y = middle
    gap = composition.px(HEIGHT / 2 + GAP)
    yield 0, x + gap, y - high / 2
    yield 0, x - gap - long, y - high / 2
    yield 0, x - long / 2, y - gap - high if y < sphere.y else y + gap
    reach = sphere.radius + composition.px(AWAY + 3)
    for offset in range(STEP, FARTHEST + 1, STEP):
        for turn in (offset, -offset):
            right, down = cos(radians(angle + turn)), -sin(radians(angle + turn))
            x, y = sphere.x + reach * right, sphere.y + reach * down
            yield turn, x - (long if right < 0 else 0.0), y - (high if down < 0 else 0.0)


def _arc(sphere: Sphere, angle: int, turn: int, composition: Composition) -> tuple[Point, ...]:
    """The points of a line along the limb from a triangle to its text; none where they nearly touch."""
    radius = sphere.radius + composition.px(AWAY)
    aside = degrees(composition.px(BASE / 2 + 2) / radius)
    if radians(abs(turn) - aside) * radius < composition.px(12):
        return ()
    begin = aside if turn > 0 else -aside
    turns = np.radians(angle + np.linspace(begin, turn, 2 + abs(turn) // 3))
    return tuple((sphere.x + radius * cos(t), sphere.y - radius * sin(t)) for t in turns)


def _limb(sphere: Sphere, angle: float) -> tuple[float, float]:
    return sphere.x + sphere.radius * cos(radians(angle)), sphere.y - sphere.radius * sin(radians(angle))


def _room(composition: Composition) -> Box:
    """The part of the frame that the panes stand in."""
    line = composition.hairline
    if line.height > line.width:
        return Box(2, 2, line.left - 2, composition.height - 2)
    return Box(2, 2, composition.width - 2, line.top - 2 if line.top > 0 else composition.height - 2)


def _radius(composition: Composition) -> float:
    return composition.px(COMPACT_RING if composition.compact else RING)


def _type(composition: Composition) -> float:
    return composition.px(COMPACT_TYPE if composition.compact else TYPE)


@lru_cache(maxsize=64)
def _label(words: tuple[str, ...], size: float) -> tuple[tuple[Piece, ...], float, float]:
    """The pieces of a text from the corner (0, 0) on, its length and its height: the value, and where it is."""
    value_ = Text("", 0.0, 0.78 * size, words[0], size, INK, MEDIUM)
    rest = tuple(Text("", value_.right, 0.78 * size, word, size, GREY) for word in words[1:])
    return (value_, *rest), (rest[-1] if rest else value_).right, size


@lru_cache(maxsize=16)
def _ring(radius: float, scale: float) -> Curve:
    """A ring round the middle of the pixel at 0, 0."""
    around = [2 * pi * n / 64 for n in range(65)]
    points = tuple((0.5 + radius * cos(angle), 0.5 + radius * sin(angle)) for angle in around)
    return Curve(points, THICKNESS * scale, INK, FAR, casing=CASING_WIDTH * scale)


@lru_cache(maxsize=256)
def _triangle(angle: int, scale: float) -> Curve:
    """A triangle round 0, 0 that points to an angle, degrees counterclockwise from the right."""
    corners = ((HEIGHT / 2, 0.0), (-HEIGHT / 2, BASE / 2), (-HEIGHT / 2, -BASE / 2))
    c, s = cos(radians(angle)), sin(radians(angle))
    points = tuple((scale * (along * c + across * s), scale * (across * c - along * s)) for along, across in corners)
    return Curve(points, 0.0, INK, FAR, closed=True)


def _layers(pieces: tuple[Piece, ...], left: int, top: int) -> tuple[Layer, ...]:
    """The layer of pieces, moved: pieces around 0, 0 are drawn once."""
    found = layer_of(pieces)
    return () if found is None else (Layer(found.image, found.left + left, found.top + top),)


def _moved(text: Text, x: float, baseline: float) -> Text:
    return Text(text.name, x, baseline, text.text, text.size, text.ink, text.weight, text.casing)


def _shifted(box: Box, x: float, y: float) -> Box:
    return Box(box.left + x, box.top + y, box.right + x, box.bottom + y)


def _free(box: Box, obstacles: Sequence[Box]) -> bool:
    return not any(box.overlaps(other) for other in obstacles)


def _within(box: Box, room: Box) -> bool:
    return room.left <= box.left and room.top <= box.top and box.right <= room.right and box.bottom <= room.bottom
