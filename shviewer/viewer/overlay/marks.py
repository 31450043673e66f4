"""Marks of the lowest radiance and of the largest error: a ring on the sphere, with the value beside it.

Marks move with the spheres, so they are layers of their own: turning draws no text anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from PIL import Image, ImageDraw

from shviewer.analysis.figures import Pending
from shviewer.harmonics.basis import Array
from shviewer.viewer.composition import Composition
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.lettering import GREY, INK, MIN_TYPE, Ink, font
from shviewer.viewer.panes import Box, Sphere
from shviewer.viewer.picture import Picture
from shviewer.words import percent, radiance

RING, THICKNESS, SHADOW = 6.0, 1.5, 1.25
"""Radius, line width and dark rim of a ring, in pixels of the design."""

DARK: Ink = (10, 10, 12, 200)
FINE = 4
"""How many times larger a ring is drawn before it is averaged."""

DASHES = 8
RECONSTRUCTION, ERROR = 1, 2


@dataclass(frozen=True, eq=False)
class Mark:
    """A marked direction of the light on one of the spheres, and the text beside it."""

    name: str
    sphere: int
    direction: Array
    text: str


@dataclass(frozen=True)
class Placed:
    """A mark in a frame: the middle of its ring, the box of its text, and the layer that shows both."""

    x: float
    y: float
    behind: bool
    """Whether it is on the far side: then the ring is broken, and stands where one would see it through the sphere."""
    label: Box
    layer: Layer


def marks_of(picture: Picture) -> list[Mark]:
    """Marks of the minimum, if it is negative, and of the largest error, if the error is shown; surfaces have no marks."""
    state, extremes = picture.state, picture.extremes
    marks: list[Mark] = []
    if isinstance(extremes, Pending) or not state.view.marks or state.view.lobe_view or state.view.help_visible:
        return marks
    lowest = radiance(extremes.minimum, extremes.peak)
    if extremes.minimum < 0 and lowest != "0":
        marks.append(Mark("minimum", RECONSTRUCTION, np.array(extremes.minimum_direction), f"minimum {lowest}"))
    scale = picture.error_scale
    if scale is not None and scale.worth_showing:
        value = percent(scale.largest) if scale.kind == "relative" else radiance(scale.largest, extremes.peak)
        sign = "+" if scale.kind == "signed" and scale.largest > 0 else ""
        marks.append(Mark("largest", ERROR, scale.direction, f"largest {sign}{value}"))
    return marks


def place_marks(picture: Picture, composition: Composition, obstacles: Sequence[Box] = ()) -> dict[str, Placed]:
    """The marks in sight, by name. A mark under an obstacle is left out, and no text of a mark touches an obstacle."""
    placed = {}
    for mark in marks_of(picture):
        sphere = composition.spheres[mark.sphere]
        right, up, towards = mark.direction @ picture.light_from_world @ picture.world_from_view
        x, y = sphere.x + sphere.radius * right, sphere.y - sphere.radius * up
        if sphere.clip.contains(x, y) and not any(other.contains(x, y) for other in obstacles):
            placed[mark.name] = _place(mark.text, x, y, bool(towards < 0), sphere, composition, obstacles)
    return placed


def mark_layers(picture: Picture, composition: Composition, obstacles: Sequence[Box] = ()) -> tuple[Layer, ...]:
    return tuple(mark.layer for mark in place_marks(picture, composition, obstacles).values())


def _place(
    text: str, x: float, y: float, behind: bool, sphere: Sphere, composition: Composition, obstacles: Sequence[Box]
) -> Placed:
    """Place a mark with the longest text that finds room in the cell, right or left of the ring, or with no text."""
    size = max(round(composition.px(12)), MIN_TYPE)
    scale = max(composition.scale, MIN_TYPE / 12)
    half = round(scale * (RING + THICKNESS + SHADOW)) + 1
    gap = round(4 * scale)
    choices = [(words, left) for words in (f"{text}, behind" if behind else text, text) for left in (False, True)]
    for words, leftwards in (*choices, ("", False)):
        image, label = _image(words, size, scale, half, gap, behind, leftwards)
        left = round(x - 0.5) - (image.shape[1] - half - 1 if leftwards else half)
        top = round(y - 0.5) - image.shape[0] // 2
        box = Box(left + label[0], top + label[1], left + label[2], top + label[3])
        within = sphere.clip.left <= box.left - gap and box.right + gap <= sphere.clip.right
        if not words or (within and not any(box.overlaps(other) for other in obstacles)):
            break
    return Placed(x, y, behind, box, Layer(image, left, top))


@lru_cache(maxsize=64)
def _image(
    text: str, size: int, scale: float, half: int, gap: int, behind: bool, leftwards: bool
) -> tuple[np.ndarray, tuple[int, int, int, int]]:
    """An image of a ring, in a square of 2 half + 1 pixels, with its text beside it; and the box of the text in the image."""
    face = font(size)
    side, length = 2 * half + 1, round(face.getlength(text))
    height = max(side, size + 6) | 1
    image = Image.new("RGBA", (side + gap + length + 2, height), (*DARK[:3], 0))
    place = (image.width - side if leftwards else 0, (height - side) // 2)
    shadow, ring = _ring(half, scale, behind)
    image.paste((*DARK[:3], 255), place, shadow)
    image.paste((GREY if behind else INK), place, ring)
    draw = ImageDraw.Draw(image)
    x, y = (1 if leftwards else side + gap), height / 2
    draw.text((x, y), text, INK, face, anchor="lm", stroke_width=max(1, round(scale)), stroke_fill=DARK)
    pixels = np.asarray(image)
    pixels.flags.writeable = False
    left, top, right, bottom = draw.textbbox((x, y), text, font=face, anchor="lm")
    return pixels, (int(left), int(top), int(right), int(bottom))


def _ring(half: int, scale: float, broken: bool) -> tuple[Image.Image, Image.Image]:
    """Coverage of the dark rim and of the ring, (2 half + 1) pixels square."""
    side = FINE * (2 * half + 1)
    right, up = np.meshgrid(*2 * [(np.arange(side) + 0.5) / FINE - half - 0.5])
    off = np.abs(np.hypot(right, up) - RING * scale)
    drawn = np.ones_like(off, dtype=bool)
    if broken:
        drawn = np.floor((np.arctan2(up, right) / (2 * np.pi) + 0.5) * 2 * DASHES) % 2 == 0
    masks = ((off < THICKNESS * scale / 2 + rim) & drawn for rim in (SHADOW * scale, 0.0))
    shadow, ring = (
        Image.fromarray((255 * mask).astype(np.uint8)).resize((2 * half + 1,) * 2, Image.Resampling.BOX)
        for mask in masks
    )
    return shadow, ring
