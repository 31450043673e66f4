"""Rotating coefficients: those of g(s) = f(R^T s), the function f carried along by the rotation R.

The rotated function is evaluated and projected again on Gauss-Legendre points that integrate every product of two n-band
functions exactly. Nothing but the 3 x 3 matrix enters, so there are no angles, no gimbal and no recurrence in l that
would lose digits (Ivanic and Ruedenberg's loses nine by l = 100). The viewer itself turns the look-up direction
instead, which is exact at any n; this is for what is written, and for tests.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from shviewer.harmonics.basis import Array, check_bands, count_bands, degrees, evaluate_basis
from shviewer.harmonics.metrics import band_power
from shviewer.harmonics.projection import BLOCK_VALUES
from shviewer.harmonics.quadrature import gauss_legendre
from shviewer.progress import tell

MAX_ROTATED_BANDS = 128
"""The most bands: with more, one rotation takes over a minute."""

ORTHONORMAL = 1e-9
"""How far M M^T may be from the identity before a matrix is refused as no rotation."""


def rotate(coefficients: Array, rotation: ArrayLike) -> Array:
    """Coefficients of the rotated function: (n**2, ...) and a 3 x 3 matrix, v_out = M v_in -> (n**2, ...).

    ValueError if the matrix is no rotation, or for more than MAX_ROTATED_BANDS bands. The error is below 1e-13 of
    the largest coefficient up to 64 bands.
    """
    n_bands = count_bands(coefficients)
    check_bands(n_bands, MAX_ROTATED_BANDS)
    matrix = check_rotation(rotation)
    columns = coefficients.reshape(n_bands**2, -1)
    points = gauss_legendre(2 * n_bands**2).direction_set()
    rotated = np.zeros_like(columns, dtype=np.float64)
    block = max(64, BLOCK_VALUES // n_bands**2)
    for start in range(0, len(points.weights), block):
        tell(share=start / len(points.weights))
        here = points.directions[start : start + block]
        values = evaluate_basis(here @ matrix, n_bands) @ columns  # row vectors: here @ M is M^T applied to each
        rotated += evaluate_basis(here, n_bands).T @ (points.weights[start : start + block, None] * values)
    return (rotated * _power_kept(columns, rotated)).reshape(coefficients.shape)


def _power_kept(before: Array, after: Array) -> Array:
    """The factor per band and column, next to 1, that gives a band the power it had: (n**2, k).

    A rotation keeps it exactly, the sum over the points to a few roundings, which would add up over many rotations.
    """
    power, kept = band_power(before), band_power(after)
    with np.errstate(divide="ignore", invalid="ignore"):
        factors = np.where(kept > 0, np.sqrt(power / kept), 1.0)
    return np.asarray(factors[degrees(len(factors))])


def turn(azimuth: float, elevation: float, roll: float = 0.0) -> Array:
    """The rotation, degrees, by `roll` about +x and then +x to an azimuth (from +x towards +y) and an elevation: 3 x 3."""
    a, e, r = np.radians([azimuth, elevation, roll])
    about_x = np.array([[1, 0, 0], [0, np.cos(r), -np.sin(r)], [0, np.sin(r), np.cos(r)]])
    about_y = np.array([[np.cos(e), 0, -np.sin(e)], [0, 1, 0], [np.sin(e), 0, np.cos(e)]])
    about_z = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x)


def check_rotation(rotation: ArrayLike) -> Array:
    """The nearest rotation, (3, 3), to a matrix of that shape. ValueError if it is not one to within ORTHONORMAL."""
    matrix = np.asarray(rotation, dtype=np.float64)
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
        raise ValueError(f"a rotation is a finite 3 x 3 matrix, not {np.asarray(rotation).tolist()}")
    defect = float(np.abs(matrix @ matrix.T - np.eye(3)).max())
    if defect > ORTHONORMAL or np.linalg.det(matrix) < 0:
        raise ValueError(
            f"M M^T is {defect:.1e} from the identity and det M is {np.linalg.det(matrix):.3f}: a rotation has 0 and 1"
        )
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ right)
