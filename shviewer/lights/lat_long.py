"""A lat-long raster of radiance, with the bilinear look-up that shaders/lat_long.glsl does in float32.

Column u in [0, 1] is phi = pi (1 - 2u): the centre of the image looks along +x, and turning right is decreasing phi. Row
v in [0, 1] is theta = pi v with +z on top. (OpenEXR's lat-long convention with z for its y.)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.raster import Ranges, Raster
from shviewer.harmonics.quadrature import angles_from_directions
from shviewer.harmonics.sampling.look import LOOK_ROWS

MAP_ROWS = LOOK_ROWS
"""Rows of the map of a function, from pole to pole."""


@dataclass(frozen=True, eq=False)
class LatLongMap:
    """texels: (height, width, 3) float32. Rows lie at texel centres, or from pole to pole if `rows_on_poles`.

    Texel centres suit an image of areas; rows on the poles suit a sampled function, whose value there is then exact.
    """

    texels: NDArray[np.float32]
    rows_on_poles: bool = False

    @classmethod
    def pole_to_pole(cls, rows: Callable[[Array, int], Array]) -> LatLongMap:
        """The map, of MAP_ROWS rows, of a smooth function: rows(theta (k,), n_columns) -> (k, 3, n_columns)."""
        values = rows(np.linspace(0, np.pi, MAP_ROWS), 2 * (MAP_ROWS - 1)).transpose(0, 2, 1)
        return cls(np.ascontiguousarray(values, dtype=np.float32), rows_on_poles=True)

    @property
    def form(self) -> Raster:
        """The map as that whose error can be bounded."""
        return Raster(self.texels, *self.row_scale_offset, self.at, self._ranges)

    @cached_property
    def _ranges(self) -> Ranges:
        return {}

    @property
    def row_scale_offset(self) -> tuple[float, float]:
        """The pair (a, b) with row = a theta + b."""
        height = len(self.texels)
        return ((height - 1) / np.pi, 0.0) if self.rows_on_poles else (height / np.pi, -0.5)

    def sample(self, directions: Array) -> Array:
        """Bilinear radiance (k, 3) in unit directions (k, 3); continuous across the seam and the poles."""
        theta, phi = angles_from_directions(directions)
        scale, offset = self.row_scale_offset
        return self.at(theta * scale + offset, (0.5 - phi / (2 * np.pi)) * self.texels.shape[1] - 0.5)

    def at(self, row: Array, column: Array) -> Array:
        """Bilinear radiance (..., 3) at places in texels (...), which may lie beyond a pole."""
        top = np.floor(row).astype(np.int64)
        down = (row - top)[..., None]
        return np.asarray(self._row_value(top, column) * (1 - down) + self._row_value(top + 1, column) * down)

    def _row_value(self, row: NDArray[np.int64], column: Array) -> Array:
        """Values of whole rows (...), linear between their texels; beyond a pole comes the same row half way round."""
        height, width = self.texels.shape[:2]
        pole_row = 0 if self.rows_on_poles else 1
        column = column + np.where((row < 0) | (row >= height), width / 2, 0.0)
        row = np.where(row < 0, -row - pole_row, np.where(row >= height, 2 * (height - 1) - row + pole_row, row))
        row = np.clip(row, 0, height - 1)
        left = np.floor(column).astype(np.int64)
        right = (column - left)[..., None]
        return np.asarray(self.texels[row, left % width] * (1 - right) + self.texels[row, (left + 1) % width] * right)
