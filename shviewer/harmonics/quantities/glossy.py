"""The kernel of a glossy surface, as engines filter environment maps for it: GGX, seen along its normal.

With normal, view and reflection one direction R and x the cosine of the angle between R and the light, the half vector stands
at half that angle, and the weight of the light is the density of GGX directions times x [Karis], normalised:
    K(x) = x / (2 pi Z (b - c x)^2) for x > 0, else 0,    a = roughness^4, b = 1 + a, c = 1 - a,
    Z = (c/(2a) - ln(1 + c/(2a))) / c^2.
Its factors f(l) = 2 pi integral of K P(l) dx turn the coefficients of radiance into those of what is reflected, f(0) = 1.
Roughness 1 is x / pi, so that this is irradiance over pi; as the roughness goes to 0, it is radiance.

The factors come from one Gauss-Legendre rule in t, where 1 - x = 2a (exp(ct) - 1)/c: the peak of K, which is as narrow as
2 roughness^2 radians, is spread over the nodes, and b - cx = 2a exp(ct). n_bands + 64 nodes leave 1e-13, and P(l) in the
difference form of basis.py keeps its digits next to x = 1.

Source
    [Karis] B. Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course: the pre-filtered map; the sums of Filament's
            CubemapIBL.cpp and of Khronos' glTF-IBL-Sampler are this integral, of GGX with alpha = roughness^2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import log1p, pi
from typing import ClassVar

import numpy as np

from shviewer.harmonics.basis import Array, check_bands
from shviewer.harmonics.quadrature import gauss_legendre_rows

EXTRA_NODES = 64
CLOSE = 0.4
"""Where c is below, Z cancels, and its series is used: the sum of (-c/2a)^k, a near 1, converges fast."""


@dataclass(frozen=True)
class Glossy:
    """The kernel as a profile with peak value 1. ValueError unless 0 < roughness <= 1."""

    roughness: float
    kind: ClassVar[int] = 4
    half_angle: ClassVar[float] = pi / 2

    def __post_init__(self) -> None:
        if not 0 < self.roughness <= 1:
            raise ValueError(f"roughness {self.roughness:g}: it must be above 0 and at most 1")

    @property
    def a(self) -> float:
        return self.roughness**4

    @property
    def c(self) -> float:
        """1 - a, without its rounding."""
        return (1 - self.roughness) * (1 + self.roughness) * (1 + self.roughness**2)

    @property
    def parameters(self) -> tuple[float, float]:
        return self.a, 0.0

    @property
    def peak(self) -> float:
        """K(1) = 1/(8 pi Z a^2): times this the profile has the integral 1."""
        z = self.c / (2 * self.a)
        series = sum((-z) ** k / (k + 2) for k in range(40)) if self.c < CLOSE else (z - log1p(z)) / z**2  # z < 1/3
        return 1 / (2 * pi * series)

    @property
    def slope_at_horizon(self) -> float:
        """dK/dx at x = 0, where K has its kink: 1/(2 pi Z b^2)."""
        return self.peak * (2 * self.a / (1 + self.a)) ** 2

    @property
    def energy(self) -> float:
        """The integral of K^2 over the sphere, 1/(48 pi Z^2 a^3 b), which is the sum of (2l+1)/4pi f(l)^2."""
        return 4 * pi / 3 * self.peak**2 * self.a / (1 + self.a)

    def value(self, squared_chord: Array) -> Array:
        away = np.asarray(squared_chord) / 2  # 1 - x
        return np.asarray(np.maximum(0, 1 - away) * (2 * self.a / (away + self.a * (2 - away))) ** 2)

    def along(self, angle: Array) -> tuple[Array, Array, Array, Array]:
        """As in Profile. The n-th derivative of x/(b-cx)^2 is n! c^(n-1) (nb + cx) / (b-cx)^(n+2)."""
        a, c, x, sine = self.a, self.c, np.cos(angle), np.sin(angle)
        away = 2 * np.sin(angle / 2) ** 2
        lit = (2 * a) ** 2 * (np.asarray(angle) <= self.half_angle)
        base = away + a * (2 - away)
        one, two, three, four = (
            lit * factorial * c ** (n - 1) * (n * (1 + a) + c * np.abs(x)) / base ** (n + 2)
            for n, factorial in ((1, 1), (2, 2), (3, 6), (4, 24))
        )
        fourth = one * np.abs(x) + two * (4 * sine**2 + 3 * x**2) + 6 * three * sine**2 * np.abs(x) + four * sine**4
        return self.value(2 * away), -sine * one, sine**2 * two - x * one, fourth

    def zonal(self, n_bands: int) -> Array:
        return glossy_factors(self.roughness, n_bands) / self.peak


def glossy_factors(roughness: float, n_bands: int) -> Array:
    """f(l) of a roughness, (n_bands,), absolute error 1e-13; below that, they are noise."""
    check_bands(n_bands)
    step = 128  # rules for few counts of nodes, which are kept; two more, which `Kernel.beyond` asks for
    return _factors(roughness, -(-(n_bands - 2) // step) * step + 2)[:n_bands]


@lru_cache(maxsize=256)
def _factors(roughness: float, n_bands: int) -> Array:
    kernel = Glossy(roughness)
    a, c = kernel.a, kernel.c
    end = log1p(c / (2 * a)) / c if c else 0.5
    theta, weights = gauss_legendre_rows(n_bands + EXTRA_NODES)
    t = end * np.sin(theta / 2) ** 2
    away = 2 * a * (np.expm1(c * t) / c if c else t)
    weights = weights * (1 - away) * np.exp(-c * t)
    weights /= weights.sum()
    factors = np.empty(n_bands)
    value, difference = np.ones(len(t)), np.zeros(len(t))
    for l in range(n_bands):
        if l:
            difference = (2 * l - 1) / l * (difference - away * value) - difference
            value = value + difference
        factors[l] = weights @ value
    factors.flags.writeable = False
    return factors
