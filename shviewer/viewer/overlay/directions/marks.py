"""Marks of the original's peak, of the lowest radiance and of the largest error: a ring, with the value beside it.

What is on the far side of a sphere has a triangle outside the limb, so that nothing lies on what is in front. Marks move with
the spheres, so they are layers of their own: turning draws no text anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import cos, pi, sin

import numpy as np

from shviewer.analysis.figures import Pending
from shviewer.harmonics.basis import Array
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box, Pane, Sphere
from shviewer.viewer.overlay.directions.behind import behind_sphere
from shviewer.viewer.overlay.directions.placed import FAR, GAP, Placed, free, layers_at, type_size
from shviewer.viewer.overlay.inks import INK
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.letters.lettering import MEDIUM
from shviewer.viewer.overlay.letters.numerals import share, value
from shviewer.viewer.overlay.overlay import Overlay
from shviewer.viewer.overlay.pieces import Curve, Text
from shviewer.viewer.picture import Picture

RING, COMPACT_RING, THICKNESS, CASING_WIDTH = 6.5, 5.2, 1.5, 1.4
"""Radius of a ring and in a compact frame, its line and the dark rim, in pixels of the design."""

ORIGINAL, RECONSTRUCTION, ERROR = 0, 1, 2


@dataclass(frozen=True, eq=False)
class Mark:
    """A marked direction of the light in one of the panes, and the text beside it."""

    name: str
    pane: int
    direction: Array
    text: str


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
            found = behind_sphere(
                mark.text, x, y, pane, composition.captions[mark.pane].head.left, composition, obstacles
            )
        elif pane.clip.contains(x, y) and free(_around(x, y, composition), obstacles):
            found = _on(mark.text, x, y, pane, composition, obstacles)
        else:
            found = None
        if found is not None:
            placed[mark.name] = found
            obstacles = (*obstacles, found.label) if found.label else obstacles
    return placed


def layers_over(picture: Picture, composition: Composition, written: Overlay) -> tuple[Layer, ...]:
    """Layers of all marks and all text of a picture."""
    return (*mark_layers(picture, composition, tuple(written.boxes.values())), *written.layers)


def mark_layers(picture: Picture, composition: Composition, obstacles: Sequence[Box] = ()) -> tuple[Layer, ...]:
    return tuple(layer for mark in place_marks(picture, composition, obstacles).values() for layer in mark.layers)


def _around(x: float, y: float, composition: Composition) -> Box:
    """The box of a ring and of its rim."""
    reach = _radius(composition) + composition.px(THICKNESS / 2 + CASING_WIDTH)
    return Box(x, y, x, y).grown(reach, reach)


def _on(text: str, x: float, y: float, pane: Pane, composition: Composition, obstacles: Sequence[Box]) -> Placed:
    """A ring with its text at the right, or at the left, or without one where there is no room."""
    radius = _radius(composition)
    left, top = round(x - 0.5), round(y - 0.5)
    ring = _ring(radius, composition.scale)
    size, reach = type_size(composition), radius + composition.px(GAP)
    baseline = 0.5 + 0.36 * size
    words = Text("", 0.0, baseline, text, size, INK, MEDIUM, composition.px(CASING_WIDTH))
    high, low = pane.clip.top + 3 - (top + words.box.top), pane.clip.bottom - 3 - (top + words.box.bottom)
    level = min(max(0.0, high), low)
    for start in (0.5 + reach, 0.5 - reach - words.right):
        moved = replace(words, x=start, baseline=round(level) + baseline)
        box = moved.box.moved(left, top)
        if pane.clip.left + 2 <= box.left and box.right + 2 <= pane.clip.right and free(box, obstacles):
            return Placed(x, y, False, box, _within_map(layers_at((ring, moved), left, top), pane))
    return Placed(x, y, False, None, _within_map(layers_at((ring,), left, top), pane))


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


def _radius(composition: Composition) -> float:
    return composition.px(COMPACT_RING if composition.compact else RING)


@lru_cache(maxsize=16)
def _ring(radius: float, scale: float) -> Curve:
    """A ring round the middle of the pixel at 0, 0."""
    around = [2 * pi * n / 64 for n in range(65)]
    points = tuple((0.5 + radius * cos(angle), 0.5 + radius * sin(angle)) for angle in around)
    return Curve(points, THICKNESS * scale, INK, FAR, casing=CASING_WIDTH * scale)
