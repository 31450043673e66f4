"""The whole sphere as numbers: a lat-long map of the reconstruction, the original and the error, computed in float64.

Rows and columns are those of a lat-long image, +x in the middle and +z on top, in the frame of the world: a light that was
turned is turned in the map, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, row_angles
from shviewer.harmonics.rotation import rotate
from shviewer.harmonics.synthesis import Synthesis
from shviewer.lights.light import Light
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.picture_files import write_exr
from shviewer.viewer.saving.stamp import metadata

LAYERS = ("original", "error")
"""The layers beside the reconstruction, which is in none, so that every program takes it for the image."""

BYTES = 2 * 4 * 3 * (1 + len(LAYERS))
"""Memory for a pixel: float32 of all layers, twice while they are written."""

BLOCK_PIXELS = 2**19


def write_sphere_map(picture: Picture, width: int, out: Path) -> None:
    """Write an EXR of `width` times half of it. LightError for too much memory, OutputError if it cannot be written."""
    height = width // 2
    limits = picture.state.recipe.reading.limits
    limits.check_memory(BYTES * width * height, f"a map of {width} x {height} with its layers")
    pixels = np.empty((1 + len(LAYERS), height, width, 3), dtype=np.float32)
    for rows, values in _blocks(picture, width):
        pixels[:, rows] = values
    text = metadata(picture, Composition(width, height, 1.0, ()), "", overlay=False)
    write_exr(out, pixels[0], text, dict(zip(LAYERS, pixels[1:], strict=True)))


def _blocks(picture: Picture, width: int) -> Iterator[tuple[slice, Array]]:
    """Blocks of rows, and the reconstruction and the layers there, (1 + layers, rows, width, 3)."""
    theta, block = row_angles(width // 2), max(1, BLOCK_PIXELS // width)
    world_from_light, turned = picture.light_from_world.T, bool((picture.light_from_world != np.eye(3)).any())
    coefficients = rotate(picture.coefficients, world_from_light) if turned else picture.coefficients
    synthesis = Synthesis(coefficients) if picture.stored is None else None
    for start in range(0, len(theta), block):
        here = theta[start : start + block]
        world = directions_from_angles(here[:, None], column_azimuths(width)).reshape(-1, 3)
        directions = world @ world_from_light if turned else world
        shape = (len(here), width, 3)

        def of(light: Light, here: Array = here, directions: Array = directions) -> Array:
            rows = light.radiance(directions) if turned else light.rows(here, width).transpose(0, 2, 1)
            return rows.reshape(len(here), width, 3)

        if synthesis is None:
            rest = picture.rest_at(directions).reshape(shape)
        else:
            rest = synthesis.on_rows(here, width).transpose(0, 2, 1)
        whole, suns = picture.subject.whole, picture.suns_at(directions).reshape(shape)
        original = of(whole)
        compared = original if picture.light is whole else of(picture.light)
        yield slice(start, start + len(here)), np.stack([rest + suns, original, rest - compared])
