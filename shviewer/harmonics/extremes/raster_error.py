"""The largest error of a reconstruction of a bilinear raster: texels against bounds of the band-limited part.

Between four texels the raster is bilinear in row and column, and so is it in any part of that cell. There, the error passes
its largest corner by no more than the reconstruction bends (band_limited.py). Most of the sphere is ruled out by far less: in
each cell of the grid, by the highest and the lowest texel against the corners of the reconstruction.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.extremes.band_limited import BandLimited
from shviewer.harmonics.extremes.raster import Raster
from shviewer.harmonics.synthesis import Synthesis

TEXELS_READ = 2**18
"""The most texels that are read at a time."""

MOST_CELLS = 1024
"""The most cells that are looked into: what the others may hold stays in the bound."""

MOST_BOXES, EVALUATIONS = 64, 4096
"""The most boxes in one round, and how often the reconstruction is evaluated before the search for a closer bound ends."""

BENT_CELLS = 256
"""With more open cells than this, all are bounded anew by how the reconstruction bends."""

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

    curvature: of the reconstruction, as in `BandLimited.curvature`, (k, 2, 3).
    """

    rows: Array
    columns: Array
    corners: Array
    bounds: Array
    curvature: Array

    def take(self, which: Indices | NDArray[np.bool_] | slice) -> _Boxes:
        return _Boxes(*(part[which] for part in self))

    def highest(self, most: int) -> tuple[_Boxes, _Boxes]:
        """The `most` boxes with the highest bounds, and the others."""
        order = np.argsort(-self.bounds)
        return self.take(order[:most]), self.take(order[most:])


class Search:
    """A search for the largest error on a raster, whose bound should end closely above what is found.

    waves, original: reconstruction and raster on the points of the same grid. The bound may be above by the share `tolerance`
    of what is found, or by `negligible`.
    """

    def __init__(
        self,
        raster: Raster,
        waves: BandLimited,
        original: Array,
        synthesis: Synthesis,
        tolerance: float,
        negligible: float,
    ) -> None:
        self.raster, self.waves, self.original, self.synthesis = raster, waves, original, synthesis
        self.best, self.tolerance, self.negligible = Error(0.0, 0.0, 0.0, np.inf), tolerance, negligible
        self.per_cell = raster.per_cell(waves.rows)

    @property
    def enough(self) -> float:
        return self.best.largest + max(self.tolerance * self.best.largest, self.negligible)

    def run(self) -> Error:
        bounds = self._ranges(self.waves.slack[:, None]).max(axis=1)
        highest = float(bounds.max())
        boxes = [self._highest_cells(bounds)]
        if np.count_nonzero(bounds > self.enough) > BENT_CELLS:
            self._lower(bounds)
            highest = max(float(bounds.max()), float(boxes[0].bounds.max(initial=0)))
            boxes.append(self._highest_cells(bounds))
        open_ = bounds.reshape(-1)
        cells, unseen = np.flatnonzero(open_ > self.enough), 0.0
        if len(cells) > MOST_CELLS:
            cells = cells[np.argpartition(-open_[cells], MOST_CELLS)]
            unseen = float(open_[cells[MOST_CELLS]])
        cells = cells[:MOST_CELLS]
        texels = int(np.prod([np.ceil(side) + 2 for side in self.per_cell]))
        block = max(FIRST_CELLS, TEXELS_READ // texels)
        boxes += [self._boxes(cells[start : start + block]) for start in range(0, len(cells), block)]
        bound = max(self._refine(_join(*boxes)), unseen, self.enough)
        return self.best._replace(bound=max(self.best.largest, min(highest, bound)))

    def _highest_cells(self, bounds: Array) -> _Boxes:
        """Evaluate the error in the cells with the highest bounds, and set these to 0; their boxes."""
        cells = np.argpartition(-bounds.reshape(-1), FIRST_CELLS)[:FIRST_CELLS]
        bounds.reshape(-1)[cells] = 0
        boxes = self._boxes(cells)
        self._evaluate(boxes.highest(MOST_BOXES)[0], 1)
        return boxes

    def _ranges(self, bend: Array, cells: slice = slice(None)) -> Array:
        """Bounds of the error in each cell, (rows + 1, 3, columns), by its texels, its corners, and a bend beyond these."""
        waves = self.waves
        low, high = (texels[cells] for texels in self.raster.ranges(waves.rows))
        above = high - waves.corners_low[cells]
        np.maximum(above, waves.corners_high[cells] - low, out=above)
        above += bend
        return above

    def _lower(self, bounds: Array) -> None:
        """Lower the bounds of what is open, with more work: by how the reconstruction bends, and a raster in small cells."""
        waves, few = self.waves, max(self.per_cell) <= FEW_TEXELS
        if few:
            errors = np.abs(waves.values - self.original)
            bent = np.broadcast_to(self.raster.bends(waves.rows), waves.corners_low.shape)
        for cells in waves.blocks(np.any(bounds > self.enough, axis=1)):
            bends = waves.bends(cells)
            above = self._ranges(bends, cells)
            if few:
                bends += waves.corners_in(cells, np.maximum, errors)
                bends += bent[cells]
                np.minimum(above, bends, out=above)
            np.minimum(bounds[cells], above.max(axis=1), out=bounds[cells])

    def _refine(self, boxes: _Boxes) -> float:
        """Look into boxes until none can hold more than is found, or the effort is spent; a bound of what is left."""
        waiting, evaluations = boxes.take(boxes.bounds > self.enough), 0
        ready = waiting.take(slice(0, 0))
        while len(waiting.bounds) + len(ready.bounds) and evaluations < EVALUATIONS:
            split = 1 if len(waiting.bounds) else SPLIT
            boxes, rest = (waiting if split == 1 else ready).highest(MOST_BOXES * 6 // (split + 1) ** 2)
            evaluations += len(boxes.bounds) * (split + 1) ** 2
            parts = self._evaluate(boxes, split)
            if split == 1:
                waiting, ready = rest, _join(ready, parts)
            else:
                ready = _join(rest, parts)
            waiting, ready = (part.take(part.bounds > self.enough) for part in (waiting, ready))
        return float(np.append(waiting.bounds, ready.bounds).max(initial=0.0))

    def _boxes(self, cells: Indices) -> _Boxes:
        """The parts of texel cells in cells of the grid (k,) that may hold a larger error than is found."""
        raster, waves = self.raster, self.waves
        row, column = np.divmod(cells, waves.columns)
        firsts = (row - 0.5) * self.per_cell[0] + raster.row_scale_offset[1], (column + 0.5) * self.per_cell[1] - 0.5
        rows, columns = (
            np.clip(
                (np.floor(first / unit)[:, None] + np.arange(int(np.ceil(side / unit)) + 2)) * unit,
                first[:, None],
                first[:, None] + side,
            )
            for first, side, unit in zip(firsts, self.per_cell, raster.units, strict=True)
        )
        corners = _corners(raster.at(*np.broadcast_arrays(rows[:, :, None], columns[:, None, :])))
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
        scale, offset = self.raster.row_scale_offset
        share = np.arange(split + 1) / split
        rows, columns = (edges[:, :1] + np.diff(edges) * share for edges in (boxes.rows, boxes.columns))
        first = boxes.corners[:, 0, None] + (boxes.corners[:, 1] - boxes.corners[:, 0])[:, None] * share[:, None, None]
        values = first[:, :, :1] + (first[:, :, 1:] - first[:, :, :1]) * share[:, None]
        theta, phi = (rows - offset) / scale, np.pi * (1 - (2 * columns + 1) / self.raster.texels.shape[1])
        everywhere = (len(rows), split + 1, split + 1)
        places = np.broadcast_arrays(theta[:, :, None], phi[:, None, :])
        error = np.abs(values - self.synthesis.at(*(place.ravel() for place in places)).reshape(*everywhere, 3))
        which = int(error.max(axis=-1).argmax())
        largest = float(error.max())
        if largest > self.best.largest:
            box, i, j = (int(index) for index in np.unravel_index(which, everywhere))
            self.best = Error(largest, float(theta[box, i]), float(phi[box, j]), np.inf)
        sides = np.concatenate([np.diff(angle[:, :2]) for angle in (theta, phi)], axis=1)
        bend = (sides[:, :, None] ** 2 * boxes.curvature).sum(axis=1) / 8
        near = np.maximum(error[:, :-1], error[:, 1:])
        bounds = (np.maximum(near[:, :, :-1], near[:, :, 1:]) + bend[:, None, None]).max(axis=-1)
        pairs = [np.stack([edges[:, :-1], edges[:, 1:]], axis=-1) for edges in (rows, columns)]
        shape = (len(rows), split, split, 2)
        return _Boxes(
            np.broadcast_to(pairs[0][:, :, None], shape).reshape(-1, 2),
            np.broadcast_to(pairs[1][:, None], shape).reshape(-1, 2),
            _corners(values).reshape(-1, 2, 2, 3),
            np.minimum(bounds, boxes.bounds[:, None, None]).reshape(-1),
            np.repeat(boxes.curvature, split**2, axis=0),
        )


def _corners(values: Array) -> Array:
    """Values (k, rows + 1, columns + 1, 3) at points -> those in the corners of cells, (k, rows, columns, 2, 2, 3)."""
    return np.moveaxis(sliding_window_view(values, (2, 2), axis=(1, 2)), 3, -1)


def _join(*boxes: _Boxes) -> _Boxes:
    return _Boxes(*map(np.concatenate, zip(*boxes, strict=True)))
