"""The one pass over values on rows of constant theta: their sums over the rows with cos(k theta) and sin(k theta).

Half way round, at phi + pi, cos(m phi) and sin(m phi) are the same for even m and change sign for odd m; and even orders are
series in cos(k theta), odd ones in sin(k theta) (theta_series.py). So the cosines need only the left half of a row plus its
right half, and the sines only left minus right. North and south, theta and pi - theta, fold in the same way for even and odd
k. A fold halves the products that follow, for the price of one sum over values that are in the cache.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array

FOLD_BANDS = 24
"""The number of bands from which north and south are folded, too; below, the fold costs more than it saves."""

BLOCK_ROWS = 64
"""Rows, or pairs of folded rows, in one product: the terms that float32 sums before float64 takes over."""

NARROW = 1024
"""The fewest columns for float32, whose rounding averages out over them; with fewer, float64 is as fast and is used."""

FOLDED_VALUES, FEWEST_ROWS = 600_000, 24
"""In float64 a block of folded rows has so many values, to stay in the cache, but not fewer rows."""

LARGEST_PRODUCT = 1_000_000
"""Multiplications in one product: up to so many, OpenBLAS reads operands in place, at up to twice the speed."""

FOLD_VALUES = 100_000
"""How many values are folded at a time, so that they stay in the cache."""

MAX_STEP = 3072
"""The most values of a row in one product, so that a block stays in the cache."""

ALIKE = 1e-5
"""Columns whose relative difference is less would round alike in float32: errors would add up, not average out."""

OUTSTANDING = 1 / 200
"""The share of the whole sum from which a column is summed again in float64. In float32 it errs by 1e-7 of itself."""

TIMES_THE_MEAN = 8
"""A column is summed again only if it also holds this many times the mean of all columns, which few do."""

Values = NDArray[np.floating[Any]]
Precision = type[np.float32] | type[np.float64]


def by_parity(n_bands: int) -> NDArray[np.int64]:
    """The values of k as they are stored, (n_bands,): the even ones, then the odd ones."""
    return np.concatenate([np.arange(0, n_bands, 2), np.arange(1, n_bands, 2)])


@dataclass(frozen=True, eq=False)
class RowFunctions:
    """The factors of each row: weight times cos(k theta) and sin(k theta), (n_bands, rows), mirrored about the equator."""

    cosines: Array
    sines: Array

    @cached_property
    def exact(self) -> tuple[Array, Array]:
        """Cosines and sines with the even k first, in the shapes that they have."""
        order = by_parity(len(self.cosines))
        return self.cosines[order], self.sines[order]

    @cached_property
    def rounded(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """The same in float32."""
        return self.exact[0].astype(np.float32), self.exact[1].astype(np.float32)


def row_sums(
    values: Values, functions: RowFunctions, precision: Precision, mirrored: bool = True
) -> tuple[Array, Array]:
    """values (rows, columns, 3) -> the sums for even and for odd m, (columns or half of them, 3, n_bands) float64 each.

    mirrored: whether the rows are all of them, so that the last ones mirror the first.
    The last axis has k as in `by_parity`. An even number of columns is folded, and only the left half returned.
    """
    rows, columns = values.shape[:2]
    halves = 1 if columns % 2 else 2
    if columns < NARROW:
        precision = np.float64
    flat = values.reshape(rows, halves, columns // halves * 3)
    sums = _sum_rows(flat, functions, precision, mirrored)
    if precision is np.float32:
        _repeat_outstanding(flat, functions, sums)
    even, odd = sums.reshape(2, columns // halves, 3, -1)
    return even, odd


def _sum_rows(flat: Values, functions: RowFunctions, precision: Precision, mirrored: bool) -> Array:
    """Sums over rows: (rows, halves, width) -> (even and odd m, width, n_bands)."""
    rows, _, width = flat.shape
    n_bands = len(functions.cosines)
    work = _Pass(flat, functions, np.zeros((2, width, n_bands)), precision)
    pairs = rows // 2 if mirrored and n_bands >= FOLD_BANDS else 0
    if pairs:
        work.add(0, pairs, mirrored=True)
    if pairs < rows - pairs:
        work.add(pairs, rows - pairs, mirrored=False)
    return work.sums


def _repeat_outstanding(flat: Values, functions: RowFunctions, sums: Array) -> None:
    """Sum again in float64 columns that hold much of the whole, such as a sun's: their rounding does not average out."""
    weight = np.maximum.reduce(np.abs(sums[0, :, 0]).reshape(-1, 3).T)
    share = weight / max(float(weight.sum()), np.finfo(np.float64).tiny)
    wanted = np.flatnonzero(share > max(OUTSTANDING, TIMES_THE_MEAN / len(share)))
    for run in np.split(wanted, np.flatnonzero(np.diff(wanted) > 1) + 1) if len(wanted) else ():
        columns = slice(3 * run[0], 3 * run[-1] + 3)
        west, *east = flat[:, :, columns].astype(np.float64).swapaxes(0, 1)
        for parity, folded in enumerate((west + east[0], west - east[0]) if east else (west, west)):
            sums[parity, columns] = (functions.exact[parity] @ folded).T


class _Pass:
    """flat: (rows, halves, width) values; sums: (even and odd orders, width, n_bands), so that a block is contiguous."""

    def __init__(self, flat: Values, functions: RowFunctions, sums: Array, precision: Precision) -> None:
        self.flat, self.sums, self.precision = flat, sums, precision
        self.exact = functions.exact
        self.functions: tuple[Values, Values] = functions.rounded if precision is np.float32 else functions.exact

    def add(self, start: int, stop: int, mirrored: bool) -> None:
        """Add the products of rows `start` to `stop`; mirrored: of each such row and its mirror in the south, folded."""
        width, n_bands = self.sums.shape[1:]
        split = (n_bands + 1) // 2
        even, odd, every = slice(split), slice(split, n_bands), slice(n_bands)
        # m even or odd, and k of what _fold writes: cos(k (pi - t)) = (-1)^k cos(k t), sin(k (pi - t)) = -(-1)^k sin(k t)
        parts = ((0, even), (1, odd), (0, odd), (1, even)) if mirrored else ((0, every), (1, every))
        height = min(BLOCK_ROWS, stop - start)
        if mirrored and self.precision is np.float64:
            height = min(height, max(FEWEST_ROWS, FOLDED_VALUES // (4 * width)))
        step = _step(split if mirrored else n_bands, height, width)
        folded = np.empty((len(parts), height, width), self.precision)
        product = np.empty((2, step, n_bands), self.precision)
        for first in range(start, stop, height):
            rows = slice(first, min(first + height, stop))
            block = folded[:, : rows.stop - first]
            self._fold(rows, mirrored, block)
            for left in range(0, width, step):
                columns = slice(left, min(left + step, width))
                out = product[:, : columns.stop - left]
                for (parity, k), part in zip(parts, block, strict=True):
                    np.matmul(part[:, columns].T, self.functions[parity][k, rows].T, out=out[parity, :, k])
                self.sums[:, columns] += out

    def _fold(self, rows: slice, mirrored: bool, out: Values) -> None:
        """Write left plus right and left minus right: (2, rows, width), some rows at a time, so that they stay in the cache.

        mirrored: (4, rows, width), of north plus south, then of north minus south.
        """
        count = out.shape[1]
        step = -(-count // -(-count * self.flat[0].size // FOLD_VALUES))
        north, south = np.empty((2, 2, step, out.shape[2]), self.precision)
        for top in range(rows.start, rows.stop, step):
            some = slice(top, min(top + step, rows.stop))
            here = out[:, some.start - rows.start : some.stop - rows.start]
            if not mirrored:
                self._fold_halves(some, here)
                continue
            one, other = north[:, : here.shape[1]], south[:, : here.shape[1]]
            self._fold_halves(some, one)
            self._fold_halves(slice(len(self.flat) - some.stop, len(self.flat) - some.start), other[:, ::-1])
            np.add(one, other, out=here[:2])
            np.subtract(one, other, out=here[2:])

    def _fold_halves(self, rows: slice, out: Values) -> None:
        """Write into out (2, rows, width) left plus right and left minus right, or the row twice if it has no halves."""
        values = self._taken(rows)
        if values.shape[1] == 1:
            out[:] = values[:, 0]
        elif values.dtype == self.precision:
            np.add(values[:, 0], values[:, 1], out=out[0])
            np.subtract(values[:, 0], values[:, 1], out=out[1])
        else:
            np.copyto(out, values.transpose(1, 0, 2))
            out[0] += out[1]
            out[1] *= -2
            out[1] += out[0]

    def _taken(self, rows: slice) -> Values:
        """Rows, (rows, halves, width); in float32, where columns are alike, only what they differ by from the first.

        Its own value, whose rounding would add up, is summed in float64.
        """
        values = self.flat[rows]
        if self.precision is np.float64 or abs(values[0, 0, 0] - values[0, -1, -3]) > ALIKE * abs(values[0, 0, 0]):
            return values
        texels = values.reshape(len(values), -1, 3)
        first, some = texels[:, :1], texels[:, :: max(texels.shape[1] // 16, 1)]
        if (np.abs(some - first) > ALIKE * np.abs(first)).any():
            return values
        for sums, functions in zip(self.sums[: 3 - values.shape[1]], self.exact, strict=False):
            exact = values.shape[1] * first[:, 0].T.astype(np.float64) @ functions[:, rows].T
            sums.reshape(-1, *exact.shape)[:] += exact
        return np.asarray(texels - first).reshape(values.shape)


def _step(n_functions: int, height: int, width: int) -> int:
    """The number of a row's values in one product: a multiple of 48."""
    most = LARGEST_PRODUCT // (n_functions * max(height, 1))
    return min(max(most // 48 * 48, 48), MAX_STEP, width)
