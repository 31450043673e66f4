"""The integral over the sphere of a product of two lobe profiles about any two axes, to float64 accuracy.

It makes the squared norm of a sum of lobes exact, and with it every error figure of such a light (Parseval). Pairs with a
constant, and pairs of Gaussians, have closed forms. Any other pair is one integral over the angle to the axis of the first
profile: round that circle the second profile integrates in closed form. So only a piecewise analytic function of one variable
is left, which Gauss-Legendre nodes integrate to rounding once its pieces are known.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from shviewer.harmonics.basis import Array
from shviewer.harmonics.quadrature import gauss_unit
from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc, Gaussian, Profile

NODES = 64
BLOCK = 128
"""How many angles are worked on at a time, so that the nodes of all their pieces stay in the cache."""


def inner_product(first: Profile, second: Profile, angle: ArrayLike) -> Array:
    """Integral of first * second over the sphere, in steradians, for angles (radians) between their axes; same shape."""
    angle = np.asarray(angle, dtype=np.float64)
    if isinstance(first, Constant) or isinstance(second, Constant):
        other = second if isinstance(first, Constant) else first
        return np.full(angle.shape, other.zonal(1)[0])
    if isinstance(first, Gaussian) and isinstance(second, Gaussian):
        return _gaussian_product(first.sharpness, second.sharpness, angle)
    if isinstance(second, Gaussian) or (not isinstance(first, Gaussian) and first.half_angle > second.half_angle):
        first, second = second, first
    flat = angle.ravel()
    blocks = [_ring_by_ring(first, second, flat[start : start + BLOCK]) for start in range(0, len(flat), BLOCK)]
    return np.concatenate(blocks).reshape(angle.shape)


def _gaussian_product(k1: float, k2: float, angle: Array) -> Array:
    """Two Gaussians: exp(k1 (x1 - 1)) exp(k2 (x2 - 1)) is a Gaussian about k1 a1 + k2 a2, of sharpness |k1 a1 + k2 a2|."""
    total = k1 + k2
    deficit = 4 * k1 * k2 * np.sin(angle / 2) ** 2  # total**2 - sharpness**2, without cancellation
    sharpness = np.maximum(np.sqrt(np.maximum(0, total**2 - deficit)), 1e-12 * total)
    peak = np.exp(-deficit / (total + sharpness))
    return np.asarray(-2 * np.pi * peak * np.expm1(-2 * sharpness) / sharpness)


def _ring_by_ring(first: Profile, second: Profile, angle: Array) -> Array:
    """Sum over the angle t from the axis of `first`; between two edges a cosine map removes the square roots there."""
    reach = second.half_angle
    edges = [0 * angle, np.abs(angle - reach), angle + reach, 2 * np.pi - angle - reach]
    if isinstance(first, Gaussian):
        edges += [np.full(angle.shape, step / np.sqrt(first.sharpness)) for step in (1, 2, 4, 8, 16)]
    pieces = np.sort(np.clip(np.stack([*edges, np.full(angle.shape, np.pi)]), 0, first.half_angle), axis=0)
    nodes, weights = gauss_unit(NODES)
    bend, slope = (1 - np.cos(np.pi * nodes)) / 2, np.pi / 2 * np.sin(np.pi * nodes)
    low, length = pieces[:-1, :, None], np.diff(pieces, axis=0)[..., None]
    t = low + length * bend  # piece, angle, node
    values = first.value(4 * np.sin(t / 2) ** 2) * np.sin(t) * _ring_integral(second, t, angle[:, None])
    return np.asarray((weights * slope * values * length).sum(axis=(0, 2)))


def _ring_integral(profile: Profile, t: Array, angle: Array) -> Array:
    """Integral of a Disc or ClampedLinear over the circle at angle `t` round an axis that is `angle` away from its own.

    With b the profile's half-angle, x = cos(t - angle) - 2 sin(t) sin(angle) sin(phi/2)^2 round the circle, and
    cos(t - angle) - cos(b) = 2 sin((b + t - angle)/2) sin((b - t + angle)/2): tiny caps keep their digits.
    """
    reach = profile.half_angle
    swing = np.sin(t) * np.sin(angle)
    rise = 2 * np.sin((reach + t - angle) / 2) * np.sin((reach - t + angle) / 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        half_arc = 2 * np.arcsin(np.sqrt(np.clip(np.nan_to_num(rise / (2 * swing), nan=0.0), 0, 1)))
    if isinstance(profile, Disc):
        return np.asarray(2 * half_arc)
    assert isinstance(profile, ClampedLinear)
    slope, offset = profile.parameters
    floor = max(0.0, -slope - offset)  # above zero everywhere where nothing is clamped
    return np.asarray(2 * (slope * (rise * half_arc - swing * (half_arc - np.sin(half_arc))) + floor * half_arc))
