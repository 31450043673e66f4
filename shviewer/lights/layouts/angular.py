"""The angular map, also called light probe: the angle from the direction ahead is pi times the radius [Debevec].

With X to the right and Y up in units of half the side, and r their distance from the centre,
    direction = (cos(pi r), -X sin(pi r) / r, Y sin(pi r) / r),   density = pi sin(pi r) / r,
entire functions of X and Y: one patch for all texels that the rim does not cut.

[Debevec] P. Debevec, "Light Probe Image Gallery", www.pauldebevec.com/Probes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.chebyshev import chebyshev_points, chebyshev_shares
from shviewer.harmonics.areas.patches import project_mirrored, quadrant_weights
from shviewer.harmonics.basis import Array
from shviewer.harmonics.quadrature import gauss_unit
from shviewer.lights.layouts.disc import DiscLayout
from shviewer.lights.layouts.rim import project_rim

DENSITY_POINTS = 28
"""Chebyshev points a side that make density and height times density exact to rounding in a quadrant."""

AREA_POINTS = 14
"""Gauss's points a side of a texel, exact for such a polynomial."""


FEWEST_TEXELS = 128
"""The smallest side of an image that is projected as it is."""


@dataclass(frozen=True)
class AngularLayout(DiscLayout):
    """A disc whose radius is the angle to the direction ahead, over pi."""

    name: str = "angular"

    def radius(self, theta: Array) -> Array:
        return theta / np.pi

    def theta(self, radius: Array) -> Array:
        return radius * np.pi

    def _on_line(self, y: Array, x: Array, depth: Array) -> Array:
        radius = np.hypot(x, y)
        from_rim = np.pi * depth**2 / (1 + radius)
        return np.stack([-np.cos(from_rim), x * np.sin(from_rim) / radius, y * np.sin(from_rim) / radius])

    def from_behind(self, depth: Array) -> Array:
        return np.asarray(np.pi * depth**2 / (1 + np.sqrt(1 - depth**2)))

    def whole_solid_angles(self) -> Array:
        return self._integrals(lambda x, y: self.density(np.hypot(x, y)))

    def whole_rises(self) -> Array:
        return self._integrals(lambda x, y: np.pi**3 * y * np.sinc(np.hypot(x, y)) ** 2)

    def _integrals(self, function: Callable[[Array, Array], Array]) -> Array:
        """Those of a function of X and Y over the texels of a quadrant: a matrix product, as it is a polynomial to rounding."""
        low, size = self.edges[:-1], np.diff(self.edges)
        nodes, weights = gauss_unit(AREA_POINTS)
        places = low + size * nodes[:, None]
        shares = chebyshev_shares(2 * places.ravel() - 1, DENSITY_POINTS).reshape(DENSITY_POINTS, *places.shape)
        by_texel = np.einsum("ngt,g,t->nt", shares, weights, size)
        points = (1 + chebyshev_points(DENSITY_POINTS)) / 2
        return np.asarray(by_texel.T @ function(points, points[:, None]) @ by_texel)

    def density(self, radius: Array) -> Array:
        return np.asarray(np.pi**2 * np.sinc(radius))

    def project(self, pixels: NDArray[np.float32], n_bands: int) -> Array:
        """As in Layout."""
        if self.side < FEWEST_TEXELS:  # as a larger image of the same areas, whose rim is far from the poles
            times = -(-FEWEST_TEXELS // self.side)
            finer = pixels.repeat(times, axis=0).repeat(times, axis=1)
            return replace(self, side=times * self.side).project(finer, n_bands)
        return self._project_whole(pixels, n_bands) + project_rim(self, self._on_line, pixels, self.whole, n_bands)

    def _project_whole(self, pixels: NDArray[np.float32], n_bands: int) -> Array:
        """Coefficients (n**2, 3) of the texels that the rim does not cut."""
        row = np.arange(self.side)
        count = self.whole[np.where(row < self.side // 2, self.half - 1 - row, row - self.side // 2)]
        spans = np.stack([self.half - count, self.side // 2 + count], axis=1)
        points, weights = quadrant_weights(pixels, quadrant_point_count(n_bands), spans)
        y, x = (a.ravel() for a in np.meshgrid(points, points, indexing="ij"))
        radius = np.hypot(x, y)
        density = self.density(radius)
        directions = np.stack([np.cos(np.pi * radius), x * density / np.pi, y * density / np.pi], axis=-1)
        values = weights.swapaxes(0, 1).reshape(2, 2, -1, 3) * density[:, None]
        return project_mirrored(directions, values[None], n_bands)


def quadrant_point_count(n_bands: int) -> int:
    """Chebyshev points a side that make a quadrant of the disc exact to rounding; fitted to measurements."""
    return 27 + int(np.ceil(1.78 * n_bands))
