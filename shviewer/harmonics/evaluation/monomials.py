"""The basis of few bands as polynomials: Y of degree l is a homogeneous one of x, y and z.

It is even or odd in each of the three: a polynomial of x^2, y^2 and z^2 times 1, x, y, z, xy, xz, yz or xyz, which are rows of
the table themselves but for a factor. So the monomials of the squares serve all degrees and orders, by a small matrix product
for each of their own degrees, and a multiplication a value remains: less than functions of azimuth and z take.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import product

import numpy as np

from shviewer.harmonics.evaluation.indices import Array, Indices, normalise
from shviewer.harmonics.evaluation.recurrence import UNIT, normalisation

MONOMIAL_BANDS = 8
"""The most bands for which this is the fastest way; it is as exact as the others, to 2e-15 of the largest value."""

NORMS = normalisation(4)
SCALE = float(NORMS[1, 0])
"""That of x, y and z: Y(1, m) is -y, z and -x times this."""

Part = tuple[int, slice, Array]
"""A row of the table, the rows that are it times polynomials of squares, and the factors of these, (rows, monomials)."""


class MonomialProducts:
    """The memory to evaluate the basis of 2 to MONOMIAL_BANDS bands in a block of `length` directions."""

    def __init__(self, n_bands: int, length: int) -> None:
        self.scratch = np.empty((2, length))
        squares = [np.empty((len(_powers(q)), length)) for q in range(max(2, (n_bands + 1) // 2))]
        self.squares = y, z, x = squares[1]
        self.multiplied: list[tuple[Array, Array, Array]] = []
        """Two factors and where their product goes: the monomials of the squares from degree 2 on."""
        for q in range(2, len(squares)):
            old, new, count = squares[q - 1], squares[q], len(squares[q - 1])
            self.multiplied += (old, y, new[:count]), (old[-q:], z, new[count:-1]), (old[-1], x, new[-1])
        memory = np.empty((n_bands**2, length))  # what is not used of it is never fetched
        self.even, self.odd = [], []
        for monomials, (even, *parts) in zip(squares[1:], _tables(n_bands), strict=False):
            self.even.append((even[2], monomials, even[1]))
            if parts:
                factors = np.concatenate([part[2] for part in parts])
                sums = memory[: len(factors)]
                each = np.split(sums, np.cumsum([len(part[2]) for part in parts[:-1]]))
                places = [(some, row, rows) for some, (row, rows, _) in zip(each, parts, strict=True)]
                self.odd.append((factors, monomials, sums, places))

    def fill(self, directions: Array, table: Array) -> None:
        """Write Y(l, m) at index l(l+1) + m of `table`, (n_bands**2, length), for directions (length, 3)."""
        if not self._take(directions, table[1:4]):
            self._take(normalise(directions), table[1:4])
        table[0] = NORMS[0, 0]
        y, z, x = table[1:4]
        if len(table) > 4:
            scaled = np.multiply(table[2:4], 2 * NORMS[2, 2] / SCALE**2, out=self.scratch)
            np.multiply(y, scaled[::-1], out=table[4:6])
            np.multiply(x, scaled[0], out=table[7])
        if len(table) > 9:
            np.multiply(z, NORMS[3, 2] / (NORMS[2, 2] * SCALE), out=self.scratch[0])
            np.multiply(table[4], self.scratch[0], out=table[10])
        for one, other, both in self.multiplied:
            np.multiply(one, other, out=both)
        for factors, monomials, rows in self.even:
            np.matmul(factors, monomials, out=table[rows])
        for factors, monomials, sums, places in self.odd:
            np.matmul(factors, monomials, out=sums)
            for some, row, rows in places:
                np.multiply(some, table[row], out=table[rows])

    def _take(self, directions: Array, linear: Array) -> bool:
        """Fill in Y(1, m), (3, length), and the squares; whether all directions are unit to rounding."""
        x, y, z = directions.T
        with np.errstate(over="ignore"):
            for one, factor, row in zip((y, z, x), (-SCALE, SCALE, -SCALE), linear, strict=True):
                np.multiply(one, factor, out=row)
            np.multiply(linear, linear, out=self.squares)
        norms = np.add(self.squares[0], self.squares[1], out=self.scratch[0])
        norms += self.squares[2]
        return bool(norms.min() > SCALE**2 * (1 - UNIT) and norms.max() < SCALE**2 * (1 + UNIT))  # NaN is not


def _powers(q: int) -> Indices:
    """The powers of y^2 and z^2 in the monomials of degree q of squares, (monomials, 2): y^2 in all but the last q + 1."""
    return np.array([(q - some, some - x) for some in range(q + 1) for x in range(some + 1)])


@lru_cache(maxsize=MONOMIAL_BANDS)
def _tables(n_bands: int) -> list[list[Part]]:
    """For each degree of monomials from 1 on: what they make, first the rows that are even in x, y and z.

    By the recurrence of recurrence.py, times powers of x^2 + y^2 + z^2 = 1: G(l) = q z G(l-1) - (q-1) G(l-2).
    """
    norms = normalisation(n_bands)
    bands = [np.zeros((2 * l + 1, n_bands, n_bands)) for l in range(n_bands)]  # by the powers of y and of z
    azimuth = np.zeros((n_bands, n_bands), dtype=np.complex128)  # (x + iy)^m
    azimuth[0, 0] = 1
    for m in range(n_bands):
        before, polynomial = np.zeros_like(azimuth), azimuth
        for l in range(m, n_bands):
            if l > m:
                q = (2 * l - 1) / (l + m)
                longer = before + np.roll(before, 2, axis=0) + np.roll(before, 2, axis=1)
                before, polynomial = polynomial, q * np.roll(polynomial, 1, axis=1) - (q - 1) * longer
            bands[l][l - m] = norms[l, m] * polynomial.imag
            bands[l][l + m] = norms[l, m] * polynomial.real
        azimuth = azimuth + 1j * np.roll(azimuth, 1, axis=0)
    tables: list[list[Part]] = [[] for _ in range((n_bands + 1) // 2)]
    odd: dict[tuple[int, int, int], tuple[int, float]] = {(0, 0, 0): (0, 1.0)}
    for l, band in enumerate(bands):
        for y, z in product((0, 1), repeat=2):
            x = (l - y - z) % 2
            q = (l - x - y - z) // 2
            if q >= 0:
                some = slice(z, l - x, 2) if y else slice(l + x, 2 * l + 1 - z, 2)
                rows = slice(l * l + some.start, l * l + some.stop, 2)
                powers = 2 * _powers(q) + [y, z]
                factors = band[some, powers[:, 0], powers[:, 1]]
                row, factor = odd.setdefault((x, y, z), (rows.start, factors[0, 0]))
                tables[q].append((row, rows, factors / (factor * SCALE ** (2 * q))))
    return tables[1:]
