"""The integral over the sphere of a product of two lobe profiles about any two axes, to float64 accuracy.

It makes the squared norm of a sum of lobes exact, and with it every error figure of such a light (Parseval). Pairs with
a constant or two Gaussians are closed forms. The rest is one integral over the angle to the axis of the first profile: the
integral of the second one round that circle is an arc of known length, so only a piecewise analytic function of one
variable is left, which Gauss-Legendre nodes take to rounding once its pieces are known.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc, Gaussian, Profile

NODES = 64


def inner_product(first: Profile, second: Profile, angle: float) -> float:
    """Integral of first * second over the sphere, in steradians; `angle` radians lie between their axes."""
    if isinstance(first, Constant) or isinstance(second, Constant):
        other = second if isinstance(first, Constant) else first
        return float(other.zonal(1)[0])
    if isinstance(first, Gaussian) and isinstance(second, Gaussian):
        return _gaussian_product(first.sharpness, second.sharpness, angle)
    if isinstance(second, Gaussian) or (
        isinstance(first, ClampedLinear | Disc) and first.half_angle > second.half_angle
    ):
        first, second = second, first
    if angle >= first.half_angle + second.half_angle:
        return 0.0
    return _ring_by_ring(first, second, angle)


def _gaussian_product(k1: float, k2: float, angle: float) -> float:
    """exp(k1 (x1 - 1)) exp(k2 (x2 - 1)) is a Gaussian about k1 a1 + k2 a2, of sharpness |k1 a1 + k2 a2|."""
    total = k1 + k2
    deficit = 4 * k1 * k2 * np.sin(angle / 2) ** 2  # total**2 - sharpness**2, without cancellation
    sharpness = np.sqrt(max(0.0, total**2 - deficit))
    peak = np.exp(-deficit / (total + sharpness))
    if sharpness < 1e-8 * total:
        return float(4 * np.pi * peak * np.exp(-sharpness))
    return float(-2 * np.pi * peak * np.expm1(-2 * sharpness) / sharpness)


def _ring_by_ring(first: Profile, second: Profile, angle: float) -> float:
    """Sum over the angle t from the axis of `first`; between two edges a cosine map removes the square roots there."""
    edges = {0.0, first.half_angle}
    reach = second.half_angle
    edges |= {abs(angle - reach), angle + reach, 2 * np.pi - angle - reach}
    if isinstance(first, Gaussian):
        edges |= {float(step / np.sqrt(first.sharpness)) for step in (1, 2, 4, 8, 16)}
    inside = sorted(edge for edge in edges if 0 <= edge <= first.half_angle)
    nodes, weights = _gauss_legendre_unit(NODES)
    bend, slope = (1 - np.cos(np.pi * nodes)) / 2, np.pi / 2 * np.sin(np.pi * nodes)
    total = 0.0
    for low, high in pairwise(inside):
        t = low + (high - low) * bend
        values = first.value(4 * np.sin(t / 2) ** 2) * np.sin(t) * _ring_integral(second, t, angle)
        total += float((weights * slope * values).sum() * (high - low))
    return total


def _ring_integral(profile: Profile, t: Array, angle: float) -> Array:
    """Integral of a Disc or ClampedLinear over the circle at angle `t` round an axis that is `angle` away from its own."""
    middle, swing = np.cos(t) * np.cos(angle), np.sin(t) * np.sin(angle)
    edge = np.cos(profile.half_angle)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = np.where(swing > 0, (edge - middle) / swing, np.where(middle >= edge, -np.inf, np.inf))
    half_arc = np.arccos(np.clip(cosine, -1, 1))
    if isinstance(profile, Disc):
        return np.asarray(2 * half_arc)
    assert isinstance(profile, ClampedLinear)
    slope, offset = profile.parameters
    return np.asarray(2 * ((slope * middle - offset) * half_arc + slope * swing * np.sin(half_arc)))


@lru_cache(maxsize=1)
def _gauss_legendre_unit(count: int) -> tuple[Array, Array]:
    """Gauss-Legendre nodes and weights on [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1) / 2, weights / 2
