"""The result of a decoder."""

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
    """Lines for the user on what was done to the values and what is missing."""
    layout: str | None = None
    """The layout that the file itself states, a name of lights/layouts; None if it states none."""
    largest: float | None = None
    """A number that no value exceeds, if the decoder knows that all are finite and none is negative; else None."""
