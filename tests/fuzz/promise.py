"""What the reader promises about any bytes whatever, checked on one input.

It returns finite float32 of a size that the file declares, or raises LightError with one line; within 2 s; and without
more memory than twice the image and 200 MB. What it returns makes a light, in whatever layout it is recognised to have.

Time is that of the processor, so that a busy machine fails nothing. Memory is Linux's high water mark of resident memory,
set back before each input (25 microseconds): it sees what C libraries allocate, which tracemalloc does not. The better
known ru_maxrss cannot be set back, and a child process inherits its parent's. Elsewhere memory is not measured.
"""

from __future__ import annotations

import contextlib
import re
import struct
import time
from pathlib import Path

import numpy as np

from shviewer.errors import LightError
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.radiance_files import decode_radiance_image
from shviewer.lights.layouts.recognise import recognise
from shviewer.lights.reading import Reading
from shviewer.limits import Limits

LIMITS = Limits(texels=2**20)
"""Below the reader's own, since a header of a few bytes may claim all of them and honest work on those takes seconds."""

MOST_SECONDS = 2.0
MOST_BYTES_BEYOND_IMAGE = 200 * 10**6

_AXES = np.stack(np.meshgrid(*[(-1.0, 0.0, 1.0)] * 3), axis=-1).reshape(-1, 3)
_AXES = _AXES[_AXES.any(axis=1)]
DIRECTIONS = np.vstack([_AXES, np.random.default_rng(0).standard_normal((100, 3))])
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1, keepdims=True)
"""(126, 3): both poles, the seam, edges and corners of a cube, and some anywhere."""


class BrokenPromise(Exception):
    """One line that says which."""


class Witness:
    """Checks inputs one after the other in one process."""

    def __init__(self, limits: Limits = LIMITS) -> None:
        self.limits = limits
        forget_peak()
        self.start = peak_bytes()

    def check(self, name: str, data: bytes) -> bool:
        """Whether the input was accepted. BrokenPromise if the reader misbehaved."""
        forget_peak()
        began = time.process_time()
        image = _outcome(name, data, self.limits)
        seconds = time.process_time() - began
        if seconds > MOST_SECONDS:
            raise BrokenPromise(f"took {seconds:.1f} s")
        texels = self.limits.texels if image is None else image.pixels.size // 3
        grown = peak_bytes() - self.start
        if grown > 2 * 12 * texels + MOST_BYTES_BEYOND_IMAGE:
            raise BrokenPromise(f"took {grown / 1e6:.0f} MB for at most {texels} texels")
        if image is not None:
            _check_image(image, data)
            _check_light(image)
        return image is not None


def _outcome(name: str, data: bytes, limits: Limits) -> Decoded | None:
    """None if it was refused as it should be."""
    try:
        return decode_radiance_image(data, name, Reading(limits=limits, isolated=False))
    except LightError as error:
        message = str(error)
        if not message.isprintable() or not message.startswith(f"{name}: ") or len(message) > 1000:
            raise BrokenPromise(f"refused with {message!r}") from None
        return None
    except Exception as error:
        raise BrokenPromise(f"{type(error).__name__}: {error}") from error


def _check_image(image: Decoded, data: bytes) -> None:
    pixels = image.pixels
    if pixels.dtype != np.float32 or pixels.ndim != 3 or pixels.shape[2] != 3 or not pixels.flags.c_contiguous:
        raise BrokenPromise(f"gives {pixels.dtype} {pixels.shape}")
    if not np.isfinite(pixels).all():
        raise BrokenPromise("gives values that are not finite")
    if pixels.shape[:2] not in declared_sizes(data):
        raise BrokenPromise(f"gives {pixels.shape[:2]} where the file declares {declared_sizes(data)}")


def _check_light(image: Decoded) -> None:
    """What is seen lies between the darkest and the brightest texel: it is interpolated."""
    try:
        layout, _, pixels = recognise(image.pixels, image.layout, "auto")
        light = EnvironmentLight(pixels, layout)
        seen, coefficients = light.radiance(DIRECTIONS), light.coefficients(3)
    except Exception as error:
        raise BrokenPromise(f"makes no light: {type(error).__name__}: {error}") from error
    if not (np.isfinite(seen).all() and np.isfinite(coefficients).all()):
        raise BrokenPromise(f"makes a light that is not finite, {light.layout.name}")
    lowest, highest = image.pixels.min(axis=(0, 1)), image.pixels.max(axis=(0, 1))
    rounding = 1e-5 * np.maximum(np.abs(lowest), np.abs(highest))  # of float32, some operations deep
    if (seen < lowest - rounding).any() or (seen > highest + rounding).any():
        raise BrokenPromise(f"makes a light beyond its texels, {light.layout.name}")


def declared_sizes(data: bytes) -> set[tuple[int, int]]:
    """Every (height, width) that somewhere in the file is stated as the reader understands it; few, mostly one."""
    if data.startswith(b"\x89PNG"):
        width, height = struct.unpack_from(">II", data, 16)
        return _with_spheres(data, {(height, width), (width, height)})  # turned by its EXIF orientation
    if data.startswith(b"\xff\xd8"):
        stated = {struct.unpack(">HH", found[1]) for found in re.finditer(rb"(?s)\xff[\xc0-\xcf]..\x08(....)", data)}
        return _with_spheres(data, {size for h, w in stated for size in ((h, w), (w, h))})
    if data.startswith((b"#?", b"\xef\xbb\xbf#?")):
        sizes = re.finditer(rb"[\r\n]\s*[+-]([XYxy])\s+\+?(\d+)\s+[+-][XYxy]\s+\+?(\d+)", data)
        return {(int(m[2]), int(m[3])) if m[1] in b"Yy" else (int(m[3]), int(m[2])) for m in sizes}
    if data.startswith((b"PF", b"Pf")):
        stated = re.match(rb"P.\s(?:\s|#[^\n]*\n)*(\d+)\s+(\d+)\s", data)
        return {(int(stated[2]), int(stated[1]))} if stated else set()
    if data.startswith(b"DDS "):
        height, width = struct.unpack_from("<II", data, 12)
        return {(height, width), (height, 6 * width)}
    if data.startswith(b"\x93NUMPY"):
        shape = re.search(rb"'shape': \((\d+), *(\d+), *3", data)
        return {(int(shape[1]), int(shape[2]))} if shape else set()
    if data.startswith(b"8BPS"):
        return {struct.unpack_from(">II", data, 14)}
    if data.startswith(b"BM"):
        width, height = struct.unpack_from("<ii", data, 18)
        return {(abs(height), width), struct.unpack_from("<HH", data, 18)[::-1]}  # OS/2's header has 16 bits
    if data.startswith(b"RIFF"):
        return _webp_sizes(data)
    if data.startswith((b"II*\0", b"MM\0*")):
        return _tiff_sizes(data, "<" if data.startswith(b"II") else ">")
    windows = re.finditer(rb"(?s)displayWindow\0box2i\0....(.{16})", data)
    corners = [struct.unpack("<4i", found[1]) for found in windows]
    return {(bottom - top + 1, right - left + 1) for left, top, right, bottom in corners}


def _with_spheres(data: bytes, sizes: set[tuple[int, int]]) -> set[tuple[int, int]]:
    """The sizes, and those of the whole sphere of which its XMP says that it shows a part."""
    full_width, full_height, width, height = (
        {float(value) for value in re.findall(rb"GPano:%bPixels\s*=\s*'\s*\+?([\d.eE]+)\s*'" % name, data)}
        for name in (b"FullPanoWidth", b"FullPanoHeight", b"CroppedAreaImageWidth", b"CroppedAreaImageHeight")
    )
    return sizes | {
        (round(h * rows / of), round(w * columns / within))
        for rows, columns in sizes
        for h in full_height
        for of in height - {0}
        for w in full_width
        for within in width - {0}
    }


def _tiff_sizes(data: bytes, order: str) -> set[tuple[int, int]]:
    """Sizes by the first directory: the image, and the full one that it is part of, each also turned."""
    (at,) = struct.unpack_from(f"{order}I", data, 4)
    (count,) = struct.unpack_from(f"{order}H", data, at)
    found: dict[int, set[int]] = {}
    for entry in range(count):
        tag, kind = struct.unpack_from(f"{order}HH", data, at + 2 + 12 * entry)
        value = struct.unpack_from(f"{order}{'I' if kind == 4 else 'H'}", data, at + 10 + 12 * entry)[0]
        found.setdefault(tag, set()).add(value)
    widths, heights = (found.get(tag, set()) | found.get(full, set()) for tag, full in ((256, 33300), (257, 33301)))
    return {size for width in widths for height in heights for size in ((height, width), (width, height))}


def _webp_sizes(data: bytes) -> set[tuple[int, int]]:
    """Those of a canvas, of lossy and of lossless data, turned or not."""
    found = set()
    for chunk in re.finditer(rb"(?s)VP8[X L]....(.{10})", data):
        bits = int.from_bytes(chunk[1], "little")
        width, height = {
            b"X": (1 + (bits >> 32 & 0xFFFFFF), 1 + (bits >> 56)),
            b" ": (bits >> 48 & 0x3FFF, bits >> 64 & 0x3FFF),
            b"L": (1 + (bits >> 8 & 0x3FFF), 1 + (bits >> 22 & 0x3FFF)),
        }[chunk[0][3:4]]
        found |= {(height, width), (width, height)}
    return found


def forget_peak() -> None:
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_bytes(b"5")


def peak_bytes() -> int:
    """0 where the system does not say."""
    try:
        status = Path("/proc/self/status").read_bytes()
    except OSError:
        return 0
    found = re.search(rb"VmHWM:\s*(\d+) kB", status)
    return 1024 * int(found[1]) if found else 0
