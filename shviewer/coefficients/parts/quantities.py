"""What coefficients are of: radiance, irradiance or a glossy quantity, and whether they are divided by pi."""

from __future__ import annotations

import numpy as np

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.quantities.kernels import kernel_of
from shviewer.harmonics.quantities.names import GLOSSY, IRRADIANCE, RADIANCE

_PER_PI = "-over-pi"

RADIANCE_OVER_PI, OVER_PI = RADIANCE + _PER_PI, IRRADIANCE + _PER_PI
QUANTITIES = (RADIANCE, RADIANCE_OVER_PI, IRRADIANCE, OVER_PI)
"""Those beside glossy ones, such as "glossy:0.4" (harmonics/quantities/names.py).

The last is the radiance of a white Lambertian surface; the second what a program holds that divides it before A(l).
"""

LOST = 1e-9
"""A factor below, of a kernel that is known to 1e-13, leaves no radiance to recover."""


def whole(quantity: str) -> str:
    """The quantity before it is divided by pi: "radiance", "irradiance" or a glossy one."""
    return quantity.removesuffix(_PER_PI)


def is_over_pi(quantity: str | None) -> bool:
    """Whether numbers of this quantity are divided by pi; not for one that is unknown, None."""
    return bool(quantity) and str(quantity).endswith(_PER_PI)


def to_quantity(coefficients: Array, held: str, wanted: str) -> Array:
    """Our coefficients of one quantity -> those of another. ValueError where A(l) = 0 hides the radiance, or one is glossy."""
    n_bands = count_bands(coefficients)
    if held != wanted and GLOSSY in held + wanted:
        raise ValueError(f"{held} cannot be written as {wanted}: project the light for {whole(wanted)}")
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


def recovered_radiance(held: Array, quantity: str) -> tuple[Array, list[int]]:
    """Our coefficients (n**2, k) of a quantity -> those of a radiance with just these, and the degrees that are lost.

    Lost are those whose factor is 0 or nearly, as A(l) for odd l from 3 on; their coefficients are returned as zero.
    """
    factors = kernel_of(quantity).factors(count_bands(held)).copy()
    lost = [int(l) for l in np.flatnonzero(np.abs(factors) < LOST)]
    factors[lost] = np.inf
    return held / per_coefficient(factors), lost
