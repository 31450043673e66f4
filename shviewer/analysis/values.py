"""The values of a light over the sphere: its range, its dark part, its dynamic range, and where its peak is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.analysis.figures import error_grid, grid_rows
from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.climbing import SEARCH_ROUNDS, climb
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quadrature import directions_from_angles
from shviewer.lights.light import Light

DARK_PERCENTILE = 0.01
"""The dynamic range leaves out this darkest share of the lit sphere, so that no single dark texel makes the range."""

LOWER_BITS = 18
"""The bits of a float32 that its bin of the luminance histogram does not depend on: there are 32 bins to a stop."""


@dataclass(frozen=True)
class Values:
    """The values of the linear radiance over the sphere; a value is one channel in one place."""

    minimum: float
    """The smallest in any channel."""
    maximum: float
    """The largest in any channel."""
    negative_values: int
    """How many are below 0."""
    negative_or_black_area: float
    """The share of the sphere with a Rec. 709 luminance not above 0."""
    darkest: float | None
    """The luminance that the darkest 1 % of the sphere are below, where it is above 0; None if it is nowhere above 0."""
    brightest_luminance: float
    """The largest luminance."""
    dynamic_range_stops: float | None
    """The range from `darkest` to `brightest_luminance`, in stops; None without a `darkest`."""
    source: str
    """Where the values were taken: "texels", or the size of a grid."""


def values_of(light: Light) -> tuple[Values, Array]:
    """The values of a light, and the direction of its peak."""
    if light.about.size is None:
        return _grid_values(light)
    return _gather(light.texels(), "texels"), light.landmarks()[0]


def _grid_values(light: Light) -> tuple[Values, Array]:
    """The values of a light that is no image, on the window's grid, and the direction of the peak, refined beyond the grid."""
    grid = error_grid(light, grid_rows(1))
    values = grid.original.transpose(0, 2, 1)
    n_rows, n_columns = values.shape[:2]
    areas = np.repeat(4 * np.pi * grid.row_share, n_columns)
    row, column = divmod(int(np.abs(values).max(axis=2).argmax()), n_columns)
    start = directions_from_angles(grid.theta[[row]], grid.phi[[column]])
    found = climb(lambda d: np.abs(light.radiance(d)).max(axis=1), start, np.pi / n_rows, SEARCH_ROUNDS)[1]
    candidates = np.concatenate([grid.landmarks, start, found])
    there = light.radiance(candidates)
    peak = candidates[int(np.abs(there).max(axis=1).argmax())]
    blocks = [(values.reshape(-1, 3), areas), (there, np.zeros(len(there)))]
    return _gather(iter(blocks), f"on a grid of {n_columns} x {n_rows}"), peak


def _gather(blocks: Iterator[tuple[NDArray[np.floating], Array]], source: str) -> Values:
    """Gather the values of blocks: radiance (k, 3) and solid angles (k,), which are 0 for extra directions."""
    minimum, maximum, smallest, brightest = np.inf, -np.inf, np.inf, -np.inf
    negative, dark, lit = 0, 0.0, np.zeros(2 ** (31 - LOWER_BITS))
    for radiance, areas in blocks:
        if not len(radiance):
            continue
        minimum, maximum = min(minimum, float(radiance.min())), max(maximum, float(radiance.max()))
        negative += int(np.count_nonzero(radiance < 0))
        luminance = (radiance @ LUMINANCE.astype(radiance.dtype)).astype(np.float32)
        brightest = max(brightest, float(luminance.max()))
        above = luminance > 0
        smallest = min(smallest, float(luminance.min(where=above, initial=np.inf)))
        dark += float(areas[~above].sum())
        bins = np.where(above, luminance, np.float32(0)).view(np.int32) >> LOWER_BITS  # -0.0 would be negative
        lit += np.bincount(bins, areas * above, len(lit))
    total = float(lit.sum())
    darkest = None
    if total > 0:
        place = int(np.searchsorted(np.cumsum(lit), DARK_PERCENTILE * total))
        middle = float(np.int32((2 * place + 1) << (LOWER_BITS - 1)).view(np.float32))
        darkest = min(max(middle, smallest), brightest)
    return Values(
        minimum=minimum,
        maximum=maximum,
        negative_values=negative,
        negative_or_black_area=dark / (dark + total),
        darkest=darkest,
        brightest_luminance=brightest,
        dynamic_range_stops=max(0.0, float(np.log2(brightest / darkest))) if darkest else None,
        source=source,
    )
