"""The largest magnitude of a function that is known on a grid: how high it goes, and how low."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.band_limited import BandLimited
from shviewer.harmonics.extremes.climbing import DISPLAY_ROUNDS, Objective, climb
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, row_angles


class Extreme(NamedTuple):
    """An extreme value, its direction (3,), and a bound on the far side of it."""

    value: float
    direction: Array
    bound: float = np.inf

    def or_larger(self, other: Extreme) -> Extreme:
        return other if other.value > self.value else self


def largest_magnitude(
    values: Array, less: Array | None, heights: Array, magnitude: Objective, share: float, negligible: float
) -> Extreme:
    """The largest magnitude of waves, less a function that is bilinear in their cells, as in `BandLimited`.

    magnitude: unit directions (k, 3) -> (k,), largest over the channels. The bound ends above what is found by about `share` of
    it, or by `negligible`.
    """
    waves = BandLimited(values, heights, less)
    rows, columns = len(values), values.shape[2]

    def climbed(theta: float, phi: float) -> Extreme:
        start = directions_from_angles(np.array([theta]), np.array([phi]))
        found, places = climb(magnitude, start, np.pi / rows / 2, DISPLAY_ROUNDS)
        return Extreme(float(found[0]), places[0])

    ends = int(waves.difference.argmin()), int(waves.difference.argmax())
    largest = max(ends, key=lambda at: abs(waves.difference.flat[at]))
    row, _, column = np.unravel_index(largest, values.shape)
    best = climbed(float(row_angles(rows)[row]), float(column_azimuths(columns)[column]))
    tolerance = max(share * best.value, negligible)
    sides = [waves.lowest(-best.value, tolerance, sign=sign) for sign in (1, -1)]
    deepest = min(sides, key=lambda side: side.lowest)
    if -deepest.lowest > best.value + tolerance / 2:
        best = best.or_larger(climbed(deepest.theta, deepest.phi))
    return best._replace(bound=-min(side.bound for side in sides))
