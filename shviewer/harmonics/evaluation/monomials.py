"""The basis of few bands as polynomials: Y of degree l is a sum of the monomials x^a y^b z^c with a + b + c = l.

Y is even in z for even l - m and odd for odd l - m. So a degree is two small matrix products with its monomials, and each of
these one multiplication of one of the degree before: less than functions of the azimuth and of z take.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

import numpy as np

from shviewer.harmonics.evaluation.indices import Array, normalise
from shviewer.harmonics.evaluation.recurrence import UNIT, normalisation

MONOMIAL_BANDS = 6
"""The most bands for which this is the fastest way; it is as exact as the others, to 1e-15 of the largest value."""


class MonomialProducts:
    """The memory to evaluate the basis of 3 to MONOMIAL_BANDS bands in a block of `length` directions."""

    def __init__(self, n_bands: int, length: int) -> None:
        self.points, self.norms = np.empty((3, length)), np.empty(length)
        (self.constant, self.linear), *tables = _tables(n_bands)
        self.degrees = []
        """For each degree from 2 on: how its monomials are multiplied, and the products that give its part of the basis."""
        x, y, z = self.points
        even, odd = self.points[:2], self.points[2:]  # powers of z, in the order of `_powers`
        for l, (for_even, for_odd) in enumerate(tables, start=2):
            new, new_odd = np.empty((l + 1 + len(odd), length)), np.empty((len(even), length))
            multiplied = (even[:l], x, new[:l]), (even[l - 1], y, new[l]), (odd, z, new[l + 1 :]), (even, z, new_odd)
            first, last = l * l, (l + 1) ** 2
            summed = (for_even, new, slice(first, last, 2)), (for_odd, new_odd, slice(first + 1, last, 2))
            self.degrees.append((multiplied, summed))
            even, odd = new, new_odd

    def fill(self, directions: Array, table: Array) -> None:
        """Write Y(l, m) at index l(l+1) + m of `table`, (n_bands**2, length), for directions (length, 3)."""
        if not self._take(directions):
            self._take(normalise(directions))
        table[0] = self.constant
        np.matmul(self.linear, self.points, out=table[1:4])
        for l, (multiplied, summed) in enumerate(self.degrees, start=2):
            if l > 2:
                _multiply(multiplied)
            for factors, monomials, rows in summed:
                np.matmul(factors, monomials, out=table[rows])

    def _take(self, directions: Array) -> bool:
        """Fill in the monomials of degree 1 and 2; whether all directions are unit to rounding."""
        self.points[...] = directions.T
        multiplied, ((_, (xx, _, yy, zz), _), _) = self.degrees[0]
        with np.errstate(over="ignore", invalid="ignore"):
            _multiply(multiplied)
        norms = np.add(xx, yy, out=self.norms)
        norms += zz
        return bool(norms.min() > 1 - UNIT and norms.max() < 1 + UNIT)  # NaN is not


def _multiply(rows: Iterable[tuple[Array, Array, Array]]) -> None:
    """Fill the last of each three with the product of the others."""
    for one, other, product in rows:
        np.multiply(one, other, out=product)


def _powers(l: int, parity: int) -> tuple[list[int], list[int]]:
    """The powers of y and of z in the monomials of degree l with even (0) or odd (1) powers of z."""
    pairs = [(b, c) for c in range(parity, l + 1, 2) for b in range(l - c + 1)]
    return [b for b, _ in pairs], [c for _, c in pairs]


@lru_cache(maxsize=MONOMIAL_BANDS)
def _tables(n_bands: int) -> tuple[tuple[Array, Array], ...]:
    """The factors of x, y, z in Y(1, m) beside Y(0, 0), then of the monomials of each degree for even and for odd l - m.

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
    linear = bands[1][:, [0, 1, 0], [0, 0, 1]]
    tables = [(normalisation(1)[0, 0], linear)]
    for l, band in enumerate(bands[2:], start=2):
        even, odd = (band[parity::2][(slice(None), *_powers(l, parity))] for parity in (0, 1))
        tables.append((np.ascontiguousarray(even), np.ascontiguousarray(odd)))
    return tuple(tables)
