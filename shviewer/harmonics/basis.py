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

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MAX_BANDS = 1400
"""The most bands: the normalisation grows like 10**(0.2086 l) and would leave float64 at l = 1478."""

MAX_VALUES = 2**28
"""The most basis values one call may return (2 GiB); callers evaluate larger sets in blocks."""


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
    unit = normalise(directions)
    points = unit.reshape(-1, 3)
    if points.shape[0] * n_bands**2 > MAX_VALUES:
        raise ValueError(
            f"{points.shape[0]} directions x {n_bands**2} functions: at most {MAX_VALUES} values at once; use blocks"
        )
    table = np.empty((n_bands**2, len(points)))
    block = max(128, 32768 // n_bands)  # keeps the working rows of one block in the cache
    for start in range(0, len(points), block):
        x, y, z = points[start : start + block].T
        _fill(table[:, start : start + block], x, y, z, n_bands)
    return table.T.reshape(*unit.shape[:-1], n_bands**2)


def _fill(table: Array, x: Array, y: Array, z: Array, n_bands: int) -> None:
    """Write Y(l, m) at index l(l+1) + m of `table`, shape (n_bands**2, k), for k unit directions."""
    norms = normalisation(n_bands)
    south = np.where(z < 0, -1.0, 1.0)
    one_minus_z = (x * x + y * y) / (1 + np.abs(z))
    cosines, sines = _azimuth_powers(south * x, south * y, n_bands)
    ratio = np.ones((n_bands, len(x)))
    difference = np.zeros((n_bands, len(x)))
    scratch = np.empty((n_bands, len(x)))
    for l in range(n_bands):
        if l:
            d, g, work = difference[:l], ratio[:l], scratch[:l]
            np.multiply(one_minus_z, g, out=work)
            np.subtract(d, work, out=work)
            work *= ((2 * l - 1) / (l + np.arange(l)))[:, None]
            np.subtract(work, d, out=d)
            g += d
        row = scratch[: l + 1]
        np.multiply(ratio[: l + 1], norms[l, : l + 1, None], out=row)
        if l % 2:
            row *= south
        np.multiply(row, cosines[: l + 1], out=table[l * l + l : (l + 1) ** 2])
        np.multiply(row[:0:-1], sines[l:0:-1], out=table[l * l : l * l + l])


def _azimuth_powers(x: Array, y: Array, count: int) -> tuple[Array, Array]:
    """Real and imaginary part of (x + iy)^m for m = 0 to count-1, each of shape (count, k)."""
    real, imaginary = np.empty((count, len(x))), np.empty((count, len(x)))
    real[0], imaginary[0] = 1, 0
    for m in range(1, count):
        real[m] = x * real[m - 1] - y * imaginary[m - 1]
        imaginary[m] = x * imaginary[m - 1] + y * real[m - 1]
    return real, imaginary
