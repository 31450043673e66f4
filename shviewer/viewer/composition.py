"""Where things stand in a frame of a given size. Pure numbers, in pixels from the top left, y down."""

from __future__ import annotations

from dataclasses import dataclass

from shviewer.viewer.panes import Box, Pane, Sphere, WholeSphere

MIN_SIDE, MAX_SIDE = 64, 8192
"""Frames smaller or larger than this are refused."""

DESIGN_WIDTH, DESIGN_HEIGHT = 1280, 640


@dataclass(frozen=True)
class Composition:
    """The layout of a frame: original, reconstruction and perhaps the error, captions above, figures under a hairline."""

    width: int
    height: int
    scale: float
    """Pixels per unit of type and gaps; 1 at 1280 x 640."""
    spheres: tuple[Sphere, ...]
    caption_y: float
    """The y of the corners' words and of the captions of the first row."""
    hairline_y: float
    colour_bar: Box | None = None
    """Room for the colour bar and its numbers, under the error's sphere."""
    maps: tuple[WholeSphere, ...] = ()
    """The panes of the whole sphere, where that is shown in place of the spheres."""

    @property
    def panes(self) -> tuple[Pane, ...]:
        """The panes of the original, the reconstruction and perhaps the error."""
        return self.maps or self.spheres

    def px(self, length: float) -> float:
        """A length of the 1280 x 640 design in pixels of this frame."""
        return length * self.scale

    @property
    def margin(self) -> float:
        return self.px(24)


TOP, STRIP, GAP, BAR, ROW_CAPTION = 48, 118, 30, 34, 40
"""Heights of the captions, the figures, the space before them, the colour bar, and the captions of a second row."""


def compose(width: int, height: int, zoom: float = 1.0, content_scale: float = 1.0, n_spheres: int = 2) -> Composition:
    """Lay out a frame: spheres side by side, or the third below the others where that makes them larger.

    Type does not shrink below 0.7 of the design (times the monitor's content scale).
    """
    scale = max(min(height / DESIGN_HEIGHT, width / DESIGN_WIDTH), 0.7 * content_scale)
    arrangements = [(n_spheres,)] if n_spheres < 3 else [(3,), (2, 1)]
    bar = BAR * scale if n_spheres > 2 else 0.0
    fixed = (TOP + STRIP + GAP) * scale + bar

    def radius_in(rows: tuple[int, ...]) -> float:
        free = height - fixed - (len(rows) - 1) * ROW_CAPTION * scale
        return max(min(free / len(rows) / 2, width / (2 * max(rows)) - 18 * scale), 4.0)

    rows = max(arrangements, key=radius_in)
    radius = radius_in(rows)
    pitch = 2 * radius + ROW_CAPTION * scale
    above, below = TOP * scale, len(rows) * pitch - ROW_CAPTION * scale
    top = max((height - fixed - below) / 2, 0.0)  # a tall window centres the whole
    bottom = top + above + below
    hairline = min(bottom + bar + GAP * scale, max(height - STRIP * scale, bottom + bar))
    spheres: list[Sphere] = []
    for number, count in enumerate(rows):
        centre_y = top + above + number * pitch + radius
        caption_y = centre_y - radius - 20 * scale
        ceiling = centre_y - radius + (10 * scale if zoom > 1 else -2)  # under the captions
        floor = hairline if number == len(rows) - 1 and not bar else centre_y + radius + 4 * scale
        for column in range(count):
            left, right = column * width / count, (column + 1) * width / count
            clip = Box(left + (scale if column else 0), ceiling, right - (scale if column < count - 1 else 0), floor)
            spheres.append(Sphere((left + right) / 2, centre_y, radius * zoom, clip, caption_y))
    x = spheres[-1].x
    colour_bar = Box(x - radius, bottom + 8 * scale, x + radius, bottom + 8 * scale + bar) if bar else None
    return Composition(width, height, scale, tuple(spheres), top + above - 20 * scale, hairline, colour_bar)
