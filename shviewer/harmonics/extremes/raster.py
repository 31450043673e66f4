"""A bilinear lat-long raster, and what its texels are and how it bends in each cell of a coarser or finer grid."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices

Texels = NDArray[np.float32]

COARSE, ALMOST = 1.5, 0.9
"""A raster is coarse for a grid that has at least the first part of its rows; another may have the second part of a grid's."""


@dataclass(frozen=True, eq=False)
class Raster:
    """texels: (height, width, 3) float32. Rows lie at texel centres, or from pole to pole if `rows_on_poles`."""

    texels: Texels
    rows_on_poles: bool = False
    _ranges: dict[int, tuple[Texels, Texels]] = field(default_factory=dict, init=False, repr=False)
    _bends: dict[int, Texels] = field(default_factory=dict, init=False, repr=False)
    _finer: dict[int, Array] = field(default_factory=dict, init=False, repr=False)
    """What was computed for grids, by their rows."""

    @property
    def row_scale_offset(self) -> tuple[float, float]:
        """The pair (a, b) with row = a theta + b; columns are (1/2 - phi / 2 pi) width - 1/2."""
        height = len(self.texels)
        return ((height - 1) / np.pi, 0.0) if self.rows_on_poles else (height / np.pi, -0.5)

    def at(self, row: Array, column: Array) -> Array:
        """Bilinear radiance (..., 3) at places in texels (...), which may lie beyond a pole."""
        top = np.floor(row).astype(np.int64)
        down = (row - top)[..., None]
        return np.asarray(self._row_value(top, column) * (1 - down) + self._row_value(top + 1, column) * down)

    def _row_value(self, row: Indices, column: Array) -> Array:
        """Values of whole rows (...), linear between their texels; beyond a pole comes the same row half way round."""
        height, width = self.texels.shape[:2]
        column = column + np.where((row < 0) | (row >= height), width / 2, 0.0)
        row = self._mirrored(row)
        left = np.floor(column).astype(np.int64)
        right = (column - left)[..., None]
        return np.asarray(self.texels[row, left % width] * (1 - right) + self.texels[row, (left + 1) % width] * right)

    def _mirrored(self, row: Indices) -> Indices:
        """The rows that stand for rows beyond a pole; others stay."""
        last, pole_row = len(self.texels) - 1, 0 if self.rows_on_poles else 1
        row = np.where(row < 0, -row - pole_row, np.where(row > last, 2 * last - row + pole_row, row))
        return np.asarray(np.clip(row, 0, last))

    def per_cell(self, grid_rows: int) -> tuple[float, float]:
        """Rows and columns of texels in a cell of a grid."""
        return self.row_scale_offset[0] * (np.pi / grid_rows), self.texels.shape[1] / (2 * grid_rows)

    @property
    def units(self) -> tuple[float, float]:
        """Rows and columns between lines where it bends: beyond a pole, an odd row has its texels between the columns."""
        return 1.0, 0.5 if self.texels.shape[1] % 2 else 1.0

    def aligned_rows(self, grid_rows: int) -> int | None:
        """The rows of a grid, about as fine or finer, in whose cells it is bilinear; None if none is near.

        An odd number of such rows to a row of texels has one through their centres; columns likewise.
        """
        height, width = self.texels.shape[:2]
        if self.rows_on_poles or width != 2 * height or height > COARSE * grid_rows:
            return None
        parts = int(np.ceil(ALMOST * grid_rows / height))
        return int(height * (parts + 1 - parts % 2))

    def on_grid(self, rows: int) -> Array:
        """Its values on the points of such a grid, (rows, 3, 2 rows)."""
        if rows not in self._finer:
            height = len(self.texels)
            row, column = ((np.arange(count) + 0.5) * height / rows - 0.5 for count in (rows, 2 * rows))
            self._finer[rows] = np.ascontiguousarray(self.at(row[:, None], column).swapaxes(1, 2), dtype=np.float64)
        return self._finer[rows]

    def ranges(self, grid_rows: int) -> tuple[Texels, Texels]:
        """The lowest and the highest texel that bears on each cell of a grid (band_limited.py), (grid_rows + 1, 3, columns)."""
        if grid_rows not in self._ranges:
            low, high = (self._pool(self.texels, grid_rows, better) for better in (np.minimum, np.maximum))
            self._ranges[grid_rows] = low, high
        return self._ranges[grid_rows]

    def bends(self, grid_rows: int) -> Texels:
        """How far the raster can pass the bilinear surface through the corners of each cell of a grid, like `ranges`.

        A line that turns by k at a share t of an interval of length h lies k h t (1 - t) from its chord there; k is the second
        difference of the texels.
        """
        if grid_rows not in self._bends:
            height, width = self.texels.shape[:2]
            if not self.rows_on_poles and (height, width) == (grid_rows, 2 * grid_rows):
                return np.zeros((1, 1, 1), dtype=np.float32)  # the cells are those between texels
            tall = self.texels.astype(np.float64)
            beyond = tall[self._mirrored(np.array([-1, height]))]
            turned = [np.roll(beyond, turn, axis=1) for turn in (width // 2, -(width // 2))]
            columns = [np.concatenate([ends[:1], tall, ends[1:]]) for ends in turned]
            down = np.maximum(*(np.abs(np.diff(column, 2, axis=0)) for column in columns))
            across = np.abs(np.diff(np.pad(tall, ((0, 0), (1, 1), (0, 0)), mode="wrap"), 2, axis=1))
            self._bends[grid_rows] = sum(
                np.ceil(side / unit) * side / 4 * self._pool(second, grid_rows, np.maximum)
                for second, side, unit in zip((down, across), self.per_cell(grid_rows), self.units, strict=True)
            )
        return self._bends[grid_rows]

    def _pool(self, texels: NDArray[np.floating], grid_rows: int, better: np.ufunc) -> Texels:
        """The best of the texels, (height, width, 3), that bear on each cell of a grid."""
        height, width = texels.shape[:2]
        scale, offset = self.row_scale_offset
        edges = np.asarray(scale * np.pi / grid_rows * (np.arange(grid_rows + 2) - 0.5) + offset)
        by_row = np.empty((width, grid_rows + 1, 3), dtype=np.float32)
        for cell, (top, bottom) in enumerate(_spans(edges)):
            pooled = better.reduce(texels[max(top, 0) : bottom + 1], axis=0)
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


def _spans(edges: Array) -> list[tuple[int, int]]:
    """First and last texel that bear on each of the intervals between edges in texels."""
    first, last = np.floor(edges[:-1]).astype(int), np.ceil(edges[1:]).astype(int)
    return list(zip(first.tolist(), last.tolist(), strict=True))
