"""The irradiance of a light: what a white Lambertian surface receives, as a light of its own.

E(n) = integral of L(d) max(0, n . d) over d is a convolution, so its coefficients are A(l) c(l, m) (filters.py), and
whatever can be done with a light, the exact error included, can be done with its irradiance in the same way.
Divided by pi, it is the radiance of a white surface.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from shviewer.harmonics.basis import Array, count_bands, evaluate_basis
from shviewer.harmonics.extremes.bands import Bands, band_heights
from shviewer.harmonics.extremes.zonal_sum import Lobes
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.overlap import inner_product
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.zonal import ClampedLinear, Profile, gegenbauer_ratios
from shviewer.lights.lat_long import MAP_ROWS, LatLongMap
from shviewer.lights.light import About, Light, LightBase
from shviewer.lights.lobe import Lobe, angle_between, lobes_form, pair_products

SERIES_BANDS = 1024
"""Bands in the products of lobes: A(l)^2 falls like l^-5, so that even a point light misses only 1e-9 of its norm."""

MAP_BANDS = 128
"""Bands of an image or a function; a point light misses 6e-7 of its norm, any broader light far less."""

UP = np.array([0.0, 0.0, 1.0])

TABLE_NODES, EDGE_NODES = 2049, 513


@dataclass(frozen=True, eq=False)
class IrradianceLight(LightBase):
    """The irradiance of `source`; bands beyond the first `bands` are negligible."""

    source: Light
    bands: int = MAP_BANDS

    lobes = ()

    @property
    def name(self) -> str:
        return self.source.name

    @property
    def description(self) -> str:
        return self.source.description

    @property
    def notes(self) -> tuple[str, ...]:
        return self.source.notes

    @property
    def about(self) -> About:
        return self.source.about

    @property
    def best_method(self) -> str:
        return self.source.best_method

    def irradiance(self) -> Light:
        return self

    def irradiance_up(self) -> Array:
        return self.source.irradiance_up()

    def from_source(self, coefficients: Array) -> Array:
        return coefficients * per_coefficient(irradiance_factors(count_bands(coefficients)))

    @property
    def kept_bands(self) -> int:
        return self.source.kept_bands

    def coefficients(self, n_bands: int) -> Array:
        return self.from_source(self.source.coefficients(n_bands))

    def products(self) -> Array:
        return self._products

    @cached_property
    def _products(self) -> Array:
        coefficients = self.coefficients(self.bands)
        return np.asarray(coefficients.T @ coefficients)

    def landmarks(self) -> Array:
        return self.source.landmarks()

    @cached_property
    def map(self) -> LatLongMap:
        return LatLongMap.pole_to_pole(self.rows)


class MappedIrradiance(IrradianceLight):
    """The irradiance of an image or a function: its bands are summed into a map once, from which radiance is read."""

    def accuracy(self) -> float:
        """The accuracy of the source, and a bound of what further bands could hold."""
        kept = self.source.coefficients(self.bands)
        beyond = max(float(np.trace(self.source.products()) - (kept**2).sum()), 0.0)
        total = float(np.trace(self.products()))
        tail = float(np.abs(irradiance_factors(self.bands + 2)[-2:]).max())
        return max(self.source.accuracy(), tail * float(np.sqrt(beyond / total)) if total else 0.0)

    def radiance(self, directions: Array) -> Array:
        return self.map.sample(directions)

    @cached_property
    def form(self) -> Bands | None:
        """Its bands, and how far the map is from them between its points, by their second derivatives."""
        if self.source.form is None:
            return None
        coefficients = self.coefficients(self.bands)
        heights = band_heights(coefficients)
        step, l = np.pi / (MAP_ROWS - 1), np.arange(self.bands)
        return Bands(coefficients, float((step * l) ** 2 / 4 @ heights + np.finfo(np.float32).eps * heights.sum()))

    @cached_property
    def map(self) -> LatLongMap:
        return LatLongMap.pole_to_pole(Synthesis(self.coefficients(self.bands)).on_rows)


class FiniteSum(LightBase):
    """A light that is the sum of its first bands."""

    @property
    @abstractmethod
    def synthesis(self) -> Synthesis: ...

    @property
    def form(self) -> Bands:
        return Bands(self.synthesis.coefficients)

    def radiance(self, directions: Array) -> Array:
        return self.synthesis.in_directions(directions)

    def rows(self, theta: Array, n_columns: int) -> Array:
        """As in Light; costs a fraction of `radiance` in as many directions."""
        return self.synthesis.on_rows(theta, n_columns)


class BandLimitedIrradiance(FiniteSum, IrradianceLight):
    """The irradiance of coefficients: a finite sum, like the light itself."""

    @cached_property
    def synthesis(self) -> Synthesis:
        return Synthesis(self.coefficients(self.bands))


class LobeIrradiance(IrradianceLight):
    """The irradiance of a sum of lobes, in closed form."""

    def radiance(self, directions: Array) -> Array:
        return self.form.values(directions)

    @cached_property
    def form(self) -> Lobes:
        return lobes_form([_Shade(lobe.profile, *_table(lobe)) for lobe in self.source.lobes], self.source.lobes)

    @cached_property
    def _products(self) -> Array:
        return _lobe_products(self.source.lobes)


@dataclass(frozen=True, eq=False)
class _Shade:
    """The irradiance of a lobe of unit radiance as a profile: smooth, and linear between the nodes of its table."""

    profile: Profile
    angles: Array
    values: Array
    kind: ClassVar[int] = -1
    parameters: ClassVar[tuple[float, float]] = (0.0, 0.0)
    half_angle: ClassVar[float] = np.pi

    def value(self, squared_chord: Array) -> Array:
        return np.asarray(np.interp(2 * np.arcsin(np.sqrt(np.minimum(squared_chord, 4)) / 2), self.angles, self.values))

    def zonal(self, n_bands: int) -> Array:
        return self.profile.zonal(n_bands) * irradiance_factors(n_bands)

    def along(self, angle: Array) -> tuple[Array, Array, Array, Array]:
        """As in Profile, for angles that are equally far apart: what bends within a step is twice what is seen at its ends."""
        value = np.interp(angle, self.angles, self.values)
        slope = np.gradient(value, angle)
        step = angle[1] - angle[0]
        bend = np.diff(np.pad(value, 1, mode="reflect"), 2) / step**2
        return value, slope, bend, 8 * np.abs(bend) / step**2


class RadianceLight(LightBase):
    """A light that is radiance, not the irradiance of another: its own source."""

    @property
    def source(self: Light) -> Light:
        return self

    def from_source(self, coefficients: Array) -> Array:
        return coefficients

    def irradiance(self: Light) -> Light:
        return MappedIrradiance(self)

    def irradiance_up(self: Light) -> Array:
        factors = per_coefficient(irradiance_factors(MAP_BANDS))
        return np.asarray(evaluate_basis(UP, MAP_BANDS) @ (factors * self.coefficients(MAP_BANDS)))


def _lobe_products(lobes: tuple[Lobe, ...]) -> Array:
    """Sum over bands and pairs of lobes, by the addition theorem: (2l+1)/4pi A^2 lambda lambda' P(l)(cos of the angle)."""
    strength = irradiance_factors(SERIES_BANDS) ** 2 * (2 * np.arange(SERIES_BANDS) + 1) / (4 * np.pi)
    zonal = {lobe: lobe.profile.zonal(SERIES_BANDS) for lobe in lobes}

    def integral(one: Lobe, two: Lobe) -> float:
        angle = angle_between(one, two)
        legendre = gegenbauer_ratios(np.cos(angle), 2 * np.sin(angle / 2) ** 2, 0, SERIES_BANDS)
        return float((strength * zonal[one] * zonal[two] * legendre).sum())

    return pair_products(lobes, integral)


def _table(lobe: Lobe) -> tuple[Array, Array]:
    """Irradiance of a lobe of unit radiance against the angle between normal and axis: angles (k,) in radians, values (k,).

    The clamped cosine's overlap with the profile, exact at the nodes and linear between them. Nodes crowd where the
    profile's edge crosses the horizon, which keeps the error below 1e-6 of the largest value.
    """
    horizon, edge = np.pi / 2, min(1.5 * lobe.profile.half_angle, np.pi / 2)
    crowd = np.linspace(horizon - edge, horizon + edge, EDGE_NODES)
    angles = np.union1d(np.linspace(0, np.pi, TABLE_NODES), crowd)
    return angles, inner_product(lobe.profile, ClampedLinear(1.0, 0.0), angles)
