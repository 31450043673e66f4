"""The mirror ball: an orthographic picture of a reflecting sphere, theta = 2 asin r.

With X to the right and Y up in units of half the side, and r their distance from the centre,
    direction = (1 - 2 r^2, -2 X sqrt(1 - r^2), 2 Y sqrt(1 - r^2)),   density = 4 everywhere.
The root has no series at the rim, where the whole world behind the ball is squeezed. So the disc is cut into square tiles
that shrink towards it, none larger than twice its distance from the rim, each a patch of its own; the last texels have
points of the rim's rule. All but solid angles and band 0, which are exact, are right to 1e-8 of the largest coefficient.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.patches import project_mirrored, texel_weights
from shviewer.lights.layouts.disc import DiscLayout
from shviewer.lights.layouts.layout import Indices

LARGEST_TILE = 256
"""The largest tile, in texels a side."""

BLOCK_TEXELS = 2**17
BLOCK_POINTS = 2**16


@dataclass(frozen=True)
class MirrorBallLayout(DiscLayout):
    name: str = "mirror-ball"

    def radius(self, theta: Array) -> Array:
        return np.asarray(np.sin(theta / 2))

    def theta(self, radius: Array) -> Array:
        return np.asarray(2 * np.arcsin(radius))

    @cached_property
    def quadrant_solid_angles(self) -> Array:
        size = np.diff(self.edges)
        quadrant = 4 * size * size[:, None]
        quadrant[np.arange(self.half) >= self.whole[:, None]] = 0.0
        for rows, columns in self.rim_blocks(*self.cut, 14):
            points = self.rim(rows, columns, 14)
            quadrant[rows, columns] = np.bincount(points.texels, 4 * points.weights.sum(axis=1), minlength=len(rows))
        return np.asarray(quadrant)

    def project(self, pixels: NDArray[np.float32], n_bands: int) -> Array:
        if self.side % 2:
            return _Tiles(MirrorBallLayout(2 * self.side), pixels, 2).project(n_bands)
        return _Tiles(self, pixels, 1).project(n_bands)


@dataclass(frozen=True, eq=False)
class _Tiles:
    """The tiles of a ball of even side. pixels: an image each of whose texels stands for repeat^2 of the ball's."""

    ball: MirrorBallLayout
    pixels: NDArray[np.float32]
    repeat: int

    def project(self, n_bands: int) -> Array:
        half = self.ball.half
        size = min(LARGEST_TILE, 1 << (half - 1).bit_length())
        rows, columns = (a.ravel() * size for a in np.indices((-(-half // size),) * 2))
        coefficients = np.zeros((n_bands**2, 3))
        while len(rows):
            far = np.hypot(rows + size, columns + size) / half
            fits = 1 - far >= size / (2 * half)
            coefficients += self._project_tiles(rows[fits], columns[fits], size, n_bands)
            rows, columns = rows[~fits], columns[~fits]
            if size == 1:
                break
            size //= 2
            rows = (rows[:, None] + np.array([0, 0, size, size])).ravel()
            columns = (columns[:, None] + np.array([0, size, 0, size])).ravel()
            seen = np.hypot(rows, columns) < half
            rows, columns = rows[seen], columns[seen]
        return coefficients + self._project_rim(rows, columns, n_bands)

    def _project_tiles(self, rows: Indices, columns: Indices, size: int, n_bands: int) -> Array:
        """Project tiles of size^2 texels with their first texel at rows and columns (k,) of the quadrant."""
        coefficients = np.zeros((n_bands**2, 3))
        if not len(rows):
            return coefficients
        n_points = self._point_count(rows, columns, size, n_bands)
        if size == 1:
            points, weights = np.polynomial.legendre.leggauss(max(5, n_points - 4))
            points, row_weights = (1 + points) / 2, weights[:, None] / 2
        else:
            points, row_weights = texel_weights(np.arange(size + 1) / size, n_points)
        block = max(1, min(BLOCK_TEXELS // size**2, BLOCK_POINTS // len(points) ** 2))
        within = np.arange(size)
        for start in range(0, len(rows), block):
            row, column = rows[start : start + block, None], columns[start : start + block, None]
            texels = self._mirrored((row + within)[:, :, None], (column + within)[:, None, :])
            by_row = row_weights @ texels.reshape(2, 2, len(row), size, size * 3).astype(np.float64)
            by_row = by_row.reshape(2, 2, len(row), len(points), size, 3).swapaxes(3, 4)
            weights = row_weights @ by_row.reshape(2, 2, len(row), size, len(points) * 3)
            values = (
                weights.reshape(2, 2, len(row), len(points), len(points), 3).swapaxes(3, 4)
                * (size / self.ball.half) ** 2
            )
            y, x = (
                (row + size * points)[:, :, None] / self.ball.half,
                (column + size * points)[:, None, :] / self.ball.half,
            )
            x, y = (a.ravel() for a in np.broadcast_arrays(x, y))
            coefficients += self._add(x, y, np.sqrt(1 - x * x - y * y), values.reshape(2, 2, -1, 3), n_bands)
        return coefficients

    def _point_count(self, rows: Indices, columns: Indices, size: int, n_bands: int) -> int:
        """Chebyshev points a side, by the angle that the widest of the tiles covers."""
        half = self.ball.half
        corners = [
            self.ball._directions((columns + right) / half, (rows + down) / half)
            for right, down in ((0, size), (size, 0), (0, 0), (size, size))
        ]
        widest = max(
            float(np.linalg.norm(corners[first] - corners[second], axis=1).max()) for first, second in ((0, 1), (2, 3))
        )
        return 8 + int(np.ceil(0.55 * n_bands * widest))

    def _project_rim(self, rows: Indices, columns: Indices, n_bands: int) -> Array:
        coefficients = np.zeros((n_bands**2, 3))
        n_points = (6 if self.ball.side > 16 else 14) + int(np.ceil(0.8 * n_bands * np.sqrt(2 / self.ball.half)))
        for at_rows, at_columns in self.ball.rim_blocks(rows, columns, n_points):
            rim = self.ball.rim(at_rows, at_columns, n_points)
            texels = self._mirrored(at_rows, at_columns)[:, :, rim.texels, None] * rim.weights[..., None]
            x, y, depth = rim.x.ravel(), rim.y.ravel(), rim.depth.ravel()
            coefficients += self._add(x, y, depth, texels.reshape(2, 2, -1, 3), n_bands)
        return coefficients

    def _mirrored(self, rows: Indices, columns: Indices) -> NDArray[np.float32]:
        return self.ball.mirrored(self.pixels, rows, columns, self.repeat)

    def _add(self, x: Array, y: Array, depth: Array, values: Array, n_bands: int) -> Array:
        """Coefficients (n**2, 3) of values (2, 2, k, 3) per area: world +y and -y, +z and -z, at distances x sideways and y up
        or down (k,).
        """
        directions = np.stack([2 * depth * depth - 1, 2 * x * depth, 2 * y * depth], axis=-1)
        return project_mirrored(directions, 4 * values[None], n_bands)
