"""A function of the angle to an axis, a profile less its bands, as a table that bounds it.

Along any great circle the second derivative of such a function d is at most the larger of |d''| and |d' / tan|. What is between
the ends of a bin of width w follows from those: d'' is no larger than there but for w^2 / 8 times the fourth derivative, d' but
for w times d''; and d' / tan is no larger than the largest |d''| between there and a pole, where d' is 0, if no edge is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from shviewer.harmonics.basis import Array, Indices, normalise
from shviewer.harmonics.theta_series import theta_series
from shviewer.harmonics.zonal import Profile

FEWEST_BINS, BINS_A_BAND = 1024, 64
"""Bins of a table: 64 a band, so that a wave moves by no more than 0.05 radians in one."""

EDGE = 1e-9
"""The distance from an edge, relative to its angle, of a direction that is next to it."""


@dataclass(frozen=True, eq=False)
class ZonalTable:
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
    def make(cls, profile: Profile | None, zonal: Array) -> ZonalTable:
        """The table of profile - sum of zonal(l) (2l+1)/4pi P(l), zonal: (n,); without a profile, of minus that sum."""
        n_bands = len(zonal)
        bins = max(FEWEST_BINS, 1 << int(np.ceil(np.log2(BINS_A_BAND * n_bands))))
        width, l = np.pi / bins, np.arange(n_bands)
        series = (zonal * np.sqrt((2 * l + 1) / (4 * np.pi))) @ theta_series(n_bands)[0]  # Y(l, 0) in cos(k theta)
        waves = np.fft.fft(np.stack([series, l * series, l * l * series]), 2 * bins)[:, : bins + 1]
        values, slope, bend = -waves[0].real, -waves[1].imag, waves[2].real
        between = (n_bands - 1) ** 2 * width**2 / 8  # the share of a wave that is lost between the ends of a bin
        wave = float(np.ptp(values)) / 2 / np.cos((n_bands - 1) * width / 2)  # [Ehlich-Zeller], see band_limited.py
        lit, lit_slope, lit_bend, rough = _along(profile, bins)
        total = values + lit
        alone = _larger(bend) + (n_bands - 1) ** 2 * wave * between
        bend = _larger(bend + lit_bend) + (n_bands - 1) ** 2 * wave * between + rough * width**2 / 8
        slope = _larger(slope + lit_slope) + bend * width
        bend = np.maximum(bend, _across(slope, bend, alone, profile.half_angle if profile is not None else np.pi))
        room = bend * width**2 / 8
        low, high = np.minimum(total[:-1], total[1:]) - room, np.maximum(total[:-1], total[1:]) + room
        edge, sides = 4.0, (0.0, 0.0)
        if profile is not None:  # it never rises, so that its ends bound it even where it bends too much
            low = np.maximum(low, np.minimum(values[:-1], values[1:]) + lit[1:] - wave * between)
            high = np.minimum(high, np.maximum(values[:-1], values[1:]) + lit[:-1] + wave * between)
            if profile.half_angle < np.pi:
                edge = profile.half_angle
                outside = -float(series @ np.cos(l * edge))
                sides = outside + float(profile.along(np.array(beside(edge), dtype=np.float64))[0][0]), outside
                at = np.unique(np.minimum((np.array(beside(edge)) / width).astype(np.int64), bins - 1))
                low[at], high[at] = np.minimum(low[at], min(sides)), np.maximum(high[at], max(sides))
                bend[at] = np.inf
        return cls(width, total, np.stack([-low, high, slope, bend]), edge, sides)


class Tables:
    """Several tables with as many bins as one array, (tables, ...)."""

    def __init__(self, tables: Sequence[ZonalTable]) -> None:
        self.width, self.count = tables[0].width, len(tables)
        self.ends, self.ranges = (
            np.stack([table.ends for table in tables]),
            np.stack([table.ranges for table in tables]),
        )

    def windows(self, radius: float, angles: Array) -> Array:
        """`ranges` over all bins within `radius` of those of angles (tables, k): (4, tables, k)."""
        reach = int(np.ceil(radius / self.width))
        bins = self.ranges.shape[2]
        padded = self.ranges.take(np.clip(np.arange(-reach, bins + reach), 0, bins - 1), axis=2)
        span, wanted = 1, 2 * reach + 1
        while span < wanted:
            step = min(span, wanted - span)
            padded = np.maximum(padded[..., :-step], padded[..., step:])
            span += step
        return np.asarray(np.take_along_axis(padded.swapaxes(0, 1), self._bins(angles)[None], axis=2))

    def at(self, angles: Array) -> Array:
        """Values of each table at its angles (tables, k): (tables, k)."""
        bins = self._bins(angles)
        first = bins + np.arange(self.count)[:, None] * self.ends.shape[1]
        start = self.ends.take(first)
        return np.asarray(start + (self.ends.take(first + 1) - start) * (angles / self.width - bins))

    def _bins(self, angles: Array) -> Indices:
        return np.asarray(np.minimum((angles / self.width).astype(np.int64), self.ranges.shape[2] - 1))


def perpendicular(axis: Array) -> Array:
    """A unit vector at right angles to the axis (3,)."""
    return normalise(np.cross(axis, np.eye(3)[int(np.abs(axis).argmin())]))


def around_edge(profile: Profile, axis: Array, count: int) -> Array:
    """`count` directions just inside and as many just outside of a profile's edge, (2 count, 3); (0, 3) if it has none."""
    if profile.half_angle >= np.pi:
        return np.zeros((0, 3))
    turn, side = 2 * np.pi / count * np.arange(count)[:, None], perpendicular(axis)
    ring = np.cos(turn) * side + np.sin(turn) * np.cross(axis, side)
    return np.concatenate([np.cos(angle) * axis + np.sin(angle) * ring for angle in beside(profile.half_angle)])


def beside(edge: float) -> tuple[float, float]:
    """Angles just inside and just outside of an edge."""
    return edge * (1 - EDGE), edge * (1 + EDGE)


def _larger(values: Array) -> Array:
    """The larger magnitude at the two ends of each bin."""
    size = np.abs(values)
    return np.maximum(size[:-1], size[1:])


def _across(slope: Array, bend: Array, alone: Array, edge: float) -> Array:
    """A bound of |d' / tan| in each bin, by bounds of d' and d'' and of the d'' that the waves have alone, (bins,)."""
    bins = len(slope)
    lit = int(edge * bins / np.pi) if edge < np.pi else bins
    number = np.arange(bins)
    # the largest on the way from a pole; beyond an edge there are waves alone, whose slope never jumped
    by_north, waves_by_north, by_south = map(np.maximum.accumulate, (bend, alone, bend[::-1]))
    north = np.where(number < lit, by_north, waves_by_north)
    south = np.where((number > lit) | (lit == bins), by_south[::-1], np.inf)
    nearer = np.minimum(number, bins - 1 - number) * (np.pi / bins)  # the end of a bin that is nearer to a pole
    nearest = np.divide(slope, np.tan(nearer), out=np.full(bins, np.inf), where=nearer > 0)
    return np.asarray(np.minimum(nearest, np.where(2 * number < bins, north, south)))


@lru_cache(maxsize=256)
def _along(profile: Profile | None, bins: int) -> tuple[Array, Array, Array, Array]:
    """A profile at the ends of the bins, its first and second derivative there, and the fourth in the bins."""
    if profile is None:
        return (np.zeros(bins + 1),) * 3 + (np.zeros(bins),)
    value, slope, bend, fourth = profile.along(np.linspace(0, np.pi, bins + 1))
    return value, slope, bend, np.maximum(fourth[:-1], fourth[1:])
