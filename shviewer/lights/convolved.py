"""A light convolved with a zonal kernel: its irradiance, or what a glossy surface reflects, as a light of its own.

The coefficients of a convolution are f(l) c(l, m) (harmonics/quantities/kernels.py), so whatever can be done with a light, the
exact error included, can be done with its irradiance and its glossy reflection in the same way. Irradiance over pi is the
radiance of a white surface; a glossy quantity is a radiance as it is.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import ClassVar

import numpy as np

from shviewer.harmonics.basis import Array, count_bands, evaluate_basis
from shviewer.harmonics.extremes.bands import Bands, band_heights
from shviewer.harmonics.extremes.zonal_sum import Lobes
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.overlap import inner_product
from shviewer.harmonics.quantities.kernels import FEWEST_BANDS, Kernel, kernel_of
from shviewer.harmonics.quantities.names import RADIANCE, in_words
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS
from shviewer.harmonics.zonal import ClampedLinear, Profile, gegenbauer_ratios
from shviewer.lights.lat_long import MAP_ROWS, LatLongMap
from shviewer.lights.light import About, Light, LightBase
from shviewer.lights.lobe import Lobe, angle_between, lobes_form, pair_products
from shviewer.limits import DEFAULT_LIMITS

SERIES_BANDS = 1024
"""Bands in the products of lobes: A(l)^2 falls like l^-5, so that even a point light misses only 1e-9 of its norm.

At roughness 0.1 it is 7e-9.
"""

UP = np.array([0.0, 0.0, 1.0])

TABLE_NODES, EDGE_NODES = 2049, 513
TABLE_BYTES = 14
"""Bytes that projecting and summing n bands take, over n^3: the table of theta_series.py and what is made of it."""

SHADE_STEPS = 4096
"""Steps from 0 to pi in the table of a lobe seen by a glossy surface."""


@dataclass(frozen=True, eq=False)
class ConvolvedLight(LightBase):
    """`source` convolved with `kernel`; bands beyond the first `bands` are negligible."""

    source: Light
    kernel: Kernel
    bands: int = FEWEST_BANDS

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

    @property
    def quantity(self) -> str:
        return self.kernel.quantity

    def through(self, quantity: str) -> Light:
        return self if quantity == self.quantity else self.source.through(quantity)

    def irradiance_up(self) -> Array:
        return self.source.irradiance_up()

    def from_source(self, coefficients: Array) -> Array:
        return coefficients * per_coefficient(self.kernel.factors(count_bands(coefficients)))

    @property
    def most_bands(self) -> int:
        return self.source.most_bands

    def coefficients(self, n_bands: int) -> Array:
        return self.from_source(self.source.coefficients(n_bands))

    @property
    def kept_bands(self) -> int:
        return self.source.kept_bands

    def products(self) -> Array:
        return self._products

    @cached_property
    def _products(self) -> Array:
        coefficients = self.coefficients(self.bands)
        return np.asarray(coefficients.T @ coefficients)

    def landmarks(self) -> Array:
        return self.source.landmarks()

    @property
    def map_rows(self) -> int:
        """Rows of its map from pole to pole; narrower kernels take twice as many."""
        return MAP_ROWS if self.bands <= FEWEST_BANDS else 2 * MAP_ROWS - 1

    @cached_property
    def map(self) -> LatLongMap:
        return LatLongMap.pole_to_pole(self.rows, self.map_rows)


class ConvolvedMap(ConvolvedLight):
    """An image or a function convolved: its bands are summed into a map once, from which radiance is read."""

    def accuracy(self) -> float:
        """The accuracy of the source, and a bound of what further bands could hold."""
        kept = self.source.coefficients(self.bands)
        beyond = max(float(np.trace(self.source.products()) - (kept**2).sum()), 0.0)
        total = float(np.trace(self.products()))
        tail = self.kernel.beyond(self.bands)
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
        step, l = np.pi / (self.map_rows - 1), np.arange(self.bands)
        return Bands(coefficients, float((step * l) ** 2 / 4 @ heights + ROUNDED * heights.sum()))

    @cached_property
    def map(self) -> LatLongMap:
        synthesis = Synthesis(self.coefficients(self.bands))
        return LatLongMap(synthesis.pole_to_pole(self.map_rows, 2 * (self.map_rows - 1)), rows_on_poles=True)


ROUNDED = 4 * float(np.finfo(np.float32).eps)
"""How far a map of float32 is off, over the sum of the heights of its bands."""


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


class ConvolvedSum(FiniteSum, ConvolvedLight):
    """Coefficients convolved: a finite sum, like the light itself."""

    @cached_property
    def synthesis(self) -> Synthesis:
        return Synthesis(self.coefficients(self.bands))


class ConvolvedLobes(ConvolvedLight):
    """A sum of lobes convolved: tables of each lobe against the angle to its axis."""

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


class RadianceLight(LightBase):
    """A light that is radiance, not convolved: its own source."""

    @property
    def source(self: Light) -> Light:
        return self

    @property
    def quantity(self) -> str:
        return RADIANCE

    def from_source(self, coefficients: Array) -> Array:
        return coefficients

    def through(self: Light, quantity: str) -> Light:
        return convolved(self, quantity, ConvolvedMap)

    @property
    def most_bands(self) -> int:
        return MAX_SEPARABLE_BANDS

    def irradiance_up(self: Light) -> Array:
        factors = per_coefficient(irradiance_factors(FEWEST_BANDS))
        return np.asarray(evaluate_basis(UP, FEWEST_BANDS) @ (factors * self.coefficients(FEWEST_BANDS)))


def convolved(light: Light, quantity: str, kind: type[ConvolvedLight]) -> Light:
    """A radiance as that quantity; itself, if that is radiance.

    ValueError for an unknown one, LightError for a narrow kernel whose bands take more memory than there may be.
    """
    kernel = kernel_of(quantity)
    if kernel.quantity == RADIANCE:
        return light
    bands = min(kernel.bands, light.most_bands)
    if kind is ConvolvedMap and bands > FEWEST_BANDS:
        DEFAULT_LIMITS.check_memory(TABLE_BYTES * bands**3, f"{light.name}: {in_words(quantity)} in {bands} bands")
    return kind(light, kernel, bands)


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
