"""The division of a frame of some size: how many rows its panes have, how large they are, and which numbers have room."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from math import ceil, sqrt

from shviewer.viewer.composing.numbers_area import AROUND, COLUMN_HEIGHT, COMFORTABLE, HEIGHTS, LEVELS, SIDE, Mode, fits

COMPACT_WIDTH, COMPACT_HEIGHT = 900, 480
"""A frame that is smaller both ways is compact: small type, and nothing that could be done without."""

LOW_HEIGHT = 360
"""So is one that is lower than this."""

NEAR = 0.93
"""The share of the largest panes with which a tall frame has more rows."""

LEAST = 0.4
"""The share of comfortable panes below which numbers are given up in any case."""

CLEARANCE = 12.0
"""Pixels of the design between a text and a sphere."""


def margin_of(width: float) -> float:
    """The margin of a frame so many pixels of the design wide."""
    return 24.0 if width >= COMPACT_WIDTH else 16.0 if width >= 300 else 8.0 if width >= 100 else 2.0


@dataclass(frozen=True)
class Design:
    """A frame in pixels of the design, and how large its panes can be."""

    width: float
    height: float
    n_panes: int
    maps: bool

    @property
    def compact(self) -> bool:
        return (self.width < COMPACT_WIDTH and self.height < COMPACT_HEIGHT) or self.height < LOW_HEIGHT

    @property
    def tiny(self) -> bool:
        """Whether there is room for panes alone."""
        return self.height < 100

    @property
    def margin(self) -> float:
        return margin_of(self.width)

    @property
    def top(self) -> float:
        """The top of the first row."""
        return 2.0 if self.tiny else 20.0 if self.margin == 24 else 12.0 if self.compact else 16.0

    @property
    def above(self) -> float:
        """The height of a map's head."""
        return (18.0 if self.compact else 26.0) if self.maps and not self.tiny else 0.0

    @property
    def between(self) -> float:
        """The space between two rows, without heads."""
        return 2.0 if self.tiny else 10.0 if self.maps or self.compact else 14.0

    def below(self, mode: Mode) -> float:
        """The space between the last row and the hairline, in which the colour bar stands."""
        if self.tiny:
            return 2.0
        if self.n_panes > 2:
            return (30.0 if self.maps else 34.0) if self.compact else 38.0 if self.maps else 58.0
        if self.maps and not self.compact:
            return 36.0
        return 10.0 if self.compact else 16.0 if self.margin == 24 else 14.0

    def best(self) -> tuple[int, Mode]:
        """The rows that make the panes largest, with as many numbers as leave them large enough."""
        sizes = {choice: self.size(*choice) for choice in self.choices()}
        comfortable = (0.6 if self.maps else 1.0) * COMFORTABLE
        levels = [([choice for choice in sizes if choice[1] in modes], share) for modes, share in LEVELS]
        for number, (choices, share) in enumerate(levels):
            largest = max((sizes[choice] for choice in choices), default=-1.0)
            others = (sizes[choice] for rest, _ in levels[number + 1 : number + 2] for choice in rest)
            enough = largest >= LEAST * comfortable and largest >= share * max(others, default=0.0)
            if choices and (enough or largest >= comfortable or number == len(levels) - 1):
                break
        if self.height > self.width:  # a tall frame is filled by more rows, where they hardly make the panes smaller
            choices = [choice for choice in choices if sizes[choice] >= NEAR * largest]
            return max(choices, key=lambda choice: (choice[0], sizes[choice]))
        return max(choices, key=lambda choice: sizes[choice])

    def choices(self) -> Iterator[tuple[int, Mode]]:
        """Every number of rows with every way to write the numbers that has the width for it; fewer rows first."""
        for rows, mode in product(range(1, self.n_panes + 1), Mode):
            free = self.columns(rows) * rows > self.n_panes
            cell = self.pane_width(rows, mode) if free else None
            if mode is Mode.COLUMN and self.height < COLUMN_HEIGHT:
                continue
            if fits(mode, self.width - 2 * self.margin, compact=self.compact, cell=cell):
                yield rows, mode

    def columns(self, rows: int) -> int:
        return ceil(self.n_panes / rows)

    def gap(self, rows: int) -> float:
        return (28.0 if self.columns(rows) > 2 else 24.0) if self.width >= 300 else self.margin

    def pane_width(self, rows: int, mode: Mode) -> float:
        columns = self.columns(rows)
        beside = SIDE + 2 * AROUND if mode is Mode.COLUMN else 0.0
        return (self.width - beside - 2 * self.margin - (columns - 1) * self.gap(rows)) / columns

    def size(self, rows: int, mode: Mode) -> float:
        """The largest height of a pane's picture: the diameter of a sphere, or half the width of a map."""
        low, high = 0.0, self.pane_width(rows, mode) / (2 if self.maps else 1)
        room = self.height - HEIGHTS[mode][self.compact] - self.taken(rows, mode)
        for _ in range(48):
            size = (low + high) / 2
            low, high = (size, high) if rows * (size + self.pushed(size, rows, mode)) <= room else (low, size)
        return low

    def taken(self, rows: int, mode: Mode) -> float:
        """The height of everything over the hairline but the pictures."""
        return self.top + rows * self.above + (rows - 1) * self.between + self.below(mode)

    def pushed(self, size: float, rows: int, mode: Mode) -> float:
        """How far a sphere is pushed down in its row, so that the head in the corner is clear of it."""
        if self.maps or self.tiny:
            return 0.0
        words, deep, clear, below = (
            (80.0, 14.0, 8.0, 6.0) if self.compact else (140.0 if self.margin == 24 else 96.0, 36.0, CLEARANCE, 8.0)
        )
        radius, across = size / 2, self.pane_width(rows, mode) / 2 - words
        reach = radius + clear
        if across >= reach:
            return 0.0
        down = sqrt(reach * reach - across * across) if across > 0 else reach
        return min(max(deep + down - radius, 0.0), deep + below)
