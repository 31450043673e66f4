"""The basis by its recurrence in degree: exact to rounding for any number of bands, next to the poles, too.

Sources
    [DLMF]    NIST Digital Library of Mathematical Functions, 14.10.3 and 18.9.1: recurrences in degree.
    [Reinsch] J. Stoer, R. Bulirsch, "Introduction to Numerical Analysis", 3rd ed., section 2.3.2: carrying
              differences of a recurrence instead of its terms, which keeps it stable where cos theta nears 1.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from shviewer.harmonics.evaluation.indices import Array, normalise
from shviewer.harmonics.workspace import borrowed

BLOCK_VALUES = 32768
"""Values of one kind, directions times bands, that are worked on at a time, so that they stay in the cache."""

UNIT = 1e-15
"""Directions are taken as they are where x^2 + y^2 + z^2 differs from 1 by less: by rounding alone."""


@lru_cache(maxsize=16)
def normalisation(n_bands: int) -> Array:
    """The factor N(l, m) of Y in terms of the Gegenbauer ratio G, shape (n, n), zero for m > l.

    Y(l, +-m) = N(l, m) G(l, m)(z) {Re, Im} (x + iy)^m; N holds sqrt(2) for m > 0 and the phase (-1)^m.
    """
    norms = np.zeros((n_bands, n_bands))
    sectoral = np.sqrt(1 / (4 * np.pi))
    for m in range(n_bands):
        if m:
            sectoral *= -np.sqrt((2 * m + 1) / (2 * m))
        l = np.arange(m + 1, n_bands)
        ratios = np.sqrt((2 * l + 1) * (l + m) / ((2 * l - 1) * (l - m)))
        norms[m:, m] = (np.sqrt(2) if m else 1) * sectoral * np.cumprod(np.concatenate([[1.0], ratios]))
    norms.flags.writeable = False
    return norms


def evaluate_by_recurrence(points: Array, n_bands: int) -> Array:
    """As `evaluate_basis` of basis.py, for any number of bands: directions (k, 3) -> (n_bands**2, k).

    G(l, m)(z) is the Gegenbauer polynomial C(l-m, m+1/2)(z) over its value at 1, so |G| <= 1 and G(l, m)(1) = 1.
    Its recurrence [DLMF 18.9.1], written for the difference D = G(l) - G(l-1) [Reinsch] with d = 1 - |z|, is
        G(m) = 1,  D(m) = 0,   D(l) = q (D(l-1) - d G(l-1)) - D(l-1),   G(l) = G(l-1) + D(l),   q = (2l-1)/(l+m).
    d = (x^2 + y^2)/(1 + |z|) has no cancellation, no angle appears and nothing is divided by sin(theta): the poles
    and the seam are ordinary points. The southern half follows from G(-z) = (-1)^(l+m) G(z).
    """
    table = np.empty((n_bands**2, len(points)))
    size = max(1, min(len(points), max(128, BLOCK_VALUES // n_bands)))
    with borrowed(_Rows, n_bands, size, keep=n_bands * size <= BLOCK_VALUES) as rows:
        for start in range(0, len(points), size):
            block = slice(start, start + size)
            if not rows.take(points[block]):
                points = normalise(points)
                rows.take(points[block])
            rows.fill(table[:, block])
    return table


class _Rows:
    """The memory to evaluate the basis in a block of directions: rows of values, small enough for the cache."""

    def __init__(self, n_bands: int, block: int) -> None:
        self.n_bands = n_bands
        self.points, self.squares = np.empty((2, 3, block))
        self.azimuth = np.empty((2, n_bands, block))  # {Re, Im} (x + iy)^m
        self.ratio, self.difference, self.scratch = np.empty((3, n_bands, block))  # G and D of each m
        self.south, self.rest, self.height = np.empty((3, block))
        self.count = 0

    def take(self, directions: Array) -> bool:
        """Take unit directions (k, 3), k <= block. False if some are not unit to rounding, or not finite."""
        self.count = len(directions)
        points, squares = self.points[:, : self.count], self.squares[:, : self.count]
        points[...] = directions.T
        with np.errstate(over="ignore"):
            np.multiply(points, points, out=squares)
        squares[0] += squares[1]
        squares[2] += squares[0]
        return self.count == 0 or bool(squares[2].min() > 1 - UNIT and squares[2].max() < 1 + UNIT)  # NaN is not

    def fill(self, table: Array) -> None:
        """Write Y(l, m) at index l(l+1) + m of `table`, shape (n_bands**2, k), for the directions taken."""
        x, y, z = self.points[:, : self.count]
        south, rest, height = (row[: self.count] for row in (self.south, self.rest, self.height))
        np.copysign(1.0, z, out=south)
        np.abs(z, out=height)
        np.divide(self.squares[0, : self.count], np.add(height, 1, out=rest), out=rest)  # 1 - |z|
        real, imaginary = azimuth = self.azimuth[..., : self.count]
        ratio, difference, scratch = (a[:, : self.count] for a in (self.ratio, self.difference, self.scratch))
        norms = normalisation(self.n_bands)
        real[0], imaginary[0] = 1, 0
        for l in range(self.n_bands):
            if l == 1:
                np.multiply(x, south, out=real[1])
                np.multiply(y, south, out=imaginary[1])
            elif l:
                np.multiply(azimuth[:, l - 1], real[1], out=azimuth[:, l])
                turned = np.multiply(azimuth[:, l - 1], imaginary[1], out=scratch[:2])
                real[l] -= turned[1]
                imaginary[l] += turned[0]
                self._step(l, ratio[: l - 1], difference[: l - 1], scratch[: l - 1], rest)
            row = scratch[: l + 1]
            np.multiply(ratio[: max(l - 1, 0)], norms[l, : max(l - 1, 0), None], out=row[: max(l - 1, 0)])
            if l:
                ratio[l - 1], difference[l - 1] = height, 0
                difference[l - 1] -= rest
                np.multiply(height, norms[l, l - 1], out=row[l - 1])
            row[l] = norms[l, l]
            if l % 2:
                row *= south
            np.multiply(row, real[: l + 1], out=table[l * l + l : (l + 1) ** 2])
            np.multiply(row[:0:-1], imaginary[l:0:-1], out=table[l * l : l * l + l])

    @staticmethod
    def _step(l: int, ratio: Array, difference: Array, scratch: Array, rest: Array) -> None:
        """G(l) and D(l) from G(l-1) and D(l-1), for m = 0 to l - 2."""
        np.multiply(rest, ratio, out=scratch)
        np.subtract(difference, scratch, out=scratch)
        scratch *= ((2 * l - 1) / (l + np.arange(len(ratio))))[:, None]
        np.subtract(scratch, difference, out=difference)
        ratio += difference
