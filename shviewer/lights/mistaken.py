"""Lights that are projected by mistake: without solid angles, clamped, made for a display, or only the upper half."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.quadrature import row_angles
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.images.display.colour import srgb_from_linear
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.light import Light

GRID_ROWS = 128
"""The rows of a lat-long grid on which a light that is no image is taken."""

ENOUGH_ROWS = 512
"""A lat-long image with more rows is reduced to about so many, once its values are spoiled: for the bands that are compared
the means of so small areas do as well as the texels."""

BLOCK_ROWS = 64
"""Rows of an image that are spoiled at a time."""

CLAMPED, ENCODED, UPPER = "clamped at 1", "encoded for a display", "black below the horizon"
TONED = "tone-mapped, x/(1 + x)"
SPOILED = ((), (CLAMPED,), (ENCODED,), (CLAMPED, ENCODED), (TONED,), (TONED, ENCODED), (UPPER,))
"""What is done to the values, in words."""

MISTAKES = 2 * len(SPOILED) - 1
"""How many mistaken lights there are at most."""


def mistaken(light: Light, n_bands: int) -> Iterator[tuple[list[str], Array]]:
    """Each mistake in words after "if", and the coefficients (n_bands**2, 3) of the light that it makes."""
    if isinstance(light, EnvironmentLight):
        pixels, layout = light.pixels, light.layout
    else:
        rows = light.rows(row_angles(GRID_ROWS), 2 * GRID_ROWS)
        pixels = np.ascontiguousarray(rows.transpose(0, 2, 1), dtype=np.float32)
        layout = LatLongLayout(GRID_ROWS, 2 * GRID_ROWS)
    bright = bool(pixels.max() > 1)
    alike = f"all texels count alike, without {'sin(theta)' if isinstance(layout, LatLongLayout) else 'solid angles'}"
    for spoiled in SPOILED:
        if CLAMPED in spoiled and not bright:
            continue
        taken, seen = _spoiled(pixels, layout, spoiled)
        for weighed in (True, False) if spoiled else (False,):
            values = taken if weighed else _alike(taken, seen)
            said = [f"radiance is {' and '.join(spoiled)}"] if spoiled else []
            yield [*said, *([] if weighed else [alike])], seen.project(values, n_bands)


def _spoiled(pixels: NDArray[np.float32], layout: Layout, how: tuple[str, ...]) -> tuple[NDArray[np.float32], Layout]:
    """The image with its values spoiled, smaller if it is a large lat-long one, and its layout."""
    height, width = pixels.shape[:2]
    step = max(1, height // ENOUGH_ROWS) if isinstance(layout, LatLongLayout) else 1
    if height % step or width % step:
        step = 1
    above = layout.rises()[..., None] > 0
    taken = np.empty((height // step, width // step, 3), dtype=np.float32)
    for start in range(0, len(taken), BLOCK_ROWS):
        block = pixels[start * step : (start + BLOCK_ROWS) * step]
        for one in how:
            if one == UPPER:
                block = block * above[start * step : (start + BLOCK_ROWS) * step]
            elif one == CLAMPED:
                block = np.minimum(block, 1)
            else:
                block = np.maximum(block, 0)
                block = block / (1 + block) if one == TONED else srgb_from_linear(block)
        taken[start : start + BLOCK_ROWS] = block.reshape(-1, step, width // step, step, 3).mean(axis=(1, 3))
    return taken, LatLongLayout(*taken.shape[:2]) if step > 1 else layout


def _alike(values: NDArray[np.float32], layout: Layout) -> NDArray[np.float32]:
    """Values over the solid angles of their texels, which a projection multiplies by; their mean weight stays 1."""
    angles = layout.solid_angles()
    weights = np.divide(angles.sum() / np.count_nonzero(angles), angles, out=np.zeros_like(angles), where=angles > 0)
    return np.asarray(values * weights[:, :, None], dtype=np.float32)
