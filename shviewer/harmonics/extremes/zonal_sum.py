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
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, count_bands, normalise
from shviewer.harmonics.extremes.bands import band_heights
from shviewer.harmonics.filters import per_coefficient
from shviewer.harmonics.quadrature import directions_from_angles
from shviewer.harmonics.theta_series import theta_series
from shviewer.harmonics.zonal import Constant, Profile, orient

Indices = NDArray[np.int64]

FEWEST_BINS, BINS_A_BAND = 1024, 64
"""Bins of a table: 64 a band, so that a wave moves by no more than 0.05 radians in one."""

ROOT_ROWS = 16
"""Rows of boxes to begin with."""

PARTS, LEVELS = 4, 6
"""The parts of a box along each side, and how often boxes are looked at."""

MOST_BOXES, LOOKS = 256, 32
"""The most boxes that are divided at a time, and those that are looked into."""

NOTHING = 1e-24
"""A band with less than this share of the energy is rounding, and has no factor."""

EDGE = 1e-9
"""The distance from an edge, relative to its angle, of a direction that is next to it."""

MARGIN = 1.01
"""Second derivatives are taken at the ends of bins; in between they may be this much larger."""


@dataclass(frozen=True, eq=False)
class Table:
    """A function d of the angle to an axis, in bins of equal width from 0 to pi; at an edge it may jump or bend."""

    width: float
    ends: Array
    """Values at the ends of the bins, (bins + 1,)."""
    ranges: Array
    """In each bin: minus the lowest value, the highest, the largest |d'|, and the largest second derivative along any great
    circle, which is infinite in the bin of an edge; (4, bins).
    """
    edge: float
    """The angle of the edge; 4, beyond pi, if there is none."""
    sides: tuple[float, float]
    """Values just inside and just outside of the edge."""

    @classmethod
    def make(cls, profile: Profile | None, zonal: Array) -> Table:
        """The table of profile - sum of zonal(l) (2l+1)/4pi P(l), zonal: (n,); without a profile, of minus that sum."""
        n_bands = len(zonal)
        bins = max(FEWEST_BINS, 1 << int(np.ceil(np.log2(BINS_A_BAND * n_bands))))
        width, l = np.pi / bins, np.arange(n_bands)
        series = (zonal * np.sqrt((2 * l + 1) / (4 * np.pi))) @ theta_series(n_bands)[0]  # Y(l, 0) in cos(k theta)
        waves = np.fft.fft(np.stack([series, l * series, l * l * series]), 2 * bins)[:, : bins + 1]
        angle = width * np.arange(bins + 1)
        values, slope, bend = -waves[0].real, -waves[1].imag, waves[2].real
        between = (n_bands - 1) ** 2 * width**2 / 8  # the share of a wave that is lost between the ends of a bin
        wave = float(np.ptp(values)) / 2
        lit, lit_slope, lit_bend, rough = _along(profile, bins)
        total, slope, bend = values + lit, slope + lit_slope, np.abs(bend + lit_bend)
        bend[1:-1] = np.maximum(bend[1:-1], np.abs(slope[1:-1]) * np.abs(1 / np.tan(angle[1:-1])))
        bend = MARGIN * np.maximum(bend[:-1], bend[1:]) + (n_bands - 1) ** 2 * wave * between + rough * width**2 / 8
        slope = np.maximum(np.abs(slope[:-1]), np.abs(slope[1:])) + bend * width
        room = bend * width**2 / 8
        low, high = np.minimum(total[:-1], total[1:]) - room, np.maximum(total[:-1], total[1:]) + room
        edge, sides = 4.0, (0.0, 0.0)
        if profile is not None:  # it never rises, so that its ends bound it even where it bends too much
            low = np.maximum(low, np.minimum(values[:-1], values[1:]) + lit[1:] - wave * between)
            high = np.minimum(high, np.maximum(values[:-1], values[1:]) + lit[:-1] + wave * between)
            if profile.half_angle < np.pi:
                edge = profile.half_angle
                outside = -float(series @ np.cos(l * edge))
                sides = outside + float(profile.along(np.array(_beside(edge), dtype=np.float64))[0][0]), outside
                at = np.unique(np.minimum((np.array(_beside(edge)) / width).astype(np.int64), bins - 1))
                low[at], high[at] = np.minimum(low[at], min(sides)), np.maximum(high[at], max(sides))
                bend[at] = np.inf
        return cls(width, total, np.stack([-low, high, slope, bend]), edge, sides)

    def window(self, radius: float) -> Array:
        """`ranges` over all bins within `radius` of each."""
        reach = int(np.ceil(radius / self.width))
        padded = np.pad(self.ranges, ((0, 0), (reach, reach)), mode="edge")
        span, wanted = 1, 2 * reach + 1
        while span < wanted:
            step = min(span, wanted - span)
            padded = np.maximum(padded[:, :-step], padded[:, step:])
            span += step
        return padded

    def bins(self, angle: Array) -> Indices:
        return np.asarray(np.minimum((angle / self.width).astype(np.int64), self.ranges.shape[1] - 1))

    def at(self, angle: Array) -> Array:
        place = angle / self.width
        bin_ = self.bins(angle)
        start = self.ends[bin_]
        return np.asarray(start + (self.ends[bin_ + 1] - start) * (place - bin_))


@dataclass(frozen=True, eq=False)
class Lobes:
    """A light that is the sum of radiance(i) profile(i) about axes; axes and radiance (k, 3)."""

    profiles: Sequence[Profile]
    axes: Array
    radiance: Array

    def factors(self, shown: Array) -> tuple[Array, float]:
        """Coefficients shown (n**2, 3) as a factor a band times the light's own, and a rest.

        Returns lambda(l) of the profiles times those factors, (lobes, n), and a bound of the rest's values.
        """
        zonal = np.stack([profile.zonal(count_bands(shown)) for profile in self.profiles])
        exact = orient(zonal, self.axes).T @ self.radiance
        first = np.arange(zonal.shape[1]) ** 2
        power, along = (np.add.reduceat((exact * other).sum(axis=1), first) for other in (exact, shown))
        kept = power > NOTHING * power.sum()
        factors = np.where(kept, along / np.where(kept, power, 1), 0)
        return zonal * factors, float(band_heights(shown - per_coefficient(factors) * exact).sum())

    def error(self, zonal: Array) -> ZonalSum:
        """The light minus the reconstruction of lambda(l), (lobes, n)."""
        return self._sum(self.profiles, zonal)

    def shade(self, zonal: Array) -> ZonalSum:
        """Minus that reconstruction."""
        return self._sum([None] * len(zonal), zonal)

    def rings(self, count: int) -> Array:
        """`count` directions just inside and as many just outside of each lobe's edge, and of those where two cross, (k, 3)."""
        turn = 2 * np.pi / count * np.arange(count)[:, None]
        found = [np.zeros((0, 3))]
        edged = [lobe for lobe in zip(self.profiles, self.axes, strict=True) if lobe[0].half_angle < np.pi]
        for number, (profile, axis) in enumerate(edged):
            for other, second in edged[:number]:
                found += _crossings(
                    axis, second, np.cos(_beside(profile.half_angle)), np.cos(_beside(other.half_angle))
                )
            side = normalise(np.cross(axis, np.eye(3)[int(np.abs(axis).argmin())]))
            ring = np.cos(turn) * side + np.sin(turn) * np.cross(axis, side)
            found += [np.cos(angle) * axis + np.sin(angle) * ring for angle in _beside(profile.half_angle)]
        return np.concatenate(found)

    def _sum(self, profiles: Sequence[Profile | None], zonal: Array) -> ZonalSum:
        constant = np.array([isinstance(profile, Constant) for profile in self.profiles])
        axes = np.where(constant[:, None], self.axes[int(constant.argmin())], self.axes)  # any axis is theirs
        return ZonalSum([Table.make(*lobe) for lobe in zip(profiles, zonal, strict=True)], axes, self.radiance)


@dataclass(frozen=True, eq=False)
class ZonalSum:
    """D(x) = sum of radiance(i) table(i)(angle of x and axis i); axes (k, 3), radiance (k, 3)."""

    tables: Sequence[Table]
    axes: Array
    radiance: Array

    def largest(self, tolerance: float, negligible: float, *, magnitude: bool) -> tuple[Array, float]:
        """Directions (j, 3) near which the largest value of a channel is, or the largest magnitude, and a bound of it.

        The bound ends above what is found by about `tolerance`, relative to it, or by `negligible`.
        """
        if (np.abs(self.axes @ self.axes[0]) > 1 - 1e-15).all():
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
                angles += [angle if forward > 0 else np.pi - angle for angle in _beside(table.edge)]
        across = next(np.cross(self.axes[0], unit) for unit in np.eye(3)[np.argsort(np.abs(self.axes[0]))])
        across /= np.linalg.norm(across)
        angle = np.array(angles)[:, None]
        return np.cos(angle) * self.axes[0] + np.sin(angle) * across, float(bounds.max())

    def _bounds(
        self, theta: Array, phi: Array, half: float, magnitude: bool, enough: float
    ) -> tuple[Array, NDArray[np.bool_]]:
        """Bounds (k,) of boxes that reach `half` radians from their middles, and which lobes' edges may cross them, (k, lobes).

        Boxes whose ranges alone stay below `enough` are not looked at again.
        """
        middles = directions_from_angles(theta, phi)
        windows, ends = [], []
        for table, axis, radiance in zip(self.tables, self.axes, self.radiance, strict=True):
            window = table.window(half * np.sqrt(2)).take(table.bins(_angle(middles, axis)), axis=1)
            windows.append(window)
            ends.append(np.sort(np.stack([-window[0], window[1]])[..., None] * radiance, axis=0))
        low, high = np.sum(ends, axis=0)
        bounds = (np.maximum(high, -low) if magnitude else high).max(axis=1)
        crossed = ~np.isfinite([window[3] for window in windows]).T
        open_ = np.flatnonzero(bounds > enough)
        theta, low, high = theta[open_], low[open_], high[open_]
        corners = directions_from_angles(
            theta[:, None] + half * np.array([-1, -1, 1, 1]), phi[open_, None] + half * np.array([-1, 1, -1, 1])
        )
        smooth, bend, slope = np.zeros((len(theta), 4, 3)), np.zeros((len(theta), 3)), np.zeros((len(theta), 3))
        low_there, high_there = np.zeros((2, len(theta), 3))
        for lobe, (table, axis, radiance) in enumerate(zip(self.tables, self.axes, self.radiance, strict=True)):
            edge = crossed[open_, lobe, None]
            low_there += edge * ends[lobe][0, open_]
            high_there += edge * ends[lobe][1, open_]
            bend += np.where(edge, 0, windows[lobe][3, open_, None]) * np.abs(radiance)
            slope += np.where(edge, 0, windows[lobe][2, open_, None]) * np.abs(radiance)
            smooth += np.where(edge, 0, table.at(_angle(corners, axis)))[..., None] * radiance
        sine = np.minimum(1, np.abs(np.sin(theta)) + half)[:, None]
        room = half**2 / 2 * (bend + sine * (sine * bend + slope)) + bend * self.tables[0].width ** 2 / 8
        high = np.minimum(high, smooth.max(axis=1) + room + high_there)
        if magnitude:
            high = np.maximum(high, -np.maximum(low, smooth.min(axis=1) - room + low_there))
        bounds[open_] = np.minimum(bounds[open_], high.max(axis=1))
        return bounds, crossed

    def _seen(self, middles: Array, crossed: NDArray[np.bool_], magnitude: bool) -> tuple[Array, Array]:
        """Directions in boxes, their middles and next to the edges that cross them, and the values there."""
        points, fixed = [middles], [(-1, slice(0, 0), 0.0)]
        for lobe, (table, axis) in enumerate(zip(self.tables, self.axes, strict=True)):
            near = middles[crossed[:, lobe]]
            across = near - (near @ axis)[:, None] * axis
            length = np.linalg.norm(across, axis=1)
            across = across[length > 1e-9] / length[length > 1e-9, None]
            for angle, value in zip(_beside(table.edge), table.sides, strict=True):
                start = sum(map(len, points))
                points.append(np.cos(angle) * axis + np.sin(angle) * across)
                fixed.append((lobe, slice(start, start + len(across)), value))
        directions = np.concatenate(points)
        total = np.zeros((len(directions), 3))
        for lobe, (table, axis, radiance) in enumerate(zip(self.tables, self.axes, self.radiance, strict=True)):
            values = table.at(_angle(directions, axis))
            for other, which, value in fixed:
                if other == lobe:
                    values[which] = value
            total += values[:, None] * radiance
        return directions, (np.abs(total) if magnitude else total).max(axis=1)


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


def _angle(directions: Array, axis: Array) -> Array:
    return np.asarray(np.arccos(np.clip(directions @ axis, -1, 1)))


def _beside(edge: float) -> tuple[float, float]:
    """Angles just inside and just outside of an edge."""
    return edge * (1 - EDGE), edge * (1 + EDGE)


@lru_cache(maxsize=256)
def _along(profile: Profile | None, bins: int) -> tuple[Array, Array, Array, Array]:
    """A profile at the ends of the bins, its first and second derivative there, and the fourth in the bins."""
    if profile is None:
        return (np.zeros(bins + 1),) * 3 + (np.zeros(bins),)
    value, slope, bend, fourth = profile.along(np.linspace(0, np.pi, bins + 1))
    return value, slope, bend, np.maximum(fourth[:-1], fourth[1:])
