"""Ambient cubes: irradiance as six numbers a channel, one for each direction along an axis of the world.

E(n) = n_x^2 e(+-x) + n_y^2 e(+-y) + n_z^2 e(+-z), with the faces that n looks at [G. McTaggart, "Half-Life 2 / Valve Source
Shading", GDC 2004]. It belongs to the axes: the cube of a turned light is another. What a face adds is x^2 on its half of the
sphere, zonal about its axis, with every band.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from shviewer.harmonics.basis import Array, count_bands, evaluate_basis
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.zonal import orient
from shviewer.limits import MAX_DIRECT_BANDS

FACES = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=np.float64)
"""+x, -x, +y, -y, +z, -z, as engines have them."""

CUBE_BANDS = MAX_DIRECT_BANDS
"""Bands of radiance that a cube is made of, and of irradiance that stand for it: they leave some 3e-4 of its largest face."""


def sampled(radiance: Array, faces: Array = FACES) -> Array:
    """The irradiance (6, 3) in the faces' directions, from coefficients (n**2, 3) of radiance. faces: FACES, or turned."""
    irradiance = _irradiance(radiance)
    return np.asarray(evaluate_basis(faces, count_bands(irradiance)) @ irradiance)


def fitted(radiance: Array, faces: Array = FACES) -> Array:
    """The faces (6, 3) whose cube is nearest to the irradiance in the L2 sense; some may be negative."""
    irradiance = _irradiance(radiance)
    return np.asarray(np.linalg.solve(_gram(), orient(_face(count_bands(irradiance)), faces) @ irradiance))


def bands_of_cube(numbers: Array, faces: Array = FACES) -> Array:
    """The first CUBE_BANDS bands of a cube of six numbers a channel, (CUBE_BANDS**2, 3)."""
    return np.asarray(orient(_face(CUBE_BANDS), faces).T @ numbers)


def products_of_cube(numbers: Array) -> Array:
    """Integrals of E_i E_j over the sphere for channels i and j of a cube, with all its bands, (3, 3)."""
    return np.asarray(numbers.T @ _gram() @ numbers)


def _gram() -> Array:
    """Integrals of the products of what two faces add, (6, 6): of x^4 on a half, of x^2 y^2 on a quarter of the sphere."""
    one, other = 2 * np.pi / 5, np.pi / 15
    return np.asarray(one * np.eye(len(FACES)) + other * (1 - np.abs(FACES @ FACES.T)))


def _irradiance(radiance: Array) -> Array:
    n_bands = min(count_bands(radiance), CUBE_BANDS)
    return np.asarray(radiance[: n_bands**2] * per_coefficient(irradiance_factors(n_bands)))


@cache
def _face(n_bands: int) -> Array:
    """2 pi times the integral of x^2 P_l(x) from 0 to 1 for every degree, (n_bands,): exact by so many nodes."""
    nodes, weights = np.polynomial.legendre.leggauss(n_bands // 2 + 2)
    x = (1 + nodes) / 2
    return np.asarray(np.pi * (weights * x**2) @ np.polynomial.legendre.legvander(x, n_bands - 1))
