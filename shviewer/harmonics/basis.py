"""Real spherical harmonics Y(l, m) and the one place where their convention is written.

Convention (pinned by tests/harmonics/test_basis.py against independent references):
    orthonormal over the sphere; z is the polar axis; the Condon-Shortley phase is kept, so that
    Y(1,-1), Y(1,0), Y(1,1) are sqrt(3/4pi) times -y, z, -x.
    Degree l >= 0 and order -l <= m <= l are stored at index l(l+1) + m. A band is all orders of one degree;
    "n bands" means the degrees 0 to n-1, which is n**2 functions.

With theta the angle from +z and phi the angle from +x towards +y,
    Y(l, m)  = sqrt(2) K(l, m) cos(m phi) P(l, m)(cos theta)      for m > 0,
    Y(l,-m)  = sqrt(2) K(l, m) sin(m phi) P(l, m)(cos theta)      for m > 0,
    Y(l, 0)  = K(l, 0) P(l)(cos theta),      K(l, m) = sqrt((2l+1)/(4 pi) (l-m)!/(l+m)!),
where the phase (-1)^m is part of P(l, m).

Sources
    [Green]   R. Green, "Spherical Harmonic Lighting: The Gritty Details", GDC 2003: the convention.
    [DLMF]    NIST Digital Library of Mathematical Functions, 14.10.3 and 18.9.1: recurrences in degree.
    [Reinsch] J. Stoer, R. Bulirsch, "Introduction to Numerical Analysis", 3rd ed., section 2.3.2: carrying
              differences of a recurrence instead of its terms, which keeps it stable where cos theta nears 1.
"""

from __future__ import annotations

from functools import lru_cache
from math import isqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shviewer.harmonics.workspace import borrowed

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MAX_BANDS = 1400
"""The most bands: the normalisation grows like 10**(0.2086 l) and would leave float64 at l = 1478."""

MAX_VALUES = 2**28
"""The most basis values one call may return (2 GiB); callers evaluate larger sets in blocks."""

BLOCK_VALUES = 32768
"""Values of one kind, directions times bands, that are worked on at a time, so that they stay in the cache."""

UNIT = 1e-15
"""Directions are taken as they are where x^2 + y^2 + z^2 differs from 1 by less: by rounding alone."""


def index(l: int, m: int) -> int:
    """The index at which Y(l, m) is stored: l(l+1) + m."""
    return l * (l + 1) + m


def degree_order(i: int) -> tuple[int, int]:
    """Degree l and order m of the coefficient at index i: the inverse of `index`."""
    l = isqrt(i)
    return l, i - l * (l + 1)


def check_bands(n_bands: int, most: int = MAX_BANDS) -> None:
    """Raise ValueError unless 1 <= n_bands <= most."""
    if not 1 <= n_bands <= most:
        raise ValueError(f"{n_bands} bands: there must be 1 to {most}")


def count_bands(coefficients: NDArray[np.generic]) -> int:
    """The number of bands n that `coefficients`, shape (n**2, ...), hold. ValueError if the length is no square."""
    n_bands = isqrt(len(coefficients))
    if n_bands**2 != len(coefficients) or not n_bands:
        raise ValueError(f"{len(coefficients)} coefficients: n bands have n**2 of them")
    return n_bands


def degrees(n_bands: int) -> NDArray[np.int64]:
    """The degree l of each coefficient, shape (n_bands**2,)."""
    return np.repeat(np.arange(n_bands), 2 * np.arange(n_bands) + 1)


def normalise(directions: ArrayLike) -> Array:
    """Unit vectors along `directions`, shape (..., 3), whatever their length, down to subnormal and up to 1e308.

    ValueError for a zero vector, NaN or infinity, naming the first one.
    """
    vectors = np.asarray(directions, dtype=np.float64)
    if vectors.ndim == 0 or vectors.shape[-1] != 3:
        raise ValueError(f"directions of shape {vectors.shape}: the last axis must hold x, y, z")
    largest = np.abs(vectors).max(axis=-1, keepdims=True)  # NaN propagates
    good = np.isfinite(largest) & (largest > 0)
    if not good.all():
        first = tuple(int(i) for i in np.argwhere(~good[..., 0])[0])
        raise ValueError(f"direction {vectors[first].tolist()} at {first}: it must be finite and not zero")
    exponent = np.frexp(largest)[1]
    scaled = np.ldexp(vectors, -exponent)  # exact, and no reciprocal of a subnormal that overflows
    return np.asarray(scaled / np.sqrt((scaled * scaled).sum(axis=-1, keepdims=True)))


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


def evaluate_basis(directions: ArrayLike, n_bands: int) -> Array:
    """Every Y(l, m) of `n_bands` bands in every direction.

    directions: (..., 3), any length. Returns (..., n_bands**2), float64.
    ValueError for bad directions, more than MAX_BANDS bands or more than MAX_VALUES values.

    G(l, m)(z) is the Gegenbauer polynomial C(l-m, m+1/2)(z) over its value at 1, so |G| <= 1 and G(l, m)(1) = 1.
    Its recurrence [DLMF 18.9.1], written for the difference D = G(l) - G(l-1) [Reinsch] with d = 1 - |z|, is
        G(m) = 1,  D(m) = 0,   D(l) = q (D(l-1) - d G(l-1)) - D(l-1),   G(l) = G(l-1) + D(l),   q = (2l-1)/(l+m).
    d = (x^2 + y^2)/(1 + |z|) has no cancellation, no angle appears and nothing is divided by sin(theta): the poles
    and the seam are ordinary points. The southern half follows from G(-z) = (-1)^(l+m) G(z).
    shaders/sh.glsl runs the same recurrence in float32.
    """
    check_bands(n_bands)
    vectors = np.asarray(directions, dtype=np.float64)
    if vectors.ndim == 0 or vectors.shape[-1] != 3:
        vectors = normalise(vectors)  # which says what is wrong
    points = vectors.reshape(-1, 3)
    if points.shape[0] * n_bands**2 > MAX_VALUES:
        raise ValueError(
            f"{points.shape[0]} directions x {n_bands**2} functions: at most {MAX_VALUES} values at once; use blocks"
        )
    table = np.empty((n_bands**2, len(points)))
    size = max(1, min(len(points), max(128, BLOCK_VALUES // n_bands)))
    with borrowed(_Rows, n_bands, size, keep=n_bands * size <= BLOCK_VALUES) as rows:
        for start in range(0, len(points), size):
            block = slice(start, start + size)
            if not rows.take(points[block]):
                points = normalise(vectors).reshape(-1, 3)
                rows.take(points[block])
            rows.fill(table[:, block])
    return table.T.reshape(*vectors.shape[:-1], n_bands**2)


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
