"""Panes: where in a frame a sphere, or the whole sphere as a map, is drawn; from pixels to directions and back.

Pixels from the top left, y down. shaders/sphere.frag turns pixels into directions in the same way.
"""

from __future__ import annotations

from math import cos, sin, sqrt
from typing import NamedTuple, TypeAlias

import numpy as np

from shviewer.harmonics.basis import Array


class Box(NamedTuple):
    """A rectangle of pixels: columns left to right and rows top to bottom, without the last ones."""

    left: float
    top: float
    right: float
    bottom: float

    @property
    def width(self) -> float:
        return self.right - self.left

    @property
    def height(self) -> float:
        return self.bottom - self.top

    def contains(self, x: float, y: float) -> bool:
        return self.left <= x < self.right and self.top <= y < self.bottom

    def moved(self, right: float, down: float) -> Box:
        return Box(self.left + right, self.top + down, self.right + right, self.bottom + down)

    def grown(self, across: float, down: float) -> Box:
        return Box(self.left - across, self.top - down, self.right + across, self.bottom + down)

    def inside(self, other: Box) -> bool:
        across = other.left <= self.left and self.right <= other.right
        return across and other.top <= self.top and self.bottom <= other.bottom

    def overlaps(self, other: Box) -> bool:
        across = self.left < other.right and other.left < self.right
        return across and self.top < other.bottom and other.top < self.bottom


Pixels: TypeAlias = tuple[int, int, int, int]
"""A rectangle of a framebuffer: x and y from the lower left, width and height."""


class Place(NamedTuple):
    """The place of a direction in a pane: a pixel, which may lie outside the clip, and whether it is on the far side."""

    x: float
    y: float
    behind: bool


class Sphere(NamedTuple):
    """Centre and radius, and the box it is cut to when zoomed in."""

    x: float
    y: float
    radius: float
    clip: Box

    @property
    def outline(self) -> Box:
        """The square around it, and the pixel of its soft edge, within the clip."""
        reach = self.radius + 1
        return _common(Box(self.x - reach, self.y - reach, self.x + reach, self.y + reach), self.clip)

    def touches(self, box: Box) -> bool:
        """Whether any visible part of the sphere lies in the box."""
        left, top, right, bottom = _common(box, self.clip)
        if left >= right or top >= bottom:
            return False
        across = self.x - min(max(self.x, left), right)
        down = self.y - min(max(self.y, top), bottom)
        return across * across + down * down < self.radius * self.radius

    @property
    def visible_area(self) -> float:
        """The area in pixels of the sphere's square within its clip."""
        wide = min(self.x + self.radius, self.clip.right) - max(self.x - self.radius, self.clip.left)
        high = min(self.y + self.radius, self.clip.bottom) - max(self.y - self.radius, self.clip.top)
        return max(wide, 0.0) * max(high, 0.0)

    def position(self, x: float, y: float) -> tuple[float, float] | None:
        """The place of a pixel in radii, right and up from the centre; None outside the sphere or where it is cut."""
        right, up = (x - self.x) / self.radius, (self.y - y) / self.radius
        return (right, up) if self.clip.contains(x, y) and right * right + up * up < 1 else None

    def direction(self, x: float, y: float, world_from_view: Array) -> Array | None:
        """The direction in the world (3,) that a pixel shows; None outside the sphere or where it is cut."""
        found = self.position(x, y)
        if found is None:
            return None
        right, up = found
        return np.asarray(world_from_view @ np.array([right, up, sqrt(max(0.0, 1 - right * right - up * up))]))

    def moved(self, right: float, up: float) -> Sphere:
        """The sphere so many pixels further right and up, in the same clip."""
        return self._replace(x=self.x + right, y=self.y - up)

    def place(self, direction: Array, world_from_view: Array) -> Place:
        """The place of a direction in the world; on the far side, where one would see it through the sphere."""
        right, up, towards = (float(part) for part in direction @ world_from_view)
        return Place(self.x + self.radius * right, self.y - self.radius * up, towards < 0)


class WholeSphere(NamedTuple):
    """The whole sphere as a lat-long map: +z on top, azimuth falling to the right."""

    x: float
    y: float
    """The pixel of azimuth 0 and elevation 0, which may lie outside the clip: the map repeats to both sides."""
    width: float
    """Pixels of a full turn."""
    clip: Box

    @property
    def outline(self) -> Box:
        """The part of the clip that has a direction."""
        return _common(
            Box(self.clip.left, self.y - self.width / 4, self.clip.right, self.y + self.width / 4), self.clip
        )

    def touches(self, box: Box) -> bool:
        return self.outline.overlaps(box)

    @property
    def visible_area(self) -> float:
        left, top, right, bottom = self.outline
        return max(right - left, 0.0) * max(bottom - top, 0.0)

    def direction(self, x: float, y: float, world_from_view: Array) -> Array | None:
        """The direction in the world (3,) that a pixel shows, wherever the camera is; None beside the map."""
        if not self.outline.contains(x, y):
            return None
        azimuth, elevation = (self.x - x) * 2 * np.pi / self.width, (self.y - y) * 2 * np.pi / self.width
        return np.array([cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation)])

    def place(self, direction: Array, world_from_view: Array) -> Place:
        """The place of a direction in the world, of all that it has in the repeated map the one nearest the clip's middle."""
        across, along, up = (float(part) for part in direction)
        per_radian, middle = self.width / (2 * np.pi), (self.clip.left + self.clip.right) / 2
        x = self.x - per_radian * float(np.arctan2(along, across))
        x += self.width * round((middle - x) / self.width)
        return Place(x, self.y - per_radian * float(np.arctan2(up, np.hypot(across, along))), False)


Pane: TypeAlias = Sphere | WholeSphere


def whole_sphere_in(box: Box, zoom: float = 1.0, centre: tuple[float, float] = (0.0, 0.0)) -> WholeSphere:
    """The map in a box twice as wide as high, with an azimuth and an elevation, degrees, in its middle.

    zoom: below 1 it is 1, since the map has no more to show; the elevation gives way so that none of the box is empty.
    """
    width = max(zoom, 1.0) * (box.right - box.left)
    azimuth, elevation = centre
    most = max(0.0, 90 - 180 * (box.bottom - box.top) / width)
    x = (box.left + box.right) / 2 + azimuth / 360 * width
    y = (box.top + box.bottom) / 2 + min(max(elevation, -most), most) / 360 * width
    return WholeSphere(x, y, width, box)


def _common(one: Box, other: Box) -> Box:
    return Box(
        max(one.left, other.left),
        max(one.top, other.top),
        min(one.right, other.right),
        min(one.bottom, other.bottom),
    )
