"""A light convolved with a zonal kernel: its irradiance, or what a glossy surface reflects, as a light of its own.

The coefficients of a convolution are f(l) c(l, m) (harmonics/quantities/kernels.py), so whatever can be done with a light, the
exact error included, can be done with its irradiance and its glossy reflection in the same way. Irradiance over pi is the
radiance of a white surface; a glossy quantity is a radiance as it is.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from shviewer.harmonics.basis import Array, count_bands, evaluate_basis
from shviewer.harmonics.extremes.bands import Bands
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.quantities.kernels import FEWEST_BANDS, Kernel, kernel_of
from shviewer.harmonics.quantities.names import RADIANCE
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS
from shviewer.lights.lat_long import MAP_ROWS, LatLongMap
from shviewer.lights.light import Light, LightBase

UP = np.array([0.0, 0.0, 1.0])

FEW_DIRECTIONS = 64
"""Up to so many, the sum of bands takes less time than making a map."""


ROUNDING = 1e-13
"""The share of the norm of its source below which a convolved light is rounding."""


def _of_source(name: str) -> Any:
    """An attribute that is that of the source."""
    return property(lambda light: getattr(light.source, name))


@dataclass(frozen=True, eq=False, repr=False)
class ConvolvedLight(LightBase):
    """`source` convolved with `kernel`."""

    source: Light
    kernel: Kernel

    lobes = ()
    name, description, notes = map(_of_source, ("name", "description", "notes"))
    about, best_method, landmarks = map(_of_source, ("about", "best_method", "landmarks"))
    irradiance_up, most_bands, kept_bands = map(_of_source, ("irradiance_up", "most_bands", "kept_bands"))

    @cached_property
    def bands(self) -> int:
        """The number of its bands: of those beyond, kernel or source holds little."""
        return min(self.kernel.bands, self.source.most_bands)

    @property
    def quantity(self) -> str:
        return self.kernel.quantity

    def through(self, quantity: str) -> Light:
        return self if quantity == self.quantity else self.source.through(quantity)

    def from_source(self, coefficients: Array) -> Array:
        """As in Light. What is only the rounding of the source, as all that surfaces see of Y(3, m), is nothing."""
        found = coefficients * per_coefficient(self.kernel.factors(count_bands(coefficients)))
        return found if (found**2).sum() > ROUNDING**2 * np.trace(self.source.products()) else 0 * found

    def coefficients(self, n_bands: int) -> Array:
        return self.from_source(self.source.coefficients(n_bands))

    def products(self) -> Array:
        return self._products

    @cached_property
    def _products(self) -> Array:
        coefficients = self.coefficients(self.bands)
        return np.asarray(coefficients.T @ coefficients)

    @property
    def map_rows(self) -> int:
        """Rows of its map from pole to pole; narrower kernels take twice as many."""
        return MAP_ROWS if self.bands <= FEWEST_BANDS else 2 * MAP_ROWS - 1

    @cached_property
    def synthesis(self) -> Synthesis:
        """The sum of its bands."""
        return Synthesis(self.coefficients(self.bands))

    @cached_property
    def map(self) -> LatLongMap:
        return self.map_of_bands(self.coefficients(self.bands))

    def map_of_bands(self, coefficients: Array) -> LatLongMap:
        texels = Synthesis(coefficients).pole_to_pole(self.map_rows, 2 * (self.map_rows - 1))
        return LatLongMap(texels, rows_on_poles=True)


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
        """As in Light; in few directions exactly, such as at the mark of a figure."""
        if len(directions) <= FEW_DIRECTIONS:
            return self.synthesis.in_directions(directions)
        return self.map.sample(directions)

    @cached_property
    def form(self) -> Bands | None:
        """Its bands, and a bound of further ones by the norms of what kernel and source hold there (Cauchy and Schwarz)."""
        if self.source.about.size is None and self.source.form is None:  # an image has one, which may take a raster
            return None
        kept = self.source.coefficients(self.bands)
        beyond = (self.source.products().diagonal() - (kept**2).sum(axis=0)).max()
        return Bands(self.from_source(kept), self.kernel.norm_beyond(self.bands) * float(np.sqrt(max(beyond, 0.0))))


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


class ConvolvedSum(ConvolvedLight, FiniteSum):
    """Coefficients convolved: a finite sum, like the light itself."""


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
    """A radiance as that quantity; itself, if that is radiance. ValueError for an unknown one."""
    kernel = kernel_of(quantity)
    return light if kernel.quantity == RADIANCE else kind(light, kernel)
