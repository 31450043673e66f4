"""Zonal kernels: what makes another quantity of radiance, by one factor a band.

A quantity is the convolution of the radiance with a kernel that is symmetric about the direction asked for: a point for
radiance itself, the clamped cosine for irradiance (not divided by pi), and glossy.py for what a glossy surface reflects.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.filters import irradiance_factors
from shviewer.harmonics.quantities.glossy import Glossy, glossy_factors
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE, quantity_of, roughness_of
from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS

FEWEST_BANDS = 128
"""Bands of an image or a function that a kernel is given at least; of irradiance a point light misses 6e-7 of its norm."""

NEGLIGIBLE = 1e-6
"""Bands are given until their factor is below, or up to MAX_SEPARABLE_BANDS."""


@dataclass(frozen=True)
class Kernel:
    """A zonal kernel, which is a profile times `scale`."""

    quantity: str
    factors: Callable[[int], Array] = field(compare=False)
    """n_bands -> the factor of each band of the radiance, (n_bands,)."""
    profile: Glossy | None = None
    """The shape of a glossy kernel."""
    scale: float = 1.0
    slope_at_horizon: float = 1.0
    """The kernel is this times the cosine of the angle, and smoother terms, next to the horizon, and nothing below it."""
    bands: int = FEWEST_BANDS
    """The number of bands beyond which little is left of a light."""
    energy: float = np.inf
    """The integral of its square, which is the sum of (2l+1)/4pi times the squared factors."""

    def beyond(self, n_bands: int) -> float:
        """The largest factor from that band on; from there on they shrink, every other one may be 0."""
        return float(np.abs(self.factors(n_bands + 2)[-2:]).max())

    def norm_beyond(self, n_bands: int) -> float:
        """The L2 norm of its bands from that one on."""
        held = float((2 * np.arange(n_bands) + 1) @ self.factors(n_bands) ** 2) / (4 * np.pi)
        return float(np.sqrt(max(self.energy - held, 0.0)))


@lru_cache(maxsize=64)
def kernel_of(quantity: str) -> Kernel:
    """The kernel of a quantity by its name. ValueError if there is none."""
    quantity = quantity_of(quantity)
    if quantity == RADIANCE:
        return Kernel(RADIANCE, np.ones)
    if quantity == IRRADIANCE:
        return Kernel(IRRADIANCE, irradiance_factors, energy=2 * np.pi / 3)
    roughness = roughness_of(quantity)
    assert roughness is not None
    shape = Glossy(roughness)

    def factors(n_bands: int) -> Array:
        return glossy_factors(shape.roughness, n_bands)

    return Kernel(quantity, factors, shape, shape.peak, shape.slope_at_horizon, _bands(shape), shape.energy)


def _bands(shape: Glossy) -> int:
    """The bands that a kernel needs; the factors of rougher ones than 0.25 fall below NEGLIGIBLE sooner."""
    if shape.roughness >= 0.25:
        return FEWEST_BANDS
    small = np.abs(glossy_factors(shape.roughness, MAX_SEPARABLE_BANDS)) < NEGLIGIBLE
    return int(small.argmax()) if small.any() else MAX_SEPARABLE_BANDS
