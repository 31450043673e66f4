"""DirectDraw surfaces of floating-point texels, which OpenImageIO does not read; it reads any other DDS.

Faces of a cube lie in the order +X -X +Y -Y +Z -Z, each before its smaller levels [Microsoft, Programming guide for DDS].
"""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.decoded import Decoded
from shviewer.limits import DEFAULT_LIMITS, Limits

_FORMATS: dict[int, tuple[type[np.floating], int]] = {113: (np.float16, 4), 116: (np.float32, 4)}
_DXGI: dict[int, tuple[type[np.floating], int]] = {2: (np.float32, 4), 6: (np.float32, 3), 10: (np.float16, 4)}
_CUBE, _VOLUME, _ALL_FACES = 0x200, 0x200000, 0xFC00
_HAS_LEVELS, _COMPLEX = 0x20000, 0x8
_HEADER, _DX10_HEADER = 128, 148  # bytes
_DX10 = int.from_bytes(b"DX10", "little")


def decode_float_dds(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded | None:
    """The radiance in a DDS of floats: a cube as a strip of six faces, or an image. None for a DDS of anything else.

    LightError if it is damaged, too large, or neither a whole cube nor one image.
    """
    if len(data) < (_DX10_HEADER if data.startswith(b"DX10", 84) else _HEADER):
        raise LightError(f"{len(data)} bytes, which no DDS has; fetch or export it again")
    height, width, _, _, levels = struct.unpack_from("<5I", data, 12)
    flags, code = struct.unpack_from("<II", data, 80)
    (caps,) = struct.unpack_from("<I", data, 112)
    start, faces, surfaces = _HEADER, 6 if caps & _CUBE else 1, 1
    found = _FORMATS.get(code) if flags & 4 else None
    if flags & 4 and code == _DX10:
        form, _, misc, surfaces = struct.unpack_from("<4I", data, _HEADER)
        start, faces, found = _DX10_HEADER, 6 if misc & 4 else faces, _DXGI.get(form)
    if caps & _VOLUME or surfaces > 1:
        raise LightError("a volume, or several textures; one image or one cube is read: export that alone")
    if faces == 6 and caps & _CUBE and (caps & _ALL_FACES) != _ALL_FACES:
        raise LightError("a cube of which faces are missing; export all six")
    limits.check_image(faces * width, height, 12 * faces * width * height)
    if faces == 6 and width != height:
        raise LightError(f"a cube with faces of {width} x {height} texels; they are square: export it again")
    if found is None:
        return None
    dtype, channels = found
    pixels = np.empty((height, faces * width, 3), np.float32)
    for face in range(faces):
        pixels[:, face * width : (face + 1) * width] = _level(data, start, (height, width, channels), dtype)[..., :3]
        start += sum(
            max(height >> level, 1) * max(width >> level, 1) * channels * np.dtype(dtype).itemsize
            for level in range(max(min(levels, 32), 1))
        )
    words = f"DDS, {'half' if dtype is np.float16 else 'float'}{', cube' if faces == 6 else ''}"
    return Decoded(pixels, words, ("alpha dropped",) if channels == 4 else (), "cube" if faces == 6 else None)


def spelled_out(data: bytes) -> bytes:
    """A DDS, for OpenImageIO: that it has smaller levels, or is a cube, also in the flags that a writer may leave out."""
    flags, levels = struct.unpack_from("<I", data, 8)[0], struct.unpack_from("<I", data, 28)[0]
    kind, faces = struct.unpack_from("<2I", data, 108)
    if levels > 1:
        flags |= _HAS_LEVELS
    if data.startswith(b"DX10", 84) and struct.unpack_from("<I", data, _HEADER + 8)[0] & 4:
        kind, faces = kind | _COMPLEX, faces | _CUBE | _ALL_FACES
    said = struct.pack("<I", flags) + data[12:108] + struct.pack("<2I", kind, faces)
    return data if data.startswith(said, 8) else data[:8] + said + data[116:]


def _level(data: bytes, start: int, shape: tuple[int, int, int], dtype: type[np.floating]) -> NDArray[np.floating]:
    count = shape[0] * shape[1] * shape[2]
    if len(data) - start < count * np.dtype(dtype).itemsize:
        raise LightError(f"cut short: {len(data)} bytes end within its texels; fetch or export it again")
    return np.frombuffer(data, dtype, count, start).reshape(shape)
