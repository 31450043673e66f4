"""The angular map, also called light probe: the angle from the direction ahead is pi times the radius [Debevec].

With X to the right and Y up in units of half the side, and r their distance from the centre,
    direction = (cos(pi r), -X sin(pi r) / r, Y sin(pi r) / r),   density = pi sin(pi r) / r,
entire functions of X and Y: one patch for the whole disc.

[Debevec] P. Debevec, "Light Probe Image Gallery", www.pauldebevec.com/Probes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.patches import chebyshev_points, chebyshev_shares, project_mirrored, quadrant_weights
from shviewer.lights.layouts.disc import DiscLayout
from shviewer.lights.layouts.layout import Indices

SMALLEST_SIDE = 16
"""The side below which an image's texels are divided, so that none on the rim needs many points."""


@dataclass(frozen=True)
class AngularLayout(DiscLayout):
    name: str = "angular"

    def radius(self, theta: Array) -> Array:
        return theta / np.pi

    def theta(self, radius: Array) -> Array:
        return radius * np.pi

    @cached_property
    def quadrant_solid_angles(self) -> Array:
        quadrant = np.zeros((self.half, self.half))
        low, size = self.edges[:-1], np.diff(self.edges)
        nodes, weights = np.polynomial.legendre.leggauss(_whole_point_count(self.side))
        for x_node, x_weight in zip((1 + nodes) / 2, weights / 2, strict=True):
            for y_node, y_weight in zip((1 + nodes) / 2, weights / 2, strict=True):
                radius = np.hypot(low + size * x_node, (low + size * y_node)[:, None])
                quadrant += (x_weight * y_weight * np.pi**2) * np.sinc(radius)
        quadrant *= size * size[:, None]
        quadrant[np.arange(self.half) >= self.whole[:, None]] = 0.0
        n_points = 20 if self.side < SMALLEST_SIDE else self._rim_point_count(1)
        for rows, columns in self.rim_blocks(*self.cut, n_points):
            points = self.rim(rows, columns, n_points)
            area = points.weights * np.pi**2 * np.sinc(np.hypot(points.x, points.y))
            quadrant[rows, columns] = np.bincount(points.texels, area.sum(axis=1), minlength=len(rows))
        return quadrant

    def project(self, pixels: NDArray[np.float32], n_bands: int) -> Array:
        """The disc in one patch, except the texels on the rim, which have points of their own."""
        if self.side < SMALLEST_SIDE:
            times = -(-SMALLEST_SIDE // self.side)
            return AngularLayout(times * self.side).project(pixels.repeat(times, axis=0).repeat(times, axis=1), n_bands)
        row = np.arange(self.side)
        inside = self.whole[np.where(row < self.side // 2, self.half - 1 - row, row - self.side // 2)]
        spans = np.stack([self.half - inside, self.side // 2 + inside], axis=1)
        points, weights = quadrant_weights(pixels, quadrant_point_count(n_bands), spans)
        y, x = (a.ravel() for a in np.meshgrid(points, points, indexing="ij"))
        coefficients = self._add(x, y, weights.swapaxes(0, 1).reshape(2, 2, -1, 3), n_bands)
        n_points = self._rim_point_count(n_bands)
        for at_rows, at_columns in self.rim_blocks(*self.cut, n_points):
            x, y, areas = self._rim_shares(at_rows, at_columns, n_points)
            texels = self.mirrored(pixels, at_rows, at_columns)[:, :, :, None, None] * areas[..., None]
            coefficients += self._add(x.ravel(), y.ravel(), texels.reshape(2, 2, -1, 3), n_bands)
        return coefficients

    def _rim_shares(self, rows: Indices, columns: Indices, n_points: int) -> tuple[Array, Array, Array]:
        """x, y and areas, (k, n, n) each, of a few points on each texel that the rim cuts.

        The kernel goes on smoothly outside the disc, so its integral over the part inside follows from these values.
        """
        rim, n_shares = self.rim(rows, columns, n_points), n_points - 2
        middle, half = (self.edges[:-1] + self.edges[1:]) / 2, np.diff(self.edges) / 2
        of = rim.texels[:, None]
        across = chebyshev_shares((rim.x - middle[columns][of]) / half[columns][of], n_shares)
        upward = chebyshev_shares((rim.y - middle[rows][of]) / half[rows][of], n_shares)
        areas = np.zeros((len(rows), n_shares, n_shares))
        np.add.at(areas, rim.texels, (upward * rim.weights[..., None]).swapaxes(1, 2) @ across)
        points = chebyshev_points(n_shares)
        x, y = (middle[at][:, None] + half[at][:, None] * points for at in (columns, rows))
        return np.broadcast_to(x[:, None, :], areas.shape), np.broadcast_to(y[:, :, None], areas.shape), areas

    def _add(self, x: Array, y: Array, values: Array, n_bands: int) -> Array:
        """Coefficients (n**2, 3) of values (2, 2, k, 3) per area: world +y and -y, +z and -z, at distances x sideways and y up
        or down (k,).
        """
        radius = np.hypot(x, y)
        density = np.pi**2 * np.sinc(radius)
        directions = np.stack([np.cos(np.pi * radius), x * density / np.pi, y * density / np.pi], axis=-1)
        return project_mirrored(directions, (values * density[:, None])[None], n_bands)

    def _rim_point_count(self, n_bands: int) -> int:
        """Points a side of each piece that make the texels on the rim exact to rounding; fitted to measurements.

        For the kernel on a whole texel, two fewer a side suffice.
        """
        phase = np.pi * n_bands / self.side
        return int(np.ceil(6 + 16 * self.side**-0.4 + 1.1 * phase + 3 * np.sqrt(phase)))


def _whole_point_count(side: int) -> int:
    """Points a side of a whole texel that make its area exact to rounding, by the error term of Gauss's rule."""
    return 14 if side < SMALLEST_SIDE else 6 if side < 512 else 3


def quadrant_point_count(n_bands: int) -> int:
    """Chebyshev points a side that make a quadrant of the disc exact to rounding; fitted to measurements."""
    return 27 + int(np.ceil(1.78 * n_bands))
