"""The largest error of a reconstruction of a bilinear lat-long raster: texels against bounds of the band-limited part.

Between four texels the raster is bilinear in row and column, and so is it in any part of that cell. There, the error passes its
largest corner by no more than the reconstruction bends (waves.py). Most of the sphere is ruled out by far less: in each cell of
the grid, by the highest and the lowest texel against the corners of the reconstruction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.waves import Waves
from shviewer.harmonics.synthesis import Synthesis

Indices = NDArray[np.int64]
Texels = NDArray[np.float32]
Ranges = dict[int, tuple[Texels, Texels]]
"""The lowest and the highest texels of the cells of grids, by their rows."""

TEXELS_READ = 2**18
"""The most texels that are read at a time."""

MOST_CELLS = 1024
"""The most cells that are looked into: what the others may hold stays in the bound."""

MOST_BOXES, EVALUATIONS = 64, 1024
"""The most boxes in one round, and how often the reconstruction is evaluated before the search for a closer bound ends."""

FEW_TEXELS = 1.5
"""Up to so many texels a side, the corners of a cell may bound the error in it better than its range does."""

FIRST_CELLS = 16
"""The cells that are looked into at first, so that the others are judged by the largest error in these."""

SPLIT = 4
"""The parts of a box along each side."""


class Error(NamedTuple):
    """The largest error found, where (radians), and a bound that no direction passes."""

    largest: float
    theta: float
    phi: float
    bound: float


class _Boxes(NamedTuple):
    """Rectangles within a texel cell: edges in texels (k, 2), the raster in their corners (k, 2, 2, 3), bounds (k,).

    curvature: of the reconstruction, as in `Waves.curvature`, (k, 2, 3).
    """

    rows: Array
    columns: Array
    corners: Array
    bounds: Array
    curvature: Array

    def take(self, which: Indices | NDArray[np.bool_] | slice) -> _Boxes:
        return _Boxes(*(part[which] for part in self))


@dataclass(frozen=True, eq=False)
class Raster:
    """texels: (height, width, 3), at row = scale theta + offset and column = (1/2 - phi / 2 pi) width - 1/2."""

    texels: Texels
    scale: float
    offset: float
    at: Callable[[Array, Array], Array]
    """Places in texels (...), rows and columns -> the raster there, (..., 3); beyond a pole it continues on the other side."""
    known: Ranges

    def largest_error(
        self, waves: Waves, original: Array, synthesis: Synthesis, tolerance: float, negligible: float
    ) -> Error:
        """The largest error; its bound should end above it by `tolerance`, relative to it, or by `negligible`.

        waves, original: reconstruction and raster on the points of the same grid.
        """
        return _Search(self, waves, original, synthesis, tolerance, negligible).run()

    @property
    def unit(self) -> float:
        """Columns between lines where it bends: the row beyond a pole is half way round, between the texels of an odd row."""
        return 0.5 if self.texels.shape[1] % 2 else 1.0

    def ranges(self, grid_rows: int) -> tuple[Texels, Texels]:
        """The lowest and the highest texel that bears on each cell of a grid (waves.py), (grid_rows + 1, 3, columns)."""
        if grid_rows not in self.known:
            low, high = (self._pool(grid_rows, better) for better in (np.minimum, np.maximum))
            self.known[grid_rows] = low, high
        return self.known[grid_rows]

    def bends(self, grid_rows: int, per_cell: tuple[float, float]) -> Texels:
        """How far the raster can pass the bilinear surface through the corners of each cell of a grid, like `ranges`.

        A line that turns by k at a share t of an interval of length h lies k h t (1 - t) from its chord there; k is the second
        difference of the texels. per_cell: texels in a cell, down and across.
        """
        if -grid_rows not in self.known:
            height, width = self.texels.shape[:2]
            edge = 0 if self.offset == 0 else 1  # whether a row lies on the pole, or half a texel from it
            tall = self.texels.astype(np.float64)
            beyond = [tall[[min(at, height - 1)]] for at in (1 - edge, max(height - 2 + edge, 0))]
            ends = [(np.roll(row, width // 2, axis=1), np.roll(row, -(width // 2), axis=1)) for row in beyond]
            down = np.maximum(
                *(np.abs(np.diff(np.concatenate([ends[0][i], tall, ends[1][i]]), 2, axis=0)) for i in (0, 1))
            )
            across = np.abs(np.diff(np.pad(tall, ((0, 0), (1, 1), (0, 0)), mode="wrap"), 2, axis=1))
            total = sum(
                np.ceil(side / unit)
                * side
                / 4
                * Raster(second, self.scale, self.offset, self.at, {})._pool(grid_rows, np.maximum)
                for second, side, unit in zip((down, across), per_cell, (1.0, self.unit), strict=True)
            )
            self.known[-grid_rows] = total, total
        return self.known[-grid_rows][0]

    def _pool(self, grid_rows: int, better: np.ufunc) -> Texels:
        height, width = self.texels.shape[:2]
        edges = np.asarray(self.scale * np.pi / grid_rows * (np.arange(grid_rows + 2) - 0.5) + self.offset)
        by_row = np.empty((width, grid_rows + 1, 3), dtype=np.float32)
        for cell, (top, bottom) in enumerate(_spans(edges)):
            pooled = better.reduce(self.texels[max(top, 0) : bottom + 1], axis=0)
            if top < 0 or bottom >= height:  # the row beyond a pole is the same row half way round
                turned = better(np.roll(pooled, width // 2, axis=0), np.roll(pooled, -(width // 2), axis=0))
                pooled = better(pooled, turned)
            by_row[:, cell] = pooled
        columns = 2 * grid_rows
        edges = np.asarray((np.arange(columns + 1) + 0.5) * width / columns - 0.5)
        cells = np.empty((columns, grid_rows + 1, 3), dtype=np.float32)
        for cell, (left, right) in enumerate(_spans(edges)):
            if left >= 0 and right < width:
                better.reduce(by_row[left : right + 1], axis=0, out=cells[cell])
            else:
                better.reduce(by_row.take(np.arange(left, right + 1), axis=0, mode="wrap"), axis=0, out=cells[cell])
        return np.ascontiguousarray(cells.transpose(1, 2, 0))


class _Search:
    def __init__(
        self,
        raster: Raster,
        waves: Waves,
        original: Array,
        synthesis: Synthesis,
        tolerance: float,
        negligible: float,
    ) -> None:
        self.raster, self.waves, self.original, self.synthesis = raster, waves, original, synthesis
        self.best, self.tolerance, self.negligible = Error(0.0, 0.0, 0.0, np.inf), tolerance, negligible
        self.low, self.high = raster.ranges(waves.rows)
        self.per_cell = raster.scale * waves.step, raster.texels.shape[1] / waves.columns
        """Rows and columns of texels in a cell of the grid."""

    @property
    def enough(self) -> float:
        return self.best.largest + max(self.tolerance * self.best.largest, self.negligible)

    def run(self) -> Error:
        waves = self.waves
        above = self.high - waves.corners_low
        np.maximum(above, waves.corners_high - self.low, out=above)
        above += waves.slack[:, None]
        bounds = above.max(axis=1)
        highest = float(bounds.max())
        cells = np.flatnonzero(bounds.reshape(-1) > self.enough)
        if len(cells) > MOST_CELLS:
            bends = waves.bends()
            above += bends - waves.slack[:, None]
            if max(self.per_cell) <= FEW_TEXELS:
                corners = waves.largest_corners(np.abs(waves.values - self.original))
                corners += bends
                corners += self.raster.bends(waves.rows, self.per_cell)
                np.minimum(above, corners, out=above)
            bounds = above.max(axis=1)
            highest = float(bounds.max())
            cells = np.flatnonzero(bounds.reshape(-1) > self.enough)
        unseen = 0.0
        if len(cells) > MOST_CELLS:
            cells = cells[np.argpartition(-bounds.reshape(-1)[cells], MOST_CELLS)]
            unseen = float(bounds.reshape(-1)[cells[MOST_CELLS]])
        cells = cells[:MOST_CELLS][np.argsort(-bounds.reshape(-1)[cells[:MOST_CELLS]])]
        texels = int(np.prod([np.ceil(side) + 2 for side in self.per_cell]))
        boxes: list[_Boxes] = []
        start, block = 0, FIRST_CELLS
        while start < len(cells):
            part = cells[start : start + block]
            part = part[bounds.reshape(-1)[part] > self.enough]
            found = self._boxes(part // waves.columns, part % waves.columns)
            if start == 0:
                self._evaluate(_highest(found, MOST_BOXES)[0], 1)
            boxes.append(found)
            start, block = start + block, max(FIRST_CELLS, TEXELS_READ // texels)
        bound = self._refine(_Boxes(*map(np.concatenate, zip(*boxes, strict=True)))) if boxes else 0.0
        bound = max(bound, unseen if unseen > self.enough else 0.0)
        return self.best._replace(bound=max(self.best.largest, min(highest, max(bound, self.enough))))

    def _refine(self, boxes: _Boxes) -> float:
        """Look into boxes until none can hold more than is found, or the effort is spent; a bound of what is left."""
        waiting, split, evaluations = boxes.take(boxes.bounds > self.enough), 1, 0
        ready = waiting.take(slice(0, 0))
        while len(waiting.bounds) + len(ready.bounds) and evaluations < EVALUATIONS:
            split = 1 if len(waiting.bounds) else SPLIT
            boxes, rest = _highest(waiting if split == 1 else ready, MOST_BOXES * 6 // (split + 1) ** 2)
            evaluations += len(boxes.bounds) * (split + 1) ** 2
            parts = self._evaluate(boxes, split)
            if split == 1:
                waiting, ready = rest, _join(ready, parts)
            else:
                ready = _join(rest, parts)
            waiting, ready = (part.take(part.bounds > self.enough) for part in (waiting, ready))
        return float(np.append(waiting.bounds, ready.bounds).max(initial=0.0))

    def _boxes(self, row: Indices, column: Indices) -> _Boxes:
        """The parts of texel cells in cells of the grid (k,) that may hold a larger error than is found."""
        raster, waves = self.raster, self.waves
        rows, columns = (
            np.clip(
                (np.floor(first / unit)[:, None] + np.arange(int(np.ceil(side / unit)) + 2)) * unit,
                first[:, None],
                first[:, None] + side,
            )
            for first, side, unit in (
                ((row - 0.5) * self.per_cell[0] + raster.offset, self.per_cell[0], 1.0),
                ((column + 0.5) * self.per_cell[1] - 0.5, self.per_cell[1], raster.unit),
            )
        )
        values = raster.at(
            rows[:, :, None], np.broadcast_to(columns[:, None, :], (len(row), rows.shape[1], columns.shape[1]))
        )
        corners = np.stack(
            [np.stack([values[:, i : i - 1 or None, j : j - 1 or None] for j in (0, 1)], 3) for i in (0, 1)], 3
        )
        low, high = corners.min(axis=(3, 4)), corners.max(axis=(3, 4))
        at = row, slice(None), column
        lowest, highest = (a[at][:, None, None] for a in (waves.corners_low, waves.corners_high))
        bounds = (np.maximum(high - lowest, highest - low) + waves.slack).max(axis=-1)
        real = (np.diff(rows)[:, :, None] > 0) & (np.diff(columns)[:, None, :] > 0) & (bounds > self.enough)
        cell, i, j = np.nonzero(real)
        used, among = np.unique(cell, return_inverse=True)
        return _Boxes(
            np.stack([rows[cell, i], rows[cell, i + 1]], axis=1),
            np.stack([columns[cell, j], columns[cell, j + 1]], axis=1),
            corners[cell, i, j],
            bounds[cell, i, j],
            waves.curvature(row[used], column[used])[among],
        )

    def _evaluate(self, boxes: _Boxes, split: int) -> _Boxes:
        """Evaluate the error in split + 1 points a side of boxes, and note the largest; the parts between with new bounds."""
        if not len(boxes.bounds):
            return boxes
        raster = self.raster
        share = np.arange(split + 1) / split
        rows, columns = (edges[:, :1] + np.diff(edges) * share for edges in (boxes.rows, boxes.columns))
        first = boxes.corners[:, 0, None] + (boxes.corners[:, 1] - boxes.corners[:, 0])[:, None] * share[:, None, None]
        values = first[:, :, :1] + (first[:, :, 1:] - first[:, :, :1]) * share[:, None]
        theta, phi = (rows - raster.offset) / raster.scale, np.pi * (1 - (2 * columns + 1) / raster.texels.shape[1])
        everywhere = (len(rows), split + 1, split + 1)
        shown = self.synthesis.at(
            *(np.broadcast_to(a, everywhere).ravel() for a in (theta[:, :, None], phi[:, None, :]))
        )
        error = np.abs(values - shown.reshape(*everywhere, 3))
        which = int(error.max(axis=-1).argmax())
        largest = float(error.max())
        if largest > self.best.largest:
            box, i, j = (int(index) for index in np.unravel_index(which, everywhere))
            self.best = Error(largest, float(theta[box, i]), float(phi[box, j]), np.inf)
        sides = np.concatenate([np.diff(angle[:, :2]) for angle in (theta, phi)], axis=1)
        bend = (sides[:, :, None] ** 2 * boxes.curvature).sum(axis=1) / 8
        near = np.maximum(error[:, :-1], error[:, 1:])
        bounds = (np.maximum(near[:, :, :-1], near[:, :, 1:]) + bend[:, None, None]).max(axis=-1)
        bounds = np.minimum(bounds, boxes.bounds[:, None, None]).reshape(-1)
        pairs = [np.stack([edges[:, :-1], edges[:, 1:]], axis=-1) for edges in (rows, columns)]
        corners = np.stack([np.stack([values[:, i : split + i, j : split + j] for j in (0, 1)], 3) for i in (0, 1)], 3)
        shape = (len(rows), split, split, 2)
        return _Boxes(
            np.broadcast_to(pairs[0][:, :, None], shape).reshape(-1, 2),
            np.broadcast_to(pairs[1][:, None], shape).reshape(-1, 2),
            corners.reshape(-1, 2, 2, 3),
            bounds,
            np.repeat(boxes.curvature, split**2, axis=0),
        )


def _join(first: _Boxes, second: _Boxes) -> _Boxes:
    return _Boxes(*map(np.concatenate, zip(first, second, strict=True)))


def _highest(boxes: _Boxes, most: int) -> tuple[_Boxes, _Boxes]:
    """The `most` boxes with the highest bounds, and the others."""
    order = np.argsort(-boxes.bounds)
    return boxes.take(order[:most]), boxes.take(order[most:])


def _spans(edges: Array) -> list[tuple[int, int]]:
    """First and last texel that bear on each of the intervals between edges in texels."""
    first, last = np.floor(edges[:-1]).astype(int), np.ceil(edges[1:]).astype(int)
    return list(zip(first.tolist(), last.tolist(), strict=True))
