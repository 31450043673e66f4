"""The irradiance of a light: what a white Lambertian surface receives, as a light of its own.

E(n) = integral of L(d) max(0, n . d) over d is a convolution, so its coefficients are A(l) c(l, m) (filters.py), and
everything that is done with a light, the exact error included, is done with its irradiance in the same way.
Divide by pi for the radiance of a white surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.overlap import inner_product
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.zonal import ClampedLinear, gegenbauer_ratios
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import Light
from shviewer.lights.lobes import Lobe, LobeLight, angle_between

SERIES_BANDS = 1024
"""Bands in the products of lobes: A(l)^2 falls like l^-5, so that even a point light misses only 1e-9 of its norm."""

MAP_BANDS = 128
"""Bands of an image or a function; a point light misses 6e-7 of its norm, any broader light far less."""

MAP_ROWS = 513
TABLE_NODES, EDGE_NODES = 2049, 513


@dataclass(frozen=True, eq=False)
class IrradianceLight:
    """The irradiance of `source`."""

    source: Light

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
    def best_method(self) -> str:
        return self.source.best_method

    def accuracy(self) -> float:
        """That of the source, and for images and functions what its bands beyond MAP_BANDS could still hold."""
        if isinstance(self.source, LobeLight):
            return 0.0
        kept = self.source.coefficients(MAP_BANDS)
        beyond = max(float(np.trace(self.source.products()) - (kept**2).sum()), 0.0)
        total = float(np.trace(self.products()))
        tail = float(irradiance_factors(MAP_BANDS + 2)[-2:].__abs__().max())
        return max(self.source.accuracy(), tail * float(np.sqrt(beyond / total)) if total else 0.0)

    def integrand(self, directions: Array) -> Array:
        return self.radiance(directions)

    def coefficients(self, n_bands: int) -> Array:
        return self.source.coefficients(n_bands) * per_coefficient(irradiance_factors(n_bands))

    def products(self) -> Array:
        return self._products

    @cached_property
    def _products(self) -> Array:
        if isinstance(self.source, LobeLight):
            return _lobe_products(self.source.lobes)
        coefficients = self.coefficients(MAP_BANDS)
        return np.asarray(coefficients.T @ coefficients)

    def landmarks(self) -> Array:
        return self.source.landmarks()

    def radiance(self, directions: Array) -> Array:
        """Irradiance (k, 3) on surfaces that face `directions` (k, 3)."""
        if isinstance(self.source, CoefficientLight):
            return self._band_limited.radiance(directions)
        if not isinstance(self.source, LobeLight):
            return self.radiance_map().sample(directions)
        total = np.zeros((len(directions), 3))
        for lobe, (angles, values) in zip(self.source.lobes, self._tables, strict=True):
            half_chord = np.linalg.norm(directions - lobe.axis, axis=1) / 2
            total += np.interp(2 * np.arcsin(np.minimum(half_chord, 1)), angles, values)[:, None] * lobe.radiance
        return total

    def radiance_map(self) -> LatLongMap:
        return self._map

    @cached_property
    def _band_limited(self) -> CoefficientLight:
        """Of coefficients, the irradiance is a finite sum, too."""
        assert isinstance(self.source, CoefficientLight)
        return CoefficientLight(self.coefficients(self.source.n_bands))

    @cached_property
    def _tables(self) -> list[tuple[Array, Array]]:
        return [_table(lobe) for lobe in self.source.lobes] if isinstance(self.source, LobeLight) else []

    @cached_property
    def _map(self) -> LatLongMap:
        width = 2 * (MAP_ROWS - 1)
        theta = np.linspace(0, np.pi, MAP_ROWS)
        if isinstance(self.source, LobeLight):
            directions = directions_from_angles(theta[:, None], column_azimuths(width)).reshape(-1, 3)
            values = self.radiance(directions).reshape(MAP_ROWS, width, 3)
        else:
            values = Synthesis(self.coefficients(MAP_BANDS)).on_rows(theta, width).transpose(0, 2, 1)
        return LatLongMap(np.ascontiguousarray(values, dtype=np.float32), rows_on_poles=True)


def _lobe_products(lobes: tuple[Lobe, ...]) -> Array:
    """Sum over bands and pairs of lobes, by the addition theorem: (2l+1)/4pi A^2 lambda lambda' P(l)(cos of the angle)."""
    strength = irradiance_factors(SERIES_BANDS) ** 2 * (2 * np.arange(SERIES_BANDS) + 1) / (4 * np.pi)
    zonal = [lobe.profile.zonal(SERIES_BANDS) for lobe in lobes]
    products = np.zeros((3, 3))
    for i, first in enumerate(lobes):
        for j, second in enumerate(lobes[: i + 1]):
            angle = angle_between(first, second)
            legendre = gegenbauer_ratios(np.cos(angle), 2 * np.sin(angle / 2) ** 2, 0, SERIES_BANDS)
            pair = float((strength * zonal[i] * zonal[j] * legendre).sum()) * np.outer(first.radiance, second.radiance)
            products += pair if i == j else pair + pair.T
    return products


def _table(lobe: Lobe) -> tuple[Array, Array]:
    """Irradiance of a lobe of unit radiance against the angle between surface and axis: (k,) radians, (k,).

    The clamped cosine's overlap with the profile, exact; read off linearly between nodes that crowd where the profile's edge
    crosses the horizon, which keeps the error below 1e-6 of the largest value.
    """
    horizon, edge = np.pi / 2, min(1.5 * lobe.profile.half_angle, np.pi / 2)
    crowd = np.linspace(horizon - edge, horizon + edge, EDGE_NODES)
    angles = np.union1d(np.linspace(0, np.pi, TABLE_NODES), crowd)
    return angles, inner_product(lobe.profile, ClampedLinear(1.0, 0.0), angles)
