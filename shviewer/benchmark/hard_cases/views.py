"""The views that the shader draws for the cases that concern it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shviewer.benchmark.hard_cases.shader import FROM_NORTH, FROM_SOUTH, View
from shviewer.harmonics.basis import Array, degrees, evaluate_basis
from shviewer.harmonics.zonal import Disc, orient
from shviewer.viewer.camera import world_from_view

SEED = 20_240_601
"""The seed of everything random in the table."""

SUN_AXIS = (0.36, -0.48, 0.8)
SUN, SKY, SUN_HALF_ANGLE = 1.6e9, 1e3, 0.265
"""Radiances of sun and sky, in any unit, and the sun's half-angle in degrees."""

OBLIQUE = world_from_view(78.0, 22.0)
"""The matrix of a camera that is on no axis."""


def delta(direction: Sequence[float], n_bands: int = 32) -> Array:
    """Coefficients of a point light, which peaks at n^2/4pi and cancels to nothing elsewhere."""
    return evaluate_basis(np.array(direction), n_bands)


def noise(n_bands: int) -> Array:
    return np.random.default_rng(SEED).normal(size=n_bands**2)


def pole_views() -> list[View]:
    """Both poles in the middle, whole and magnified 50, 1e4 and 1e8 times, for white noise and a point light beside."""
    everything = [noise(32), delta([1e-3, 2e-3, 1]), delta([1e-3, 2e-3, -1])]
    glasses = (78.0, 4e3, 1e6, 1e10)
    return [View(c, camera, radius) for c in everything for camera in (FROM_NORTH, FROM_SOUTH) for radius in glasses]


def seam_views() -> list[View]:
    """A camera on -x: the seam runs down the middle, whole and magnified."""
    from_behind = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    return [View(c, from_behind, r) for c in (noise(32), delta([-1, 1e-3, 0.2])) for r in (78.0, 1e6)]


def factorial_views() -> list[View]:
    """All orders of the degrees 17 to 31, where factorials have left float32."""
    return [View(np.where(degrees(32) >= 17, lights, 0), OBLIQUE) for lights in (noise(32), delta([1, 2, 3]))]


def noise_views() -> list[View]:
    """White noise from several sides."""
    return [View(noise(n), camera) for n in (2, 16, 32) for camera in (OBLIQUE, FROM_NORTH, FROM_SOUTH)]


def sun_views() -> list[View]:
    """The sun and the sky in 32 bands."""
    sun = orient(Disc(float(np.radians(SUN_HALF_ANGLE))).zonal(32), np.array(SUN_AXIS)) * (SUN - SKY)
    sun[0] += SKY * np.sqrt(4 * np.pi)
    return [View(sun, OBLIQUE), View(sun)]


def cancelling_views() -> list[View]:
    """Two suns of +-1e6 close together over 1e-3: away from them terms of 1e6 have to leave 1e-3."""
    pair = (delta([0.6, 0, 0.8]) - delta([0.62, 0.01, 0.8])) * 1e6
    pair[0] += 1e-3 * np.sqrt(4 * np.pi)
    return [View(pair, OBLIQUE), View(pair), View(pair, FROM_SOUTH)]
