"""The angular map, also called light probe: the angle from the direction ahead is pi times the radius [Debevec].

With X to the right and Y up in units of half the side, and r their distance from the centre,
    direction = (cos(pi r), -X sin(pi r) / r, Y sin(pi r) / r),   density = pi sin(pi r) / r,
entire functions of X and Y: one patch for the whole disc.

[Debevec] P. Debevec, "Light Probe Image Gallery", www.pauldebevec.com/Probes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.patches import project_mirrored, quadrant_weights
from shviewer.lights.layouts.disc import DiscLayout


@dataclass(frozen=True)
class AngularLayout(DiscLayout):
    name: str = "angular"

    def radius(self, theta: Array) -> Array:
        return theta / np.pi

    def theta(self, radius: Array) -> Array:
        return radius * np.pi

    def solid_angles(self) -> Array:
        quadrant = np.zeros((self.half, self.half))
        low, size = self.edges[:-1], np.diff(self.edges)
        nodes, weights = np.polynomial.legendre.leggauss(14 if self.side < 16 else 6)
        for x_node, x_weight in zip((1 + nodes) / 2, weights / 2, strict=True):
            for y_node, y_weight in zip((1 + nodes) / 2, weights / 2, strict=True):
                radius = np.hypot(low + size * x_node, (low + size * y_node)[:, None])
                quadrant += (x_weight * y_weight * np.pi**2) * np.sinc(radius)
        quadrant *= size * size[:, None]
        quadrant[np.arange(self.half) >= self.whole[:, None]] = 0.0
        n_points = self._rim_point_count(1)
        for rows, columns in self.rim_blocks(*self.cut, n_points):
            points = self.rim(rows, columns, n_points)
            area = points.weights * np.pi**2 * np.sinc(np.hypot(points.x, points.y))
            quadrant[rows, columns] = np.bincount(points.texels, area, minlength=len(rows))
        return self.whole_sphere(quadrant)

    def project(self, pixels: NDArray[np.float32], n_bands: int) -> Array:
        """The disc in one patch, except the texels on the rim, which have points of their own."""
        row = np.arange(self.side)
        inside = self.whole[np.where(row < self.side // 2, self.half - 1 - row, row - self.side // 2)]
        spans = np.stack([self.half - inside, self.side // 2 + inside], axis=1)
        points, weights = quadrant_weights(pixels, quadrant_point_count(n_bands), spans)
        y, x = (a.ravel() for a in np.meshgrid(points, points, indexing="ij"))
        coefficients = self._add(x, y, weights.swapaxes(0, 1).reshape(2, 2, -1, 3), n_bands)
        n_points = self._rim_point_count(n_bands)
        for at_rows, at_columns in self.rim_blocks(*self.cut, n_points):
            rim = self.rim(at_rows, at_columns, n_points)
            texels = self.mirrored(pixels, at_rows, at_columns)[:, :, rim.texels] * rim.weights[:, None]
            coefficients += self._add(rim.x, rim.y, texels, n_bands)
        return coefficients

    def _add(self, x: Array, y: Array, values: Array, n_bands: int) -> Array:
        """Of values (2, 2, k, 3) per area: world +y and -y, +z and -z, at distances x sideways and y up or down (k,)."""
        radius = np.hypot(x, y)
        density = np.pi**2 * np.sinc(radius)
        directions = np.stack([np.cos(np.pi * radius), x * density / np.pi, y * density / np.pi], axis=-1)
        return project_mirrored(directions, (values * density[:, None])[None], n_bands)

    def _rim_point_count(self, n_bands: int) -> int:
        """So many points a side of each part make the texels on the rim exact to rounding; fitted to measurements."""
        phase = np.pi * n_bands / max(self.side, 2)
        return int(np.ceil(6 + 16 * max(self.side, 2) ** -0.4 + 1.1 * phase + 3.5 * phase**0.4))


def quadrant_point_count(n_bands: int) -> int:
    """So many Chebyshev points a side make a quadrant of the disc exact to rounding; fitted to measurements."""
    return 27 + int(np.ceil(1.78 * n_bands))
