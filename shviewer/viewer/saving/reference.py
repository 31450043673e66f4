"""A picture compared with a reference: the share of the pixels that differ, and an image of where."""

from __future__ import annotations

import io
import json
import os
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from shviewer.errors import UsageError
from shviewer.files import read_bytes
from shviewer.limits import DEFAULT_LIMITS
from shviewer.viewer.saving.picture_files import write_png

FORMATS = {".jpg": ("JPEG",), ".jpeg": ("JPEG",), ".webp": ("WEBP",), ".bmp": ("BMP",)}
"""Pillow's formats for a suffix, PNG for all others: a file named .png that is PostScript would start an interpreter."""

PIXEL_STEP = 2
"""Pixels differ if some channel differs by more than this, of 255: between drivers, rounding differs by 1."""


def compare_with_reference(pixels: NDArray[np.uint8], reference: Path, difference: Path, threshold: float) -> str:
    """ "" if at most the share `threshold` of the pixels differs by more than PIXEL_STEP of 255, else what differs.

    Then `difference` is written: the absolute difference, sixteen times as bright. UsageError if the reference is bad.
    """
    remedy = "make it with the same command, REF.png as OUT"
    if not os.path.exists(reference):
        raise UsageError(f"{reference}: no such reference; {remedy}")
    try:
        data = io.BytesIO(read_bytes(reference, DEFAULT_LIMITS))
        formats = FORMATS.get(reference.suffix.lower(), ("PNG",))
        with warnings.catch_warnings(action="error"), Image.open(data, formats=formats) as image:
            height, width = pixels.shape[:2]
            if image.size != (width, height):  # looked at before the other one is decoded, however large it is
                return f"{reference} is {image.width} x {image.height}, the picture {width} x {height}"
            wanted = np.asarray(image.convert("RGB"))
    except Exception as error:  # Pillow raises what it likes: OSError, SyntaxError, struct.error, ...
        raise UsageError(f"{reference}: not a readable picture; {remedy}") from error
    distance = np.abs(wanted.astype(np.int16) - pixels)
    share = float((distance.max(axis=2) > PIXEL_STEP).mean())
    if share <= threshold:
        return ""
    write_png(difference, np.minimum(distance * 16, 255).astype(np.uint8), json.dumps({"reference": str(reference)}))
    return (
        f"{share:.4%} of the pixels differ from {reference} by more than {PIXEL_STEP}/255 (allowed {threshold:.4%}, "
        f"largest {distance.max()}/255); see {difference}"
    )
