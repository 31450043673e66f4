"""Where things stand in a frame of a given size. Pure numbers, in pixels from the top left, y down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

MIN_SIDE, MAX_SIDE = 64, 8192
"""Frames smaller or larger than this are refused."""

DESIGN_WIDTH, DESIGN_HEIGHT = 1280, 640


class Box(NamedTuple):
    """left, top, right, bottom; the last two lie outside."""

    left: float
    top: float
    right: float
    bottom: float

    def contains(self, x: float, y: float) -> bool:
        return self.left <= x < self.right and self.top <= y < self.bottom


class Sphere(NamedTuple):
    """Centre and radius, and the box it is cut to when zoomed in."""

    x: float
    y: float
    radius: float
    clip: Box

    def touches(self, box: Box) -> bool:
        """Whether any of the sphere that is seen lies in the box."""
        left, right = max(box.left, self.clip.left), min(box.right, self.clip.right)
        top, bottom = max(box.top, self.clip.top), min(box.bottom, self.clip.bottom)
        if left >= right or top >= bottom:
            return False
        across = self.x - min(max(self.x, left), right)
        down = self.y - min(max(self.y, top), bottom)
        return across * across + down * down < self.radius * self.radius


@dataclass(frozen=True)
class Composition:
    """The original on the left, the reconstruction on the right, captions above, figures under a hairline."""

    width: int
    height: int
    scale: float
    """Size of type and gaps; 1 at 1280 x 640."""
    spheres: tuple[Sphere, Sphere]
    caption_y: float
    hairline_y: float

    def px(self, length: float) -> float:
        """A length of the 1280 x 640 design in pixels of this frame."""
        return length * self.scale

    @property
    def margin(self) -> float:
        return self.px(24)


def compose(width: int, height: int, zoom: float = 1.0, content_scale: float = 1.0) -> Composition:
    """Lay out a frame. Type does not shrink below 0.7 of the design (times the monitor's content scale)."""
    scale = max(min(height / DESIGN_HEIGHT, width / DESIGN_WIDTH), 0.7 * content_scale)
    top, strip, gap = 48 * scale, 118 * scale, 30 * scale
    free = height - top - strip - gap
    radius = max(min(free / 2, width / 4 - 18 * scale), 4.0)
    block = top + 2 * radius + gap + strip
    first = max((height - block) / 2, 0.0)  # a tall window centres the whole
    centre_y = first + top + radius
    hairline = min(centre_y + radius + gap, max(height - strip, centre_y + radius))
    half, ceiling = width / 2, first + top + (10 * scale if zoom > 1 else -2)  # under the captions
    spheres = (
        Sphere(width / 4, centre_y, radius * zoom, Box(0, ceiling, half - scale, hairline)),
        Sphere(3 * width / 4, centre_y, radius * zoom, Box(half + scale, ceiling, width, hairline)),
    )
    return Composition(width, height, scale, spheres, first + 28 * scale, hairline)
