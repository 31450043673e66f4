"""Degrees and orders, and the index at which they are stored; what a direction may be."""

from __future__ import annotations

from math import isqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MAX_BANDS = 1400
"""The most bands: the normalisation grows like 10**(0.2086 l) and would leave float64 at l = 1478."""


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


def orders(n_bands: int) -> NDArray[np.int64]:
    """The order m of each coefficient, shape (n_bands**2,)."""
    l = degrees(n_bands)
    return np.arange(n_bands**2) - l * (l + 1)


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
