"""The base of lights that are radiance, not the irradiance of another light."""

from __future__ import annotations

from shviewer.harmonics.basis import Array
from shviewer.lights.irradiance import MappedIrradiance
from shviewer.lights.light import Light, LightBase


class RadianceLight(LightBase):
    """A light that is its own source."""

    @property
    def source(self: Light) -> Light:
        return self

    def from_source(self, coefficients: Array) -> Array:
        return coefficients

    def irradiance(self: Light) -> Light:
        return MappedIrradiance(self)
