"""A light that is a sum of lobes: coefficients at every band, norm and radiance all in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from shviewer.harmonics.basis import Array, normalise
from shviewer.harmonics.overlap import inner_product
from shviewer.harmonics.zonal import Profile, orient
from shviewer.limits import check_brightness

EDGE = 1e-9
"""How far from an edge, relative to its angle, a landmark lies."""

MAX_LOBES = 64
"""As many as the uniform block of shaders/lobes.glsl holds."""


@dataclass(frozen=True, eq=False)
class Lobe:
    """A profile about `axis` (3,), any length, times `radiance` (3,), linear RGB."""

    profile: Profile
    axis: Array
    radiance: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "axis", normalise(self.axis))
        object.__setattr__(self, "radiance", np.broadcast_to(np.asarray(self.radiance, dtype=np.float64), (3,)))


def angle_between(first: Lobe, second: Lobe) -> float:
    """The angle between two axes, radians, with all its digits near 0 and near pi."""
    apart, along = np.linalg.norm(first.axis - second.axis), np.linalg.norm(first.axis + second.axis)
    return float(2 * np.arctan2(apart, along))


def _edge(lobe: Lobe) -> Array:
    if lobe.profile.half_angle >= np.pi:
        return lobe.axis[None]
    side = normalise(np.cross(lobe.axis, np.eye(3)[int(np.abs(lobe.axis).argmin())]))
    up = np.cross(lobe.axis, side)
    turn = np.pi / 4 * np.arange(8)[:, None]
    ring = np.cos(turn) * side + np.sin(turn) * up
    angles = lobe.profile.half_angle * np.array([1 - EDGE, 1 + EDGE])
    return np.concatenate([lobe.axis[None], *(np.cos(angle) * lobe.axis + np.sin(angle) * ring for angle in angles)])


@dataclass(frozen=True, eq=False)
class LobeLight:
    """The sum of up to MAX_LOBES lobes. ValueError for none or more, LightError for more radiance than can be shown."""

    lobes: tuple[Lobe, ...]
    name: str = "lobes"
    description: str = ""
    notes: tuple[str, ...] = ()
    best_method: str = "closed form"

    def __post_init__(self) -> None:
        if not 1 <= len(self.lobes) <= MAX_LOBES:
            raise ValueError(f"{len(self.lobes)} lobes: there must be 1 to {MAX_LOBES}")
        axes = np.stack([lobe.axis for lobe in self.lobes])
        check_brightness(float(np.abs(self.radiance(axes)).max()), self.name)

    def radiance(self, directions: Array) -> Array:
        total = np.zeros((len(directions), 3))
        for lobe in self.lobes:
            chord = directions - lobe.axis
            total += lobe.profile.value((chord * chord).sum(axis=1))[:, None] * lobe.radiance
        return total

    def integrand(self, directions: Array) -> Array:
        return self.radiance(directions)

    def coefficients(self, n_bands: int) -> Array:
        zonal = np.stack([lobe.profile.zonal(n_bands) for lobe in self.lobes])
        oriented = orient(zonal, np.stack([lobe.axis for lobe in self.lobes]))
        return np.asarray(oriented.T @ np.stack([lobe.radiance for lobe in self.lobes]))

    def accuracy(self) -> float:
        return 0.0

    def products(self) -> Array:
        return self._products

    @cached_property
    def _products(self) -> Array:
        total = np.zeros((3, 3))
        for i, first in enumerate(self.lobes):
            for j, second in enumerate(self.lobes[: i + 1]):
                product = inner_product(first.profile, second.profile, angle_between(first, second))
                overlap = product * np.outer(first.radiance, second.radiance)
                total += overlap if i == j else overlap + overlap.T
        return total

    def landmarks(self) -> Array:
        """The axes, and points just inside and outside the edge of every profile that has one."""
        return np.concatenate([_edge(lobe) for lobe in self.lobes])

    def radiance_map(self) -> None:
        return None
