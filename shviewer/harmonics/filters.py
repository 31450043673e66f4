"""Weights per degree: windows against ringing, and the clamped cosine that turns radiance into irradiance.

A window multiplies band l by h(l/w). Tools disagree on what w means; here
    hann:     (1 + cos(pi l/w)) / 2   for l < w, 0 beyond,
    lanczos:  sin(pi l/w) / (pi l/w)  for l < w, 0 beyond,
    gauss:    exp(-(pi l/w)^2 / 2)    for every l,
so that w is the degree at which Hann and Lanczos reach zero, whatever n is [P.-P. Sloan, "Stupid Spherical Harmonics
Tricks", GDC 2008, Windowing]. deringing.py finds the factors that one reconstruction needs.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shviewer.harmonics.basis import Array, check_bands, degrees
from shviewer.harmonics.zonal import ClampedLinear

WINDOWS: dict[str, Callable[[Array], Array]] = {
    "hann": lambda x: np.where(x < 1, (1 + np.cos(np.pi * np.minimum(x, 1))) / 2, 0.0),
    "lanczos": lambda x: np.where(x < 1, np.sinc(x), 0.0),
    "gauss": lambda x: np.exp(-((np.pi * x) ** 2) / 2),
}


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
