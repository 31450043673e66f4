"""Extremes of a sum of functions that are each symmetric about an axis: lobes, less their bands.

If a reconstruction has the bands of a light times a factor each, it is a sum about the same axes as the light's lobes, and so
is the error: D(x) = sum of r(i) d(i)(angle of x and axis i). Each d is a table of one angle. Its ranges over a box of
directions bound D there; where no edge of a profile crosses the box, so do the box's corners, up to a bend: the second
derivative of d along any great circle is at most the larger of |d''| and |d' / tan|. Boxes that could hold more than is found
are divided.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.extremes.bands import band_heights
from shviewer.harmonics.extremes.zonal_table import Tables, ZonalTable, around_edge, beside, perpendicular
from shviewer.harmonics.filters import per_coefficient
from shviewer.harmonics.quadrature import directions_from_angles
from shviewer.harmonics.zonal import Constant, Profile, orient

ROOT_ROWS = 16
"""Rows of boxes to begin with."""

PARTS, LEVELS = 4, 6
"""The parts of a box along each side, and how often boxes are looked at."""

MOST_BOXES, LOOKS = 256, 32
"""The most boxes that are divided at a time, and those that are looked into."""

NOTHING = 1e-24
"""A band with less than this share of the energy is rounding, and has no factor."""


@dataclass(frozen=True, eq=False)
class Lobes:
    """A light that is the sum of radiance(i) profile(i) about axes; axes and radiance (k, 3)."""

    profiles: Sequence[Profile]
    axes: Array
    radiance: Array

    def values(self, directions: Array) -> Array:
        """The light in unit directions (k, 3): (k, 3)."""
        total = np.zeros((len(directions), 3))
        for profile, axis, radiance in zip(self.profiles, self.axes, self.radiance, strict=True):
            chord = directions - axis
            total += profile.value((chord * chord).sum(axis=1))[:, None] * radiance
        return total

    def zonal(self, n_bands: int) -> Array:
        """lambda(l) of the profiles, (lobes, n_bands)."""
        return np.stack([profile.zonal(n_bands) for profile in self.profiles])

    def coefficients(self, zonal: Array) -> Array:
        """Coefficients (n**2, 3) of a sum about the same axes with lambda(l) (lobes, n)."""
        return np.asarray(orient(zonal, self.axes).T @ self.radiance)

    def factors(self, shown: Array) -> tuple[Array, float]:
        """Coefficients shown (n**2, 3) as a factor a band times the light's own, and a rest.

        Returns lambda(l) of the profiles times those factors, (lobes, n), and a bound of the rest's values.
        """
        zonal = self.zonal(count_bands(shown))
        exact = self.coefficients(zonal)
        first = np.arange(zonal.shape[1]) ** 2
        power, along = (np.add.reduceat((exact * other).sum(axis=1), first) for other in (exact, shown))
        kept = power > NOTHING * power.sum()
        factors = np.where(kept, along / np.where(kept, power, 1), 0)
        return zonal * factors, float(band_heights(shown - per_coefficient(factors) * exact).max(axis=1).sum())

    def error(self, zonal: Array) -> ZonalSum:
        """The light minus the reconstruction of lambda(l), (lobes, n)."""
        return self._sum(self.profiles, zonal)

    def shade(self, zonal: Array) -> ZonalSum:
        """Minus that reconstruction."""
        return self._sum([None] * len(zonal), zonal)

    def rings(self, count: int) -> Array:
        """`count` directions just inside and as many just outside of each lobe's edge, and of those where two cross, (k, 3)."""
        found = [around_edge(*lobe, count) for lobe in zip(self.profiles, self.axes, strict=True)]
        edged = [lobe for lobe in zip(self.profiles, self.axes, strict=True) if lobe[0].half_angle < np.pi]
        for number, (profile, axis) in enumerate(edged):
            for other, second in edged[:number]:
                found += _crossings(axis, second, np.cos(beside(profile.half_angle)), np.cos(beside(other.half_angle)))
        return np.concatenate(found)

    @property
    def on_one_axis(self) -> bool:
        return bool((np.abs(self._axes @ self._axes[0]) > 1 - 1e-15).all())

    @property
    def _axes(self) -> Array:
        """The axes; constants, of which any axis is one, have that of another lobe."""
        constant = np.array([isinstance(profile, Constant) for profile in self.profiles])
        return np.where(constant[:, None], self.axes[int(constant.argmin())], self.axes)

    def _sum(self, profiles: Sequence[Profile | None], zonal: Array) -> ZonalSum:
        tables = [ZonalTable.make(*lobe) for lobe in zip(profiles, zonal, strict=True)]
        return ZonalSum(tables, self._axes, self.radiance, self.on_one_axis)


@dataclass(frozen=True, eq=False)
class ZonalSum:
    """D(x) = sum of radiance(i) table(i)(angle of x and axis i); axes (k, 3), radiance (k, 3)."""

    tables: Sequence[ZonalTable]
    axes: Array
    radiance: Array
    on_one_axis: bool

    def largest(self, tolerance: float, negligible: float, *, magnitude: bool) -> tuple[Array, float]:
        """Directions (j, 3) near which the largest value of a channel is, or the largest magnitude, and a bound of it.

        The bound ends above what is found by about `tolerance`, relative to it, or by `negligible`.
        """
        if self.on_one_axis:
            return self._along_the_axis(magnitude)
        rows = (np.arange(ROOT_ROWS) + 0.5) * np.pi / ROOT_ROWS
        theta, phi = (a.ravel() for a in np.meshgrid(rows, rows[0] * (2 * np.arange(2 * ROOT_ROWS) + 1), indexing="ij"))
        half, enough, bound = float(rows[0]), -np.inf, -np.inf
        places: list[tuple[float, Array]] = []
        for level in range(LEVELS):
            bounds, crossed = self._bounds(theta, phi, half, magnitude, enough)
            order = np.argsort(-bounds)
            look = order[:LOOKS]
            points, values = self._seen(directions_from_angles(theta[look], phi[look]), crossed[look], magnitude)
            best = int(values.argmax())
            places.append((float(values[best]), points[best]))
            enough = max(enough, float(values[best]) + max(tolerance * abs(float(values[best])), negligible))
            open_ = min(int(np.count_nonzero(bounds > enough)), MOST_BOXES if level < LEVELS - 1 else 0)
            bound = max(bound, float(bounds[order[open_:]].max(initial=-np.inf)))
            if not open_:
                break
            half /= PARTS
            steps = half * (2 * np.arange(PARTS) + 1 - PARTS)
            theta = (theta[order[:open_], None] + np.repeat(steps, PARTS)).ravel()
            phi = (phi[order[:open_], None] + np.tile(steps, PARTS)).ravel()
        return np.stack([place for _, place in sorted(places, key=lambda pair: -pair[0])]), bound

    def _along_the_axis(self, magnitude: bool) -> tuple[Array, float]:
        """`largest` where all axes are one: a search along one meridian of it."""
        along = self.axes @ self.axes[0]
        low, high = np.zeros((2, self.tables[0].ranges.shape[1], 3))
        for table, forward, radiance in zip(self.tables, along, self.radiance, strict=True):
            ends = table.ranges[:2, :: 1 if forward > 0 else -1, None] * [[[-1]], [[1]]] * radiance
            low += ends.min(axis=0)
            high += ends.max(axis=0)
        bounds = (np.maximum(high, -low) if magnitude else high).max(axis=1)
        width = self.tables[0].width
        angles = [width * (int(bounds.argmax()) + share) for share in (0, 0.5, 1)]
        for table, forward in zip(self.tables, along, strict=True):
            if table.edge < np.pi:
                angles += [angle if forward > 0 else np.pi - angle for angle in beside(table.edge)]
        angle = np.array(angles)[:, None]
        return np.cos(angle) * self.axes[0] + np.sin(angle) * perpendicular(self.axes[0]), float(bounds.max())

    def _bounds(
        self, theta: Array, phi: Array, half: float, magnitude: bool, enough: float
    ) -> tuple[Array, NDArray[np.bool_]]:
        """Bounds (k,) of boxes that reach `half` radians from their middles, and which lobes' edges may cross them, (k, lobes).

        Boxes whose ranges alone stay below `enough` are not looked at again.
        """
        windows = self._stacked.windows(half * np.sqrt(2), self._angles(directions_from_angles(theta, phi)))
        one, other = (end[..., None] * self.radiance[:, None] for end in (-windows[0], windows[1]))
        ends = np.stack([np.minimum(one, other), np.maximum(one, other)])
        low, high = ends.sum(axis=1)
        bounds = (np.maximum(high, -low) if magnitude else high).max(axis=1)
        crossed = ~np.isfinite(windows[3])
        open_ = np.flatnonzero(bounds > enough)
        theta, low, high, edge = theta[open_], low[open_], high[open_], crossed[:, open_]
        corners = directions_from_angles(
            theta[:, None] + half * np.array([-1, -1, 1, 1]), phi[open_, None] + half * np.array([-1, 1, -1, 1])
        )
        low_there, high_there = np.where(edge[..., None], ends[:, :, open_], 0).sum(axis=1)
        slope, bend = (np.where(edge, 0, part[:, open_]).T @ np.abs(self.radiance) for part in windows[2:])
        values = self._stacked.at(self._angles(corners.reshape(-1, 3))).reshape(*edge.shape, 4)
        smooth = np.tensordot(np.where(edge[..., None], 0, values), self.radiance, axes=(0, 0))
        sine = np.minimum(1, np.abs(np.sin(theta)) + half)[:, None]
        room = half**2 / 2 * (bend + sine * (sine * bend + slope)) + bend * self._stacked.width**2 / 8
        high = np.minimum(high, smooth.max(axis=1) + room + high_there)
        if magnitude:
            high = np.maximum(high, -np.maximum(low, smooth.min(axis=1) - room + low_there))
        bounds[open_] = np.minimum(bounds[open_], high.max(axis=1))
        return bounds, crossed.T

    def _seen(self, middles: Array, crossed: NDArray[np.bool_], magnitude: bool) -> tuple[Array, Array]:
        """Directions in boxes, their middles and next to the edges that cross them, and the values there."""
        points, fixed = [middles], []
        for lobe, (table, axis) in enumerate(zip(self.tables, self.axes, strict=True)):
            near = middles[crossed[:, lobe]]
            across = near - (near @ axis)[:, None] * axis
            length = np.linalg.norm(across, axis=1)
            across = across[length > 1e-9] / length[length > 1e-9, None]
            for angle, value in zip(beside(table.edge), table.sides, strict=True):
                start = sum(map(len, points))
                points.append(np.cos(angle) * axis + np.sin(angle) * across)
                fixed.append((lobe, slice(start, start + len(across)), value))
        directions = np.concatenate(points)
        values = self._stacked.at(self._angles(directions))
        for lobe, which, value in fixed:
            values[lobe, which] = value
        total = values.T @ self.radiance
        return directions, (np.abs(total) if magnitude else total).max(axis=1)

    @cached_property
    def _stacked(self) -> Tables:
        return Tables(self.tables)

    def _angles(self, directions: Array) -> Array:
        """The angles of unit directions (k, 3) from each axis, (lobes, k)."""
        return np.asarray(np.arccos(np.clip(self.axes @ directions.T, -1, 1)))


def _crossings(one: Array, two: Array, near: Array, far: Array) -> list[Array]:
    """The directions where circles x . one = p and x . two = q cross, p each of near and q each of far: pairs, (2, 3) each."""
    along, across = float(one @ two), np.cross(one, two)
    apart = 1 - along * along
    found = []
    if apart > 1e-12:
        for p, q in product(near, far):
            a, b = (p - along * q) / apart, (q - along * p) / apart
            height = (1 - a * p - b * q) / apart
            if height > 0:
                found.append(a * one + b * two + np.array([[1], [-1]]) * np.sqrt(height) * across)
    return found
