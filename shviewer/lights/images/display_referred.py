"""PNG and JPEG: pictures made for a display, whose codes are turned back into light that is proportional to radiance.

Whatever was brighter than white is lost in them; the notes say so. Codes are decoded by Pillow; they become
radiance by a table: the sRGB curve, or the power that a PNG's gAMA chunk states.

Traps of Pillow (10 to 13), each with a test:
    Image.open warns, later refuses, above a number of texels of its own: the format's class is opened instead;
    PNGs of 16 bit RGB are decoded to their high bytes: the raw mode of the other byte order gives the low bytes;
    a JPEG that ends early may pass unnoticed, and so may much damage in a PNG: see png_chunks.py.

Damage within the scans of a JPEG cannot be told from a picture: the format has no checksum.

Sources
    [sRGB] IEC 61966-2-1:1999, 5.2: the curve from codes to linear light
    [PNG] Portable Network Graphics, third edition, 4.3 (which colour chunk counts), 11.3.2 (colour)
"""

from __future__ import annotations

import io
import struct
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.png_chunks import check_texels, damaged, plain_png, read_chunks
from shviewer.limits import DEFAULT_LIMITS, Limits

_BLOCK_TEXELS = 2**16
_MOST_TEXELS_OF_A_BYTE = 8 * 64  # of a JPEG: a block of 8 x 8 takes at least one bit of Huffman code

_LOW_BYTES = {"RGB;16B": "RGB;16L", "RGBA;16B": "RGBA;16L", "LA;16B": "RGBA"}
"""The raw mode for the high bytes of 16 bit samples -> the raw mode for the low bytes, in an image of the same mode."""

_SRGB_GAMMA = 0.45455  # what encoders write for sRGB
_TRANSFERS_OF_HDR = {16: "PQ", 18: "HLG"}  # of a PNG's cICP chunk, as numbered by ITU-T H.273
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
    values: NDArray[Any]  # (height, width), or (height, width, 2 to 4) with the colours first; integers
    bits: int
    alpha: bool
    orientation: int  # EXIF, 1 to 8
    profile: bytes  # ICC, empty for none


def decode_png(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded:
    """The radiance that a PNG's codes stand for; an animated PNG gives its first frame.

    data: the whole file.
    Raises LightError, without the name of the file, if it is damaged, too large, or in PQ or HLG.
    """
    from PIL.PngImagePlugin import PngImageFile  # here, so that lights without such a file start faster

    chunks, compressed = read_chunks(data)
    check_texels(chunks[b"IHDR"], compressed, limits)
    gamma, notes = _png_colour(chunks)
    codes = _decode(PngImageFile, plain_png(chunks, compressed), limits)
    if b"cICP" not in chunks:
        notes += profile_notes(codes.profile)
    if b"acTL" in chunks:
        notes.append("animated: only the first frame is read")
    return linearised("PNG", codes, gamma, notes)


def decode_jpeg(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded:
    """The radiance that a JPEG's codes stand for, upright by its EXIF orientation.

    data: the whole file.
    Raises LightError, without the name of the file, if it is damaged, too large, or neither RGB nor grey.
    """
    from PIL.JpegImagePlugin import JpegImageFile

    if data.rfind(b"\xff\xd9") < data.rfind(b"\xff\xda"):  # in the texels, 0xff is followed by 0 or a restart number
        raise damaged("no end of the image after its last scan")
    codes = _decode(JpegImageFile, data, limits, most_texels=_MOST_TEXELS_OF_A_BYTE * len(data))
    return linearised("JPEG", codes, None, profile_notes(codes.profile))


def linearised(kind: str, codes: Codes, gamma: float | None, notes: list[str]) -> Decoded:
    """Codes as linear radiance. gamma: the power by which codes were made from light; None for the sRGB curve."""
    steps = np.arange(2**codes.bits) / (2**codes.bits - 1)
    table = (_linear_from_srgb(steps) if gamma is None else steps ** (1.0 / gamma)).astype(np.float32)
    values, turned = codes.values, []
    if turn := TURNS.get(codes.orientation):
        values = turn(values)
        turned = [f"turned upright: its EXIF orientation is {codes.orientation}"]
    curve = "sRGB" if gamma is None else f"gamma {gamma:g}"
    lost = f"{codes.bits} bit {curve}, linearised: what was brighter than white is lost, so a sun will be too weak"
    dropped = ["alpha dropped"] if codes.alpha else []
    return Decoded(
        _look_up(table, values), f"{kind}, {codes.bits} bit {curve} (LDR)", (lost, *notes, *turned, *dropped)
    )


def _linear_from_srgb(encoded: NDArray[np.float64]) -> NDArray[np.float64]:
    """The inverse of the curve [sRGB]; encoded and linear are in 0 to 1."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def _look_up(table: NDArray[np.float32], values: NDArray[Any]) -> NDArray[np.float32]:
    """Radiance (height, width, 3), grey in all three channels; by blocks of rows, since an index takes 8 bytes a value."""
    height, width = values.shape[:2]
    colours = (
        values[..., :3] if values.ndim == 3 and values.shape[2] >= 3 else values.reshape(height, width, -1)[..., :1]
    )
    pixels = np.empty((height, width, 3), np.float32)
    rows = max(1, _BLOCK_TEXELS // width)
    for top in range(0, height, rows):
        pixels[top : top + rows] = table[colours[top : top + rows]]
    return pixels


def _decode(
    image_class: Callable[[io.BytesIO], Any], data: bytes, limits: Limits, most_texels: int | None = None
) -> Codes:
    """Decode with Pillow, and turn its errors into LightErrors.

    most_texels: how many texels a file of this length can hold, if that is known.
    """
    try:
        with warnings.catch_warnings(action="ignore"):
            image = image_class(io.BytesIO(data))
            width, height = image.size
            limits.check_size(width, height)
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


def _png_colour(chunks: dict[bytes, bytes]) -> tuple[float | None, list[str]]:
    """The power of the PNG's curve, None for sRGB's, and notes. The first colour chunk in the list of [PNG] 4.3 counts."""
    if cicp := chunks.get(b"cICP"):
        primaries, transfer = (*cicp, 0, 0)[:2]
        if transfer in _TRANSFERS_OF_HDR:
            raise LightError(
                f"coded in {_TRANSFERS_OF_HDR[transfer]} (its cICP chunk says so); only sRGB and plain powers are read:"
                " convert it to .exr"
            )
        return None, [] if primaries == 1 else [f"its colour primaries (cICP {primaries}) are taken for Rec. 709"]
    if b"iCCP" in chunks or b"sRGB" in chunks or len(chunks.get(b"gAMA", b"")) != 4:
        return None, []
    gamma = struct.unpack(">I", chunks[b"gAMA"])[0] / 1e5
    if abs(gamma - _SRGB_GAMMA) < 0.005:
        return None, []
    if not 0.1 <= gamma <= 10.0:
        return None, [f"its gAMA of {gamma:g} is ignored, sRGB assumed"]
    return gamma, [f"its gAMA of {gamma:g} is honoured"]


def profile_notes(profile: bytes) -> list[str]:
    """The note on an ICC profile; a profile that calls itself sRGB needs none."""
    if not profile or b"sRGB" in profile or "sRGB".encode("utf-16-be") in profile:
        return []
    return ["its colour profile (ICC) is ignored, sRGB assumed"]
