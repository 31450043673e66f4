"""Where panes, captions, hairline and numbers of a design stand, once its rows and its way to write numbers are chosen.

In pixels of the design but for panes, which have whole pixels of the frame, and captions, which keep clear of them.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from shviewer.viewer.composing.caption import Caption, clear
from shviewer.viewer.composing.design import Design
from shviewer.viewer.composing.numbers_area import AROUND, HEIGHTS, SIDE, Line, Mode, Numbers, numbers_area, scaled
from shviewer.viewer.composing.panes import Box, Pane, Sphere

MOST_LINES = 4
"""How many lines after a head there may be, as far as they are clear of the sphere."""

GROWTH = {Mode.HALVES: 160.0, Mode.STACK: 160.0, Mode.CELL: 46.0, Mode.BARE: 46.0}
"""How much higher than needed the numbers become where the panes cannot grow; the rest parts the rows."""

UNDER_HEAD = 22.0
"""Where the room of a curve among the spheres begins at the earliest, under its head."""


class Placed:
    """A design with its rows and its numbers: everything has a place."""

    def __init__(self, design: Design) -> None:
        rows, mode = design.best()
        self.design, self.rows, self.mode = design, rows, mode
        self.columns, self.gap = design.columns(rows), design.gap(rows)
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
        self.floor = floor - growth if mode is not Mode.NONE else design.height
        self.push = push

    @property
    def hairline(self) -> Box:
        """The line between panes and numbers, without a width: under the panes, or upright before the column at the right."""
        design = self.design
        if self.mode is Mode.COLUMN:
            x = design.width - design.margin - SIDE - AROUND
            return Box(x, 24, x, self.picture(design.n_panes - 1).bottom + 32)
        return Box(design.margin, self.floor, design.width - design.margin, self.floor)

    def pane(self, number: int) -> tuple[Box, float]:
        """The cell of a pane, from its row's top to the picture's lower edge, and the top of the picture."""
        design, (row, column) = self.design, divmod(number, self.columns)
        left = design.margin + column * (self.pane_width + self.gap)
        pitch = design.above + self.push + self.size + design.between + self.apart
        top = design.top + (self.apart if self.rows == 1 else 0.0) + row * pitch
        shape_top = top + design.above + self.push
        return Box(left, top, left + self.pane_width, shape_top + self.size), shape_top

    def picture(self, number: int) -> Box:
        """The rectangle of a pane's picture: in the middle of its cell, but maps beside each other at the left of it."""
        cell, top = self.pane(number)
        half = self.size * (1.0 if self.design.maps else 0.5)
        aside = self.design.maps and self.columns > 1
        middle = cell.left + half if aside else (cell.left + cell.right) / 2
        return Box(middle - half, top, middle + half, cell.bottom)

    def pixels(self, number: int, scale: float) -> Box:
        """The same in whole pixels, and exactly a square or a map of 2:1."""
        box = self.picture(number)
        high = max(int(self.size * scale + 1e-6), 1)
        wide = 2 * high if self.design.maps else high
        left, top = round((box.left + box.right) * scale / 2 - wide / 2), round(box.top * scale)
        return Box(float(left), float(top), float(left + wide), float(top + high))

    def sphere(self, number: int, box: Box, scale: float, zoom: float) -> Sphere:
        """A sphere in its square; enlarged, it is cut half-way to the other panes, at the hairline, and at the edges."""
        cell, design, side = self.pane(number)[0], self.design, self.gap / 2 - 1
        row, column = divmod(number, self.columns)
        last = self.mode is not Mode.COLUMN and column == self.columns - 1
        left = 0.0 if column == 0 else cell.left - side
        right = design.width if last else cell.right + side
        over = 0.0 if row == 0 else cell.top - min(design.top, 14)
        under = self.floor if row == self.rows - 1 and design.n_panes == 2 else cell.bottom + 1
        radius = box.width / 2
        return Sphere(box.left + radius, box.top + radius, radius * zoom, scaled(Box(left, over, right, under), scale))

    def numbers(self) -> Numbers:
        """The numbers under the hairline or beside it, with the curve in the cell that the panes leave free, if any."""
        design, line = self.design, self.hairline
        area = Box(line.left, self.floor, line.right, design.height)
        if self.mode is Mode.COLUMN:
            area = Box(line.left + AROUND, 24, design.width - design.margin, design.height)
        third = self.picture(0) if design.n_panes == 3 and self.rows == 1 and not design.maps else None
        free = None
        if self.rows * self.columns > design.n_panes:
            cell, top = self.pane(design.n_panes)
            free = cell._replace(top=top if design.maps else max(top, cell.top + UNDER_HEAD))
        exposed = self._foot(0) is not None
        found = numbers_area(self.mode, area, compact=design.compact, third=third, cell=free, exposed=exposed)
        among = free is not None and self.mode in (Mode.CELL, Mode.COLUMN)
        return replace(found, curve_head=self._head(design.n_panes)) if among else found

    def colour_bar(self) -> Box | None:
        """The room under the third pane."""
        design = self.design
        if design.n_panes < 3 or design.tiny:
            return None
        box = self.picture(2)
        top = box.bottom + (8 if design.maps or design.compact else 16)
        return Box(box.left, top, box.right, top + (22 if design.compact else 30))

    def caption(self, number: int, scale: float, pane: Pane | None) -> Caption:
        """The lines of a pane, each ending before the sphere. pane: None where there is nothing to keep clear of."""
        maps, compact, head, foot = self.design.maps, self.design.compact, self._head(number), self._foot(number)
        sphere = pane if isinstance(pane, Sphere) else None
        count, pitch = 0 if compact else 1 if maps else MOST_LINES, 0 if maps else 18
        lines = [head._replace(baseline=head.baseline + line * pitch) for line in range(1, count + 1)]

        def kept(line: Line, high: float, gap: float) -> Line:
            return clear(scaled(line, scale), sphere, high * scale, gap * scale)

        return Caption(
            kept(head, 9.5, 4) if compact else kept(head, 12, 8),
            tuple(kept(line, 11, 8) for line in lines),
            foot and kept(foot, 9, 1.5),
        )

    def _head(self, number: int) -> Line:
        (cell, shape_top), compact = self.pane(number), self.design.compact
        if self.design.maps:
            picture = self.picture(number)
            return Line(picture.left, picture.right, shape_top - (6 if compact else 13))
        return Line(cell.left, cell.right, cell.top + (12 if compact else 14))

    def _foot(self, number: int) -> Line | None:
        """The line at the foot of the original and of the reconstruction, where no pane stands under them."""
        design = self.design
        if design.maps or number // self.columns < self.rows - 1 or number > 1:
            return None
        below = 12 if design.n_panes == 3 and number + self.columns >= 3 else -2
        return self._head(number)._replace(baseline=self.pane(number)[0].bottom + below)


@lru_cache(maxsize=8)
def placed(design: Design) -> Placed:
    return Placed(design)
