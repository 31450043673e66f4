"""Where things stand in a frame of a given size. Pure numbers, in pixels from the top left, y down.

Panes stand in as many rows as makes them largest; the numbers under the hairline get what they need first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from shviewer.viewer.composing import panes
from shviewer.viewer.composing.caption import Caption, clear
from shviewer.viewer.composing.design import Design, margin_of
from shviewer.viewer.composing.numbers_area import AROUND, HEIGHTS, SIDE, Line, Mode, Numbers, numbers_area
from shviewer.viewer.composing.panes import Box, Pane, Sphere, WholeSphere

if TYPE_CHECKING:
    from shviewer.viewer.view import View

MIN_SIDE, MAX_SIDE = 64, 8192
"""Frames smaller or larger than this are refused."""

DESIGN_WIDTH, DESIGN_HEIGHT = 1280, 640
MOST_LINES = 4
"""How many lines after a head there may be, as far as they are clear of the sphere."""

GROWTH = {Mode.HALVES: 160.0, Mode.STACK: 160.0, Mode.CELL: 46.0, Mode.BARE: 46.0}
"""How much higher than needed the numbers become where the panes cannot grow; the rest parts the rows."""


UNDER_HEAD = 22.0
"""Where the room of a curve among the spheres begins at the earliest, under its head."""

NOWHERE, NO_NUMBERS = Box(0.0, 0.0, 0.0, 0.0), Numbers()


@dataclass(frozen=True)
class Composition:
    """The layout of a frame: panes of original, reconstruction and perhaps the error, a hairline, and the numbers."""

    width: int
    height: int
    scale: float
    """Pixels of the frame per pixel of the design; 1 at 1280 x 640."""
    spheres: tuple[Sphere, ...]
    captions: tuple[Caption, ...] = ()
    """One for each pane."""
    hairline: Box = NOWHERE
    """The line between panes and numbers, which shows progress, too; upright where the numbers stand beside the panes."""
    numbers: Numbers = NO_NUMBERS
    compact: bool = False
    colour_bar: Box | None = None
    """Room for the colour bar and its numbers, under the error."""
    maps: tuple[WholeSphere, ...] = ()
    """The panes of the whole sphere, where that is shown in place of the spheres."""
    ticks: bool = False
    """Whether there is room for azimuths under the maps."""
    over: bool = False
    """Whether the panes reach under their captions, as those of enlarged spheres do."""

    @property
    def panes(self) -> tuple[Pane, ...]:
        """The panes of the original, the reconstruction and perhaps the error."""
        return self.maps or self.spheres

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
    return _placed(Design(width / scale, height / scale, n_spheres, whole_sphere)).composition(
        width, height, scale, zoom, map_centre
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
    homes = (sphere.radius / view.zoom for sphere in frame.spheres)
    shifts = ((view.pan[0] * home, view.pan[1] * home) for home in homes)
    moved = (sphere.moved(*shift) for sphere, shift in zip(frame.spheres, shifts, strict=True))
    return replace(frame, spheres=tuple(moved), over=True)


class _Placed:
    """A design with its rows and its numbers: everything has a place."""

    def __init__(self, design: Design) -> None:
        rows, mode = design.best()
        self.design, self.rows, self.mode = design, rows, mode
        self.size = design.size(rows, mode)
        self.pane_width = design.pane_width(rows, mode)
        push = design.pushed(self.size, rows, mode)
        floor = design.height - HEIGHTS[mode][design.compact]
        spare = max(floor - design.taken(rows, mode) - rows * (self.size + push), 0.0)
        if not design.maps and not design.compact:  # first every head gets its whole room
            more = min(42.0 - push, spare / rows) if self.size > self.pane_width - 40 else 0.0
            push, spare = push + max(more, 0.0), spare - rows * max(more, 0.0)
        growth = min(spare, GROWTH.get(mode, 0.0) / (2 if design.compact else 1))
        self.apart = (spare - growth) / (rows if rows > 1 else 2)
        self.hairline = floor - growth if mode is not Mode.NONE else design.height
        self.push = push

    def row_top(self, row: int) -> float:
        design = self.design
        pitch = design.above + self.push + self.size + design.between + self.apart
        return design.top + (self.apart if self.rows == 1 else 0.0) + row * pitch

    def pane(self, number: int) -> tuple[Box, float]:
        """The cell of a pane, from its row's top to the picture's lower edge, and the top of the picture."""
        row, column = divmod(number, self.design.columns(self.rows))
        left = self.design.margin + column * (self.pane_width + self.design.gap(self.rows))
        top = self.row_top(row)
        shape_top = top + self.design.above + self.push
        return Box(left, top, left + self.pane_width, shape_top + self.size), shape_top

    def picture(self, number: int) -> Box:
        """The rectangle of a pane's picture: in the middle of its cell, but maps beside each other at the left of it."""
        cell, top = self.pane(number)
        half = self.size * (1.0 if self.design.maps else 0.5)
        aside = self.design.maps and self.design.columns(self.rows) > 1
        middle = cell.left + half if aside else (cell.left + cell.right) / 2
        return Box(middle - half, top, middle + half, cell.bottom)

    def pixels(self, number: int, scale: float) -> Box:
        """The same in whole pixels, and exactly a square or a map of 2:1."""
        box = self.picture(number)
        high = max(int(self.size * scale + 1e-6), 1)
        wide = 2 * high if self.design.maps else high
        left, top = round((box.left + box.right) * scale / 2 - wide / 2), round(box.top * scale)
        return Box(float(left), float(top), float(left + wide), float(top + high))

    def composition(
        self, width: int, height: int, scale: float, zoom: float, map_centre: tuple[float, float]
    ) -> Composition:
        design, column = self.design, self.mode is Mode.COLUMN
        pictures = [self.pixels(number, scale) for number in range(design.n_panes)]
        spheres = () if design.maps else tuple(self._sphere(n, pictures[n], scale, zoom) for n in range(len(pictures)))
        maps = tuple(panes.whole_sphere(box, zoom, map_centre) for box in pictures) if design.maps else ()
        margin = design.margin
        line = max(1, round(scale))
        if column:
            x = design.width - margin - SIDE - AROUND
            hairline = Box(x, 24, x, self.picture(design.n_panes - 1).bottom + 32).scaled(scale)
            hairline = hairline._replace(right=hairline.left + line)
            area = Box(x + AROUND, 24, design.width - margin, design.height)
        else:
            hairline = Box(margin, self.hairline, design.width - margin, self.hairline).scaled(scale)
            hairline = hairline._replace(bottom=hairline.top + line)
            area = Box(margin, self.hairline, design.width - margin, design.height)
        third = self.picture(0) if design.n_panes == 3 and self.rows == 1 and not design.maps else None
        free = None
        if self.rows * design.columns(self.rows) > design.n_panes:
            cell, top = self.pane(design.n_panes)
            free = cell._replace(top=top if design.maps else max(top, cell.top + UNDER_HEAD))
        feet = self._foot(0) is not None
        numbers = numbers_area(self.mode, area, compact=design.compact, third=third, cell=free, exposed=feet)
        if free is not None and self.mode in (Mode.CELL, Mode.COLUMN):
            numbers = replace(numbers, curve_head=self._head(design.n_panes))
        bar = None
        if design.n_panes == 3 and not design.tiny:
            box = self.picture(2)
            top = box.bottom + (8 if design.maps or design.compact else 16)
            bar = Box(box.left, top, box.right, top + (22 if design.compact else 30)).scaled(scale)
        over = zoom > 1 and not design.maps
        captions = tuple(
            self._caption(n, scale, spheres[n] if spheres and not over else None) for n in range(len(pictures))
        )
        return Composition(
            width=width,
            height=height,
            scale=scale,
            compact=design.compact,
            spheres=spheres,
            captions=captions,
            hairline=hairline,
            numbers=numbers.scaled(scale),
            colour_bar=bar,
            maps=maps,
            ticks=design.maps and not design.compact and self.rows == 1 and design.n_panes == 2,
            over=over,
        )

    def _sphere(self, number: int, box: Box, scale: float, zoom: float) -> Sphere:
        """A sphere in its square; enlarged, it is cut half-way to the other panes, at the hairline, and at the edges."""
        cell, design = self.pane(number)[0], self.design
        side, columns = design.gap(self.rows) / 2 - 1, design.columns(self.rows)
        row, column = divmod(number, columns)
        last = self.mode is not Mode.COLUMN and column == columns - 1
        left = 0.0 if column == 0 else cell.left - side
        right = design.width if last else cell.right + side
        over = 0.0 if row == 0 else cell.top - min(design.top, 14)
        under = self.hairline if row == self.rows - 1 and design.n_panes == 2 else cell.bottom + 1
        clip = Box(left, over, right, under).scaled(scale)
        radius = box.width / 2
        return Sphere(box.left + radius, box.top + radius, radius * zoom, clip)

    def _head(self, number: int) -> Line:
        cell, shape_top = self.pane(number)
        left = self.picture(number).left if self.design.maps else cell.left
        right = self.picture(number).right if self.design.maps else cell.right
        baseline = shape_top - (6 if self.design.compact else 13) if self.design.maps else cell.top + 14
        return Line(left, right, baseline - 2 if self.design.compact and not self.design.maps else baseline)

    def _foot(self, number: int) -> Line | None:
        """The line at the foot of the original and of the reconstruction, where no pane stands under them."""
        design, columns = self.design, self.design.columns(self.rows)
        if design.maps or number // columns < self.rows - 1 or number > 1:
            return None
        below = 12 if design.n_panes == 3 and number + columns >= 3 else -2
        return self._head(number)._replace(baseline=self.pane(number)[0].bottom + below)

    def _caption(self, number: int, scale: float, sphere: Sphere | None) -> Caption:
        """The lines of a pane, each ending before the sphere; None where there is no sphere to keep clear of."""
        design, head = self.design, self._head(number)
        pitch = 18 if not design.maps else 0
        count = 0 if design.compact else 1 if design.maps else MOST_LINES
        lines = [head._replace(baseline=head.baseline + (number + 1) * pitch) for number in range(count)]
        foot = self._foot(number)
        return Caption(
            clear(
                head.scaled(scale),
                sphere,
                (9.5 if design.compact else 12) * scale,
                (4 if design.compact else 8) * scale,
            ),
            tuple(clear(line.scaled(scale), sphere, 11 * scale, 8 * scale) for line in lines),
            foot and clear(foot.scaled(scale), sphere, 9 * scale, 1.5 * scale),
        )


@lru_cache(maxsize=8)
def _placed(design: Design) -> _Placed:
    return _Placed(design)
