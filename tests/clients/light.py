"""The light that all programs are given: three colours, and no turn and no mirror leaves it as it is."""

from __future__ import annotations

import numpy as np
from lights.images.hdr_files import hdr_file
from numpy.typing import NDArray

Array = NDArray[np.float64]

WIDTH = 256
"""Texels of the lat-long image, twice its height."""
LOBES = (
    ((0.9, 0.3, 0.35), 1.5, (0.7, 0.3, 0.1)),
    ((-0.3, 0.9, 0.2), 3.0, (0.1, 0.65, 0.25)),
    ((-0.2, -0.5, 0.8), 5.0, (0.2, 0.3, 0.9)),
    ((0.3, -0.7, -0.6), 2.5, (0.6, 0.1, 0.5)),
)
"""Direction, sharpness k and colour of exp(k (cos - 1)), in our axes."""
AMBIENT = (0.16, 0.12, 0.14)
"""Everything that is lit shows 0.2 to 0.8: nothing is clamped, and Cesium's tone curve is straight there."""


def light_file() -> bytes:
    """A lat-long image as .hdr: its first row is the zenith, its middle our +x, its left our +y."""
    theta = np.pi * (np.arange(WIDTH // 2) + 0.5) / (WIDTH // 2)
    phi = np.pi - 2 * np.pi * (np.arange(WIDTH) + 0.5) / WIDTH
    theta, phi = np.meshgrid(theta, phi, indexing="ij")
    directions = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    radiance = np.zeros_like(directions) + AMBIENT
    for towards, sharpness, colour in LOBES:
        cosine = directions @ (np.array(towards) / np.linalg.norm(towards))
        radiance += np.exp(sharpness * (cosine - 1))[..., None] * np.array(colour)
    return bytes(hdr_file(rgbe(radiance)))


def rgbe(radiance: Array) -> NDArray[np.uint8]:
    """(..., 3) -> (..., 4), about the nearest that the format holds."""
    exponent = np.frexp(radiance.max(axis=-1))[1]
    mantissa = np.minimum(np.round(radiance * np.ldexp(256.0, -exponent)[..., None]), 255)
    return np.concatenate([mantissa, exponent[..., None] + 128], axis=-1).astype(np.uint8)
