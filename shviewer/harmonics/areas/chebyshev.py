"""Chebyshev points, polynomials and series (T. J. Rivlin, "Chebyshev Polynomials", 2nd ed., chapters 1 to 3)."""

from __future__ import annotations

import numpy as np

from shviewer.harmonics.basis import Array


def chebyshev_values(positions: Array, n: int) -> Array:
    """T(0) to T(n-1) at positions in [-1, 1], (n, *positions.shape), from those of half the degree."""
    table = np.empty((max(n, 2), *positions.shape))
    table[0], table[1] = 1.0, positions
    for j in range(2, n):
        np.multiply(table[j // 2], table[j - j // 2], out=table[j])
        table[j] *= 2
        table[j] -= table[j % 2]
    return table[:n]


def integrate_series(table: Array) -> Array:
    """Antiderivatives of T(0) to T(n-2), or the same sums of anything else, from T(0) to T(n-1): (n, ...) -> (n-1, ...)."""
    degree = np.arange(len(table) - 1).reshape(-1, *[1] * (table.ndim - 1))
    result = table[1:] / (2 * degree + 2)
    result[2:] -= table[1:-2] / (2 * degree[2:] - 2)
    result[0] *= 2
    return np.asarray(result)


def point_count(phase: float, more: int = 0) -> int:
    """Chebyshev points that make waves of at most this phase, from the middle of an interval to its ends, exact to rounding.

    The series of e^(i phase u) ends like the Bessel functions J(j)(phase): this many make the rest less than 1e-14.
    more: how many more points than radians a factor needs whose series ends later.
    """
    return max(int(np.ceil(1.03 * phase + 8 * np.cbrt(phase) + 7)), int(phase) + more)


def chebyshev_points(n_points: int) -> Array:
    """Chebyshev points, (n_points,), in (-1, 1), descending."""
    return np.asarray(np.cos(np.pi * (np.arange(n_points) + 0.5) / n_points))


def chebyshev_shares(positions: Array, n_points: int) -> Array:
    """The share of each Chebyshev point in the interpolation at positions (k,) in [-1, 1]: (n_points, k).

    The shares are the polynomials that are 1 at their own point and 0 at the others.
    """
    return np.asarray(points_from_series(n_points) @ chebyshev_values(positions, n_points))


def points_from_series(n_points: int) -> Array:
    """The matrix from values of the Chebyshev polynomials T(0) to T(n-1), or functionals of them, to shares of the points."""
    angle = np.pi * (np.arange(n_points) + 0.5) / n_points
    matrix = np.cos(angle[:, None] * np.arange(n_points)) * (2 / n_points)
    matrix[:, 0] /= 2
    return np.asarray(matrix)
