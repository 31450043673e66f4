"""A lat-long raster of radiance, with the bilinear look-up that shaders/lat_long.glsl does in float32.

Column u in [0, 1] is phi = pi (1 - 2u): the centre of the image looks along +x, and turning right is decreasing phi. Row
v in [0, 1] is theta = pi v with +z on top. (OpenEXR's lat-long convention with z for its y.)
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.raster import Raster
from shviewer.harmonics.quadrature import angles_from_directions
from shviewer.harmonics.sampling.look import LOOK_ROWS

MAP_ROWS = LOOK_ROWS
"""Rows of the map of a function, from pole to pole."""


class LatLongMap(Raster):
    """A raster of radiance.

    Rows at texel centres suit an image of areas; rows on the poles suit a sampled function, whose value there is then exact.
    """

    @classmethod
    def pole_to_pole(cls, rows: Callable[[Array, int], Array]) -> LatLongMap:
        """The map, of MAP_ROWS rows, of a smooth function: rows(theta (k,), n_columns) -> (k, 3, n_columns)."""
        values = rows(np.linspace(0, np.pi, MAP_ROWS), 2 * (MAP_ROWS - 1)).transpose(0, 2, 1)
        return cls(np.ascontiguousarray(values, dtype=np.float32), rows_on_poles=True)

    def sample(self, directions: Array) -> Array:
        """Bilinear radiance (k, 3) in unit directions (k, 3); continuous across the seam and the poles."""
        theta, phi = angles_from_directions(directions)
        scale, offset = self.row_scale_offset
        return self.at(theta * scale + offset, (0.5 - phi / (2 * np.pi)) * self.texels.shape[1] - 0.5)
