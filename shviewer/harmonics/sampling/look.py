"""One look at a function, which steps over no disc that is SEEN_DEGREES wide, and what integrals follow from it.

The look is a lat-long grid from pole to pole, with fewer columns where they crowd: LOOK_ROWS rows, in strips of eight, and in
each strip 1024 / stride columns, no further apart than the rows. So every point of the sphere is within
sqrt(2) / 2 * 180 / 512 = 0.249 degrees of one. It serves as a quadrature (Clenshaw-Curtis in the rows), as the raster that is
drawn, and for comparison with everything else that is known of the function.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.quadrature import (
    Radiance,
    clenshaw_curtis_rows,
    column_azimuths,
    directions_from_angles,
    gauss_legendre,
)

LOOK_ROWS, LOOK_COLUMNS = 513, 1024
"""Rows from pole to pole, and columns where they are most."""

STRIP_ROWS = 8
N_STRIPS = (LOOK_ROWS - 1) // STRIP_ROWS
"""The rows of the look at both ends of a strip belong to it, too; there are 64 strips."""

SEEN_DEGREES = 0.5
"""The width of the smallest disc that is hit wherever it stands, rounded up."""

TURNED_ROWS = 128
"""Rows of the rule in another frame: exact for products of two functions of 128 bands."""

BLOCK = 2**14
"""Directions in one call of the function, which stay in the cache."""

AXES = np.concatenate([np.eye(3), -np.eye(3)])
"""Directions in which functions of x, y and z are most often not defined; looked at as they are, without rounding."""

TURN = np.linalg.qr(np.array([[0.36, 0.48, 0.8], [0.71, -0.11, 0.43], [0.13, 0.97, -0.29]]))[0]
"""A frame that has no axis, plane or diagonal in common with ours."""


@dataclass(eq=False)
class Integrals:
    """Integrals of a function f over the sphere by one rule."""

    moments: Array = field(default_factory=lambda: np.zeros((4, 3)))
    """Those of f, and unless there is only one row, of x f, y f and z f, for each channel."""
    products: Array = field(default_factory=lambda: np.zeros((3, 3)))
    """Those of f_i f_j."""
    magnitude: Array = field(default_factory=lambda: np.zeros(3))
    """Those of |f|, (3,)."""
    peak: float = 0.0
    """The largest |f| seen."""
    evaluations: int = 0

    def add(self, directions: Array, values: Array, weights: Array) -> None:
        """Add points: directions and values (k, 3), weights (k,) in steradians."""
        weighted = weights[:, None] * values
        self.evaluations += len(values)
        self.moments[0] += weights @ values
        if len(self.moments) > 1:
            self.moments[1:] += directions.T @ weighted
        self.products += values.T @ weighted
        size = np.abs(values)
        self.magnitude += weights @ size
        self.peak = max(self.peak, float(size.max(initial=0.0)))


class Watched:
    """A function, of which the brightest and the darkest point of every call are kept."""

    def __init__(self, radiance: Radiance) -> None:
        self.radiance = radiance
        self.points: list[Array] = []
        self.values: list[Array] = []

    def __call__(self, directions: Array) -> Array:
        values = self.radiance(directions)
        for channel in range(3):
            ends = [values[:, channel].argmax(), values[:, channel].argmin()]
            self.points.append(directions[ends])
            self.values.append(values[ends])
        return values

    @property
    def seen(self) -> tuple[Array, Array]:
        """Directions and values of the points kept, (k, 3) each."""
        return np.concatenate(self.points), np.concatenate(self.values)


def strides() -> Indices:
    """How many columns of the grid lie between those of each strip, (N_STRIPS,): powers of two."""
    edges = np.sin(np.pi * np.arange(N_STRIPS + 1) / N_STRIPS)
    widest = np.maximum(edges[:-1], edges[1:])
    return np.asarray(2 ** np.floor(np.log2(1 / widest)).astype(np.int64))


def look(radiance: Radiance) -> tuple[NDArray[np.float32], Integrals]:
    """The raster (LOOK_ROWS, LOOK_COLUMNS, 3), linear between the columns there are, and the integrals by its points."""
    texels = np.empty((LOOK_ROWS, LOOK_COLUMNS, 3), dtype=np.float32)
    found = Integrals(moments=np.zeros((1, 3)))
    found.add(AXES, radiance(AXES), np.zeros(len(AXES)))
    theta, row_weights = clenshaw_curtis_rows(LOOK_ROWS)
    for rows, stride in _row_groups():
        phi = column_azimuths(LOOK_COLUMNS)[::stride]
        step = max(1, BLOCK // len(phi))
        for start in range(rows.start, rows.stop, step):
            part = slice(start, min(start + step, rows.stop))
            directions = directions_from_angles(theta[part, None], phi).reshape(-1, 3)
            values = radiance(directions)
            found.add(directions, values, np.repeat(row_weights[part] * (2 * np.pi / len(phi)), len(phi)))
            _widen(values.reshape(-1, len(phi), 3), stride, texels[part])
    return texels, found


def turned(radiance: Radiance) -> tuple[Integrals, Array, Array]:
    """The integrals by a Gauss-Legendre rule whose poles and rows are not those of our frame; directions and values (k, 3)."""
    rule = gauss_legendre(2 * TURNED_ROWS**2)
    found = Integrals()
    directions, values = np.empty((2, 2 * TURNED_ROWS**2, 3))
    step = max(1, BLOCK // rule.n_columns)
    for start in range(0, len(rule.theta), step):
        points = rule.direction_set(slice(start, start + step))
        part = slice(start * rule.n_columns, start * rule.n_columns + len(points.weights))
        np.matmul(points.directions, TURN, out=directions[part])
        values[part] = radiance(directions[part])
        found.add(directions[part], values[part], points.weights)
    return found, directions, values


def _row_groups() -> list[tuple[slice, int]]:
    """Successive rows with the same stride. A row between two strips has the columns of the one that has more."""
    between = np.pad(np.repeat(strides(), STRIP_ROWS), 1, mode="edge")
    per_row = np.minimum(between[:-1], between[1:])
    starts = np.flatnonzero(np.r_[True, np.diff(per_row) != 0])
    return [(slice(int(a), int(b)), int(per_row[a])) for a, b in zip(starts, [*starts[1:], len(per_row)], strict=True)]


def _widen(values: Array, stride: int, texels: NDArray[np.float32]) -> None:
    """Fill whole rows of texels from every `stride`-th one, linearly in between."""
    texels[:, ::stride] = values
    following = np.roll(values, -1, axis=1)
    for between in range(1, stride):
        share = between / stride
        texels[:, between::stride] = (1 - share) * values + share * following
