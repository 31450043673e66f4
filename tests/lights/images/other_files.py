"""Files in the containers of shviewer/lights/images/others, made byte by byte by their published specifications."""

from __future__ import annotations

import io
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np

Pixels = np.ndarray[Any, Any]


def pfm_file(image: Pixels, order: str = "<", scale: str = "-1.0", comment: str = "") -> bytes:
    """A portable float map of an image (height, width, 3) or (height, width), lowest row first."""
    height, width = image.shape[:2]
    kind = "PF" if image.ndim == 3 else "Pf"
    return f"{kind}\n{comment}{width} {height}\n{scale}\n".encode() + image[::-1].astype(f"{order}f4").tobytes()


def npy_file(array: Any) -> bytes:
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def dds_file(
    faces: Sequence[Pixels] | Pixels,
    code: int = 0,
    dxgi: int | None = None,
    caps: int = 0xFE00,
    levels: int = 1,
    surfaces: int = 1,
) -> bytes:
    """A DDS of faces (height, width, channels); without a code of their format, 8 bit RGBA. The smaller levels are black."""
    height, width, channels = faces[0].shape
    flags, code = (4, int.from_bytes(b"DX10", "little")) if dxgi is not None else (4, code) if code else (0x41, 0)
    masks = (32, 0xFF, 0xFF00, 0xFF0000, 0xFF000000) if flags == 0x41 else (0,) * 5
    header = b"DDS " + struct.pack("<7I", 124, 0x1007, height, width, 0, 0, levels) + bytes(44)
    header += struct.pack("<8I", 32, flags, code, *masks) + struct.pack("<5I", 0x1008, caps, 0, 0, 0)
    if dxgi is not None:
        header += struct.pack("<5I", dxgi, 3, 4 if caps & 0x200 else 0, surfaces, 0)
    texel = faces[0].itemsize * channels
    smaller = b"".join(bytes(max(height >> level, 1) * max(width >> level, 1) * texel) for level in range(1, levels))
    return header + b"".join(face.tobytes() + smaller for face in faces)


def psd_file(pixels: Pixels) -> bytes:
    """A picture of Photoshop without layers, uncompressed."""
    height, width, channels = pixels.shape
    header = (
        b"8BPS" + struct.pack(">H6xHIIHH", 1, channels, height, width, 8 * pixels.itemsize, 3) + bytes(12) + b"\0\0"
    )
    return header + np.moveaxis(pixels, 2, 0).astype(pixels.dtype.newbyteorder(">")).tobytes()


def tiff_file(
    pixels: Pixels,
    photometric: int = 2,
    width: int = 0,
    orientation: int = 1,
    extra: Sequence[tuple[int, int, bytes]] = (),
) -> bytes:
    """An uncompressed TIFF in one strip, little-endian. width: what its header says. extra: (tag, type, value) of bytes."""
    height, columns, channels = pixels.shape
    kind = {"u": 1, "i": 2, "f": 3}[pixels.dtype.kind]
    data = pixels.tobytes()
    after = 8 + len(data)
    bits = struct.pack(f"<{channels}H", *(8 * pixels.itemsize,) * channels)
    longs = [(256, 4, 1, width or columns), (257, 4, 1, height), (258, 3, channels, after), (259, 3, 1, 1)]
    longs += [
        (262, 3, 1, photometric),
        (273, 4, 1, 8),
        (274, 3, 1, orientation),
        (277, 3, 1, channels),
        (278, 4, 1, height),
    ]
    longs += [(279, 4, 1, len(data)), (339, 3, 1, kind)]
    block = bits
    for tag, type_, value in extra:
        longs.append((tag, type_, len(value), after + len(block)))
        block += value + bytes(len(value) % 2)
    directory = (
        struct.pack("<H", len(longs)) + b"".join(struct.pack("<HHII", *entry) for entry in sorted(longs)) + bytes(4)
    )
    return b"II*\0" + struct.pack("<I", after + len(block)) + data + block + directory
