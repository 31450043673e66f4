"""Where things stand in a frame of a given size. Pure numbers, in pixels from the top left, y down.

Panes stand in as many rows as makes them largest; the numbers under the hairline get what they need first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from shviewer.viewer.composing.caption import Caption
from shviewer.viewer.composing.design import Design, margin_of
from shviewer.viewer.composing.numbers_area import Numbers, scaled
from shviewer.viewer.composing.panes import Box, Pane, Sphere, WholeSphere, whole_sphere_in
from shviewer.viewer.composing.placed import placed

if TYPE_CHECKING:
    from shviewer.viewer.view import View

MIN_SIDE, MAX_SIDE = 64, 8192
"""Frames smaller or larger than this are refused."""

DESIGN_WIDTH, DESIGN_HEIGHT = 1280, 640

NOWHERE, NO_NUMBERS = Box(0.0, 0.0, 0.0, 0.0), Numbers()


@dataclass(frozen=True)
class Composition:
    """The layout of a frame: panes of original, reconstruction and perhaps the error, a hairline, and the numbers."""

    width: int
    height: int
    scale: float
    """Pixels of the frame per pixel of the design; 1 at 1280 x 640."""
    panes: tuple[Pane, ...]
    """Those of the original, the reconstruction and perhaps the error: all spheres, or all maps of the whole sphere."""
    captions: tuple[Caption, ...] = ()
    """One for each pane."""
    hairline: Box = NOWHERE
    """The line between panes and numbers, which shows progress, too; upright where the numbers stand beside the panes."""
    numbers: Numbers = NO_NUMBERS
    compact: bool = False
    colour_bar: Box | None = None
    """Room for the colour bar and its numbers, under the error."""
    ticks: bool = False
    """Whether there is room for azimuths under the maps."""
    over: bool = False
    """Whether the panes reach under their captions, as those of enlarged spheres do."""

    @property
    def spheres(self) -> tuple[Sphere, ...]:
        return tuple(pane for pane in self.panes if isinstance(pane, Sphere))

    @property
    def maps(self) -> tuple[WholeSphere, ...]:
        return tuple(pane for pane in self.panes if isinstance(pane, WholeSphere))

    def px(self, length: float) -> float:
        """A length of the 1280 x 640 design in pixels of this frame."""
        return length * self.scale

    @property
    def margin(self) -> float:
        return self.px(margin_of(self.width / self.scale))

    @property
    def hair(self) -> int:
        """The width of the finest line, pixels."""
        return max(1, round(self.scale))

    @property
    def small(self) -> float:
        """The size of small type, pixels."""
        return self.px(11.0 if self.compact else 12.0)


@lru_cache(maxsize=8)
def compose(
    width: int,
    height: int,
    zoom: float = 1.0,
    content_scale: float = 1.0,
    n_spheres: int = 2,
    *,
    whole_sphere: bool = False,
    map_centre: tuple[float, float] = (0.0, 0.0),
) -> Composition:
    """Lay out a frame. Nothing is smaller than in a design of 1280 x 640, times the monitor's content scale.

    n_spheres: the number of panes, 2 or 3, whether they are spheres or maps.
    whole_sphere: panes are maps with map_centre, azimuth and elevation in degrees, in their middle.
    """
    scale = max(content_scale, min(width / DESIGN_WIDTH, height / DESIGN_HEIGHT))
    at = placed(Design(width / scale, height / scale, n_spheres, whole_sphere))
    design, numbers, over = at.design, range(n_spheres), zoom > 1 and not whole_sphere
    boxes = [at.pixels(number, scale) for number in numbers]
    panes: tuple[Pane, ...] = tuple(whole_sphere_in(box, zoom, map_centre) for box in boxes)
    if not whole_sphere:
        panes = tuple(at.sphere(number, boxes[number], scale, zoom) for number in numbers)
    hairline, upright, line = scaled(at.hairline, scale), at.hairline.width == 0, max(1, round(scale))
    return Composition(
        width=width,
        height=height,
        scale=scale,
        panes=panes,
        captions=tuple(at.caption(number, scale, None if over else panes[number]) for number in numbers),
        hairline=hairline._replace(right=hairline.left + line)
        if upright
        else hairline._replace(bottom=hairline.top + line),
        numbers=at.numbers().scaled(scale),
        compact=design.compact,
        colour_bar=None if (bar := at.colour_bar()) is None else scaled(bar, scale),
        ticks=whole_sphere and not design.compact and at.rows == 1 and n_spheres == 2,
        over=over,
    )


def frame_for(view: View, width: int, height: int, content_scale: float = 1.0) -> Composition:
    """The frame of a view in a picture of this size, its spheres where the view has moved them."""
    frame = compose(
        width,
        height,
        view.zoom,
        content_scale,
        view.n_spheres,
        whole_sphere=view.whole_sphere,
        map_centre=view.map_centre,
    )
    if view.pan == (0.0, 0.0):
        return frame
    right, up = view.pan[0] / view.zoom, view.pan[1] / view.zoom
    moved = tuple(one.moved(right * one.radius, up * one.radius) for one in frame.spheres)
    return replace(frame, panes=moved or frame.panes, over=True)
