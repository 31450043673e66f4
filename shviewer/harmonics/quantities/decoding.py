"""Irradiance in any direction from the numbers that an encoding keeps of it: the formulas of shaders/encodings.glsl.

Numbers are (floats, channels): c0 ... c3, the coefficients of radiance in its first two bands, and what an encoding keeps
beyond them. v = (-c3, -c1, c2), u = v/|v|, n a unit normal; A(l) are the factors of irradiance_factors.
    l1            A(0) Y(0,0) c0 + A(1) sqrt(3/(4 pi)) v.n
    geomerics     pi R0 (a + (1-a)(p+1) q^p), q = (1 + n.u)/2, r = |v|/(sqrt(3) c0) but at most 1, p = 1 + 2r, a = (1-r)/(1+r),
                  R0 = c0/(2 sqrt pi) the mean radiance [Hazel]
    zh3           l1 + A(2) z sqrt(5/(16 pi)) (3 (u.n)^2 - 1), z the fifth number
    hallucinated  the same with z = c0 s (0.08 + 0.6 s), s = |v.u|/c0 [Roughton]
    ...-shared    u is that of the luminance, the same for all channels
    l2            the sum of A(l) c(l, m) Y(l, m) over three bands, nine numbers
    cube          n_x^2 e(+-x) + n_y^2 e(+-y) + n_z^2 e(+-z), six numbers e(+x), e(-x), e(+y) ...
Where v is 0 there is no axis, and what needs one is l1; where c0 is not positive, r and s are 0.

Sources
    [Hazel]    G. Hazel, "Reconstructing Diffuse Lighting from Spherical Harmonic Data" (2017).
    [Roughton] T. Roughton, P.-P. Sloan, A. Silvennoinen, M. Iwanicki, P. Shirley, "ZH3: Quadratic Zonal Harmonics", i3D 2024.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from math import pi, sqrt
from types import MappingProxyType

import numpy as np

from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.metrics import LUMINANCE

MEAN, LINEAR, ZONAL = sqrt(pi) / 2, sqrt(pi / 3), sqrt(5 * pi) / 16
"""A(0) Y(0,0), A(1) sqrt(3/(4 pi)) and A(2) sqrt(5/(16 pi))."""


def vectors(numbers: Array) -> Array:
    """v of each channel, (channels, 3)."""
    return np.asarray(numbers[[3, 1, 2]].T * [-1, -1, 1])


def axes(numbers: Array, shared: bool) -> tuple[Array, Array]:
    """u of each channel, (channels, 3), and 1 where there is one, else 0, (channels,)."""
    v = vectors(numbers)
    v = np.broadcast_to(LUMINANCE @ v, v.shape) if shared else v
    length = lengths(v)
    there = length > 0
    u = np.where(there[:, None], v / np.where(there, length, 1)[:, None], [0.0, 0.0, 1.0])
    return np.asarray(u), there.astype(np.float64)


def lengths(vectors: Array) -> Array:
    """Lengths of vectors (k, 3), of any size: their squares are never formed."""
    largest = np.abs(vectors).max(axis=1)
    unit = np.where(largest > 0, largest, 1.0)
    return np.asarray(largest * np.sqrt(((vectors / unit[:, None]) ** 2).sum(axis=1)))


def one_sidedness(numbers: Array, length: Array, ratio: float) -> Array:
    """`ratio` |v|/c0 of each channel, (3,), 0 where c0 is not positive. length: |v|, (3,)."""
    positive = numbers[0] > 0
    return np.asarray(np.where(positive, ratio * length / np.where(positive, numbers[0], 1.0), 0.0))


def hallucination(numbers: Array, shared: bool) -> Array:
    """z of each channel, (3,), as it is guessed from the other four numbers."""
    along = np.abs((vectors(numbers) * axes(numbers, shared)[0]).sum(axis=1))
    s = one_sidedness(numbers, along, 1.0)
    return np.asarray(numbers[0] * s * (0.08 + 0.6 * s))


def _l1(numbers: Array, normals: Array) -> Array:
    return np.asarray(MEAN * numbers[0] + LINEAR * normals @ vectors(numbers).T)


def _geomerics(numbers: Array, normals: Array) -> Array:
    u, there = axes(numbers, shared=False)
    r = np.minimum(one_sidedness(numbers, lengths(vectors(numbers)), 1 / np.sqrt(3)), 1.0)
    p, a = 1 + 2 * r, (1 - r) / (1 + r)
    q = np.maximum(0.5 + 0.5 * there * (normals @ u.T), 0.0)
    return np.asarray(MEAN * numbers[0] * (a + (1 - a) * (p + 1) * q**p))


def _zh3(numbers: Array, normals: Array, shared: bool) -> Array:
    return _with_zonal(numbers, numbers[4], normals, shared)


def _hallucinated(numbers: Array, normals: Array, shared: bool) -> Array:
    return _with_zonal(numbers, hallucination(numbers, shared), normals, shared)


def _with_zonal(numbers: Array, z: Array, normals: Array, shared: bool) -> Array:
    u, there = axes(numbers, shared)
    return _l1(numbers, normals) + np.asarray(ZONAL * there * z * (3 * (normals @ u.T) ** 2 - 1))


def _l2(numbers: Array, normals: Array) -> Array:
    return np.asarray(evaluate_basis(normals, 3) @ (numbers * per_coefficient(irradiance_factors(3))))


def _cube(numbers: Array, normals: Array) -> Array:
    squares = normals[:, :, None] ** 2
    return np.asarray((squares * np.where(normals[:, :, None] >= 0, numbers[0::2], numbers[1::2])).sum(axis=1))


FORMULAS: Mapping[str, Callable[[Array, Array], Array]] = MappingProxyType(
    {
        "l1": _l1,
        "geomerics": _geomerics,
        "hallucinated": partial(_hallucinated, shared=False),
        "hallucinated_shared": partial(_hallucinated, shared=True),
        "zh3": partial(_zh3, shared=False),
        "zh3_shared": partial(_zh3, shared=True),
        "l2": _l2,
        "cube": _cube,
    }
)
"""Name of a formula -> numbers (floats, channels), unit normals (k, 3) -> irradiance (k, channels)."""
