"""A photo sphere: a lat-long picture that says in its XMP which part of the sphere it covers.

Source
    [GPano] Photo Sphere XMP Metadata, developers.google.com/streetview/spherical-metadata: the whole sphere in texels, and
            the place of the picture within it
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.display.xmp import number, properties
from shviewer.limits import Limits

_GPANO = "{http://ns.google.com/photos/1.0/panorama/}"
_FULL = ("FullPanoWidthPixels", "FullPanoHeightPixels")
_PART = (
    "CroppedAreaImageWidthPixels",
    "CroppedAreaImageHeightPixels",
    "CroppedAreaLeftPixels",
    "CroppedAreaTopPixels",
)
_POSE = ("PosePitchDegrees", "PoseRollDegrees")


def placed(decoded: Decoded, xmp: bytes, limits: Limits) -> Decoded:
    """The picture on the whole sphere, black elsewhere, with the layout that its XMP states.

    A picture that was made smaller since keeps its place: the numbers count texels of the picture as it was.
    LightError for a sphere beyond the limits.
    """
    pixels, layout, notes = _placed(decoded.pixels, xmp, limits)
    return replace(decoded, pixels=pixels, layout=layout, notes=(*decoded.notes, *notes))


def _placed(
    pixels: NDArray[np.float32], xmp: bytes, limits: Limits
) -> tuple[NDArray[np.float32], str | None, tuple[str, ...]]:
    """Pixels, layout and notes."""
    gpano = {name.removeprefix(_GPANO): texts for name, texts in properties(xmp).items() if name.startswith(_GPANO)}
    projection = (gpano.get("ProjectionType") or [""])[0]
    if projection not in ("", "equirectangular"):
        return pixels, None, (f"its XMP (GPano) states the projection {projection[:40]!a}, which is not read",)
    numbers = [number(gpano.get(name)) for name in (*_FULL, *_PART)]
    if all(value is None for value in numbers):
        return pixels, "lat-long" if projection else None, _pose(gpano)
    sizes = _in_texels(numbers, pixels)
    if sizes is None:
        return pixels, None, ("its XMP (GPano) is ignored: its numbers are no part of a sphere",)
    full_width, full_height, left, top = sizes
    height, width = pixels.shape[:2]
    if (full_width, full_height) == (width, height):
        return pixels, "lat-long", _pose(gpano)
    limits.check_image(full_width, full_height, 12 * (full_width * full_height + pixels.size // 3), "photo sphere")
    sphere = np.zeros((full_height, full_width, 3), np.float32)
    sphere[top : top + height, left : left + width] = pixels
    note = (
        f"a part of a sphere by its XMP (GPano): {width} x {height} texels placed at column {left}, row {top} of"
        f" {full_width} x {full_height}, the rest is black"
    )
    return sphere, "lat-long", (note, *_pose(gpano))


def _in_texels(numbers: list[float | None], pixels: NDArray[np.float32]) -> tuple[int, int, int, int] | None:
    """Width and height of the sphere, left and top of the picture, in its texels; None for numbers that do not fit together."""
    if any(value is None or not math.isfinite(value) for value in numbers):
        return None
    full_width, full_height, width, height, left, top = (value for value in numbers if value is not None)
    if not (0 < width <= full_width <= 2**20 and 0 < height <= full_height <= 2**20):
        return None
    if not (0 <= left <= full_width - width and 0 <= top <= full_height - height):
        return None
    rows, columns = pixels.shape[:2]
    across, down = columns / width, rows / height  # texels now for each as it was
    full = max(columns, round(full_width * across)), max(rows, round(full_height * down))
    return (*full, min(round(left * across), full[0] - columns), min(round(top * down), full[1] - rows))


def _pose(gpano: dict[str, list[str]]) -> tuple[str, ...]:
    """A note if the sphere is not level."""
    angles = [number(gpano.get(name)) or 0.0 for name in _POSE]
    if not any(angles):
        return ()
    return ("its XMP (GPano) states a pitch of {:g} and a roll of {:g} degrees: not applied".format(*angles),)
