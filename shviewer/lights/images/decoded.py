"""What a decoder makes of a file's bytes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Decoded:
    """Linear RGB with Rec. 709 primaries, as it is in the file: not rescaled, not repaired."""

    pixels: NDArray[np.float32]
    """(height, width, 3), top row first, left column first, C-contiguous."""
    encoding: str
    """The format in words, such as "OpenEXR, half, PIZ, tiled"."""
    notes: tuple[str, ...] = ()
    """What was done to the values and what is missing, a line each, for the person who chose the file."""
    layout: str | None = None
    """How the image covers the sphere, where the file itself says so: a name of lights/layouts."""
