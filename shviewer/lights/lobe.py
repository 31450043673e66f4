"""One lobe: a profile about an axis, times a colour."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array, normalise
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


def angle_between(first: Lobe, second: Lobe) -> float:
    """The angle between two axes, radians, with all its digits near 0 and near pi."""
    apart, along = np.linalg.norm(first.axis - second.axis), np.linalg.norm(first.axis + second.axis)
    return float(2 * np.arctan2(apart, along))
