"""A mark on the far side of a sphere: a triangle outside the limb, with words where there is room along it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import product
from math import atan2, cos, degrees, radians, sin

import numpy as np

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box, Sphere
from shviewer.viewer.overlay.directions.placed import FAR, GAP, Placed, free, layers_at, type_size
from shviewer.viewer.overlay.inks import GREY, INK
from shviewer.viewer.overlay.letters.lettering import MEDIUM
from shviewer.viewer.overlay.pieces import Curve, Piece, Point, Text

AWAY, BASE, HEIGHT = 3.0, 7.0, 10.0
"""The triangle: its distance from the limb, its base and its height."""

STEP = 3
"""Degrees in which triangles turn, and in which room for their text is sought along the limb."""

NEAR, FARTHEST = 30, 84
"""Degrees along the limb between a triangle and its text: up to NEAR all words are kept."""

CLEAR, OFF, ASIDE = 3.0, 8.0, 14.0
"""Pixels of the design between those words and a sphere; over and under them, and beside them, to other text, whose lines they
are not."""


def behind_sphere(
    text: str,
    x: float,
    y: float,
    sphere: Sphere,
    cell_left: float,
    composition: Composition,
    obstacles: Sequence[Box],
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
    around = Box(min(across), min(down), max(across), max(down)).moved(*middle)
    if not (around.inside(room) and sphere.clip.contains(*_limb(sphere, angle)) and free(around, obstacles)):
        return None
    left, top = round(middle[0]), round(middle[1])
    triangle = layers_at((drawn,), left, top)
    size = type_size(composition)
    side = sphere.x - cell_left
    cell = Box(sphere.x - side, room.top, sphere.x + side, room.bottom)
    wide, over, aside = composition.px(CLEAR), composition.px(OFF), composition.px(ASIDE)
    whole, brief = ((text, ", behind"), (text,)), ((text.partition(" ")[2],),)
    distances = (0, NEAR, FARTHEST)
    for within, words in (*product(distances, whole), *product(distances, brief)):
        pieces, long, high = _label(words, size)
        for offset, x_, y_ in _beside(sphere, angle, middle, long, high, composition):
            at = round(x_), round(y_)
            box = Box(at[0], at[1], at[0] + long, at[1] + high)
            apart = box.grown(wide, wide)
            clear = abs(offset) <= within and not any(pane.touches(apart) for pane in composition.panes)
            if clear and box.inside(cell) and free(box.grown(aside, over), obstacles) and free(box, (around,)):
                arc = _arc(sphere, angle, offset, composition) if offset else ()
                if all(free(Box(*point, *point).grown(wide, wide), obstacles) for point in arc):
                    line = layers_at((Curve(arc, composition.px(1.0), GREY, FAR),), 0, 0) if arc else ()
                    return Placed(x, y, True, box, (*line, *triangle, *layers_at(pieces, *at)))
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


@lru_cache(maxsize=64)
def _label(words: tuple[str, ...], size: float) -> tuple[tuple[Piece, ...], float, float]:
    """The pieces of a text from the corner (0, 0) on, its length and its height: the value, and where it is."""
    value_ = Text("", 0.0, 0.78 * size, words[0], size, INK, MEDIUM)
    rest = tuple(Text("", value_.right, 0.78 * size, word, size, GREY) for word in words[1:])
    return (value_, *rest), (rest[-1] if rest else value_).right, size


@lru_cache(maxsize=256)
def _triangle(angle: int, scale: float) -> Curve:
    """A triangle round 0, 0 that points to an angle, degrees counterclockwise from the right."""
    corners = ((HEIGHT / 2, 0.0), (-HEIGHT / 2, BASE / 2), (-HEIGHT / 2, -BASE / 2))
    c, s = cos(radians(angle)), sin(radians(angle))
    points = tuple((scale * (along * c + across * s), scale * (across * c - along * s)) for along, across in corners)
    return Curve(points, 0.0, INK, FAR, closed=True)
