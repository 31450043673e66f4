"""Layers: images that Pillow has drawn, with a place in the frame, to be blended over the spheres."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

EMPTY_ROWS = 24
"""Fewer empty rows than this do not part a layer: another texture costs more than they do."""


class Layer(NamedTuple):
    """An image (height, width, 4) uint8 with straight alpha, and the pixel of the frame at its top left."""

    image: NDArray[np.uint8]
    left: int = 0
    top: int = 0


def strips(image: NDArray[np.uint8]) -> tuple[Layer, ...]:
    """Cut an image as large as the frame into layers, so that empty rows are neither uploaded nor blended."""
    rows = np.nonzero(image[..., 3].any(axis=1))[0]
    if not len(rows):
        return ()
    parts = np.split(rows, np.nonzero(np.diff(rows) > EMPTY_ROWS)[0] + 1)
    return tuple(Layer(image[part[0] : part[-1] + 1], 0, int(part[0])) for part in parts)
