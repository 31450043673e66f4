"""The angular map, also called light probe: the angle from the direction ahead is pi times the radius [Debevec].

With X to the right and Y up in units of half the side, and r their distance from the centre,
    direction = (cos(pi r), -X sin(pi r) / r, Y sin(pi r) / r),   density = pi sin(pi r) / r,
entire functions of X and Y: one patch for all texels that the rim does not cut.

[Debevec] P. Debevec, "Light Probe Image Gallery", www.pauldebevec.com/Probes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.patches import project_mirrored, quadrant_weights
from shviewer.harmonics.basis import Array, Indices
from shviewer.lights.layouts.disc import DiscLayout


@dataclass(frozen=True)
class AngularLayout(DiscLayout):
    name: str = "angular"

    def radius(self, theta: Array) -> Array:
        return theta / np.pi

    def theta(self, radius: Array) -> Array:
        return radius * np.pi

    def on_line(self, y: Array, x: Array, depth: Array) -> tuple[Array, Array]:
        radius = np.hypot(x, y)
        from_rim = np.pi * depth**2 / (1 + radius)
        cosine, sine = -np.cos(from_rim), np.sin(from_rim)
        scale, turning = sine / radius, -x * depth / radius  # and dr/dt
        growth = turning * (np.pi * cosine - scale) / radius  # d(scale)/dt
        direction = np.stack([cosine, x * scale, y * scale])
        return direction, np.stack([-np.pi * sine * turning, x * growth - depth * scale, y * growth])

    def opening(self, depth: Array) -> Array:
        return np.asarray(2 * np.sin(np.pi / 2 * depth**2 / (1 + np.sqrt(1 - depth**2))) ** 2)

    def whole_solid_angles(self) -> Array:
        quadrant = np.zeros((self.half, self.half))
        low, size = self.edges[:-1], np.diff(self.edges)
        nodes, weights = np.polynomial.legendre.leggauss(_whole_point_count(self.side))
        for x_node, x_weight in zip((1 + nodes) / 2, weights / 2, strict=True):
            for y_node, y_weight in zip((1 + nodes) / 2, weights / 2, strict=True):
                radius = np.hypot(low + size * x_node, (low + size * y_node)[:, None])
                quadrant += (x_weight * y_weight * np.pi**2) * np.sinc(radius)
        return np.asarray(quadrant * size * size[:, None])

    def inside(self) -> Indices:
        return self.whole

    def project_inside(self, pixels: NDArray[np.float32], inside: Indices, n_bands: int) -> Array:
        row = np.arange(self.side)
        count = inside[np.where(row < self.side // 2, self.half - 1 - row, row - self.side // 2)]
        spans = np.stack([self.half - count, self.side // 2 + count], axis=1)
        points, weights = quadrant_weights(pixels, quadrant_point_count(n_bands), spans)
        y, x = (a.ravel() for a in np.meshgrid(points, points, indexing="ij"))
        radius = np.hypot(x, y)
        density = np.pi**2 * np.sinc(radius)
        directions = np.stack([np.cos(np.pi * radius), x * density / np.pi, y * density / np.pi], axis=-1)
        values = weights.swapaxes(0, 1).reshape(2, 2, -1, 3) * density[:, None]
        return project_mirrored(directions, values[None], n_bands)


def _whole_point_count(side: int) -> int:
    """Points a side of a whole texel that make its area exact to rounding, by the error term of Gauss's rule."""
    return 14 if side < 16 else 6 if side < 512 else 3


def quadrant_point_count(n_bands: int) -> int:
    """Chebyshev points a side that make a quadrant of the disc exact to rounding; fitted to measurements."""
    return 27 + int(np.ceil(1.78 * n_bands))
