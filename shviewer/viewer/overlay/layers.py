"""Layers: images that Pillow has drawn, with a place in the frame, to be blended over the spheres."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Layer(NamedTuple):
    """An image (height, width, 4) uint8 with straight alpha, and the pixel of the frame at its top left.

    An image of one colour is a pixel that is broadcast: the ground of the help takes 33 MB at 3840 x 2160 otherwise.
    """

    image: NDArray[np.uint8]
    left: int = 0
    top: int = 0
