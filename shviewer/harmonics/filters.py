"""Weights per degree: windows against ringing, deringing, and the clamped cosine that turns radiance into irradiance.

A window multiplies band l by h(l/w). Tools disagree on what w means; here
    hann:     (1 + cos(pi l/w)) / 2   for l < w, 0 beyond,
    lanczos:  sin(pi l/w) / (pi l/w)  for l < w, 0 beyond,
    gauss:    exp(-(pi l/w)^2 / 2)    for every l,
so that w is the degree at which Hann and Lanczos reach zero, whatever n is [P.-P. Sloan, "Stupid Spherical Harmonics
Tricks", GDC 2008, Windowing].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array, check_bands, count_bands, degrees
from shviewer.harmonics.metrics import smallest_value
from shviewer.harmonics.zonal import ClampedLinear

WINDOWS: dict[str, Callable[[Array], Array]] = {
    "hann": lambda x: np.where(x < 1, (1 + np.cos(np.pi * np.minimum(x, 1))) / 2, 0.0),
    "lanczos": lambda x: np.where(x < 1, np.sinc(x), 0.0),
    "gauss": lambda x: np.exp(-((np.pi * x) ** 2) / 2),
}

MAX_DERINGED_BANDS = 32
NEGATIVE_TOLERANCE = 1e-9
"""What a deringed minimum may be below zero, relative to the mean radiance: the search for it is not better."""

WIDEST = 1e3
"""In bands: a window this wide changes the last band by less than 2e-6, which no picture shows."""


def window(name: str, n_bands: int, width: float) -> Array:
    """The factor of each degree, (n_bands,). ValueError for an unknown name or a width that is not positive and finite."""
    check_bands(n_bands)
    if name not in WINDOWS:
        raise ValueError(f"window {name!r}: there is {', '.join(WINDOWS)}")
    if not 0 < width < np.inf:
        raise ValueError(f"window width {width:g}: it must be positive and finite, such as the number of bands")
    return np.asarray(WINDOWS[name](np.arange(n_bands) / width), dtype=np.float64)


def irradiance_factors(n_bands: int) -> Array:
    """A(l) of R. Ramamoorthi and P. Hanrahan (2001), (n_bands,): pi, 2pi/3, pi/4, 0, -pi/24, ...

    Irradiance is radiance convolved with the clamped cosine, whose lambda(l) has a closed form without cancellation.
    """
    return ClampedLinear(1.0, 0.0).zonal(n_bands)


def per_coefficient(factors: Array) -> Array:
    """A factor per degree, (n,), as a column for coefficients, (n**2, 1)."""
    return np.asarray(factors[degrees(len(factors))][:, None])


@dataclass(frozen=True, eq=False)
class Deringing:
    """factors: per degree (n,). width: of the Lanczos window, infinite if nothing had to change. minimum: reached."""

    factors: Array
    width: float
    minimum: float


def dering(coefficients: Array) -> Deringing:
    """The widest Lanczos window under which no channel of the reconstruction is negative [Sloan 2017, "Deringing"].

    coefficients: (n**2, 3), n up to MAX_DERINGED_BANDS. One window for all channels, so that no hue shifts. The minimum
    is that of the function, not of a grid: each of its lowest valleys is followed down. A channel whose mean is
    negative cannot be made non-negative by any window: ValueError.
    """
    n_bands = count_bands(coefficients)
    check_bands(n_bands, MAX_DERINGED_BANDS)
    mean = coefficients[0] / np.sqrt(4 * np.pi)
    if (mean < 0).any():
        raise ValueError(f"mean radiance {mean.min():.3g} in a channel: no window makes a negative mean non-negative")
    floor = -NEGATIVE_TOLERANCE * float(mean.max())

    def lowest(width: float) -> float:
        return smallest_value(coefficients * per_coefficient(window("lanczos", n_bands, width)))[0]

    unchanged = smallest_value(coefficients)[0]
    if unchanged >= floor:
        return Deringing(np.ones(n_bands), np.inf, unchanged)
    narrow, wide = 1.0, WIDEST * n_bands  # width 1 leaves the mean alone, which is not negative
    for _ in range(60):
        middle = np.sqrt(narrow * wide)
        if lowest(middle) >= floor:
            narrow = middle
        else:
            wide = middle
        if wide - narrow < 1e-6 * wide:
            break
    return Deringing(window("lanczos", n_bands, narrow), narrow, lowest(narrow))
