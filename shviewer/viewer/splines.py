"""The map that a reconstruction is drawn from: splines, in a map no finer than its bands and its colours need."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.analysis.cache import remember
from shviewer.analysis.figures import error_grid, grid_rows, sums
from shviewer.analysis.projections import Projection
from shviewer.analysis.recipe import Shown
from shviewer.analysis.reconstruction import Reconstruction
from shviewer.harmonics.synthesis import Synthesis
from shviewer.lights.light import Light
from shviewer.viewer.colour.error_scale import ErrorScale

MAP_COLUMNS = (512, 1024, 2048)
"""Widths that a map can have."""

MAP_ERROR = 0.25 / 255
"""How far its splines may be off, in units of white: half of what could be seen. Where no width is enough, the widest."""

SPLINE_ERROR = 0.012
"""The spline of a wave of w radians a column is off by at most this times w^3 of its height (Synthesis.spline_map)."""

LONGEST_STEP = 0.7
"""Radians a column of the shortest wave for which that bound holds."""

BETWEEN = 1.1
"""A reconstruction is at most this many times as large as on its grid, which has eight points to its shortest wave."""


def splines_of(one: Reconstruction, exposure: float, scale: ErrorScale | None) -> NDArray[np.float32]:
    """The map of a reconstruction: spline coefficients (rows, columns, 4).

    exposure: the factor of its radiance to white; scale: that of the error's colours, if the error is shown.
    """
    light, shown = one.subject.light, one.recipe.shown
    grid = error_grid(light, grid_rows(shown.n_bands))
    largest = BETWEEN * float(np.abs(Synthesis(one.coefficients).on_rows(grid.theta, len(grid.phi))).max())
    if scale is not None:
        exposure = max(exposure, 1 / (scale.end * (scale.floor if scale.kind == "relative" else 1.0)))
    return _splines(light, one.projection, shown, map_size(shown.n_bands, largest * exposure))


@remember(most=2, doing="drawing the map")
def _splines(light: Light, projection: Projection, shown: Shown, size: tuple[int, int]) -> NDArray[np.float32]:
    return Synthesis(sums(light, projection, shown)[0]).spline_map(*size)


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
