"""Encodings of irradiance that engines store in fewer numbers than bands have, made of the first nine coefficients of radiance.

Each is a function of the normal, and here its irradiance as coefficients. All but Geomerics' hold three bands at most; that one
has every band, in closed form, and its first GEOMERICS_BANDS are given, which leave less than 1e-5 of its peak. With c the
coefficients of a channel, v = (-c3, -c1, c2) the vector of band 1, u = v/|v|, R0 = c0/(2 sqrt pi) the mean radiance:
    l1              A(l) c(l, m) of two bands.
    geomerics       pi R0 (a + (1-a)(p+1) q^p), q = (1 + n.u)/2, r = |v|/(sqrt(3) c0), p = 1 + 2r, a = (1-r)/(1+r) [Hazel].
                    q^p has the zonal coefficients 4 pi/(p+1) times the product of (p-k+1)/(p+k+1) for k = 1 ... l.
    zh3             l1 and the part of band 2 that is symmetric about u, z = sqrt(4 pi/5) sum of Y(2, m)(u) c(2, m).
    hallucinated    the same with z = c0 s (0.08 + 0.6 s), s = |v|/c0, which needs no fifth number [Roughton].
    ...-shared      one axis for all channels, that of their luminance, as programs do.
    l2, l2-deringed A(l) c(l, m) of three bands, as they are and with the factors of deringing.py.
Where v is 0 there is no axis, and what needs one is l1.

Sources
    [Hazel]    G. Hazel, "Reconstructing Diffuse Lighting from Spherical Harmonic Data" (2017).
    [Roughton] T. Roughton, P.-P. Sloan, A. Silvennoinen, M. Iwanicki, P. Shirley, "ZH3: Quadratic Zonal Harmonics", i3D 2024.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.deringing import dering
from shviewer.harmonics.extremes.climbing import climb
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quadrature import fibonacci
from shviewer.harmonics.quantities.names import ENCODED_BANDS
from shviewer.harmonics.zonal import orient

BANDS = 3
"""Bands of radiance that encodings are made of."""

GEOMERICS_BANDS = ENCODED_BANDS["geomerics"]

SEARCHED, SEARCH_ROUNDS = 2000, 40
"""Directions, and rounds of climbing from the best of them, for the axis of `solved`."""


class Encoding(NamedTuple):
    """One way to store irradiance."""

    words: str
    floats: int
    """Numbers that are stored for a channel."""
    bands: int
    """Bands of the irradiance that it stands for."""
    make: Callable[[Array], Array]
    """Radiance (9, 3) -> irradiance (bands**2, 3)."""


def vectors(radiance: Array) -> Array:
    """v of each channel, (channels, 3)."""
    return np.asarray(radiance[[3, 1, 2]].T * [-1, -1, 1])


def _axes(radiance: Array, shared: bool) -> tuple[Array, Array]:
    """u of each channel, (3, 3), and 1 where there is one, else 0, (3,)."""
    v = vectors(radiance)
    v = np.broadcast_to(LUMINANCE @ v, v.shape) if shared else v
    length = np.linalg.norm(v, axis=1)
    there = length > 0
    u = np.where(there[:, None], v / np.where(there, length, 1)[:, None], [0.0, 0.0, 1.0])
    return np.asarray(u), there.astype(np.float64)


def linear(radiance: Array, n_bands: int) -> Array:
    return np.asarray(radiance[: n_bands**2] * per_coefficient(irradiance_factors(n_bands)))


def geomerics(radiance: Array, scale: float = 1.0, ratio: float = 1 / np.sqrt(3)) -> Array:
    """scale, ratio: what is wrong with other variants: a factor of all, and |v|/c0 times `ratio` in place of r."""
    found = np.zeros((GEOMERICS_BANDS**2, 3))
    k = np.arange(1, GEOMERICS_BANDS)
    for channel, (c0, v) in enumerate(zip(radiance[0], vectors(radiance), strict=True)):
        length = float(np.linalg.norm(v))
        r = min(ratio * length / c0, 1.0) if c0 > 0 else 0.0
        p, mean = 1 + 2 * r, scale * np.pi * c0 / (2 * np.sqrt(np.pi))
        zonal = np.append(1.0, 2 * r / (1 + r) * np.cumprod((p - k + 1) / (p + k + 1))) * 4 * np.pi * mean
        axis = v / length if length > 0 else np.array([0.0, 0.0, 1.0])
        found[:, channel] = orient(zonal, axis)
    return found


def code_as_is(radiance: Array) -> Array:
    """Geomerics' as it stands in common code: radiance in place of irradiance, so that all surfaces are 12.84 % too bright."""
    return geomerics(radiance, scale=2 / np.sqrt(np.pi), ratio=0.5)


def zh3(radiance: Array, shared: bool = False) -> Array:
    axes, there = _axes(radiance, shared)
    along = (evaluate_basis(axes, BANDS)[:, 4:] * radiance[4:].T).sum(axis=1)
    return _with_zonal(radiance, axes, there * np.sqrt(4 * np.pi / 5) * along)


def hallucinated(radiance: Array, shared: bool = False) -> Array:
    axes, there = _axes(radiance, shared)
    c0 = radiance[0]
    ratio = np.abs((vectors(radiance) * axes).sum(axis=1)) / np.where(c0 > 0, c0, np.inf)
    return _with_zonal(radiance, axes, there * c0 * ratio * (0.08 + 0.6 * ratio))


def solved(radiance: Array) -> Array:
    """Like zh3, with band 1 changed so that band 1 and 2 of the irradiance together are as near as five numbers can be.

    For an axis u the best band 1 is its part along u, if that is positive: what is left is least where v.u^2 + z(u)^2 is most.
    """
    factors = irradiance_factors(BANDS)
    changed = radiance.copy()
    for channel in range(3):
        own = radiance[:, [channel]]
        v = vectors(own)[0]

        def kept(u: Array, own: Array = own, v: Array = v) -> Array:
            along = np.sqrt(4 * np.pi / 5) * (evaluate_basis(u, BANDS)[:, 4:] @ own[4:, 0])
            return np.asarray((factors[1] * np.maximum(u @ v, 0)) ** 2 + (factors[2] * along) ** 2)

        starts = fibonacci(SEARCHED).directions
        best = starts[np.argsort(-kept(starts))[:8]]
        values, found = climb(kept, best, 2 / np.sqrt(SEARCHED), SEARCH_ROUNDS)
        u = found[int(np.argmax(values))]
        changed[[3, 1, 2], channel] = max(float(v @ u), 1e-12 * float(np.linalg.norm(v))) * u * [-1, -1, 1]
    return zh3(changed)


def _with_zonal(radiance: Array, axes: Array, z: Array) -> Array:
    """l1, and the zonal band 2 of z about the axes: (9, 3)."""
    band = evaluate_basis(axes, BANDS)[:, 4:].T * (z * np.sqrt(4 * np.pi / 5))
    return linear(np.concatenate([radiance[:4], band]), BANDS)


def deringed(radiance: Array) -> Array:
    shaded = linear(radiance, BANDS)
    return np.asarray(shaded * per_coefficient(dering(shaded).factors))


ENCODINGS = {
    "l1": Encoding("L1, linear", 4, 2, lambda c: linear(c, 2)),
    "geomerics": Encoding("L1, Geomerics", 4, GEOMERICS_BANDS, geomerics),
    "hallucinated": Encoding("ZH3 hallucinated", 4, BANDS, hallucinated),
    "hallucinated-shared": Encoding("ZH3 hallucinated, shared axis", 4, BANDS, lambda c: hallucinated(c, shared=True)),
    "zh3": Encoding("ZH3", 5, BANDS, zh3),
    "zh3-shared": Encoding("ZH3, shared axis", 5, BANDS, lambda c: zh3(c, shared=True)),
    "l2": Encoding("L2, linear", 9, BANDS, lambda c: linear(c, BANDS)),
    "l2-deringed": Encoding("L2, deringed", 9, BANDS, deringed),
}
"""Those that can be looked at, by their names on the command line."""

REPORTED = ENCODINGS | {
    "zh3-solved": Encoding("ZH3, solved", 5, BANDS, solved),
    "code-as-is": Encoding("a trap: Geomerics as in common code", 4, GEOMERICS_BANDS, code_as_is),
}
"""Those of the report."""
