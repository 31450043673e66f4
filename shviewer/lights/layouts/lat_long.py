"""The lat-long layout: rows of constant theta, columns of constant phi, placed as in shviewer/lights/lat_long.py."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.projection.rows import project_image, project_rows
from shviewer.harmonics.quadrature import angles_from_directions, directions_from_angles, row_angles
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.layouts.layout import raster_of

RUN_ROWS = 64
"""Rows around a few texels that are held in float64 at a time."""


@dataclass(frozen=True)
class LatLongLayout:
    """The whole sphere in an image of any height and width, however far from 2:1."""

    height: int
    width: int
    name: str = "lat-long"

    @property
    def size(self) -> str:
        return f"{self.width} x {self.height}"

    @property
    def raster_width(self) -> int:
        return self.width

    def solid_angles(self) -> Array:
        """As in Layout, (height, 1): the difference of the cosines of a row's edges, in a form that does not cancel."""
        rows = 2 * np.sin(row_angles(self.height)) * np.sin(np.pi / (2 * self.height)) * (2 * np.pi / self.width)
        return np.asarray(rows[:, None])

    def solid_angles_at(self, rows: Indices, columns: Indices) -> Array:
        return np.asarray(self.solid_angles()[rows, 0])

    def rises(self) -> Array:
        sines = np.sin(np.minimum(np.linspace(0, np.pi, self.height + 1), np.pi / 2))
        return np.asarray(np.diff(sines**2)[:, None] * (np.pi / self.width))

    def nearest(self, directions: Array) -> tuple[Indices, Indices]:
        theta, phi = angles_from_directions(directions)
        row = (theta * (self.height / np.pi)).astype(np.int64)
        column = np.floor((0.5 - phi / (2 * np.pi)) * self.width).astype(np.int64)
        return np.minimum(row, self.height - 1), column % self.width

    def centres(self, rows: Indices, columns: Indices) -> Array:
        phi = np.pi * (1 - (2 * columns + 1) / self.width)
        return directions_from_angles(np.pi * (rows + 0.5) / self.height, phi)

    def sample(self, pixels: NDArray[np.float32], directions: Array) -> Array:
        return LatLongMap(pixels).sample(directions)

    def raster(self, pixels: NDArray[np.float32], height: int, width: int) -> NDArray[np.float32]:
        return raster_of(self, pixels, height, width)

    def project(self, pixels: NDArray[np.float32], n_bands: int) -> Array:
        return project_image(pixels, n_bands)

    def project_texels(self, values: Array, rows: Indices, columns: Indices, n_bands: int) -> Array:
        """As in Layout: by the rows that hold them."""
        found = np.zeros((n_bands**2, 3))
        order = np.argsort(rows, kind="stable")
        values, rows, columns = values[order], rows[order], columns[order]
        first = 0
        while first < len(rows):
            top = int(rows[first])
            last = int(np.searchsorted(rows, top + RUN_ROWS))
            some = np.zeros((int(rows[last - 1]) + 1 - top, self.width, 3))
            some[rows[first:last] - top, columns[first:last]] = values[first:last]
            found += project_rows(some, top, self.height, n_bands)
            first = last
        return found
