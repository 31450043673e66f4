"""Rotating coefficients: those of g(s) = f(R^T s), the function f carried along by the rotation R.

R is turned about z by c, about y by b, and about z by a. About z a rotation mixes m with -m; about y it is one about z between
quarter turns about x, whose matrices are made once: with J the generator of turns about x, exp(-i pi/2 J) has the eigenvectors
of J, and eigenvalues (-i)^k, k = -l ... l, which are known exactly. There is no recurrence in l that would lose digits (Ivanic
and Ruedenberg's loses nine by l = 100), and no angle is special: c is what is left after a and b, so that what a misses where
the axis stays upright is in c. The viewer itself turns the look-up direction instead, which is exact at any n; this is for what
is written, for lights that turn, and for tests.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from shviewer.harmonics.basis import Array, check_bands, count_bands, degrees, orders
from shviewer.harmonics.metrics import band_power
from shviewer.progress import tell

MAX_ROTATED_BANDS = 128
"""The most bands: those that are shown."""

ORTHONORMAL = 1e-9
"""How far M M^T may be from the identity before a matrix is refused as no rotation."""


def rotate(coefficients: Array, rotation: ArrayLike) -> Array:
    """Coefficients of the rotated function: (n**2, ...) and a 3 x 3 matrix, v_out = M v_in -> (n**2, ...).

    ValueError if the matrix is no rotation, or for more than MAX_ROTATED_BANDS bands. The error is below 1e-13 of
    the largest coefficient.
    """
    n_bands = count_bands(coefficients)
    check_bands(n_bands, MAX_ROTATED_BANDS)
    about, over, last = _angles(check_rotation(rotation))
    columns = coefficients.reshape(n_bands**2, -1).astype(np.float64)
    rotated = _about_z(_quartered(_about_z(columns, last), back=False), over)
    rotated = _about_z(_quartered(rotated, back=True), about)
    return (rotated * _power_kept(columns, rotated)).reshape(coefficients.shape)


def _angles(matrix: Array) -> tuple[float, float, float]:
    """a, b and c."""
    about = float(np.arctan2(matrix[1, 2], matrix[0, 2]))
    over = float(np.arctan2(np.hypot(matrix[0, 2], matrix[1, 2]), matrix[2, 2]))
    ca, sa, cb, sb = np.cos(about), np.sin(about), np.cos(over), np.sin(over)
    left = np.array([[cb * ca, cb * sa, -sb], [-sa, ca, 0.0]]) @ matrix[:, 0]  # of +x, where c turns it
    return about, over, float(np.arctan2(left[1], left[0]))


def _about_z(columns: Array, angle: float) -> Array:
    """cos(m phi) becomes cos(m (phi - angle)), and so with sin."""
    m = orders(count_bands(columns))
    other = columns[np.arange(len(m)) - 2 * m]
    return np.asarray(np.cos(m * angle)[:, None] * columns - np.sin(m * angle)[:, None] * other)


def _quartered(columns: Array, *, back: bool) -> Array:
    """After a quarter turn about x, or back."""
    turned, n_bands = np.empty_like(columns), count_bands(columns)
    for l in range(n_bands):
        tell(share=l / n_bands)  # the matrices of 128 bands take most of a second to be made
        quarter = _quarter(l)
        turned[l * l : (l + 1) ** 2] = (quarter.T if back else quarter) @ columns[l * l : (l + 1) ** 2]
    return turned


@lru_cache(MAX_ROTATED_BANDS)
def _quarter(l: int) -> Array:
    """The matrix (2l+1, 2l+1) of a quarter turn about x, of one degree, by m from -l to l."""
    m = np.arange(-l, l)
    steps = np.sqrt(l * (l + 1) - m * (m + 1)) / 2
    vectors = np.linalg.eigh(np.diag(steps, 1) + np.diag(steps, -1))[1]
    turned = (vectors * np.array([1, -1j, -1, 1j])[np.arange(-l, l + 1) % 4]) @ vectors.T
    to_complex = np.zeros((2 * l + 1, 2 * l + 1), dtype=np.complex128)  # convention.to_complex, as a matrix
    to_complex[l, l] = 1
    for k in range(1, l + 1):
        to_complex[l + k, [l + k, l - k]] = np.array([1, -1j]) / np.sqrt(2)
        to_complex[l - k, [l + k, l - k]] = (-1) ** k * np.array([1, 1j]) / np.sqrt(2)
    found = (to_complex.conj().T @ turned @ to_complex).real
    return np.asarray(found @ (3 * np.eye(2 * l + 1) - found.T @ found) / 2)  # as orthogonal as roundings let it be


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
