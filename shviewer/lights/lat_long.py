"""A lat-long raster of radiance, with the bilinear look-up that shaders/lat_long.glsl does in float32.

Column u in [0, 1] is phi = pi (1 - 2u): the centre of the image looks along +x, and turning right is decreasing phi. Row
v in [0, 1] is theta = pi v with +z on top. (OpenEXR's lat-long convention with z for its y.)
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.raster import Raster
from shviewer.harmonics.quadrature import angles_from_directions
from shviewer.harmonics.sampling.look import LOOK_ROWS

MAP_ROWS = LOOK_ROWS
"""Rows of the map of a function, from pole to pole."""


LOOKED_AT = 2**20
"""Bytes of texels that are looked at together: so many stay in the cache."""

LEAST_NORMAL, LARGEST = np.float32(np.finfo(np.float16).smallest_normal), np.float32(np.finfo(np.float16).max)
"""The magnitudes between which a half float has eleven bits."""

BELOW_HALVES = 2**13 - 1
"""The bits of a float32's fraction that a half float has not."""


class LatLongMap(Raster):
    """A raster of radiance.

    Rows at texel centres suit an image of areas; rows on the poles suit a sampled function, whose value there is then exact.
    """

    @cached_property
    def halves(self) -> bool:
        """Whether half floats hold every texel exactly, as those of a file of half floats or of RGBE mostly are."""
        rows = max(1, LOOKED_AT // max(self.texels[0].nbytes, 1))
        return all(_are_halves(self.texels[top : top + rows]) for top in range(0, len(self.texels), rows))

    @classmethod
    def pole_to_pole(cls, rows: Callable[[Array, int], Array], n_rows: int = MAP_ROWS) -> LatLongMap:
        """The map, of `n_rows` rows, of a smooth function: rows(theta (k,), n_columns) -> (k, 3, n_columns)."""
        values = rows(np.linspace(0, np.pi, n_rows), 2 * (n_rows - 1)).transpose(0, 2, 1)
        return cls(np.ascontiguousarray(values, dtype=np.float32), rows_on_poles=True)

    def sample(self, directions: Array) -> Array:
        """Bilinear radiance (k, 3) in unit directions (k, 3); continuous across the seam and the poles."""
        theta, phi = angles_from_directions(directions)
        scale, offset = self.row_scale_offset
        return self.at(theta * scale + offset, (0.5 - phi / (2 * np.pi)) * self.texels.shape[1] - 0.5)


def _are_halves(texels: NDArray[np.float32]) -> bool:
    """Whether half floats hold these values: most others show it in their last bits, before anything is converted."""
    bits = texels.view(np.uint32)
    if np.bitwise_or.reduce(bits, axis=None) & BELOW_HALVES:
        return False
    magnitude = bits & np.uint32(0x7FFFFFFF)
    least, most = (value.view(np.uint32) for value in (LEAST_NORMAL, LARGEST))
    if not ((magnitude > most) | (magnitude - np.uint32(1) < least - 1)).any():  # 0 becomes the largest number
        return True
    with np.errstate(over="ignore"):
        return bool(np.array_equal(texels.astype(np.float16), texels))
