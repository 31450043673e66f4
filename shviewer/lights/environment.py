"""A light that is an image, in any layout. Its texels are areas of constant radiance, integrated exactly."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import cast

import numpy as np
from numpy.typing import NDArray

from shviewer.files import naming
from shviewer.harmonics.basis import Array, Indices, count_bands
from shviewer.harmonics.extremes.raster import Raster
from shviewer.harmonics.projection.rows import channel_products
from shviewer.lights.convolved import RadianceLight
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.radiance_files import read_radiance_image
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.layout import Layout, SampledTexels
from shviewer.lights.layouts.recognise import recognise
from shviewer.lights.light import About, Split
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.lights.suns.patched import Patched
from shviewer.limits import DEFAULT_LIMITS, RASTER_BYTES, SPLIT_BYTES, Limits, check_brightness
from shviewer.progress import tell
from shviewer.words import one_line

MAX_RASTER_WIDTH = 8192
"""The most columns of the lat-long raster that stands for an image in another layout when it is drawn."""

FEW_DIRECTIONS = 32
"""How many texels a raster has for each direction, that it is worth making."""

BLOCK_TEXELS = 2**17
"""Texels in one block of `texels`, which bounds the memory."""

SUNS_TO_REST = 1e6
"""The most times that the squared norm of the whole may be that of the rest, for the rest to be found by subtraction."""

MAX_TEXTURE_SIDE = 16384
"""The largest side of a texture that every desktop GPU of the last ten years takes."""


@dataclass(frozen=True, eq=False, init=False, repr=False)
class EnvironmentLight(RadianceLight):
    """The light of an image. `radiance` interpolates between texel centres; coefficients and norm are those of the areas."""

    pixels: NDArray[np.float32]
    """The image as the layout has it, (height, width, 3)."""
    layout: Layout
    name: str
    notes: tuple[str, ...]
    encoding: str | None
    """The file's format in words; None for an image that was not read."""
    limits: Limits
    """The limit of memory counts for what is made of the image, too."""

    KEEPS = ("_projected",)
    best_method = "exact texel integrals"
    lobes = ()

    def __init__(
        self,
        pixels: NDArray[np.float32] | LatLongMap,
        layout: Layout | None = None,
        name: str = "image",
        notes: tuple[str, ...] = (),
        encoding: str | None = None,
        limits: Limits = DEFAULT_LIMITS,
    ) -> None:
        """Without a layout the image is lat-long. LightError for more radiance than can be shown."""
        texels = pixels.texels if isinstance(pixels, LatLongMap) else pixels
        check_brightness(max(float(texels.max()), -float(texels.min())), name)
        layout = layout or LatLongLayout(*texels.shape[:2])
        for part, value in (("pixels", texels), ("layout", layout), ("name", name), ("notes", notes)):
            object.__setattr__(self, part, value)
        object.__setattr__(self, "encoding", encoding)
        object.__setattr__(self, "limits", limits)

    @classmethod
    def read(cls, path: Path, reading: Reading = DEFAULT_READING, layer: str = "") -> EnvironmentLight:
        """The image in a file, or one layer of it. LightError if it cannot be read or does not fit the layout asked for."""
        image = read_radiance_image(path, reading, layer)
        with naming(str(path)):
            return cls.of_image(image, one_line(f"{path.stem}:{layer}" if layer else path.stem), reading)

    @classmethod
    def of_image(cls, image: Decoded, name: str, reading: Reading = DEFAULT_READING) -> EnvironmentLight:
        """An image whose values are fit for a light. LightError if it does not fit the layout asked for."""
        lossy = image.encoding.startswith("JPEG")
        layout, notes, pixels = recognise(image.pixels, image.layout, reading.layout, lossy)
        return cls(pixels, layout, name, image.notes + notes, image.encoding, reading.limits)

    @property
    def description(self) -> str:
        shape = self.layout.size
        return f"environment map, {shape if self._is_lat_long else f'{self.layout.name}, {shape}'}"

    @property
    def about(self) -> About:
        height, width = self.pixels.shape[:2]
        return About(encoding=self.encoding, size=(width, height), layout=self.layout.name)

    @property
    def _is_lat_long(self) -> bool:
        return isinstance(self.layout, LatLongLayout)

    @cached_property
    def map(self) -> LatLongMap:
        """The texels themselves if they are lat-long and fit a texture; else a raster sampled from them, about as fine.

        LightError if a raster takes more memory than it may.
        """
        if self._is_lat_long and max(self.pixels.shape) <= MAX_TEXTURE_SIDE:
            return LatLongMap(self.pixels)
        height, width = self._raster_size
        self.limits.check_memory(RASTER_BYTES * width * height, f"{self.name}: a raster of {width} x {height} texels")
        return LatLongMap(self.layout.raster(self.pixels, height, width))

    @property
    def _raster_size(self) -> tuple[int, int]:
        width = max(4, min(self.layout.raster_width, MAX_RASTER_WIDTH))
        return min(len(self.pixels), MAX_RASTER_WIDTH // 2) if self._is_lat_long else width // 2, width

    @cached_property
    def _sampled(self) -> LatLongMap:
        """The same as `map`, without an array of all its texels."""
        return LatLongMap(cast(NDArray[np.float32], SampledTexels(self.layout, self.pixels, *self._raster_size)))

    def radiance(self, directions: Array) -> Array:
        """As in Light; in few directions, which four texels each bear on, no raster is made."""
        height, width = self._raster_size
        few = not self._is_lat_long and "map" not in vars(self) and FEW_DIRECTIONS * len(directions) <= height * width
        return (self._sampled if few else self.map).sample(directions)

    def integrand(self, directions: Array) -> Array:
        return np.asarray(self.pixels[self.layout.nearest(directions)], dtype=np.float64)

    def coefficients(self, n_bands: int) -> Array:
        """As in Light. The most bands asked for so far are kept; fewer bands are their first rows."""
        held = self._projected[-1:]
        if not held or len(held[0]) < n_bands**2:
            tell("projecting")  # whoever asks, and whatever for
            held = self._projected[:] = [self._project(n_bands)]
        return held[0][: n_bands**2]

    def _project(self, n_bands: int) -> Array:
        return self.layout.project(self.pixels, n_bands)

    @property
    def kept_bands(self) -> int:
        return count_bands(self._projected[0]) if self._projected else 0

    @cached_property
    def _projected(self) -> list[Array]:
        return []

    def products(self) -> Array:
        return self._products

    @cached_property
    def _products(self) -> Array:
        return channel_products(self.pixels, self.layout.solid_angles())

    def irradiance_up(self) -> Array:
        """As in Light: the texels times the integrals of z over them."""
        rises, total = np.broadcast_to(self.layout.rises(), self.pixels.shape[:2]), np.zeros(3)
        rows = max(1, BLOCK_TEXELS // self.pixels.shape[1])
        for top in range(0, len(self.pixels), rows):
            some = rises[top : top + rows]
            if some.any():
                total += some.ravel() @ self.pixels[top : top + rows].reshape(-1, 3).astype(np.float64)
        return total

    def landmarks(self) -> Array:
        """The centre of the brightest texel, (1, 3)."""
        return self._landmarks

    @cached_property
    def _landmarks(self) -> Array:
        row, column = _brightest(self.pixels)
        if not self.layout.solid_angles_at(row, column)[0]:
            row, column = _brightest(np.where(self.layout.solid_angles()[..., None] > 0, self.pixels, np.float32(0)))
        return self.layout.centres(row, column)

    @property
    def form(self) -> Raster:
        return self.map

    def texels(self) -> Iterator[tuple[NDArray[np.floating], Array]]:
        """As in Light: the texels that show something."""
        areas = np.broadcast_to(self.layout.solid_angles(), self.pixels.shape[:2])
        rows = max(1, BLOCK_TEXELS // self.pixels.shape[1])
        for top in range(0, len(self.pixels), rows):
            pixels, steradians = self.pixels[top : top + rows], areas[top : top + rows]
            if steradians.min() > 0:
                yield pixels.reshape(-1, 3), steradians.ravel()
            else:
                shown = steradians > 0
                yield pixels[shown], steradians[shown]

    def split_suns(self, wanted: int | str = "auto") -> Split:
        from shviewer.lights.suns.compact_sources import CompactSources
        from shviewer.lights.suns.rule import chosen

        height, width = self.pixels.shape[:2]
        self.limits.check_memory(
            SPLIT_BYTES * width * height, f"{self.name}: taking suns out of {width} x {height} texels"
        )
        sources = CompactSources(self.pixels, self.layout)
        found, why = sources.take_all()
        taken = chosen(self.name, found, wanted, why)
        suns = [found[i].sun for i in taken] if len(taken) == len(found) else sources.keep(taken)
        return Split(Rest(self, sources.rest), tuple(suns))


class Rest(EnvironmentLight):
    """An image without suns. Its texels are copied when all of them are asked for, such as to be drawn."""

    whole: EnvironmentLight
    """The image with them."""
    patched: Patched

    def __init__(self, whole: EnvironmentLight, patched: Patched) -> None:
        for part in ("layout", "name", "notes", "encoding", "limits"):
            object.__setattr__(self, part, getattr(whole, part))
        object.__setattr__(self, "whole", whole)
        object.__setattr__(self, "patched", patched)

    @cached_property
    def pixels(self) -> NDArray[np.float32]:
        return self.patched[:]

    @property
    def about(self) -> About:
        return self.whole.about

    @cached_property
    def _products(self) -> Array:
        return channel_products(self.patched, self.layout.solid_angles())

    def _project(self, n_bands: int) -> Array:
        """Coefficients as those of the whole minus what was taken from it, unless that is impossible or less exact.

        It takes the rounding of the whole, which is 1e-16 of the suns: too much for a rest that is far darker.
        """
        if np.trace(self.whole.products()) <= SUNS_TO_REST * np.trace(self.products()):
            taken = self.layout.project_texels(*self.patched.taken, n_bands)
            if taken is not None:
                return np.asarray(self.whole.coefficients(n_bands) - taken)
        return super()._project(n_bands)


def _brightest(pixels: NDArray[np.float32]) -> tuple[Indices, Indices]:
    """Row and column, (1,) each, of the first texel with the value of largest magnitude."""
    values = pixels.reshape(-1)
    ends = sorted((int(values.argmax()), int(values.argmin())))
    texel = max(ends, key=lambda i: abs(values[i])) // 3
    row, column = divmod(texel, pixels.shape[1])
    return np.array([row]), np.array([column])
