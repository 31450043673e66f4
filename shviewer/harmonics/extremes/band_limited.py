"""A band-limited function between the points of a grid: how low and how high it can go there.

On every great circle through the poles, and along every circle of latitude, a function of n bands is a trigonometric
polynomial of degree N = n - 1. If it stays within A of a constant, its k-th derivatives stay within N^k A (Bernstein), and if
its band l stays within H(l), within the sum of l^k H(l). With D(k) the lesser of the two times h^k,
    in cells of h radians a side, their corners bound it up to D(2) / 4;
    in them, the polynomial through the s x s points around is off by at most (1 + L) w D(s) / s!,
with w the largest product of distances to s points one apart, and L the largest sum of the magnitudes of the weights of an
interpolation. The polynomial lies above the least of its Bernstein coefficients, and closer above it in parts of the cell.
A itself follows from the grid: M points about a circle see all of it but 1 - cos(pi N / M) [Ehlich-Zeller].

[Ehlich-Zeller] H. Ehlich, K. Zeller, "Schwankung von Polynomen zwischen Gitterpunkten", Math. Z. 86, 41 (1964).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.extremes.stencils import halved, stencil

SIEVE, FINE = 6, 10
"""Points a side of the stencil that sorts out most cells, and of the one that judges the rest."""

SIEVED_SHARE, MOST_SIEVED, MOST_FINE = 48, 8192, 400
"""The most cells that each stencil looks at, for the first also a share of all values; what is left keeps the bound it had."""

BLOCK_ROWS = 16
"""Rows of cells that are worked on together, so that they stay in the cache."""

HALVINGS = 8
"""How often cells are halved."""


class Bounded(NamedTuple):
    """A lower bound of a function, the lowest value seen on the way (to about the bound's own error), and where, radians."""

    bound: float
    lowest: float
    theta: float
    phi: float


class BandLimited:
    """A function of bands by its values (rows, channels, columns) on a lat-long grid of 2 rows columns.

    heights: what each of its bands stays within, (n_bands, channels). less: values like those of another function, which is
    bilinear in each cell; `lowest` then bounds the difference, `values` and all else are those of the bands alone.
    """

    def __init__(self, values: Array, heights: Array, less: Array | None = None) -> None:
        self.values, self.less = values, less
        self.difference = values if less is None else values - less
        self.rows, self.columns = len(values), values.shape[2]
        self.step = float(np.pi / self.rows)
        self.reach = (len(heights) - 1) * self.step
        """N h."""
        self.heights = heights
        self.high, self.low = values.max(axis=(0, 2)), values.min(axis=(0, 2))
        self.amplitude = (self.high - self.low) / 2 / np.cos(self.reach / 2) ** 2
        """A of each channel, (channels,)."""
        self.slack = self.moved(2) / 4
        """How far it may pass the corners of a cell, (channels,)."""

    def moved(self, order: int) -> Array:
        """D(order): h^order times the largest derivative of that order along a side of the cells, (channels,)."""
        by_band = (np.arange(len(self.heights)) * self.step) ** order @ self.heights
        return np.asarray(np.minimum(self.amplitude * self.reach**order, by_band))

    @cached_property
    def corners_low(self) -> Array:
        """The lowest corner of each cell, (rows + 1, channels, columns): cell i, j lies after row i - 1 and column j.

        The first and the last row of cells lie across the poles.
        """
        return self.corners(np.minimum, self.difference)

    @cached_property
    def corners_high(self) -> Array:
        """The highest corner of each cell."""
        return self.corners(np.maximum, self.values)

    def corners(self, better: np.ufunc, values: Array) -> Array:
        """The better of the corners of each cell, of any values on the points of the grid."""
        found = np.empty((self.rows + 1, *values.shape[1:]))
        for cells in self.blocks():
            found[cells] = self.corners_in(cells, better, values)
        return found

    def corners_in(self, cells: slice, better: np.ufunc, values: Array) -> Array:
        """The same in some rows of cells."""
        rows = self._rows(values, cells.start - 1, cells.stop)
        return self._paired(better, better(rows[:-1], rows[1:]))

    def blocks(self, wanted: NDArray[np.bool_] | None = None) -> Iterator[slice]:
        """The rows of cells in blocks that stay in the cache; with wanted, (rows + 1,), those blocks that hold such rows."""
        for top in range(0, self.rows + 1, BLOCK_ROWS):
            cells = slice(top, min(top + BLOCK_ROWS, self.rows + 1))
            if wanted is None or wanted[cells].any():
                yield cells

    @staticmethod
    def _paired(better: np.ufunc, by_row: Array) -> Array:
        """The better of each value and the next in its row."""
        corners = np.empty_like(by_row)
        better(by_row[..., :-1], by_row[..., 1:], out=corners[..., :-1])
        better(by_row[..., -1], by_row[..., 0], out=corners[..., -1])
        return corners

    def open_points(self, found: float, tolerance: float) -> int:
        """The number of points, times channels, beside which it may be lower by their values alone."""
        return int(np.count_nonzero(self.difference < (found - tolerance + self.slack)[:, None]))

    def lowest(self, found: float, tolerance: float, effort: int = 1, sign: int = 1) -> Bounded:
        """A lower bound of all channels, not far below found - tolerance; found: a value that the function takes.

        effort: how many times the usual number of cells are looked at, if need be. sign: -1 for minus the function.
        """
        best = Bounded(found - tolerance, found, 0.0, 0.0)
        most = effort * min(self.values.size // SIEVED_SHARE, MOST_SIEVED)
        limit = (best.bound + self.slack)[:, None]
        open_points = self.difference < limit if sign > 0 else self.difference > -limit
        cells = self._around(np.flatnonzero(open_points.reshape(-1)), most)
        if cells is None:
            cells, lows = self._below(best.bound, np.any(open_points, axis=(1, 2)), sign)
        else:
            lows = np.full(len(cells), -np.inf)
        if not len(cells):
            return best
        lows, cells, left = _lowest_first(lows, cells, most)
        row, channel, column = self._places(cells)
        lows = np.maximum(
            lows, self._control(row, channel, column, SIEVE, sign).min(axis=(1, 2)) - self._error(SIEVE)[channel]
        )
        open_ = np.flatnonzero(lows < found - tolerance)
        lows, open_, dropped = _lowest_first(lows[open_], open_, effort * MOST_FINE)
        left = min(left, dropped)
        row, channel, column = row[open_], channel[open_], column[open_]
        error = self._error(FINE)[channel]
        control = self._control(row, channel, column, FINE, sign)
        corner = np.stack([row - 0.5, column + 0.5], axis=1)  # in cells; theta = 0 and u = 0 are 0
        for halving in range(HALVINGS + 1):
            side = 0.5**halving
            corners = control[:, [0, 0, -1, -1], [0, -1, 0, -1]]
            if corners.size and (there := float(corners.min())) < best.lowest:
                which, at = divmod(int(corners.argmin()), 4)
                theta, u = corner[which] + side * np.array([at // 2, at % 2])
                best = best._replace(
                    lowest=there, theta=float(theta * self.step), phi=float(np.pi * (1 - 2 * u / self.columns))
                )
            lows = np.maximum(lows, control.min(axis=(1, 2)) - error)
            open_ = np.flatnonzero(lows < min(found, best.lowest) - np.maximum(tolerance, 1.5 * error))
            left = min(left, float(np.delete(lows, open_).min(initial=np.inf)))
            lows, open_, dropped = _lowest_first(lows[open_], open_, effort * MOST_FINE)
            left = min(left, dropped)
            if not len(open_):
                break
            if halving == HALVINGS:
                left = min(left, float(lows.min()))
                break
            corner = (corner[open_, None] + side / 2 * np.array([[0, 0], [0, 1], [1, 0], [1, 1]])).reshape(-1, 2)
            control, error, lows = halved(control[open_]), np.repeat(error[open_], 4), np.repeat(lows, 4)
        return best._replace(bound=min(best.bound, left))

    def _below(self, bound: float, rows: NDArray[np.bool_], sign: int) -> tuple[Indices, Array]:
        """The cells beside some rows of points (rows,) that may be lower by their corners and bends, and how low."""
        beside = np.append(rows, False)
        beside[1:] |= rows
        found, lows = [], []
        for cells in self.blocks(beside):
            low = sign * self.corners_in(cells, np.minimum if sign > 0 else np.maximum, self.difference)
            low -= self.bends(cells, sign)
            flat = low.reshape(-1)
            found.append(np.flatnonzero(flat < bound))
            lows.append(flat[found[-1]])
            found[-1] += cells.start * self.values[0].size
        return np.concatenate(found), np.concatenate(lows)

    def _around(self, points: Indices, most: int) -> Indices | None:
        """The cells with one of the points (k,) in a corner, as indices like those of `corners`; None if more than `most`."""
        if 4 * len(points) > most:
            return None
        row, channel, column = self._places(points)
        return np.unique(
            [
                ((row + down) * self.values.shape[1] + channel) * self.columns + (column - across) % self.columns
                for down in (0, 1)
                for across in (0, 1)
            ]
        )

    def _places(self, flat: Indices) -> tuple[Indices, Indices, Indices]:
        """Row, channel and column of indices (k,)."""
        above, column = np.divmod(flat, self.columns)
        return *np.divmod(above, self.values.shape[1]), column

    def bends(self, cells: slice, sign: int = 0) -> Array:
        """How far it can pass the bilinear surface through the corners of each cell, in rows of cells.

        That is by an eighth of the second differences along both sides. sign: 1 for below it alone, -1 for above.
        """
        values = self._rows(self.values, cells.start - 2, cells.stop + 1)
        middle = values[1:-1]
        seconds = np.empty((2, *middle.shape))
        down, across = seconds
        np.add(values[2:], values[:-2], out=down)
        np.add(middle[..., 2:], middle[..., :-2], out=across[..., 1:-1])
        across[..., 0], across[..., -1] = middle[..., 1] + middle[..., -1], middle[..., 0] + middle[..., -2]
        seconds -= 2 * middle
        np.maximum(np.multiply(seconds, sign, out=seconds), 0, out=seconds) if sign else np.abs(seconds, out=seconds)
        down, across = self._paired(np.maximum, np.maximum(seconds[:, 1:], seconds[:, :-1]))
        down += across
        down /= 8
        down += self._moved[:, None] / 4
        return np.asarray(np.minimum(down, self.slack[:, None], out=down))

    def _rows(self, values: Array, first: int, last: int) -> Array:
        """Rows from `first` to before `last` of values like ours; they may lie beyond a pole."""
        if first >= 0 and last <= self.rows:
            return values[first:last]
        rows, turned = _mirrored(np.arange(first, last), self.rows)
        taken = values[rows]
        taken[turned] = np.roll(taken[turned], self.columns // 2, axis=-1)
        return taken

    def curvature(self, row: Indices, column: Indices) -> Array:
        """The largest |second derivative| along theta and along phi in cells (k,), per radian squared: (k, 2, channels)."""
        channels = np.arange(self.values.shape[1])
        every = np.broadcast_arrays(row[:, None], channels, column[:, None])
        points = self._points(self.values, every[0].ravel(), every[1].ravel(), every[2].ravel(), 4)
        found = [np.abs(np.diff(points, 2, axis=axis)) for axis in (1, 2)]
        seen = np.stack([found[0][:, :, 1:3].max(axis=(1, 2)), found[1][:, 1:3].max(axis=(1, 2))], axis=1)
        seen = seen.reshape(len(row), len(channels), 2).swapaxes(1, 2)
        return np.asarray(np.minimum(seen + self._moved, self.moved(2)) / self.step**2)

    @property
    def _moved(self) -> Array:
        """How far h^2 times a second derivative in a cell may pass the second differences at its corners, (channels,).

        It differs from those by D(4) / 12 at most, and moves by less than D(4) / 4 within the cell.
        """
        return self.moved(4) / 3

    def _error(self, size: int) -> Array:
        """How far the polynomial through a stencil may be off, (channels,)."""
        return np.asarray(stencil(size)[1] * self.moved(size))

    def _control(self, row: Indices, channel: Indices, column: Indices, size: int, sign: int) -> Array:
        """Bernstein coefficients (k, size, size) of the polynomials through the size x size points about cells (k,)."""
        points = self._points(self.values, row, channel, column, size)
        found = np.asarray(points.reshape(-1, size**2) @ stencil(size)[2]).reshape(-1, size, size)
        if self.less is not None:  # those of a bilinear function are its values
            corners, share = self._points(self.less, row, channel, column, 2), np.linspace(0, 1, size)
            by_row = corners[:, :1] + np.diff(corners, axis=1) * share[:, None]
            found -= by_row[..., :1] + np.diff(by_row, axis=2) * share
        return sign * found

    def _points(self, values: Array, row: Indices, channel: Indices, column: Indices, size: int) -> Array:
        """The size x size points of values like ours about cells (k,), (k, size, size)."""
        about = np.arange(size) - size // 2 + 1
        rows, turned = _mirrored(row[:, None] - 1 + about, self.rows)
        columns = column[:, None, None] + about + np.where(turned, self.columns // 2, 0)[:, :, None]
        start = (rows * self.values.shape[1] + channel[:, None]) * self.columns
        return np.asarray(values.reshape(-1).take(start[:, :, None] + columns % self.columns))


def _mirrored(rows: Indices, count: int) -> tuple[Indices, NDArray[np.bool_]]:
    """The rows that continue a grid of `count` rows beyond its poles, and which of them are turned half way round."""
    beyond = (rows < 0) | (rows >= count)
    return np.where(rows < 0, -1 - rows, np.where(beyond, 2 * count - 1 - rows, rows)), beyond


def _lowest_first(lows: Array, cells: Indices, most: int) -> tuple[Array, Indices, float]:
    """The `most` lowest of the cells with their bounds, and the lowest bound of the others."""
    if len(cells) <= most:
        return lows, cells, np.inf
    order = np.argpartition(lows, most)
    return lows[order[:most]], cells[order[:most]], float(lows[order[most:]].min())
