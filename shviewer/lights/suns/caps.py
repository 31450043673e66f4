"""Finding the texels near a direction, in any layout, without looking at every one.

An image is cut into square tiles. A tile lies within an angle of its middle texel, taken from its corners, so a cap of a few
degrees needs only the texels of the few tiles that it can touch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices
from shviewer.lights.layouts.layout import Layout

TILE = 16
MARGIN = 1.5
"""A tile's texels may bulge beyond its corners: near a pole, or where a layout folds."""

FEW = 2**14
"""The most texels of an image of which all are looked at: in a small cube, a tile could hold a whole face."""


@dataclass(frozen=True)
class Texels:
    """Some texels of an image, with their places in it and on the sphere."""

    rows: Indices
    """Their rows, (k,)."""
    columns: Indices
    """Their columns, (k,)."""
    directions: Array
    """Unit vectors to their centres, (k, 3)."""
    solid_angles: Array
    """Steradians, (k,), all above 0."""

    def within(self, axis: Array, nearest: float, farthest: float) -> Texels:
        """The texels with `nearest` < angle <= `farthest` between centre and `axis` (3,), radians; `nearest` may be below 0."""
        distance = chord(self.directions, axis)
        kept = (distance <= chord_of(farthest)) & (distance > chord_of(nearest))
        return Texels(self.rows[kept], self.columns[kept], self.directions[kept], self.solid_angles[kept])


def chord(directions: Array, axis: Array) -> Array:
    """|direction - axis|, (k,): small angles keep their digits."""
    return np.asarray(np.linalg.norm(directions - axis, axis=-1))


def chord_of(angle: float) -> float:
    """The chord of an angle up to pi; negative for a negative angle."""
    return float(2 * np.sin(min(angle, np.pi) / 2))


class Caps:
    """The texels of an image, arranged so that those near a direction are found fast."""

    def __init__(self, layout: Layout, height: int, width: int) -> None:
        self._layout = layout
        self._height, self._width = height, width
        top, left = (grid.ravel() for grid in np.mgrid[0:height:TILE, 0:width:TILE])
        bottom, right = np.minimum(top + TILE, height) - 1, np.minimum(left + TILE, width) - 1
        self._top, self._left = top, left
        self._middles = layout.centres((top + bottom) // 2, (left + right) // 2)
        corners = [layout.centres(row, column) for row in (top, bottom) for column in (left, right)]
        reach = MARGIN * np.max([chord(corner, self._middles) for corner in corners], axis=0)
        self._radii = reach if height * width > FEW else np.full_like(reach, 2.0)

    def texels(self, rows: Indices, columns: Indices) -> Texels:
        """The texels at rows and columns (k,), without those that show nothing."""
        solid_angles = self._layout.solid_angles_at(rows, columns)
        seen = solid_angles > 0
        rows, columns = rows[seen], columns[seen]
        return Texels(rows, columns, self._layout.centres(rows, columns), solid_angles[seen])

    def touched(self, axis: Array, half_angle: float) -> NDArray[np.bool_]:
        """Whether each tile, row by row, may have texels within `half_angle` radians of `axis` (3,); true for a NaN middle."""
        return np.asarray(~(chord(self._middles, axis) > self._radii + chord_of(half_angle)))

    def cap(self, axis: Array, half_angle: float) -> Texels:
        """Every texel whose centre is within `half_angle` radians of `axis` (3,)."""
        touched = self.touched(axis, half_angle)
        inside = np.arange(TILE)
        rows = (self._top[touched, None, None] + inside[:, None] + 0 * inside).ravel()
        columns = (self._left[touched, None, None] + inside + 0 * inside[:, None]).ravel()
        real = (rows < self._height) & (columns < self._width)
        return self.texels(rows[real], columns[real]).within(axis, -1, half_angle)
