"""The mirror ball: an orthographic picture of a reflecting sphere, theta = 2 asin r.

With X to the right and Y up in units of half the side, and r their distance from the centre,
    direction = (1 - 2 r^2, -2 X sqrt(1 - r^2), 2 Y sqrt(1 - r^2)),   density = 4 everywhere.
The root has no series at the rim, where the whole world behind the ball is squeezed. So the disc is cut into square tiles
that shrink towards it, none larger than twice its distance from the rim, each a patch of its own (patches.py); what is left at
the rim is integrated along the texels' edges. The sums of both are those of harmonics/areas/ball.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.ball import BallSums
from shviewer.harmonics.areas.chebyshev import point_count
from shviewer.harmonics.areas.cycling import cycled
from shviewer.harmonics.areas.patches import texel_weights
from shviewer.harmonics.basis import Array, Indices
from shviewer.lights.layouts.disc import DiscLayout
from shviewer.lights.layouts.rim import quadrants

SMALLEST_TILE, LARGEST_TILE = 64, 4
"""The side of the smallest tiles, in texels, where that is an eighth of the radius or less, and of the largest ones in them.
Smaller ones would have more points than texels."""

FEWEST_TEXELS = 64
"""Texels from the centre to the rim below which all are taken by their edges."""

ROOT_POINTS = 24
"""How many more Chebyshev points than radians of a wave a tile has along a side, for the sake of the root."""


@dataclass(frozen=True)
class MirrorBallLayout(DiscLayout):
    """A disc as a mirroring ball shows it: its radius is the sine of half the angle to the direction ahead."""

    name: str = "mirror-ball"

    def radius(self, theta: Array) -> Array:
        return np.asarray(np.sin(theta / 2))

    def theta(self, radius: Array) -> Array:
        return np.asarray(2 * np.arcsin(radius))

    def from_behind(self, depth: Array) -> Array:
        return np.asarray(2 * np.arcsin(depth))

    def whole_solid_angles(self) -> Array:
        size = np.diff(self.edges)
        return np.asarray(4 * size * size[:, None])

    def whole_rises(self) -> Array:
        """As in DiscLayout, 8 Y sqrt(1 - X^2 - Y^2) in closed form, along Y and then X."""
        rho = np.sqrt(np.maximum(1 - self.edges**2, 0.0))[:, None]
        x = np.minimum(self.edges, rho)
        turn = np.arctan2(x, np.sqrt((rho - x) * (rho + x)))
        corner = x * (5 * rho**2 - 2 * x**2) * np.sqrt((rho - x) * (rho + x)) / 8 + 3 / 8 * rho**4 * turn
        return np.asarray(-8 / 3 * np.diff(np.diff(corner, axis=0), axis=1))

    def density(self, radius: Array) -> Array:
        return np.full_like(radius, 4.0)

    def project(self, pixels: NDArray[np.float32], n_bands: int) -> Array:
        """As in Layout."""
        views, sums, weights = quadrants(pixels), BallSums(n_bands), cache(self._weights)
        for size, row, column in self._tiles():
            n_down, n_right = self._point_counts(row, column, size, n_bands)
            (y, down), (x, right) = weights(row, size, n_down), weights(column, size, n_right)
            tile = np.empty((2, 2, n_down, 3, n_right))
            for view, points in zip(views, tile.reshape(4, n_down, 3, n_right), strict=True):
                texels = view[row : row + size, column : column + size].astype(np.float64)
                by_row = (4 * down @ texels.reshape(size, -1)).reshape(n_down, size, 3)
                points[:] = by_row.swapaxes(1, 2) @ right.T
            sums.add_points(x, y, tile)
        sums.add_rim(views, self._tiled, self.edges, self.quadrant_solid_angles)
        return cycled(sums.coefficients())

    @property
    def _tiled(self) -> Indices:
        """Texels of each row, or column, of a quadrant that are in tiles, from the centre on; (half,), descending."""
        if self.half < FEWEST_TEXELS:
            return np.zeros(self.half, np.int64)
        size = self._smallest_tile
        far = np.minimum(np.arange(1, -(-self.half // size) + 1) * size, self.half + 1)
        covered = _fits(far, far[:, None], size, self.half)
        return np.asarray(size * covered.sum(axis=1).repeat(size)[: self.half])

    @property
    def _smallest_tile(self) -> int:
        return int(min(SMALLEST_TILE, 2 ** (max(self.half // 8, 1).bit_length() - 1)))

    def _tiles(self) -> Iterator[tuple[int, int, int]]:
        """Sides of tiles in a quadrant, and their first rows and columns."""
        if self.half < FEWEST_TEXELS:
            return
        smallest = self._smallest_tile
        size = LARGEST_TILE * smallest
        rows, columns = (a.ravel() * size for a in np.indices((-(-self.half // size),) * 2))
        while size >= smallest and len(rows):
            fits = _fits(rows + size, columns + size, size, self.half)
            for row, column in zip(rows[fits].tolist(), columns[fits].tolist(), strict=True):
                yield size, row, column
            rows, columns = rows[~fits], columns[~fits]
            size //= 2
            rows = (rows[:, None] + np.array([0, 0, size, size])).ravel()
            columns = (columns[:, None] + np.array([0, size, 0, size])).ravel()

    def _weights(self, start: int, size: int, n_points: int) -> tuple[Array, Array]:
        return texel_weights(self.edges[start : start + size + 1], n_points)

    def _point_counts(self, row: int, column: int, size: int, n_bands: int) -> tuple[int, int]:
        """Chebyshev points down and to the right, by the angles that a tile covers along its sides."""
        y, x = (
            self.edges[at] + (self.edges[at + size] - self.edges[at]) * np.linspace(0, 1, 5) for at in (row, column)
        )
        directions = self._directions(*(a.ravel() for a in np.meshgrid(x, y))).reshape(5, 5, 3)
        down, right = (4 * np.linalg.norm(np.diff(directions, axis=axis), axis=2).max() for axis in (0, 1))
        return point_count(n_bands * down / 2, ROOT_POINTS), point_count(n_bands * right / 2, ROOT_POINTS)


def _fits(rows: Indices, columns: Indices, size: int, half: int) -> NDArray[np.bool_]:
    """Whether tiles with far corners there are no larger than twice their distance from the rim."""
    return np.asarray(np.hypot(rows, columns) + size / 2 <= half)
