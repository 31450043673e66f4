"""RGB from luminance and chroma; chroma samples may be coarser than the texels.

With the luminance Y = r R + g G + b B, whose weights follow from the chromaticities of R, G and B and sum to 1,
    RY = (R - Y) / Y,   BY = (B - Y) / Y                                                     [OpenEXR]
so that R = (1 + RY) Y, B = (1 + BY) Y, and G is what is left of Y.

A chroma sample stands at a texel; between samples chroma is interpolated linearly. A mean of colours that can be shown
can be shown, since each channel >= 0 is a linear condition on RY and BY: no channel becomes negative, as it would with
the longer filters, whose weights are negative beside a small lamp. Y is kept, so the luminance is exact.

Source: [OpenEXR] openexr.com, "Technical Introduction to OpenEXR", Luminance/Chroma Images.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.chromaticities import REC709, luminance_weights

_SMALLEST_WEIGHT = 1e-3  # of green, by which is divided; it is 0.72 for Rec. 709
_ROWS = 64  # of an image at a time


def rgb_from_luminance_chroma(
    luminance: NDArray[np.floating],
    chroma: tuple[NDArray[np.floating], NDArray[np.floating]],
    chromaticities: tuple[float, ...] | None,
) -> NDArray[np.float32]:
    """(height, width, 3) linear RGB of these chromaticities.

    luminance: (height, width). chroma: RY and BY, each with its first sample at the first texel and a whole number of
    texels from sample to sample, in either direction.
    chromaticities: CIE x and y of red, green, blue and white; None for those of Rec. 709.
    Raises LightError if green has no luminance in them, or if they make no RGB space.
    """
    xy = REC709 if chromaticities is None else np.reshape(chromaticities, (4, 2))
    red, green, blue = luminance_weights(xy).tolist()
    if not green > _SMALLEST_WEIGHT:
        raise LightError(
            f"green of luminance {green:.3g} by its chromaticities, so it does not follow from Y, RY and BY: export"
            " it as RGB"
        )
    height, width = luminance.shape
    pixels = np.empty((height, width, 3), np.float32)
    with np.errstate(invalid="ignore", over="ignore"):  # the caller decides about Inf and NaN
        chroma_red, chroma_blue = (_interpolated(samples, height, width) for samples in chroma)
        for top in range(0, height, _ROWS):
            rows = slice(top, top + _ROWS)
            y = luminance[rows].astype(np.float64)
            r, b = (1.0 + chroma_red[rows]) * y, (1.0 + chroma_blue[rows]) * y
            pixels[rows, :, 0], pixels[rows, :, 2] = r, b
            pixels[rows, :, 1] = (y - red * r - blue * b) / green
    return pixels


def _interpolated(samples: NDArray[np.floating], height: int, width: int) -> NDArray[np.float32]:
    """Samples (height / k, width / l) interpolated to (height, width); after the last sample its value is kept."""
    for axis, length in enumerate((height, width)):
        step = length // samples.shape[axis]
        if step > 1:
            samples = _finer(samples.astype(np.float32, copy=False), step, axis)
    return samples.astype(np.float32, copy=False)


def _finer(samples: NDArray[np.float32], step: int, axis: int) -> NDArray[np.float32]:
    here = np.moveaxis(samples, axis, 0)
    there = np.concatenate([here[1:], here[-1:]])
    fine = np.empty((len(here), step, here.shape[1]), np.float32)
    for k in range(step):
        fine[:, k] = here + np.float32(k / step) * (there - here)
    return np.ascontiguousarray(np.moveaxis(fine.reshape(-1, here.shape[1]), 0, axis))
