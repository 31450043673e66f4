"""What coefficients are of: radiance or irradiance, and whether they are divided by pi."""

from __future__ import annotations

import numpy as np

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.filters import irradiance_factors, per_coefficient

RADIANCE, RADIANCE_OVER_PI, IRRADIANCE, OVER_PI = QUANTITIES = (
    "radiance",
    "radiance-over-pi",
    "irradiance",
    "irradiance-over-pi",
)
"""The last is the radiance of a white Lambertian surface; the second what a program holds that divides it before A(l)."""

_PER_PI = "-over-pi"


def whole(quantity: str) -> str:
    """The quantity before it is divided by pi: "radiance" or "irradiance"."""
    return quantity.removesuffix(_PER_PI)


def is_over_pi(quantity: str | None) -> bool:
    return bool(quantity) and str(quantity).endswith(_PER_PI)


def to_quantity(coefficients: Array, held: str, wanted: str) -> Array:
    """Our coefficients of one quantity -> those of another. ValueError where A(l) = 0 hides the radiance."""
    n_bands = count_bands(coefficients)
    if (whole(held), whole(wanted)) == (IRRADIANCE, RADIANCE):
        factors = irradiance_factors(n_bands)
        if lost := [int(l) for l in range(n_bands) if l > 1 and l % 2]:
            raise ValueError(f"irradiance holds nothing of band {lost[0]} of the radiance; use at most {lost[0]} bands")
        coefficients = coefficients / per_coefficient(factors)
    elif (whole(held), whole(wanted)) == (RADIANCE, IRRADIANCE):
        coefficients = coefficients * per_coefficient(irradiance_factors(n_bands))
    if is_over_pi(held) != is_over_pi(wanted):
        coefficients = coefficients * (np.pi if is_over_pi(held) else 1 / np.pi)
    return np.asarray(coefficients)


def recovered_radiance(irradiance: Array) -> tuple[Array, list[int]]:
    """Our coefficients of irradiance (n**2, k) -> those of a radiance with that irradiance, and the degrees that are lost.

    Lost are the odd degrees from 3 on, where A(l) = 0; their coefficients are returned as zero.
    """
    n_bands = count_bands(irradiance)
    lost = list(range(3, n_bands, 2))
    factors = irradiance_factors(n_bands)
    factors[lost] = np.inf
    return irradiance / per_coefficient(factors), lost
