"""Sums over samples against few bands, in powers: {Re, Im} (x + iy)^m z^k with m + k < n, which the bands are made of.

The even powers of z go with x and y, one z with the values, so that a block of samples is few rows and one small product.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from shviewer.harmonics.basis import Array, normalisation, normalise
from shviewer.harmonics.evaluation.waves import NOT_UNIT
from shviewer.harmonics.theta_series import degrees_and_orders

POWER_BANDS = 6
"""The most bands for which powers are used; the magnitudes in their table add up to 18, for an error of 1e-14."""

SLICE = 2500
"""Samples in one product: below a million multiplications, OpenBLAS reads operands in place."""


class PowerSums:
    """Sums over samples of value * power, and the memory to add a block of samples."""

    def __init__(self, n_bands: int, block: int) -> None:
        self.n_bands = n_bands
        self.rows = _rows(n_bands)
        self.steps = _steps(n_bands)
        self.factors = np.empty((max(len(self.rows), 4), block))  # 1, x, y, and the rest
        self.factors[0] = 1
        self.z = np.empty(block)
        self.values = np.empty((2, 3, block))  # as they are, and times z
        self.scratch = np.empty((4, block))
        self.sums = np.zeros((len(self.rows), 6))

    def restart(self) -> None:
        """Forget all samples."""
        self.sums[:] = 0

    def add(self, directions: Array, values: Array, weights: Array | float) -> None:
        """Add samples: directions (k, 3), values (k, 3), weights (k,), not more than a block of them."""
        used = slice(0, len(directions))
        factors, z, products = self.factors[:, used], self.z[used], self.values[..., used]
        factors[1:3], z[:] = directions.T[:2], directions.T[2]
        np.multiply(values.T, weights, out=products[0])
        squares = self.scratch[:3, used]
        if not self._square(factors[1:3], z, squares):
            factors[1], factors[2], z[:] = normalise(directions).T
            self._square(factors[1:3], z, squares)
        self._fill(factors, squares, self.scratch[2:, used])
        np.multiply(products[0], z, out=products[1])
        left, right = factors[: len(self.rows)], products.reshape(6, -1).T
        for start in range(0, len(directions), SLICE):
            some = slice(start, start + SLICE)
            self.sums += left[:, some] @ right[some]

    def coefficients(self) -> Array:
        """Coefficients (n_bands**2, 3) of all samples added."""
        return np.asarray(_table(self.n_bands) @ self.sums.reshape(-1, 3))

    def _square(self, xy: Array, z: Array, squares: Array) -> bool:
        """Fill in the squares of x, y and z; whether all directions are unit."""
        norms = self.scratch[3, : len(z)]
        with np.errstate(over="ignore"):
            np.multiply(xy, xy, out=squares[:2])
            np.multiply(z, z, out=squares[2])
        np.add(squares[0], squares[1], out=norms)
        norms += squares[2]
        return bool(norms.min() > 1 - NOT_UNIT and norms.max() < 1 + NOT_UNIT)  # NaN is not

    def _fill(self, factors: Array, squares: Array, scratch: Array) -> None:
        """Fill in the rows from 1, x and y: with the squares first, then each from one of lower degree."""
        if self.n_bands < 3:
            return
        x, y = factors[1], factors[2]
        np.subtract(squares[0], squares[1], out=factors[3])
        np.multiply(x, y, out=factors[4])
        factors[4] *= 2
        z_squared = factors[5]
        z_squared[:] = squares[2]
        for row, before, size, with_z in self.steps:
            new, old = factors[row : row + size], factors[before : before + size]
            if with_z:
                np.multiply(old, z_squared, out=new)
                continue
            np.multiply(old, x, out=new)
            np.multiply(old, y, out=scratch)
            new[0] -= scratch[1]
            new[1] += scratch[0]


@lru_cache(maxsize=POWER_BANDS)
def _rows(n_bands: int) -> tuple[tuple[int, int, int], ...]:
    """m, 0 for Re and 1 for Im, and j of the factors {Re, Im} (x + iy)^m z^(2j), in order of their degree."""
    rows = []
    for degree in range(n_bands):
        for j in range(degree // 2 + 1):
            m = degree - 2 * j
            rows += [(m, part, j) for part in range(2 if m else 1)]
    return tuple(rows)


@lru_cache(maxsize=POWER_BANDS)
def _steps(n_bands: int) -> tuple[tuple[int, int, int, bool], ...]:
    """How the rows after the sixth are made: row, from which, how many together, and whether times z^2 or else x + iy."""
    rows = _rows(n_bands)
    first = ((row, m, j) for row, (m, part, j) in enumerate(rows) if row > 5 and not part)
    return tuple((row, rows.index((m, 0, j - 1) if j else (m - 1, 0, 0)), 2 if m else 1, j > 0) for row, m, j in first)


@lru_cache(maxsize=POWER_BANDS)
def _table(n_bands: int) -> Array:
    """The factors of each row, and of z times it, in Y(l, m), (n_bands**2, 2 rows): by the recurrence of basis.py."""
    powers = np.zeros((n_bands, n_bands, n_bands + 1))  # the factor of z^k in Y(l, m) over {Re, Im} (x + iy)^m: m, l, k
    for m in range(n_bands):
        powers[m, m, 0] = 1
        for l in range(m + 1, n_bands):
            q = (2 * l - 1) / (l + m)
            powers[m, l, 1:] = q * powers[m, l - 1, :-1]
            if l > m + 1:
                powers[m, l] -= (q - 1) * powers[m, l - 2]
    powers *= normalisation(n_bands).T[..., None]
    degree, order, sine = degrees_and_orders(n_bands)
    table = [powers[m, degree, 2 * j : 2 * j + 2].T * ((order == m) & (sine == part)) for m, part, j in _rows(n_bands)]
    return np.ascontiguousarray(np.concatenate(table).T)
