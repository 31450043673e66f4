"""The codes of a picture, decoded by Pillow, and the light they stand for.

Traps of Pillow (10 to 13), each with a test:
    Image.open warns, later refuses, above a number of texels of its own: the format's class is opened instead;
    PNGs of 16 bit RGB are decoded to their high bytes: the raw mode of the other byte order gives the low bytes;
    a JPEG that ends early may pass unnoticed, and so may much damage in a PNG: see jpeg_segments.py and png_chunks.py.
"""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.chromaticities import convert
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.display.colour import Colour
from shviewer.limits import Limits

_BLOCK_TEXELS = 2**16

_LOW_BYTES = {"RGB;16B": "RGB;16L", "RGBA;16B": "RGBA;16L", "LA;16B": "RGBA"}
"""The raw mode for the high bytes of 16 bit samples -> the raw mode for the low bytes, in an image of the same mode."""

_EXIF_ORIENTATION = 0x0112

TURNS: dict[int, Callable[[NDArray[Any]], NDArray[Any]]] = {
    2: lambda codes: codes[:, ::-1],
    3: lambda codes: codes[::-1, ::-1],
    4: lambda codes: codes[::-1],
    5: lambda codes: codes.swapaxes(0, 1),
    6: lambda codes: codes[::-1].swapaxes(0, 1),
    7: lambda codes: codes[::-1, ::-1].swapaxes(0, 1),
    8: lambda codes: codes[:, ::-1].swapaxes(0, 1),
}
"""EXIF orientation -> how the stored rows become upright; 1 is upright already."""


class Codes(NamedTuple):
    """An image as it is encoded: integers, and what says how to read them."""

    values: NDArray[Any]  # (height, width), or (height, width, 2 to 4) with the colours first; integers
    bits: int
    alpha: bool
    orientation: int  # EXIF, 1 to 8
    profile: bytes  # ICC, empty for none
    xmp: bytes = b""  # empty for none

    def colours(self, orientation: int) -> NDArray[Any]:
        """The values without alpha, (height, width, 1 or 3), turned as an EXIF orientation says."""
        values = self.values.reshape(*self.values.shape[:2], -1)
        colours = values[..., : 3 if values.shape[2] > 2 else 1]
        turn = TURNS.get(orientation)
        return turn(colours) if turn else colours

    def notes(self) -> tuple[str, ...]:
        """What is not in the values any more, for the user."""
        turned = [f"turned upright: its EXIF orientation is {self.orientation}"] if self.orientation != 1 else []
        return (*turned, *(["alpha dropped"] if self.alpha else []))


def damaged(reason: str) -> LightError:
    """The error for a file that is not what it should be."""
    return LightError(f"damaged or cut short, {reason}; fetch or export the file again")


def linear(codes: Codes, colour: Colour) -> NDArray[np.float32]:
    """The upright radiance (height, width, 3) in the picture's own primaries, grey in all three channels.

    By blocks of rows, since an index takes 8 bytes a value.
    """
    table, colours = colour.table(codes.bits), codes.colours(codes.orientation)
    height, width = colours.shape[:2]
    pixels = np.empty((height, width, 3), np.float32)
    rows = max(1, _BLOCK_TEXELS // width)
    for top in range(0, height, rows):
        block = colours[top : top + rows]
        if len(table) == 1:
            pixels[top : top + rows] = table[0][block]
            continue
        for i, curve in enumerate(table):
            pixels[top : top + rows, :, i] = curve[block[..., min(i, block.shape[2] - 1)]]
    return pixels


def linearised(kind: str, codes: Codes, colour: Colour, notes: Iterable[str] = ()) -> Decoded:
    """The light of codes for a display, of which it is said that what was brighter than white is lost. kind: the format."""
    pixels = linear(codes, colour)
    convert(pixels, colour.rec709_from)
    words = f"{codes.bits} bit {colour.curve_name}"
    lost = f"{words}, linearised: what was brighter than white is lost, so a sun will be too weak"
    return Decoded(pixels, f"{kind}, {words} (LDR)", (lost, *colour.notes, *notes, *codes.notes()))


def decode(
    image_class: Callable[[io.BytesIO], Any], data: bytes, limits: Limits, most_texels: int | None = None
) -> Codes:
    """Decode with Pillow. LightError for a file that it cannot decode or that is larger than the limits.

    most_texels: how many texels a file of this length can hold, if that is known.
    """
    try:
        with warnings.catch_warnings(action="ignore"):
            image = image_class(io.BytesIO(data))
            width, height = image.size
            limits.check_image(width, height, 28 * width * height + 2 * len(data))
            if most_texels is not None and width * height > most_texels:
                raise damaged(f"{len(data)} bytes cannot hold {width} x {height} texels")
            return _read_codes(image, lambda: image_class(io.BytesIO(data)))
    except (LightError, MemoryError):
        raise
    except Exception as error:  # SyntaxError, OSError, ValueError, struct.error, ... by file and version
        raise damaged(f"Pillow says: {_one_line(error)}") from None


def _read_codes(image: Any, reopened: Callable[[], Any]) -> Codes:
    """Decode an image that is opened but not yet decoded."""
    raw_mode = image.tile[0][3] if image.tile else None
    bits = 16 if raw_mode in _LOW_BYTES or image.mode in ("I", "I;16") else 8
    match image.mode:
        case "1":
            values = np.asarray(image.convert("L"))
        case "P" | "PA":
            values = np.asarray(image.convert("RGB"))
        case "L" | "LA" | "RGB" | "RGBA":
            values = np.asarray(image)
        case "I" | "I;16":
            values = np.asarray(image).astype(np.uint16)
        case mode:
            raise LightError(f"colours in {mode}; only RGB and grey are read: convert it to RGB")
    if raw_mode in _LOW_BYTES:
        values = _with_low_bytes(reopened(), values, raw_mode)
    return Codes(
        values,
        bits,
        alpha=image.mode in ("LA", "PA", "RGBA") or "transparency" in image.info,
        orientation=_orientation(image),
        profile=image.info.get("icc_profile") or b"",
        xmp=image.info.get("xmp") or b"",
    )


def _with_low_bytes(image: Any, high: NDArray[np.uint8], raw_mode: str) -> NDArray[np.uint16]:
    """Samples of 16 bit. image: opened again, not yet decoded; high: the high bytes, decoded by `raw_mode`."""
    image.tile = [(*image.tile[0][:3], _LOW_BYTES[raw_mode])]
    low = np.asarray(image)
    if raw_mode == "LA;16B":  # all four bytes of grey and alpha
        high, low = low[..., :1], low[..., 1:2]
    return np.asarray(np.left_shift(high, 8, dtype=np.uint16) | low, np.uint16)


def _orientation(image: Any) -> int:
    """The EXIF orientation; 1 if the EXIF data are missing, damaged or nonsense."""
    try:
        orientation = image.getexif().get(_EXIF_ORIENTATION, 1)
    except Exception:  # as many kinds as there are ways to damage a TIFF directory
        return 1
    return orientation if orientation in TURNS else 1


def _one_line(error: Exception) -> str:
    text = " ".join((str(error) or type(error).__name__).split())
    return ascii(text[:160])[1:-1]
