"""Colour maps of the error: tables of matplotlib (assets/README.md), 256 sRGB colours each."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from shviewer.harmonics.basis import Array
from shviewer.lights.images.display.colour import linear_from_srgb
from shviewer.resources import resource_folder

DIVERGING, SEQUENTIAL = "berlin", "inferno"
"""Both have black for no error, as radiance has; both look ordered to every kind of colour vision."""


def map_of(error: str) -> str:
    """The name of the map for one of the ERRORS but "off"."""
    return DIVERGING if error == "signed" else SEQUENTIAL


@lru_cache
def table(name: str) -> NDArray[np.uint8]:
    """The colours of a map: sRGB, (256, 3) uint8."""
    with Image.open(resource_folder("assets") / "colour_maps" / f"{name}.png") as image:
        colours: NDArray[np.uint8] = np.array(image.convert("RGB"), dtype=np.uint8)[0]
    colours.flags.writeable = False
    return colours


def linear(srgb: NDArray[np.uint8]) -> Array:
    """Linear RGB of sRGB bytes."""
    return linear_from_srgb(srgb / 255.0)
