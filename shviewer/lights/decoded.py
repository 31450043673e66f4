"""The irradiance that an engine stores in few numbers, as a light: what its formula decodes, in every direction.

It may have bands that no radiance gives it, such as odd ones; its source is a radiance that has the first three.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.extremes.bands import Bands
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.quantities.encodings import BANDS, Encoding, Stored
from shviewer.lights.convolved import ConvolvedLight
from shviewer.lights.lat_long import LatLongMap


@dataclass(frozen=True, eq=False, repr=False)
class DecodedIrradiance(ConvolvedLight):
    """The irradiance of `stored`, whose radiance `source` has."""

    stored: Stored

    best_method = "numbers as given"

    @property
    def encoding(self) -> Encoding:
        return self.stored.encoding

    @cached_property
    def _decoded(self) -> Array:
        return self.encoding.expand(self.stored.numbers)

    def radiance(self, directions: Array) -> Array:
        return self.stored.irradiance(directions)

    def from_source(self, coefficients: Array) -> Array:
        """As in Light; with what the formula has beyond the irradiance of the source."""
        found = super().from_source(coefficients)
        own = self.source.coefficients(count_bands(coefficients))
        count = min(len(found), len(self._decoded))
        beyond = np.zeros_like(found)
        beyond[:count] = self._decoded[:count]
        return found + beyond - own * per_coefficient(irradiance_factors(count_bands(coefficients)))

    def products(self) -> Array:
        return self.stored.products()

    @property
    def form(self) -> Bands | None:
        """Its bands, where they are all of it: Geomerics' curve and cubes have more."""
        return Bands(self._decoded) if self.encoding.bands <= BANDS else None

    @cached_property
    def map(self) -> LatLongMap:
        return LatLongMap.pole_to_pole(self.rows)
