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

FOLD_BANDS = 28
"""The number of bands from which north and south are folded, too; below, the fold costs more than it saves."""

BLOCK_ROWS = 64
"""Rows, or pairs of folded rows, in one product: the terms that float32 sums before float64 takes over."""

NARROW = 1024
"""The fewest columns for float32, whose rounding averages out over them; with fewer, float64 is as fast and is used."""

LARGEST_PRODUCT = 4_000_000
"""Multiplications in one product."""

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
    n_bands, half = len(functions.cosines), rows // 2
    work = _Pass(flat, functions, np.zeros((2, width, n_bands)), precision)
    if n_bands < FOLD_BANDS or not half or not mirrored:
        work.add_rows(0, rows)
    else:
        work.add_pairs(half)
        work.add_rows(half, rows - half)
    return work.sums


def _repeat_outstanding(flat: Values, functions: RowFunctions, sums: Array) -> None:
    """Sum again in float64 columns that hold much of the whole, such as a sun's: their rounding does not average out."""
    rows, halves, width = flat.shape
    weight = np.abs(sums[0, :, 0]).reshape(-1, 3)
    share = weight.max(axis=1) / max(float(weight.max(axis=1).sum()), np.finfo(np.float64).tiny)
    wanted = np.flatnonzero(share > max(OUTSTANDING, TIMES_THE_MEAN / len(share)))
    if not len(wanted):
        return
    some = flat.reshape(rows, halves, -1, 3)[:, :, wanted].reshape(rows, halves, -1).astype(np.float64)
    west, east = some[:, 0], some[:, 1] if halves == 2 else 0.0
    for parity, folded in enumerate((west + east, west - east)):
        again = functions.exact[parity] @ folded
        sums[parity].reshape(width // 3, 3, -1)[wanted] = again.T.reshape(len(wanted), 3, -1)


class _Pass:
    """flat: (rows, halves, width) values; sums: (even and odd orders, width, n_bands), so that a block is contiguous."""

    def __init__(self, flat: Values, functions: RowFunctions, sums: Array, precision: Precision) -> None:
        self.flat, self.sums, self.precision = flat, sums, precision
        self.cosines = functions.exact[0]
        self.functions: tuple[Values, Values] = functions.rounded if precision is np.float32 else functions.exact
        self.n_even = (len(self.cosines) + 1) // 2

    def add_rows(self, start: int, stop: int) -> None:
        """Add the products of rows `start` to `stop`, not folded."""
        width, n_bands = self.sums.shape[1:]
        height = min(BLOCK_ROWS, stop - start)
        folded = np.empty((2, max(height, 1), width), self.precision)
        step = _step(n_bands, height, width)
        product = np.empty((step, n_bands), self.precision)
        for first in range(start, stop, BLOCK_ROWS):
            rows = slice(first, min(first + BLOCK_ROWS, stop))
            block = folded[:, : rows.stop - rows.start]
            self._fold_halves(rows, block)
            for left in range(0, width, step):
                columns = slice(left, min(left + step, width))
                out = product[: columns.stop - columns.start]
                for parity in (0, 1):
                    np.matmul(block[parity][:, columns].T, self.functions[parity][:, rows].T, out=out)
                    self.sums[parity][columns] += out

    def add_pairs(self, count: int) -> None:
        """Add the products of the first and last `count` rows, each northern row folded with its mirror in the south."""
        width, n_bands = self.sums.shape[1:]
        rows = len(self.flat)
        height = min(BLOCK_ROWS, count)
        step = _step(self.n_even, height, width)
        north, south = np.empty((2, 2, height, width), self.precision)
        total, difference = np.empty((2, height, step), self.precision)
        product = np.empty((step, n_bands), self.precision)
        split = self.n_even
        for first in range(0, count, BLOCK_ROWS):
            pairs = slice(first, min(first + BLOCK_ROWS, count))
            size = pairs.stop - pairs.start
            self._fold_halves(pairs, north[:, :size])
            self._fold_halves(slice(rows - pairs.stop, rows - pairs.start), south[:, size - 1 :: -1] if size else south)
            for left in range(0, width, step):
                columns = slice(left, min(left + step, width))
                out = product[: columns.stop - columns.start]
                plus, minus = total[:size, : len(out)], difference[:size, : len(out)]
                for parity in (0, 1):
                    np.add(north[parity, :size, columns], south[parity, :size, columns], out=plus)
                    np.subtract(north[parity, :size, columns], south[parity, :size, columns], out=minus)
                    even, odd = (minus, plus) if parity else (plus, minus)  # sin(k (pi - t)) = -(-1)^k sin(k t)
                    np.matmul(even.T, self.functions[parity][:split, pairs].T, out=out[:, :split])
                    np.matmul(odd.T, self.functions[parity][split:, pairs].T, out=out[:, split:])
                    self.sums[parity][columns] += out

    def _fold_halves(self, rows: slice, out: Values) -> None:
        """Write into out (2, rows, width) left plus right and left minus right, or the row twice if it has no halves."""
        block = self.flat[rows]
        if block.shape[1] == 1:
            out[:] = block[:, 0]
        elif block.dtype == self.precision:
            np.add(block[:, 0], block[:, 1], out=out[0])
            np.subtract(block[:, 0], block[:, 1], out=out[1])
        else:
            np.copyto(out, block.transpose(1, 0, 2))
            out[0] += out[1]
            out[1] *= -2
            out[1] += out[0]
        if self.precision is np.float32:
            self._take_out_alike(rows, out[0])

    def _take_out_alike(self, rows: slice, block: Values) -> None:
        """In rows whose columns are alike, sum the first column's value in float64, and leave only the differences from it."""
        middle = block.shape[1] // 6 * 3
        if abs(block[0, middle] - block[0, 0]) > ALIKE * abs(block[0, 0]):
            return
        texels = block.reshape(len(block), -1, 3)
        some = texels[:, :: max(texels.shape[1] // 8, 1)]
        first = texels[:, :1].copy()
        if (np.abs(some - first) <= ALIKE * np.abs(first)).all():
            texels -= first
            exact = first[:, 0].T.astype(np.float64) @ self.cosines[:, rows].T
            self.sums[0].reshape(-1, *exact.shape)[:] += exact


def _step(n_functions: int, height: int, width: int) -> int:
    """The number of a row's values in one product: a multiple of 48."""
    most = LARGEST_PRODUCT // (n_functions * max(height, 1))
    return min(max(most // 48 * 48, 48), MAX_STEP, width)
