"""Where a function on the sphere is evaluated, and with what weight."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import isqrt

import numpy as np

from shviewer.harmonics.basis import Array

MAX_SAMPLES = 16_000_000
"""The most directions a rule may have: 512 MB of directions and weights."""


@dataclass(frozen=True, eq=False)
class DirectionSet:
    """Sample directions (k, 3), unit, and their weights (k,) in steradians, which add up to 4 pi."""

    directions: Array
    weights: Array


def jittered(n_samples: int, seed: int) -> DirectionSet:
    """The paper's stratified samples: one uniformly random point in each of side x side equal-area cells.

    side = floor(sqrt(n_samples)), so the set may be a little smaller than asked for. With (u, v) uniform in its cell
    the direction is theta = 2 acos(sqrt(1-u)), phi = 2 pi v [Green], whose cosine 1 - 2u is uniform: every cell
    covers the same solid angle and every sample weighs 4 pi / side**2.
    """
    check_samples(n_samples)
    side = isqrt(n_samples)
    jitter = np.random.default_rng(seed).random((2, side, side))
    u = ((np.arange(side)[:, None] + jitter[0]) / side).ravel()
    phi = (2 * np.pi * (np.arange(side) + jitter[1]) / side).ravel()
    radius = 2 * np.sqrt(u * (1 - u))
    directions = np.stack([radius * np.cos(phi), radius * np.sin(phi), 1 - 2 * u], axis=-1)
    return DirectionSet(directions, np.full(side * side, 4 * np.pi / side**2))


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
        """(columns,) radians, decreasing: the columns of a lat-long image."""
        return column_azimuths(self.n_columns)

    def direction_set(self, rows: slice = slice(None)) -> DirectionSet:
        """The points of some rows, row by row."""
        directions = directions_from_angles(self.theta[rows, None], self.phi)
        weights = np.repeat(self.row_weights[rows] * (2 * np.pi / self.n_columns), self.n_columns)
        return DirectionSet(directions.reshape(-1, 3), weights)


def gauss_legendre(n_samples: int) -> ProductRule:
    """About n_samples points: Gauss-Legendre nodes in cos(theta), twice as many equidistant azimuths.

    With r = floor(sqrt(n_samples / 2)) rows it integrates every product of two functions of r bands exactly.
    """
    check_samples(n_samples)
    rows = max(1, isqrt(n_samples // 2))
    return ProductRule(*_gauss_legendre_rows(rows), 2 * rows)


@lru_cache(maxsize=16)
def _gauss_legendre_rows(rows: int) -> tuple[Array, Array]:
    """Gauss-Legendre nodes as angles (rows,) and their weights (rows,).

    numpy's weights lose four digits next to the poles. Newton steps in theta, with P(rows) from the difference form of
    basis.py, and the weight 2 / (dP/dtheta)^2 keep them all.
    """
    theta = np.arccos(np.polynomial.legendre.leggauss(rows)[0][::-1])[: (rows + 1) // 2]
    for _ in range(3):
        delta = 2 * np.sin(theta / 2) ** 2
        before = ratio = np.ones(len(theta))
        difference = np.zeros(len(theta))
        for l in range(1, rows + 1):
            before = ratio
            difference = (2 * l - 1) / l * (difference - delta * ratio) - difference
            ratio = ratio + difference
        slope = rows * (before - np.cos(theta) * ratio) / np.sin(theta)  # -dP/dtheta
        weights = 2 / slope**2
        theta = theta + ratio / slope
    mirrored = slice(rows // 2 - 1, None, -1) if rows > 1 else slice(0, 0)
    return np.concatenate([theta, np.pi - theta[mirrored]]), np.concatenate([weights, weights[mirrored]])


def check_samples(n_samples: int) -> None:
    """Raise ValueError unless 1 <= n_samples <= MAX_SAMPLES."""
    if not 1 <= n_samples <= MAX_SAMPLES:
        raise ValueError(f"{n_samples} samples: there must be 1 to {MAX_SAMPLES}")


def column_azimuths(n_columns: int) -> Array:
    """phi of the column centres of a lat-long image, radians: u in [0, 1] from left to right is phi = pi (1 - 2u)."""
    return np.asarray(np.pi * (1 - (2 * np.arange(n_columns) + 1) / n_columns))


def directions_from_angles(theta: Array, phi: Array) -> Array:
    """Unit vectors (..., 3) from the angle to +z and the azimuth from +x towards +y, both broadcast, in radians."""
    theta, phi = np.broadcast_arrays(theta, phi)
    sine = np.sin(theta)
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), np.cos(theta)], axis=-1)
