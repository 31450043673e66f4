"""A sum of lobes convolved with a zonal kernel: tables of each lobe against the angle to its axis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import ClassVar

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.zonal_sum import Lobes
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.overlap import inner_product
from shviewer.harmonics.quantities.kernels import Kernel
from shviewer.harmonics.zonal import ClampedLinear, Profile, gegenbauer_ratios
from shviewer.lights.analytic.lobe import Lobe, angle_between, lobes_form, pair_products
from shviewer.lights.convolved import ConvolvedLight
from shviewer.lights.lat_long import MAP_ROWS, LatLongMap

SERIES_BANDS = 1024
"""Bands in the products of lobes: A(l)^2 falls like l^-5, so that even a point light misses only 1e-9 of its norm.

At roughness 0.1 it is 7e-9.
"""

TABLE_NODES, EDGE_NODES = 2049, 513

SHADE_STEPS = 4096
"""Steps from 0 to pi in the table of a lobe seen by a glossy surface."""


class ConvolvedLobes(ConvolvedLight):
    """`source` is a sum of lobes."""

    @cached_property
    def map(self) -> LatLongMap:
        """The kink that the kernel has at the horizon is exact, as the map of the irradiance has it; the rest is of bands."""
        if self.kernel.profile is None:
            return LatLongMap.pole_to_pole(self.rows)
        if self.map_rows > MAP_ROWS:
            return self.map_of_bands(
                self.coefficients(self.bands)
            )  # the kink of narrow kernels is less than 1e-3 of them
        slope = self.kernel.slope_at_horizon
        smooth = self.kernel.factors(self.bands) - slope * irradiance_factors(self.bands)
        rest = self.map_of_bands(self.source.coefficients(self.bands) * per_coefficient(smooth))
        cosine = self.source.irradiance().map
        assert cosine is not None
        return LatLongMap(rest.texels + np.float32(slope) * cosine.texels, rows_on_poles=True)

    def radiance(self, directions: Array) -> Array:
        return self.form.values(directions)

    @cached_property
    def form(self) -> Lobes:
        return lobes_form([_Shade.of(lobe.profile, self.kernel) for lobe in self.source.lobes], self.source.lobes)

    @cached_property
    def _products(self) -> Array:
        return _lobe_products(self.source.lobes, self.kernel.factors(SERIES_BANDS))


@dataclass(frozen=True, eq=False)
class _Shade:
    """A lobe of unit radiance convolved with a kernel, as a profile: smooth, from a table.

    The kernel is the clamped cosine times its slope at the horizon, and a rest that is smoother by a degree there, and that a
    series of SERIES_BANDS bands holds to 1e-6 of the peak. The cosine's part is linear between its nodes, the rest cubic.
    """

    profile: Profile
    kernel: Kernel
    rest: Array | None
    """The rest at the SHADE_STEPS + 1 angles from 0 to pi, and one more beyond each end; None if there is none."""
    kind: ClassVar[int] = -1
    parameters: ClassVar[tuple[float, float]] = (0.0, 0.0)
    half_angle: ClassVar[float] = np.pi

    @classmethod
    def of(cls, profile: Profile, kernel: Kernel) -> _Shade:
        if kernel.profile is None:
            return cls(profile, kernel, None)
        factors = kernel.factors(SERIES_BANDS) - kernel.slope_at_horizon * irradiance_factors(SERIES_BANDS)
        even, odd = _legendre_table()
        terms = _zonal(profile) * factors * (2 * np.arange(SERIES_BANDS) + 1) / (4 * np.pi)
        sums, differences = terms[0::2] @ even, terms[1::2] @ odd
        rest = np.concatenate([sums + differences, (sums - differences)[-2::-1]])
        return cls(profile, kernel, np.pad(rest, 1, mode="reflect"))

    def value(self, squared_chord: Array) -> Array:
        angle = 2 * np.arcsin(np.sqrt(np.minimum(squared_chord, 4)) / 2)
        found = np.interp(angle, *_cosine_table(self.profile))
        if self.rest is None:
            return np.asarray(found)
        place = angle * (SHADE_STEPS / np.pi)
        start = np.minimum(place.astype(np.int64), SHADE_STEPS - 1)
        u = place - start
        before, here, after, beyond = (self.rest[start + i] for i in range(4))
        cubic = (
            here * (u + 1) * (u - 1) * (u - 2) / 2
            - after * (u + 1) * u * (u - 2) / 2
            + (beyond * (u + 1) - before * (u - 2)) * u * (u - 1) / 6
        )
        return np.asarray(self.kernel.slope_at_horizon * found + cubic)

    def zonal(self, n_bands: int) -> Array:
        return self.profile.zonal(n_bands) * self.kernel.factors(n_bands)

    def along(self, angle: Array) -> tuple[Array, Array, Array, Array]:
        """As in Profile, for angles that are equally far apart: what bends within a step is twice what is seen at its ends."""
        value = self.value(4 * np.sin(angle / 2) ** 2)
        slope = np.gradient(value, angle)
        step = angle[1] - angle[0]
        bend = np.diff(np.pad(value, 1, mode="reflect"), 2) / step**2
        return value, slope, bend, 8 * np.abs(bend) / step**2


def _lobe_products(lobes: tuple[Lobe, ...], factors: Array) -> Array:
    """Sum over bands and pairs of lobes, by the addition theorem: (2l+1)/4pi f^2 lambda lambda' P(l)(cos of the angle)."""
    strength = factors**2 * (2 * np.arange(len(factors)) + 1) / (4 * np.pi)

    def integral(one: Lobe, two: Lobe) -> float:
        angle = angle_between(one, two)
        legendre = gegenbauer_ratios(np.cos(angle), 2 * np.sin(angle / 2) ** 2, 0, len(factors))
        return float((strength * _zonal(one.profile) * _zonal(two.profile) * legendre).sum())

    return pair_products(lobes, integral)


@lru_cache(maxsize=128)
def _zonal(profile: Profile) -> Array:
    return profile.zonal(SERIES_BANDS)


@lru_cache(maxsize=1)
def _legendre_table() -> tuple[Array, Array]:
    """P(l), even and odd l < SERIES_BANDS, at the angles from 0 to pi/2 of the rest's table: (bands / 2, angles) each."""
    x = np.cos(np.pi / SHADE_STEPS * np.arange(SHADE_STEPS // 2 + 1))
    values = np.empty((SERIES_BANDS, len(x)))
    values[0], values[1] = 1, x
    for l in range(2, SERIES_BANDS):
        values[l] = ((2 * l - 1) * x * values[l - 1] - (l - 1) * values[l - 2]) / l
    return np.ascontiguousarray(values[0::2]), np.ascontiguousarray(values[1::2])


@lru_cache(maxsize=128)
def _cosine_table(profile: Profile) -> tuple[Array, Array]:
    """Irradiance of a lobe of unit radiance against the angle between normal and axis: angles (k,) in radians, values (k,).

    The clamped cosine's overlap with the profile, exact at the nodes and linear between them. Nodes crowd where the
    profile's edge crosses the horizon, which keeps the error below 1e-6 of the largest value.
    """
    horizon, edge = np.pi / 2, min(1.5 * profile.half_angle, np.pi / 2)
    crowd = np.linspace(horizon - edge, horizon + edge, EDGE_NODES)
    angles = np.union1d(np.linspace(0, np.pi, TABLE_NODES), crowd)
    return angles, inner_product(profile, ClampedLinear(1.0, 0.0), angles)
