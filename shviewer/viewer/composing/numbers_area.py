"""Where the numbers of a frame stand: answers, figures, curve and foot. In pixels of the design.

What has no room goes in this order: legend, keys, curve, figures, answers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from math import ceil
from typing import Any, NamedTuple, TypeVar

from shviewer.viewer.composing.panes import Box


class Line(NamedTuple):
    """A line for text: where it begins, where it has to end, and its baseline."""

    left: float
    right: float
    baseline: float


class Cell(NamedTuple):
    """A column for a value and the label under it: its sides and the two baselines."""

    left: float
    right: float
    value: float
    label: float


Place = TypeVar("Place", Box, Line, Cell)


def scaled(place: Place, scale: float) -> Place:
    """A place in pixels of the design in whole pixels of the frame."""
    return type(place)(*(float(round(side * scale)) for side in place))


NARROW_COLUMN, SHORT_COLUMN, COLUMN = 66.0, 84.0, 118.0
"""Widths of a figure's column: the least, the least with large type, and the least with long labels."""

FOOT = 12.0
"""The foot's baseline over the lower edge."""


class Mode(Enum):
    """How the numbers are arranged under the panes, or beside them."""

    HALVES = "answers and figures at the left, the curve at the right"
    STACK = "answers, figures and curve one under the other"
    CELL = "the curve in the fourth cell of two rows, answers and figures under them"
    COLUMN = "the curve in the fourth cell, answers and figures in a column at the right"
    BARE = "answers and figures alone"
    ANSWERS = "answers alone"
    NONE = "nothing"


HEIGHTS = {
    Mode.HALVES: (160.0, 98.0),
    Mode.STACK: (268.0, 172.0),
    Mode.CELL: (160.0, 98.0),
    Mode.COLUMN: (36.0, 36.0),
    Mode.BARE: (160.0, 98.0),
    Mode.ANSWERS: (104.0, 56.0),
    Mode.NONE: (0.0, 0.0),
}
"""The least height that each takes, and what it takes in a compact frame."""

FULL = (Mode.HALVES, Mode.STACK, Mode.CELL, Mode.COLUMN)
LEVELS = ((FULL, 0.8), ((Mode.BARE,), 0.6), ((Mode.ANSWERS,), 0.6), ((Mode.NONE,), 0.0))
"""Modes from the most numbers to none. One is given up for panes that it makes smaller than this share of what they would be
with fewer numbers; but not where they are comfortably large."""

COMFORTABLE = 145.0
"""The height of a pane's picture that is large enough for anybody; of a map, six tenths of this."""

ROOMY = 205.0
"""From this height on the numbers are larger, or the figures stand in two rows beside a wider curve."""

HIGH = 262.0
"""From this height on both."""

COLUMN_HEIGHT = 450.0
"""The least height of a frame whose numbers stand in a column at the right."""

SIDE, AROUND = 192.0, 24.0
"""Width of the column of numbers at the right, without the margin, and the space on both sides of its hairline."""


LINES = ("curve", "legend", "foot", "exposure", "curve_head")
"""Places of Numbers of which there is one or none."""


@dataclass(frozen=True)
class Numbers:
    """Places of the numbers, and the sizes of their type. What has no room is None or empty."""

    answers: tuple[Cell, ...] = ()
    """Two: for the radiance, and for the shading."""
    figures: tuple[Cell, ...] = ()
    """Error, largest, lowest, negative area, and perhaps the energy in use."""
    curve: Box | None = None
    """The axes: the lines of the largest and the least error are its top and its bottom; labels stand left and below."""
    legend: Line | None = None
    foot: Line | None = None
    """Keys and messages."""
    exposure: Line | None = None
    """Exposure, where the panes have no foot for it."""
    curve_head: Line | None = None
    """A head for the curve, where it stands among the panes."""
    answer_size: float = 28.0
    figure_size: float = 18.0
    label_size: float = 13.0
    short: bool = False
    """Whether only short labels have room."""

    def on_foot(self, line: Line | None) -> bool:
        """Whether a line is on the baseline of the foot."""
        return line is not None and self.foot is not None and line.baseline == self.foot.baseline

    def scaled(self, scale: float) -> Numbers:
        """The same in pixels; sizes of type stay those of the design."""
        answers, figures = (tuple(scaled(cell, scale) for cell in cells) for cells in (self.answers, self.figures))
        lines: dict[str, Any] = {name: getattr(self, name) for name in LINES}
        lines = {name: line and scaled(line, scale) for name, line in lines.items()}
        return replace(self, answers=answers, figures=figures, **lines)


def fits(mode: Mode, width: float, *, compact: bool, cell: float | None) -> bool:
    """Whether numbers have the width for it. width: without margins; cell: the width of a free fourth cell of the panes."""
    least = 4 * NARROW_COLUMN if compact else 5 * NARROW_COLUMN
    halves = (width - 24) / 2 >= least
    return {
        Mode.HALVES: halves and cell is None,
        Mode.STACK: (compact or not halves) and width >= least and cell is None,
        Mode.CELL: cell is not None and cell >= 200 and width >= least,
        Mode.COLUMN: cell is not None and cell >= 300 and not compact,
        Mode.BARE: width >= least,
        Mode.ANSWERS: width >= (220 if compact else 330),
        Mode.NONE: True,
    }[mode]


def numbers_area(
    mode: Mode, area: Box, *, compact: bool, third: Box | None, cell: Box | None, exposed: bool = False
) -> Numbers:
    """Lay the numbers out.

    area: from the hairline down to the frame's lower edge, between the margins; for COLUMN the column at the right.
    third: the first of three panes in a row; cell: the fourth cell of the panes, the shape's rectangle.
    exposed: whether the exposure stands at the foot of a pane.
    """
    if mode is Mode.NONE:
        return Numbers()
    if mode is Mode.COLUMN:
        assert cell is not None
        return _column(area, cell, exposed=exposed)
    roomy = not compact and area.height >= ROOMY
    left, right = area, None
    if mode is Mode.HALVES:
        middle = (area.left + area.right) / 2
        left, right = area._replace(right=middle - 12), area._replace(left=middle + 12)
        if third is not None and roomy and third.width >= 3 * COLUMN:
            left, right = area._replace(right=third.right), area._replace(left=third.right + 28)
    found = _answers_and_figures(left, compact=compact, roomy=roomy and mode is not Mode.STACK)
    if mode is Mode.ANSWERS:
        found = replace(found, figures=())
    foot = None if compact else Line(area.left, area.right if right is None else left.right, area.bottom - FOOT)
    base = area.bottom - (24 if compact else 48)
    legend = None
    if right is not None:
        curve: Box | None = Box(right.left, area.top + (12 if compact else 18), right.right, base)
        legend = None if compact else Line(right.left, right.right, area.bottom - FOOT)
    elif mode is Mode.STACK:
        top = found.figures[-1].label + (14 if compact else 20)
        curve = Box(area.left, top, area.right, base)
    else:
        curve = None
    found = replace(found, curve=curve, legend=legend, foot=foot)
    if cell is not None and mode is Mode.CELL:
        found = _in_cell(found, cell)
    if exposed:
        return found
    if mode is not Mode.STACK and roomy and found.figures and area.bottom - found.figures[-1].label > 60:
        last = found.figures[-1].label
        return replace(found, exposure=Line(left.left, left.right, last + 28))
    return replace(found, exposure=foot)  # before as many keys as have room there


def _answers_and_figures(area: Box, *, compact: bool, roomy: bool) -> Numbers:
    """Answers over figures, in as few rows as their columns allow."""
    top, width = area.top, area.width
    if compact:
        column = min(width / 4, 121.0)
        answers = [
            Cell(area.left + 2 * n * column, area.left + (2 * n + 2) * column, top + 28, top + 43) for n in (0, 1)
        ]
        figures = [Cell(area.left + n * column, area.left + (n + 1) * column, top + 68, top + 83) for n in range(4)]
        return Numbers(tuple(answers), tuple(figures), answer_size=20, figure_size=14, label_size=11, short=True)
    two_rows = roomy and 3 * SHORT_COLUMN <= width < 5 * COLUMN
    column = min(width / 3, 132.0) if two_rows else min(float(ceil(width / 5)), 121.0)
    large = roomy and (not two_rows or area.height >= HIGH)
    first = (51, 74, 124, 144) if large else (42, 62, 96, 114) if two_rows else (42, 62, 94, 112)
    step = width / 2 if two_rows else 2 * column
    answers = [Cell(area.left + n * step, area.left + (n + 1) * step, top + first[0], top + first[1]) for n in (0, 1)]
    figures = []
    for n in range(5):
        row, place = divmod(n, 3) if two_rows else (0, n)
        x, down = area.left + place * column, top + (58 if large else 50) * row
        figures.append(Cell(x, x + column, down + first[2], down + first[3]))
    narrow = column < SHORT_COLUMN
    return Numbers(
        tuple(answers),
        tuple(figures),
        answer_size=34 if large and step >= 200 else 28,
        figure_size=20 if large and not narrow else 15 if narrow else 18,
        label_size=12 if narrow else 13,
        short=column < COLUMN,
    )


def _in_cell(found: Numbers, cell: Box) -> Numbers:
    """The same with the curve in a cell among the panes."""
    curve = Box(cell.left, cell.top + 12, cell.right, cell.bottom - (4 if cell.width >= 300 else 20))
    legend = Line(cell.left, cell.right, curve.bottom + 36) if found.foot else None
    return replace(found, curve=curve, legend=legend)


def _column(area: Box, cell: Box, *, exposed: bool) -> Numbers:
    """Answers and figures under each other, the foot under the panes."""
    top = area.top
    answers = [Cell(area.left, area.right, top + 46 + 66 * n, top + 66 + 66 * n) for n in (0, 1)]
    start = answers[-1].label + 56
    pitch = min(56.0, (area.bottom - 60 - start) / 4.5)
    figures = [Cell(area.left, area.right, start + pitch * n, start + pitch * n + 20) for n in range(5)]
    foot = Line(24, area.left - 2 * AROUND, area.bottom - FOOT)
    exposure = None if exposed else Line(area.left, area.right, area.bottom - 44)
    return _in_cell(Numbers(tuple(answers), tuple(figures), foot=foot, exposure=exposure, figure_size=20), cell)
