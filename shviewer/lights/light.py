"""What every light can do."""

from __future__ import annotations

from typing import Protocol

from shviewer.harmonics.basis import Array
from shviewer.lights.lat_long import LatLongMap


class Light(Protocol):
    """A function on the sphere with values in linear RGB; it may be negative."""

    @property
    def name(self) -> str:
        """What the user calls it: a built-in name, a file's stem or a function's name."""

    @property
    def description(self) -> str:
        """A few words under the name."""

    @property
    def notes(self) -> tuple[str, ...]:
        """Warnings worth a line each, such as negative texels."""

    @property
    def best_method(self) -> str:
        """How `coefficients` computes, in words: "closed form", "exact texel integrals", ..."""

    def radiance(self, directions: Array) -> Array:
        """Unit directions (k, 3) -> radiance (k, 3), float64."""

    def integrand(self, directions: Array) -> Array:
        """What `coefficients` are integrals of: the radiance, or for an image its texels as areas, not interpolated."""

    def coefficients(self, n_bands: int) -> Array:
        """(n_bands**2, 3) by the best way this light knows."""

    def products(self) -> Array:
        """Integrals of f_i f_j over the channels, (3, 3), by the same quadrature as `coefficients`."""

    def accuracy(self) -> float:
        """How far a relative L2 error of this light may be off for want of quadrature points; 0 where it is exact."""

    def landmarks(self) -> Array:
        """Directions (j, 3) of features that a grid might step over, such as the axis of a sun."""

    def __hash__(self) -> int:
        """By identity: what is computed for a light is remembered."""

    def radiance_map(self) -> LatLongMap | None:
        """What the GPU samples; None for lobes, which the shader evaluates itself."""
