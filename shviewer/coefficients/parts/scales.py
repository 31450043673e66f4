"""Normalisations: the factors from our coefficients to those for other basis functions, which are ours over them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shviewer.harmonics.basis import Array, degrees, normalisation, orders

POLYNOMIAL_BANDS = 3
LEADING = np.array([1.0, 1.0, 1.0, 1.0, 2.0, 1.0, 0.5, 1.0, 1.0])
"""The factors that make 1, y, z, x, xy ... Im or Re (x + iy)^m times G(l, m): Im (x + iy)^2 is 2xy, P(2) (3z^2-1)/2."""

FUMA_BANDS = 4

_FUMA_WEIGHTS = {
    (0, 0): 1 / np.sqrt(2),
    (2, 1): 2 / np.sqrt(3),
    (2, 2): 2 / np.sqrt(3),
    (3, 1): np.sqrt(45 / 32),
    (3, 2): 3 / np.sqrt(5),
    (3, 3): np.sqrt(8 / 5),
}
"""(l, |m|) -> what FuMa's weight is over SN3D's: no channel but W exceeds 1 for a plane wave (D. Malham, 1999)."""


def _orthonormal(n_bands: int) -> Array:
    return np.ones(n_bands**2)


def _four_pi(n_bands: int) -> Array:
    """The factors for basis functions of mean square 1, which are sqrt(4 pi) times ours."""
    return np.full(n_bands**2, 1 / np.sqrt(4 * np.pi))


def _schmidt(n_bands: int) -> Array:
    """The factors for Schmidt's semi-normalised functions, of mean square 1/(2l+1), when the function is their plain sum."""
    return np.asarray(np.sqrt((2 * degrees(n_bands) + 1) / (4 * np.pi)))


def _sn3d(n_bands: int) -> Array:
    """The factors for ambisonics: integrals of the function with SN3D functions, which are ours times sqrt(4 pi/(2l+1))."""
    return np.sqrt(4 * np.pi / (2 * degrees(n_bands) + 1))


def _fuma(n_bands: int) -> Array:
    """The factors for B-format: those of SN3D times a weight of each channel. ValueError for more than four bands."""
    if n_bands > FUMA_BANDS:
        raise ValueError(f"{n_bands} bands: FuMa's weights are defined for 1 to {FUMA_BANDS}")
    pairs = zip(degrees(n_bands).tolist(), np.abs(orders(n_bands)).tolist(), strict=True)
    return np.asarray(_sn3d(n_bands) * np.array([_FUMA_WEIGHTS.get(pair, 1.0) for pair in pairs]))


def _polynomial(n_bands: int) -> Array:
    """The factors for 1, y, z, x, xy, yz, 3z^2-1, xz and x^2-y^2: the coefficient holds the constant in front of each.

    ValueError for more than three bands.
    """
    if n_bands > POLYNOMIAL_BANDS:
        raise ValueError(f"{n_bands} bands: coefficients of polynomials are defined for 1 to {POLYNOMIAL_BANDS}")
    l, m = degrees(n_bands), np.abs(orders(n_bands))
    return np.asarray(np.abs(normalisation(n_bands)[l, m]) * LEADING[: n_bands**2])


SCALES: dict[str, tuple[Callable[[int], Array], str]] = {
    "orthonormal": (_orthonormal, "orthonormal real spherical harmonics"),
    "4pi": (_four_pi, "4-pi-normalised real spherical harmonics (mean square 1)"),
    "schmidt": (_schmidt, "Schmidt semi-normalised real spherical harmonics (mean square 1/(2l+1))"),
    "sn3d": (_sn3d, "SN3D real spherical harmonics; the numbers are integrals with them"),
    "fuma": (_fuma, "SN3D real spherical harmonics with FuMa's weights; the numbers are integrals with them"),
    "polynomial": (_polynomial, "1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2, their constants in the numbers"),
}
"""Normalisation -> the factors from our coefficients to theirs, (n_bands**2,), and the basis in words."""
