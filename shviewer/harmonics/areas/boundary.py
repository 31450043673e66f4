"""Integrals of the basis over areas of the sphere from their boundaries alone.

By Green's theorem, for a function that is f(theta) times {cos, sin}(m phi),
    integral of it over an area = the integral of F(theta) {cos, sin}(m phi) d(phi) along its boundary,   F' = f sin(theta),
counterclockwise as seen from outside. With F(pi) = 0 the south pole is no exception; the north pole must not be in the area,
nor near it. The waves of theta_series.py are such functions, and their F are waves again, but for a constant:
    f = cos(k theta):   F = cos((k-1) theta) / (2 (k-1)) - cos((k+1) theta) / (2 (k+1)),   for k = 1 without the first,
    f = sin(k theta):   F = sin((k-1) theta) / (2 (k-1)) - sin((k+1) theta) / (2 (k+1)),   for k = 1 (theta - pi) / 2 first.
So one plain sum of waves over the boundary is all that is needed.
"""

from __future__ import annotations

import numpy as np

from shviewer.harmonics.areas.patches import mirrored_waves
from shviewer.harmonics.basis import Array, check_bands
from shviewer.harmonics.projection.row_transform import by_parity
from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS, from_waves


def project_boundary(directions: Array, values: Array, n_bands: int) -> Array:
    """Coefficients (n**2, channels) of areas of constant value, from points on their boundaries and on mirror images of them.

    directions: (k, 3). values: (x, y, z, k, channels), as in `project_mirrored`: value times d(phi).
    """
    check_bands(n_bands, MAX_SEPARABLE_BANDS)
    sums = np.empty((n_bands, 2, values.shape[-1], n_bands + 1))
    sums[..., by_parity(n_bands + 1)] = mirrored_waves(directions, values, n_bands + 1)[:n_bands]
    k = np.arange(n_bands)
    apart = np.where(k == 1, np.inf, k - 1)
    areas = sums[..., np.abs(k - 1)] / apart - sums[..., 1:] / (k + 1)
    if n_bands > 1:
        areas[1::2, ..., 1] += sums[1::2, ..., 0]
    areas[::2] -= sums[::2, ..., :1] * ((-1.0) ** (k - 1) * (1 / apart - 1 / (k + 1)))
    return from_waves(areas[..., by_parity(n_bands)] / 2)
