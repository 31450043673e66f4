"""A light that is a lat-long image. Its texels are areas of constant radiance, integrated exactly."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.projection import channel_products, project_image
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.radiance_files import DEFAULT_READING, Reading, read_radiance_image


@dataclass(frozen=True, eq=False)
class EnvironmentLight:
    """map: the image. `radiance` interpolates between texel centres; coefficients and norm are those of the areas."""

    map: LatLongMap
    name: str = "image"
    notes: tuple[str, ...] = ()
    best_method: str = "exact texel integrals"
    unit: float = 1.0
    """Squares of float32 texels are far inside float64."""

    @classmethod
    def read(cls, path: Path, reading: Reading = DEFAULT_READING) -> EnvironmentLight:
        """The image in a .hdr or .exr file. LightError if it cannot be read."""
        image = read_radiance_image(path, reading)
        return cls(LatLongMap(image.pixels), path.stem, image.notes)

    @property
    def description(self) -> str:
        height, width = self.map.texels.shape[:2]
        return f"environment map, {width} x {height}"

    def radiance(self, directions: Array) -> Array:
        return self.map.sample(directions)

    def integrand(self, directions: Array) -> Array:
        return self.map.nearest(directions)

    def coefficients(self, n_bands: int) -> Array:
        """Projected once to the most bands asked for so far; fewer are the first rows of more."""
        held = self._projected
        if not held or len(held[0]) < n_bands**2:
            held[:] = [project_image(self.map.texels, n_bands)]
        return held[0][: n_bands**2]

    @cached_property
    def _projected(self) -> list[Array]:
        return []

    def accuracy(self) -> float:
        return 0.0

    def products(self) -> Array:
        return self._products

    @cached_property
    def _products(self) -> Array:
        height, width = self.map.texels.shape[:2]
        edges = np.linspace(0, np.pi, height + 1)
        solid_angle = 2 * np.sin((edges[1:] + edges[:-1]) / 2) * np.sin(np.pi / (2 * height)) * 2 * np.pi / width
        return channel_products(self.map.texels, solid_angle)

    def landmarks(self) -> Array:
        """The centre of the brightest texel."""
        height, width = self.map.texels.shape[:2]
        row, column = divmod(int(np.abs(self.map.texels).max(axis=2).argmax()), width)
        theta = np.pi * (row + 0.5) / height
        return directions_from_angles(np.array([theta]), column_azimuths(width)[[column]])

    def radiance_map(self) -> LatLongMap:
        return self.map
