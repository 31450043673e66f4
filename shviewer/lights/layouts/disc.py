"""The base of the angular map and the mirror ball: the sphere within a disc, symmetric about the direction ahead.

The centre of the image looks along +x. A direction at the angle theta from there lies at a radius that depends on theta
alone, 1 (the rim, half the image's side) for straight back, and on the side where it is seen: the image's right is -y, its
top +z, as in all layouts. Texels outside the disc show nothing.

HDRShop and the published probes use the same two layouts, not mirrored against their lat-long images. (A photograph of a
mirror ball shows left and right exchanged, like any mirror: turn it over first.)
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.patches import above_the_middle, four_quadrants, quadrant_edges
from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, row_angles
from shviewer.lights.layouts.bilinear import between_texels
from shviewer.lights.layouts.layout import RASTER_BLOCK
from shviewer.lights.layouts.rim import Disc, cut_areas, cut_rises
from shviewer.lights.layouts.texels import FAR, integrate_texels

ON_THE_RIM = 1e-14
"""Corners that are this near the rim do not cross it, on whichever side rounding puts them."""


@dataclass(frozen=True)
class DiscLayout(Disc):
    """A layout within a disc. side: texels of the square image. The subclasses say how the radius follows from theta."""

    side: int
    name: str = ""

    @property
    def size(self) -> str:
        return f"{self.side} x {self.side}"

    @property
    def raster_width(self) -> int:
        """Columns of a lat-long image that is nowhere much coarser than this one."""
        return 2 * self.side

    @abstractmethod
    def radius(self, theta: Array) -> Array:
        """The radius, in [0, 1], of directions at an angle from the direction ahead, in radians; of the same shape."""

    @abstractmethod
    def theta(self, radius: Array) -> Array:
        """The angle of a radius, radians: the inverse of `radius`."""

    def nearest(self, directions: Array) -> tuple[Indices, Indices]:
        down, right, _ = self._places(directions)
        return self._texel(down), self._texel(right)

    def _places(self, directions: Array) -> tuple[Array, Array, Array]:
        """Down and right, in [-1, 1] within the image, and the radius there, (k,) each, of unit directions (k, 3)."""
        x, y, z = np.ascontiguousarray(directions.T)
        across = np.hypot(y, z)
        radius = self.radius(np.arctan2(across, x))
        scale = np.divide(radius, across, where=across > 0, out=np.zeros_like(across))
        return -z * scale, np.where((across == 0) & (x < 0), 1.0, -y * scale), radius

    def _texel(self, position: Array) -> Indices:
        return np.clip(((1 + position) / 2 * self.side).astype(np.int64), 0, self.side - 1)

    def centres(self, rows: Indices, columns: Indices) -> Array:
        """As in Layout; if the centre is outside the disc, another point of the texel, and if all of it is, straight back."""
        right, down = ((2 * index + 1) / self.side - 1 for index in (columns, rows))
        radius = np.hypot(right, down)
        inner_right, inner_down = (np.sign(a) * np.maximum(np.abs(a) - 1 / self.side, 0) for a in (right, down))
        inner = np.hypot(inner_right, inner_down)
        outside = (radius >= 1) & (inner < 1)
        share = np.where(outside, (1 - inner) / 2 / np.maximum(radius - inner, 1e-300), 1.0)
        right, down = inner_right + share * (right - inner_right), inner_down + share * (down - inner_down)
        return self._directions(right, down)

    def _directions(self, right: Array, down: Array) -> Array:
        """Unit directions (k, 3) at points of the square [-1, 1]^2; outside the disc straight back."""
        radius = np.hypot(right, down)
        theta = self.theta(np.minimum(radius, 1))
        across = np.where(radius < 1, np.sin(theta), 0.0)
        scale = np.divide(across, radius, where=radius > 0, out=np.zeros_like(radius))
        return np.stack([np.cos(theta), -right * scale, -down * scale], axis=-1)

    def solid_angles(self) -> Array:
        return four_quadrants(self.quadrant_solid_angles, self.side)

    def solid_angles_at(self, rows: Indices, columns: Indices) -> Array:
        inside, edge = self.side // 2, self.half - 1
        row, column = (np.where(index < inside, edge - index, index - inside) for index in (rows, columns))
        halves = self.side % 2 * ((row == 0).astype(np.int64) + (column == 0))
        return np.asarray(self.quadrant_solid_angles[row, column] * 2**halves)

    @cached_property
    def quadrant_solid_angles(self) -> Array:
        """Steradians of the texels of the lower right quadrant, (half, half); the middle ones of an odd number count half."""
        return self._with_cut(self.whole_solid_angles(), cut_areas)

    def rises(self) -> Array:
        return four_quadrants(self._with_cut(self.whole_rises(), cut_rises), self.side) * above_the_middle(self.side)

    def _with_cut(self, quadrant: Array, cut: Callable[[Disc, Indices, Indices], Array]) -> Array:
        """The integrals over whole texels, and those over texels that the rim cuts."""
        quadrant[np.arange(self.half) >= self.whole[:, None]] = 0.0
        at_rim = self.from_column(self.whole)
        quadrant[at_rim] = cut(self, *at_rim)
        return quadrant

    @abstractmethod
    def whole_solid_angles(self) -> Array:
        """The same for texels wholly inside the disc; anything for others."""

    @abstractmethod
    def whole_rises(self) -> Array:
        """The integrals of the distance from the horizon over the texels of a quadrant; of those wholly inside."""

    def sample(self, pixels: NDArray[np.float32], directions: Array) -> NDArray[np.float32]:
        """As in Layout. Texels whose centres are outside the disc do not count: beyond the rim comes the opposite side."""
        return self._between(pixels, *self._places(directions))

    def _between(self, pixels: NDArray[np.float32], below: Array, beside: Array, radius: Array) -> NDArray[np.float32]:
        """Radiance (k, 3) at places and radii as in `_places`."""
        row, column = ((1 + place) / 2 * self.side - 0.5 for place in (below, beside))
        left, top = np.floor(column), np.floor(row)
        down, right = row - top, column - left
        result = between_texels(pixels, top.astype(np.int64), left.astype(np.int64), down, right)
        rim = np.flatnonzero(radius >= 1 - 3 / self.side)  # a texel's diagonal is 2.83 / side
        if len(rim):
            result[rim] = self._across_the_rim(pixels, top[rim], left[rim], down[rim], right[rim])
        return result

    def raster(self, pixels: NDArray[np.float32], height: int, width: int) -> NDArray[np.float32]:
        """As in Layout: above and below, left and right are at the same places but for their signs."""
        texels = np.empty((height, width, 3), dtype=np.float32)
        theta, phi = row_angles(height)[: (height + 1) // 2], column_azimuths(width)[: (width + 1) // 2]
        block = max(1, RASTER_BLOCK // len(phi))
        for start in range(0, len(theta), block):
            some = theta[start : start + block, None]
            below, beside, radius = self._places(directions_from_angles(some, phi).reshape(-1, 3))
            for part, down in ((texels, 1), (texels[::-1], -1)):
                for view, right in ((part, 1), (part[:, ::-1], -1)):
                    found = self._between(pixels, down * below, right * beside, radius)
                    view[start : start + len(some), : len(phi)] = found.reshape(len(some), -1, 3)
        return texels

    def _across_the_rim(self, pixels: NDArray[np.float32], top: Array, left: Array, down: Array, right: Array) -> Array:
        """Radiance (k, 3) where some of the four texels may have their centres outside."""
        total = np.zeros((len(top), 3))
        for below, beside in np.ndindex(2, 2):
            weight = np.abs(1 - beside - right) * np.abs(1 - below - down)
            total += weight[:, None] * self._beyond_the_rim(pixels, top + below, left + beside)
        return total

    def _beyond_the_rim(self, pixels: NDArray[np.float32], rows: Array, columns: Array) -> Array:
        """Texels (k, 3); in place of a centre at radius r > 1, the texel near 2 - r on the opposite side, its centre inside."""
        right, down = ((2 * index + 1) / self.side - 1 for index in (columns, rows))
        radius = np.hypot(right, down)
        opposite = np.clip(2 - radius, 0, max(0.0, 1 - 1.42 / self.side)) / np.maximum(radius, 1)
        folded = np.where(radius < 1, 1.0, -opposite)
        return np.asarray(pixels[self._texel(down * folded), self._texel(right * folded)], dtype=np.float64)

    def project_texels(self, values: Array, rows: Indices, columns: Indices, n_bands: int) -> Array | None:
        """As in Layout: of texels away from the rim."""
        corner = 2 * np.stack([columns, rows]) / self.side - 1
        if np.hypot(*(corner + 1 / self.side)).max(initial=0.0) > 1 - FAR / self.side:
            return None

        def places(right: Array, down: Array) -> tuple[Array, Array]:
            x, y = corner[0] + 2 * right / self.side, corner[1] + 2 * down / self.side
            directions = self._directions(x.ravel(), y.ravel()).reshape(*x.shape, 3)
            return directions, self.density(np.hypot(x, y)) * (2 / self.side) ** 2

        return integrate_texels(places, values, n_bands, self.side**2)

    @abstractmethod
    def density(self, radius: Array) -> Array:
        """Steradians per area of the disc of radius 1."""

    # A quadrant: texels by their distance from the centre, down or up and sideways, from 0 to half.

    @property
    def half(self) -> int:
        """The number of texels from the centre to the rim, counting the middle one of an odd number."""
        return self.side - self.side // 2

    @cached_property
    def edges(self) -> Array:
        """The edges of these texels, (half + 1,), from 0 to 1."""
        return quadrant_edges(self.side)

    @cached_property
    def whole(self) -> Indices:
        """The number of texels in each row of the quadrant that lie wholly inside the disc, (half,)."""
        reach = np.sqrt(np.maximum(1 - self.edges[1:] ** 2, 0.0)) + ON_THE_RIM
        return np.searchsorted(self.edges[1:], reach, side="right")

    @cached_property
    def reach(self) -> Indices:
        """The number of texels in each row of the quadrant of which some part lies inside the disc, (half,)."""
        reach = np.sqrt(np.maximum(1 - self.edges[:-1] ** 2, 0.0)) - ON_THE_RIM
        return np.searchsorted(self.edges[:-1], reach, side="left")

    def from_column(self, first: Indices) -> tuple[Indices, Indices]:
        """Row and column of the texels of a quadrant from column first[row] on to the rim."""
        counts = self.reach - first
        rows = np.repeat(np.arange(self.half), counts)
        return rows, np.arange(len(rows)) + np.repeat(first - np.cumsum(counts) + counts, counts)
