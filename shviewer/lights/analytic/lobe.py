"""One lobe: a profile about an axis, times a colour."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array, normalise
from shviewer.harmonics.extremes.zonal_sum import Lobes
from shviewer.harmonics.zonal import Profile


@dataclass(frozen=True, eq=False)
class Lobe:
    """A profile about `axis` (3,), any length, times `radiance` (3,), linear RGB."""

    profile: Profile
    axis: Array
    radiance: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "axis", normalise(self.axis))
        object.__setattr__(self, "radiance", np.broadcast_to(np.asarray(self.radiance, dtype=np.float64), (3,)))


def lobes_form(profiles: Sequence[Profile], lobes: Sequence[Lobe]) -> Lobes:
    """The sum of such profiles about the lobes' axes and in their colours, as that whose error can be bounded."""
    return Lobes(profiles, np.stack([lobe.axis for lobe in lobes]), np.stack([lobe.radiance for lobe in lobes]))


def angle_between(first: Lobe, second: Lobe) -> float:
    """The angle between two axes, radians, with all its digits near 0 and near pi."""
    apart, along = np.linalg.norm(first.axis - second.axis), np.linalg.norm(first.axis + second.axis)
    return float(2 * np.arctan2(apart, along))


def pair_products(lobes: tuple[Lobe, ...], integral: Callable[[Lobe, Lobe], float]) -> Array:
    """The products (3, 3) of a sum of lobes; integral: of the product of two lobes as if their radiance were 1."""
    total = np.zeros((3, 3))
    for i, first in enumerate(lobes):
        for j, second in enumerate(lobes[: i + 1]):
            product = integral(first, second) * np.outer(first.radiance, second.radiance)
            total += product if i == j else product + product.T
    return total
