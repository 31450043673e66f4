"""An image in a NumPy file: an array (height, width, 3) of linear radiance, lat-long unless --layout says otherwise."""

from __future__ import annotations

import io
import warnings
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from shviewer.coefficients.array_files import npy_header
from shviewer.coefficients.lists.cilm import has_shape_of_cilm
from shviewer.errors import LightError
from shviewer.files import decoding, read_bytes
from shviewer.lights.images.decoded import Decoded
from shviewer.limits import DEFAULT_LIMITS, Limits


def holds_image(path: Path, limits: Limits = DEFAULT_LIMITS) -> bool:
    """Whether the array in a file has the three dimensions of an image. What cannot be read is none."""
    with suppress(LightError):  # a pipe, which can be read once, has no image
        shape, _ = _header(read_bytes(path, replace(limits, pipe_seconds=0)))
        return len(shape) == 3 and not has_shape_of_cilm(shape)
    return False


def decode_array(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded:
    """The radiance in an .npy. LightError if it is no image of floating-point numbers, damaged or too large."""
    shape, dtype = _header(data)
    if len(shape) != 3 or shape[2] != 3:
        raise LightError(f"an array of shape {shape}; an image is (height, width, 3), cilm of SHTOOLS (2, n, n)")
    limits.check_image(shape[1], shape[0], (12 + 6 * dtype.itemsize) * shape[0] * shape[1])
    if dtype.kind != "f":
        raise LightError(f"an image of type {dtype}; radiance is linear and floating-point: linearise and convert it")
    with decoding("NPY"), warnings.catch_warnings(action="ignore"):
        values = np.lib.format.read_array(io.BytesIO(data), allow_pickle=False)
    with np.errstate(over="ignore", invalid="ignore"):  # what is infinite in float32 is refused later
        pixels = np.ascontiguousarray(values, dtype=np.float32)
    return Decoded(pixels, f"NumPy, {dtype}", layout="lat-long")


def _header(data: bytes) -> tuple[tuple[int, ...], np.dtype[Any]]:
    with decoding("NPY"), warnings.catch_warnings(action="ignore"):  # of headers that Python 2 wrote
        return npy_header(data)
