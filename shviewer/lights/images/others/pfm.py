"""Portable float maps, in which the light probes of 1998 were published: three lines of text, then float32.

The first row is the lowest, and the sign of the scale tells the byte order [P. Debevec, HDRShop; netpbm's pfm(5)]. ImageMagick
and pfstools keep to that; ffmpeg and libvips write the top row first, which cannot be seen in a file.
"""

from __future__ import annotations

import math
import re

import numpy as np

from shviewer.errors import LightError
from shviewer.lights.images.decoded import Decoded
from shviewer.limits import DEFAULT_LIMITS, Limits

_HEADER = re.compile(
    rb"P([Ff])\s(?:\s|#[^\n]{0,999}\n){0,99}(\d{1,9})\s{1,9}(\d{1,9})\s{1,9}([+-]?[\d.eE+-]{1,40})(?:\r\n|\s)"
)


def decode_pfm(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded:
    """The radiance in a PFM, times the absolute value of its scale. LightError if it is damaged or too large."""
    header = _HEADER.match(data)
    try:
        scale = float(header[4]) if header else 0.0
    except ValueError:
        scale = 0.0
    if header is None or not scale or not math.isfinite(scale):
        raise LightError(
            "a PFM begins with PF or Pf, its width, height and scale; this header does not: export it again"
        )
    width, height, channels = int(header[2]), int(header[3]), 3 if header[1] == b"F" else 1
    limits.check_image(width, height, 12 * width * height)
    count = width * height * channels
    if len(data) - header.end() < 4 * count:
        raise LightError(f"cut short: {len(data) - header.end()} bytes of {4 * count}; fetch or export it again")
    order = "little" if scale < 0 else "big"
    rows = np.frombuffer(data, "<f4" if scale < 0 else ">f4", count, header.end()).reshape(height, width, channels)
    pixels = np.empty((height, width, 3), np.float32)
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused later
        np.multiply(rows[::-1], np.float32(abs(scale)), out=pixels)
    notes = ["the lowest row first, as PFM is defined: upside down if ffmpeg or libvips wrote it"]
    if abs(scale) != 1:
        notes.append(f"multiplied by its scale, {abs(scale):g}")
    return Decoded(pixels, f"PFM, {'RGB' if channels == 3 else 'grey'}, {order}-endian", tuple(notes))
