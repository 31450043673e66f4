"""Lights of NumPy arrays in Python, which are read as files that hold them would be."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.array_files import listed_array
from shviewer.coefficients.lists.cilm import has_shape_of_cilm
from shviewer.coefficients.reading import interpreted
from shviewer.errors import LightError, UsageError, refused_as
from shviewer.harmonics.basis import count_bands
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.radiance_files import checked
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.limits import check_brightness


def light_of_array(
    array: NDArray[np.generic], reading: Reading = DEFAULT_READING
) -> CoefficientLight | EnvironmentLight:
    """The light of coefficients or of an image (height, width, 3), linear radiance.

    reading: the convention of coefficients, ours for (n**2, 3) if it names none; layout and repairs of an image.
    UsageError for what is neither, or for a reading that it cannot have.
    """
    if isinstance(array, np.ma.MaskedArray):
        raise UsageError("a masked array is no light: fill what is masked, array.filled(0)")
    if array.dtype.kind not in "fiuc" or (array.dtype.kind == "c" and not reading.convention):
        hint = "; complex coefficients need convention='scipy'" if array.dtype.kind == "c" else ""
        raise UsageError(
            f"an array of type {array.dtype} is no light; radiance and coefficients are real numbers{hint}"
        )
    if array.ndim == 3 and array.shape[2] == 3 and array.size and not has_shape_of_cilm(array.shape):
        return _image(array, reading)
    for name, value, usual in (("layout", reading.layout, "auto"), ("sanitize", reading.sanitize, False)):
        if value != usual:
            raise UsageError(
                f"{name} {value!r}: it is for images, and an array of shape {array.shape} is none; leave it out"
            )
    if not np.isfinite(array).all():
        raise UsageError("an array with NaN or infinite values is no light; radiance and coefficients are finite")
    if not reading.convention and array.ndim == 2 and array.shape[1] == 3:
        with refused_as(UsageError):
            count_bands(array)
        return CoefficientLight(np.array(array, dtype=np.float64))
    if not reading.convention and not has_shape_of_cilm(array.shape):
        raise UsageError(
            f"an array of shape {array.shape}: coefficients are (n**2, 3), or with convention= as files have them; a lat-long "
            "image is (height, width, 3)"
        )
    try:
        return CoefficientLight.of_file(interpreted(listed_array(array), reading.convention), "coefficients")
    except LightError as error:
        raise UsageError(f"an array of shape {array.shape} as coefficients: {error}") from error


def _image(array: NDArray[np.generic], reading: Reading) -> EnvironmentLight:
    if array.dtype.kind != "f":
        raise UsageError(
            f"an image of type {array.dtype}: radiance is linear; divide by 255 and linearise, or give the file"
        )
    if reading.convention:
        raise UsageError(
            f"convention {reading.convention!r}: it is for coefficients, and an image is none; leave it out"
        )
    if not reading.sanitize:
        if not np.isfinite(array).all():
            raise UsageError("an array with NaN or infinite values is no light; sanitize=True repairs an image")
        check_brightness(float(np.abs(array).max()), "image")  # before float32 makes it infinite
    with np.errstate(over="ignore", invalid="ignore"):
        pixels = np.array(array, dtype=np.float32, order="C")
    image = checked(Decoded(pixels, f"NumPy, {array.dtype}", layout="lat-long"), "image", reading.sanitize)
    return EnvironmentLight.of_image(image, "image", reading)
