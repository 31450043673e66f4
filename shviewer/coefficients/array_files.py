"""Coefficients in NumPy's files. Nothing pickled is loaded, and sizes in a header are checked before memory is taken."""

from __future__ import annotations

import io
import json
import math
import warnings
import zipfile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.lists.cilm import rows_of_cilm
from shviewer.coefficients.numbers import MAX_NUMBERS, Listed, arranged
from shviewer.coefficients.stamp import SCHEMA_KEY, Stamp
from shviewer.errors import LightError
from shviewer.files import decoding
from shviewer.words import one_line

NPY = ".npy"
_LONGEST_HEADER = 2**17  # bytes
_WIDEST = 6
"""The most columns that rows of coefficients have: real and imaginary parts of three channels."""


def read_arrays(data: bytes) -> Listed:
    """The numbers in an .npz with `coefficients` and, if project wrote it, `stamp`, or in an .npy; cilm is put in rows.

    LightError if it is bad.
    """
    most = 16 * MAX_NUMBERS + 2**16
    with decoding("readable NPZ or NPY"), warnings.catch_warnings(action="ignore"):  # of headers that Python 2 wrote
        arrays = _arrays(data, most)
    listed = listed_array(arrays["coefficients"], bare="stamp" not in arrays)
    return Listed(listed.numbers, _stamp_text(arrays["stamp"])) if "stamp" in arrays else listed


def listed_array(numbers: NDArray[Any], *, bare: bool = True) -> Listed:
    """The numbers of an array, cilm put in rows; those of a bare one are arranged. LightError if they are no coefficients."""
    if numbers.ndim > 2 and numbers.size and numbers.dtype.kind in "fiuc" and bare:
        return rows_of_cilm(numbers)
    if numbers.dtype.kind not in "fiuc" or numbers.ndim not in (1, 2) or not numbers.size:
        raise LightError(f"coefficients of type {numbers.dtype} and shape {numbers.shape}; they are (n^2, 3) numbers")
    if bare and numbers.ndim == 2 and numbers.shape[1] > _WIDEST and len(numbers) != 3:
        raise LightError(
            f"an array of shape {numbers.shape}; coefficients are (n^2, 3), an image is (height, width, 3)"
        )
    return arranged(numbers) if bare else Listed(numbers)


def _arrays(data: bytes, most: int) -> dict[str, NDArray[Any]]:
    """Name -> array, for "coefficients" and, if it is there, "stamp"; each of at most `most` bytes."""
    if not data.startswith(b"PK"):
        return {"coefficients": _array(_small_npy(data, most))}
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = {info.filename: info for info in archive.infolist()}
        if f"coefficients{NPY}" not in members:
            there = ", ".join(sorted(name.removesuffix(NPY) for name in members)[:8]) or "nothing"
            raise LightError(f'no array "coefficients" in it; there is: {one_line(there)}')
        return {
            name: _array(_member(archive, members[name + NPY], most))
            for name in ("coefficients", "stamp")
            if name + NPY in members
        }


def _array(file: io.BytesIO) -> NDArray[Any]:
    try:
        return np.lib.format.read_array(file, allow_pickle=False)
    except ValueError as error:
        if "pickle" in str(error) or "Object arrays" in str(error):
            raise LightError(
                "holds pickled Python objects, which are never loaded; save plain arrays of numbers"
            ) from None
        raise


def _stamp_text(array: NDArray[Any]) -> Stamp:
    try:
        if array.dtype.kind != "U" or array.size != 1:
            raise ValueError
        # not str(array): it believes code points beyond those of Unicode, and Python ends with a SystemError
        text = array.astype(array.dtype.newbyteorder("<")).tobytes().decode("utf-32-le")
        found = json.loads(text.rstrip("\0"))
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict) or SCHEMA_KEY not in found:
        raise LightError("its stamp is no JSON object of a coefficient file: project the light again")
    return found


def _member(archive: zipfile.ZipFile, info: zipfile.ZipInfo, most: int) -> io.BytesIO:
    if info.file_size > most:
        raise LightError(
            f"{info.filename} takes {info.file_size} bytes unpacked; the limit is {most}: 128 bands have less"
        )
    with archive.open(info) as file:
        return _small_npy(file.read(most + 1), most)


def _small_npy(data: bytes, most: int) -> io.BytesIO:
    if len(data) > most:
        raise LightError(f"more than {most} bytes unpacked: 128 bands have less")
    shape, dtype = npy_header(data)
    size = dtype.itemsize * math.prod(shape)
    if size > most:
        raise LightError(f"an array of shape {shape} claims {size} bytes; the limit is {most}: 128 bands have less")
    return io.BytesIO(data)


def npy_header(data: bytes) -> tuple[tuple[int, ...], np.dtype[Any]]:
    """The shape and the type of the array in an .npy. Whatever NumPy raises for a header that is none."""
    file = io.BytesIO(data[:_LONGEST_HEADER])
    version = np.lib.format.read_magic(file)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, _, dtype = read(file)
    return shape, dtype
