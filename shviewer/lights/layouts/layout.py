"""The interface of every layout. A texel is an area of constant radiance, whatever its shape on the sphere.

The world: x forward, y left, z up, as everywhere (shviewer/harmonics/basis.py). The centre of a lat-long image, the front
face of a cross, the middle of an angular map and of a mirror ball all look along +x; seen from inside, +y is to the left
and +z is up, and nothing is mirrored.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, row_angles

RASTER_BLOCK = 2**15
"""About how many directions of a raster are sampled at a time."""


class Layout(Protocol):
    """How an image of a given height and width, in texels, covers the sphere."""

    @property
    def name(self) -> str:
        """One of LAYOUTS in recognise.py."""

    @property
    def size(self) -> str:
        """The size in words, such as "1024 x 512", width first, or "6 x 512 x 512" for a cube."""

    @property
    def raster_width(self) -> int:
        """Columns of a lat-long image that is about as fine."""

    def solid_angles(self) -> Array:
        """Steradians of each texel, exact, with the sum 4 pi: (height, width), or (height, 1) where a row's are equal.

        0 for texels that show nothing: the empty cells of a cross, the corners around a disc.
        """

    def solid_angles_at(self, rows: Indices, columns: Indices) -> Array:
        """Steradians of the texels (k,) alone: (k,)."""

    def rises(self) -> Array:
        """The integral of z over the part of each texel that lies above the horizon, exact: of the shape of `solid_angles`."""

    def nearest(self, directions: Array) -> tuple[Indices, Indices]:
        """Row and column, (k,) each, of the texel in whose area each unit direction (k, 3) lies."""

    def centres(self, rows: Indices, columns: Indices) -> Array:
        """Unit directions (k, 3) of the centres of texels (k,); anywhere for texels that show nothing."""

    def sample(self, pixels: NDArray[np.float32], directions: Array) -> NDArray[np.floating]:
        """Bilinear radiance (k, 3) in unit directions (k, 3), from pixels (height, width, 3)."""

    def raster(self, pixels: NDArray[np.float32], height: int, width: int) -> NDArray[np.float32]:
        """`sample` at the centres of a lat-long image's texels: (height, width, 3)."""

    def project(self, pixels: NDArray[np.float32], n_bands: int) -> Array:
        """Coefficients (n_bands**2, 3): the exact integrals of the texels as areas."""

    def project_texels(self, values: Array, rows: Indices, columns: Indices, n_bands: int) -> Array | None:
        """The same, as exact, of an image that is black but for texels (k,) with `values` (k, 3).

        None where that takes longer than `project`, or one of them is too near where directions have no series.
        """


def raster_of(layout: Layout, pixels: NDArray[np.float32], height: int, width: int) -> NDArray[np.float32]:
    """`Layout.raster` of a layout that knows no better way."""
    texels = np.empty((height, width, 3), dtype=np.float32)
    theta, phi = row_angles(height), column_azimuths(width)
    block = max(1, RASTER_BLOCK // width)
    for start in range(0, height, block):
        directions = directions_from_angles(theta[start : start + block, None], phi).reshape(-1, 3)
        texels[start : start + block] = layout.sample(pixels, directions).reshape(-1, width, 3)
    return texels


class SampledTexels:
    """The texels of `Layout.raster` where they are asked for, in place of an array of all of them."""

    def __init__(self, layout: Layout, pixels: NDArray[np.float32], height: int, width: int) -> None:
        self.layout, self.pixels, self.shape = layout, pixels, (height, width, 3)

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, place: tuple[Indices, Indices]) -> NDArray[np.float32]:
        """Texels (..., 3) at rows and columns (...)."""
        theta, phi = row_angles(self.shape[0])[place[0]], column_azimuths(self.shape[1])[place[1]]
        directions = directions_from_angles(theta, phi)
        found = self.layout.sample(self.pixels, directions.reshape(-1, 3))
        return found.reshape(directions.shape).astype(np.float32, copy=False)
