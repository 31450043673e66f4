"""Bilinear interpolation between four neighbouring texels of an image."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices


def between_texels(
    pixels: NDArray[np.float32], top: Indices, left: Indices, down: Array, right: Array
) -> NDArray[np.float32]:
    """Radiance (k, 3) at shares `down` and `right` (k,), in [0, 1], of the way from texel (top, left) to the next ones.

    For texels beyond the image any values are returned. Works channel by channel, which is faster than texel by texel.
    """
    width = pixels.shape[1]
    values = pixels.reshape(-1)
    first = 3 * (top * width + left)
    down, right = down.astype(np.float32), right.astype(np.float32)
    up = 1 - down
    weights = up * (1 - right), up * right, down * (1 - right), down * right
    result = np.empty((len(first), 3), dtype=np.float32)
    for channel in range(3):
        total = np.zeros(len(first), dtype=np.float32)
        for texel, weight in zip((0, 1, width, width + 1), weights, strict=True):
            there = values[min(3 * texel + channel, len(values) - 1) :]
            total += there.take(first, mode="clip") * weight
        result[:, channel] = total
    return result
