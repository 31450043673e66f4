"""Quadrature rules on the sphere: directions and weights.

Sources
    [Green]     R. Green, "Spherical Harmonic Lighting: The Gritty Details", GDC 2003: jittered samples.
    [Hannay]    J. H. Hannay, J. F. Nye, "Fibonacci numerical integration on a sphere", J. Phys. A 37, 11591 (2004).
    [Olver]     F. W. J. Olver, "Asymptotics and Special Functions", 1974, chapter 12: zeros of P(n) by those of J(0), as in
                N. Hale, A. Townsend, SIAM J. Sci. Comput. 35, A652 (2013).
    [Waldvogel] J. Waldvogel, "Fast construction of the Fejer and Clenshaw-Curtis quadrature rules", BIT 46, 195 (2006).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import isqrt

import numpy as np

from shviewer.harmonics.evaluation.indices import Array
from shviewer.limits import MAX_SAMPLES

NEWTON_STEPS = 8
NODE_FOUND = 1e-15
"""A Newton step, in radians, after which the next would be less than the rounding."""

Radiance = Callable[[Array], Array]
"""Directions (k, 3) -> linear RGB (k, 3)."""


@dataclass(frozen=True, eq=False)
class DirectionSet:
    """Sample directions (k, 3), unit, and their weights (k,) in steradians, which add up to 4 pi."""

    directions: Array
    weights: Array


def jittered(n_samples: int, seed: int) -> DirectionSet:
    """The paper's stratified samples: one uniformly random point in each of side x side equal-area cells.

    The paper's name is `SH_setup_spherical_samples`, without the basis it stores with them: `project_samples` needs none.
    side = floor(sqrt(n_samples)), so the set may be a little smaller than asked for. With (u, v) uniform in its cell
    the direction is theta = 2 acos(sqrt(1-u)), phi = 2 pi v [Green], whose cosine 1 - 2u is uniform: every cell
    covers the same solid angle and every sample weighs 4 pi / side**2.
    """
    check_samples(n_samples)
    side = isqrt(n_samples)
    jitter = np.random.default_rng(seed).random((2, side, side))
    u = (np.arange(side)[:, None] + jitter[0]) / side
    v = (np.arange(side) + jitter[1]) / side
    return _equal_weights(u.ravel(), v.ravel())


def uniform_random(n_samples: int, seed: int) -> DirectionSet:
    """Independent points, uniform on the sphere: cosine 1 - 2u and azimuth 2 pi v of uniform (u, v)."""
    check_samples(n_samples)
    return _equal_weights(*np.random.default_rng(seed).random((2, n_samples)))


def fibonacci(n_samples: int) -> DirectionSet:
    """The golden spiral, [Hannay] for any number of points: no randomness, and no direction is preferred.

    Point i = 0, ..., N-1 has the cosine 1 - (2i+1)/N, the middle of the i-th of N zones of equal area, and the azimuth
    2 pi i/g, g = (1 + sqrt(5))/2. Each weighs 4 pi/N.
    """
    check_samples(n_samples)
    i = np.arange(n_samples)
    return _equal_weights((i + 0.5) / n_samples, i * ((np.sqrt(5) - 1) / 2) % 1)


def _equal_weights(u: Array, v: Array) -> DirectionSet:
    """Points of the equal-area map of the unit square: cosine 1 - 2u, azimuth 2 pi v."""
    radius = 2 * np.sqrt(u * (1 - u))
    phi = 2 * np.pi * v
    directions = np.stack([radius * np.cos(phi), radius * np.sin(phi), 1 - 2 * u], axis=-1)
    return DirectionSet(directions, np.full(len(u), 4 * np.pi / len(u)))


@dataclass(frozen=True, eq=False)
class ProductRule:
    """Rows of constant theta crossed with equidistant azimuths: what a separable projection needs.

    theta: (rows,) radians; row_weights: (rows,), sum 2; columns sit at phi = pi (1 - (2i+1)/columns).
    """

    theta: Array
    row_weights: Array
    n_columns: int

    @property
    def phi(self) -> Array:
        """The azimuths (columns,) in radians, decreasing: the columns of a lat-long image."""
        return column_azimuths(self.n_columns)

    def directions(self, rows: slice = slice(None)) -> Array:
        """The points of some rows, row by row, (k, 3)."""
        return directions_from_angles(self.theta[rows, None], self.phi).reshape(-1, 3)

    def direction_set(self, rows: slice = slice(None)) -> DirectionSet:
        """The points of some rows with their weights."""
        weights = np.repeat(self.row_weights[rows] * (2 * np.pi / self.n_columns), self.n_columns)
        return DirectionSet(self.directions(rows), weights)


def gauss_legendre(n_samples: int) -> ProductRule:
    """About n_samples points: Gauss-Legendre nodes in cos(theta), twice as many equidistant azimuths.

    With r = floor(sqrt(n_samples / 2)) rows it integrates every product of two functions of r bands exactly.
    """
    check_samples(n_samples)
    rows = max(1, isqrt(n_samples // 2))
    return ProductRule(*gauss_legendre_rows(rows), 2 * rows)


def fejer(n_samples: int) -> ProductRule:
    """About n_samples points: the texel centres of a lat-long image twice as wide as high, with Fejer's weights.

    Its r = floor(sqrt(n_samples / 2)) rows are spaced equally and integrate polynomials in cos(theta) of degree r - 1, and
    so every product of two functions of (r+1)//2 bands, exactly.
    """
    check_samples(n_samples)
    rows = max(1, isqrt(n_samples // 2))
    return ProductRule(*_fejer_rows(rows), 2 * rows)


@lru_cache(maxsize=16)
def _fejer_rows(rows: int) -> tuple[Array, Array]:
    """Angles (i + 1/2) pi/rows and the weights of Fejer's first rule (rows,) [Waldvogel]; all are positive."""
    theta = row_angles(rows)
    k = np.arange(1, rows // 2 + 1)
    return theta, 2 / rows * (1 - np.cos(np.outer(theta, 2 * k)) @ (2 / (4 * k**2 - 1)))


@lru_cache(maxsize=1)
def clenshaw_curtis_rows(rows: int) -> tuple[Array, Array]:
    """Angles from pole to pole, an odd number, and their weights (rows,) [Waldvogel, (2.4)], exact up to degree rows - 1."""
    n = rows - 1
    theta = np.linspace(0, np.pi, rows)
    k = np.arange(1, n // 2 + 1)
    share = np.where(k == n // 2, 1, 2) / (4 * k**2 - 1)
    weights = (1 - np.cos(np.outer(theta, 2 * k)) @ share) * 2 / n
    weights[[0, -1]] /= 2
    return theta, weights


@lru_cache(maxsize=8)
def gauss_unit(count: int) -> tuple[Array, Array]:
    """Gauss-Legendre nodes in (0, 1) and their weights, sum 1: (count,) each."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1) / 2, weights / 2


@lru_cache(maxsize=16)
def gauss_legendre_rows(rows: int) -> tuple[Array, Array]:
    """Gauss-Legendre nodes as angles (rows,), ascending, and their weights (rows,), read-only.

    By Newton steps in theta from [Olver], with P(rows) from the difference form of basis.py, and the weight
    2 / (dP/dtheta)^2: nodes to 1e-15 and weights to 1e-13 of themselves at 4096 rows, next to the poles, too, in the square of
    the time of a row, where numpy takes the cube and loses four digits of the weights there.
    """
    beta = np.pi * (np.arange((rows + 1) // 2) + 0.75)
    zero_of_bessel = beta + 1 / (8 * beta) - 124 / 3 / (8 * beta) ** 3 + 120928 / 15 / (8 * beta) ** 5
    psi = zero_of_bessel / (rows + 0.5)
    theta = psi + (psi / np.tan(psi) - 1) / (8 * psi * (rows + 0.5) ** 2)
    for _ in range(NEWTON_STEPS):
        delta = 2 * np.sin(theta / 2) ** 2
        difference, ratio, work = np.zeros(len(theta)), np.ones(len(theta)), np.empty(len(theta))
        for l in range(1, rows + 1):
            np.multiply(delta, ratio, out=work)
            np.subtract(difference, work, out=work)
            work *= (2 * l - 1) / l
            np.subtract(work, difference, out=difference)
            ratio += difference
        slope = rows * ((ratio - difference) - np.cos(theta) * ratio) / np.sin(theta)  # -dP/dtheta
        step = ratio / slope
        theta = theta + step
        if np.abs(step).max() < NODE_FOUND:
            break
    weights = 2 / slope**2
    mirrored = slice(rows // 2 - 1, None, -1) if rows > 1 else slice(0, 0)
    found = np.concatenate([theta, np.pi - theta[mirrored]]), np.concatenate([weights, weights[mirrored]])
    for values in found:
        values.flags.writeable = False
    return found


def check_samples(n_samples: int) -> None:
    """Raise ValueError unless 1 <= n_samples <= MAX_SAMPLES."""
    if not 1 <= n_samples <= MAX_SAMPLES:
        raise ValueError(f"{n_samples} samples: there must be 1 to {MAX_SAMPLES}")


def row_angles(n_rows: int) -> Array:
    """theta of the row centres of a lat-long image, radians from the top: (n_rows,)."""
    return np.asarray(np.pi * (np.arange(n_rows) + 0.5) / n_rows)


def column_azimuths(n_columns: int) -> Array:
    """phi of the column centres of a lat-long image, radians: u in [0, 1] from left to right is phi = pi (1 - 2u)."""
    return np.asarray(np.pi * (1 - (2 * np.arange(n_columns) + 1) / n_columns))


def angles_from_directions(directions: Array) -> tuple[Array, Array]:
    """The angle to +z and the azimuth from +x towards +y, each (...), radians, of vectors (..., 3) of any length."""
    x, y, z = np.moveaxis(directions, -1, 0)
    return np.arctan2(np.hypot(x, y), z), np.arctan2(y, x)


def evaluate_rows(radiance: Radiance, theta: Array, n_columns: int) -> Array:
    """Evaluate a function on rows of a lat-long grid at angles theta (rows,) from +z: (rows, 3, n_columns)."""
    directions = directions_from_angles(theta[:, None], column_azimuths(n_columns)).reshape(-1, 3)
    return np.ascontiguousarray(radiance(directions).reshape(len(theta), n_columns, 3).transpose(0, 2, 1))


def directions_from_angles(theta: Array, phi: Array) -> Array:
    """Unit vectors (..., 3) from the angle to +z and the azimuth from +x towards +y, both broadcast, in radians."""
    sine = np.sin(theta)
    directions = np.empty((*np.broadcast_shapes(np.shape(theta), np.shape(phi)), 3))
    np.multiply(sine, np.cos(phi), out=directions[..., 0])
    np.multiply(sine, np.sin(phi), out=directions[..., 1])
    directions[..., 2] = np.cos(theta)
    return directions


def share_below_zero(values: Array, theta: Array) -> float:
    """The share of the sphere where values on whole rows (rows, columns), linear in theta (rows,) between them, are below zero.

    Each column stands for a lune, exact but where the border of what is below zero bends between rows and columns.
    """
    below, z = values < 0, np.cos(theta)
    length = float(np.count_nonzero(below[:-1] & below[1:], axis=1) @ (z[:-1] - z[1:]))
    length += float(np.count_nonzero(below[0]) * (1 - z[0]) + np.count_nonzero(below[-1]) * (1 + z[-1]))
    rows, columns = np.nonzero(below[:-1] != below[1:])
    first, second = values[rows, columns], values[rows + 1, columns]
    border = np.cos(theta[rows] + (theta[rows + 1] - theta[rows]) * first / (first - second))
    length += float(np.where(below[rows, columns], z[rows] - border, border - z[rows + 1]).sum())
    return min(1.0, length / float(2 * values.shape[1]))
