"""The ways to draw the reconstruction. `prepare` decides once; its choice is passed to the renderer and the overlay."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.quantities.encodings import Stored
from shviewer.viewer.surface import Surface

MAP_COLUMNS = (512, 1024, 2048)
"""Widths that a map can have."""

MAP_ERROR = 0.25 / 255
"""How far its splines may be off, in units of white: half of what could be seen. Where no width is enough, the widest."""

SPLINE_ERROR = 0.012
"""The spline of a wave of w radians a column is off by at most this times w^3 of its height (Synthesis.spline_map)."""

LONGEST_STEP = 0.7
"""Radians a column of the shortest wave for which that bound holds."""


@dataclass(frozen=True, eq=False)
class DirectSum:
    """Each pixel sums the bands: coefficients (n**2, 3), of at most MAX_DIRECT_BANDS bands."""

    coefficients: Array


@dataclass(frozen=True, eq=False)
class Encoded:
    """Each pixel evaluates the formula of an encoding, from the numbers that it keeps."""

    stored: Stored


@dataclass(frozen=True, eq=False)
class SplineMap:
    """Each pixel looks the reconstruction up: spline coefficients (rows, columns, 4), rows on the poles."""

    splines: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Surfaces in place of the spheres: the light, its reconstruction or one basis function, and perhaps the error."""

    shown: tuple[Surface, ...]


Drawn: TypeAlias = DirectSum | Encoded | SplineMap | Surfaces


def map_size(n_bands: int, peak: float) -> tuple[int, int]:
    """Rows and columns of the map of a reconstruction, no finer than needed. peak: its largest magnitude, in units of white."""
    waves = {columns: 2 * np.pi * (n_bands - 1) / columns for columns in MAP_COLUMNS}
    good = (
        columns
        for columns, wave in waves.items()
        if wave <= LONGEST_STEP and SPLINE_ERROR * wave**3 * peak <= MAP_ERROR
    )
    columns = next(good, MAP_COLUMNS[-1])
    return columns // 2 + 1, columns
