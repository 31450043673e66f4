"""The Radiance picture format: .hdr and .pic, RGBE and XYZE texels.

A texel is four bytes: three mantissas and one exponent e. A channel's value is mantissa * 2**(e - 136), and e = 0
is black. Writers and readers agree on this; only Radiance itself adds half a step to the mantissa.

Primaries. Radiance's own are near Rec. 709 but have another white (1/3, 1/3). No reader converts a file that states no
primaries: its RGB is taken as it is, here too. Primaries that a file states are believed, and the colours adapted to
D65. XYZE counts as such an RGB written as XYZ: it becomes RGB with Radiance's primaries, as by ra_xyze -r, or with those
of Rec. 709 if the file states primaries. Its unit is luminance, 179 lm/W times radiance.

Source
    [R] Radiance File Formats, radsite.lbl.gov/radiance/refer/filefmts.pdf, "Picture File Format (.hdr suffix)"
    [X] Radiance, src/px/ra_xyze.c and src/common/color.h: conversion, primaries and luminous efficacy
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.chromaticities import is_rec709, rec709_from, xyz_from_rgb
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.rgbe_scanlines import Packing, check_enough_bytes, read_scanlines
from shviewer.limits import DEFAULT_LIMITS, Limits

MAX_HEADER_BYTES = 64 * 2**10
_SIZE_LINE = re.compile(rb"\s*([+-])([XY])\s+([+-]?\d{1,30})\s+([+-])([XY])\s+([+-]?\d{1,30})\s*")
_FORMATS = {b"32-bit_rle_rgbe": "RGBE", b"32-bit_rle_xyze": "XYZE"}
_PACKINGS: dict[Packing, str] = {"flat": "not packed", "old": "old run-length packing", "new": "new run-length packing"}

_RADIANCE = np.array([[0.640, 0.330], [0.290, 0.600], [0.150, 0.060], [1 / 3, 1 / 3]])  # [X]
_XYZ = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1 / 3, 1 / 3]])
_WHITE_EFFICACY = 179.0  # lm/W, of an equal-energy white [X]

_VALUE_OF_ONE_STEP = np.ldexp(1.0, np.arange(256) - 136).astype(np.float32)  # exact, also where it is subnormal
_VALUE_OF_ONE_STEP[0] = 0.0


@dataclass(frozen=True)
class _Header:
    first_texel: int  # offset into the file, bytes
    scanlines: int
    length: int  # texels of one scanline
    column_by_column: bool  # a scanline is a column of the image
    reversed_scanlines: bool  # they come bottom to top, or right to left
    reversed_texels: bool  # so do the texels within one
    channels: str  # "RGBE" or "XYZE"
    rec709_from_stored: NDArray[np.float64] | None  # (3, 3), exposure included; None for no change
    notes: tuple[str, ...]


class _Settings:
    """The settings in the header lines read so far."""

    def __init__(self) -> None:
        self.channels = "RGBE"
        self.exposure = 1.0  # stored = radiance * exposure * colour_correction
        self.colour_correction = np.ones(3)
        self.primaries: NDArray[np.float64] | None = None  # (4, 2), stated and sensible; the last ones count [X]
        self.ignored: list[str] = []

    def read(self, line: bytes) -> None:
        """Read one header line. A setting counts only at the start of its line: indented ones are history."""
        key, _, value = line.partition(b"=")
        match key:
            case b"FORMAT":
                if value.strip() not in _FORMATS:
                    raise LightError(
                        f"{_shown(line)}: only 32-bit_rle_rgbe and 32-bit_rle_xyze are read; convert it, e.g. with"
                        " ra_xyze -r"
                    )
                self.channels = _FORMATS[value.strip()]
            case b"EXPOSURE":
                self.exposure *= _positive_numbers(line, 1)[0]
            case b"COLORCORR":
                self.colour_correction *= _positive_numbers(line, 3)
            case b"PRIMARIES":
                self._read_primaries(line)
            case b"GAMMA":
                numbers = _numbers(line, 1)
                if len(numbers) != 1 or numbers[0] != 1.0:
                    self.ignored.append(f"{_shown(line)} ignored: the texels are linear by definition")

    def _read_primaries(self, line: bytes) -> None:
        numbers = _numbers(line, 8)
        if len(numbers) != 8:
            self.ignored.append(f"{_shown(line)} ignored: it is not eight numbers")
        elif not np.any(numbers):
            self.ignored.append("PRIMARIES ignored: all are 0, as Photoshop writes them")
        else:
            try:
                rec709_from(numbers.reshape(4, 2))
            except LightError as error:
                self.ignored.append(f"PRIMARIES ignored: {str(error).rpartition(';')[0]}")
            else:
                self.primaries = numbers.reshape(4, 2)

    def rec709_from_stored(self) -> NDArray[np.float64] | None:
        """The matrix (3, 3) from stored values to linear Rec. 709; None for the identity."""
        divisor = self.exposure * self.colour_correction
        if not np.all(np.isfinite(divisor) & (divisor > 0.0) & np.isfinite(1.0 / divisor)):
            raise LightError(
                f"EXPOSURE and COLORCORR multiply to {divisor}; that must be finite and above 0: correct them"
            )
        matrix = np.diag(1.0 / divisor)
        if self.channels == "XYZE":
            rgb = np.linalg.inv(xyz_from_rgb(_RADIANCE)) if self.primaries is None else rec709_from(_XYZ)
            matrix = rgb / _WHITE_EFFICACY @ matrix
        elif self.primaries is not None and not is_rec709(self.primaries):
            matrix = rec709_from(self.primaries) @ matrix
        return None if np.array_equal(matrix, np.eye(3)) else matrix

    def notes(self) -> tuple[str, ...]:
        notes = []
        if self.exposure != 1.0:
            notes.append(f"EXPOSURE {self.exposure:g} divided out")
        if np.any(self.colour_correction != 1.0):
            notes.append("COLORCORR {:g} {:g} {:g} divided out".format(*self.colour_correction))
        if self.channels == "XYZE":
            target = "RGB of Radiance's primaries" if self.primaries is None else "Rec. 709"
            notes.append(f"XYZE converted to {target}, 179 lm/W")
        elif self.primaries is not None and not is_rec709(self.primaries):
            notes.append("PRIMARIES {} converted to Rec. 709".format(" ".join(f"{x:g}" for x in self.primaries.flat)))
        return (*notes, *self.ignored)


@np.errstate(
    over="ignore", under="ignore", divide="ignore"
)  # an exposure that overflows is refused, and so is infinite radiance
def decode_rgbe(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded:
    """The radiance in a .hdr file, with notes for the user.

    data: the whole file; bytes after the last scanline are allowed.
    Raises LightError, without the name of the file, if it is cut short, damaged, or neither RGBE nor XYZE.
    """
    header = _read_header(data, limits)
    check_enough_bytes(data, header.first_texel, header.scanlines, header.length)
    columns = header.column_by_column
    sides = (header.length, header.scanlines) if columns else (header.scanlines, header.length)
    pixels = np.empty((*sides, 3), np.float32)
    scanlines = pixels.swapaxes(0, 1) if columns else pixels  # a view in the order of the file
    if header.reversed_scanlines:
        scanlines = scanlines[::-1]
    if header.reversed_texels:
        scanlines = scanlines[:, ::-1]

    packings: set[Packing] = set()
    row = 0
    for packing, planes in read_scanlines(data, header.first_texel, header.scanlines, header.length):
        _convert(planes, header.rec709_from_stored, scanlines[row : row + len(planes)])
        packings.add(packing)
        row += len(planes)
    return Decoded(pixels, f"Radiance {header.channels}, {_in_words(packings)}", header.notes)


def _convert(planes: NDArray[np.uint8], matrix: NDArray[np.float64] | None, out: NDArray[np.float32]) -> None:
    """Convert mantissas and exponents (rows, 4, length) to radiance, written into `out` (rows, length, 3)."""
    step = _VALUE_OF_ONE_STEP.take(planes[:, 3])
    for i in range(3):
        np.multiply(planes[:, i], step, out=out[..., i])
    if matrix is not None:
        out[...] = out.astype(np.float64) @ matrix.T


def _in_words(packings: set[Packing]) -> str:
    """The packings in words. Old scanlines without a repeated texel look flat, so among old ones they count as old."""
    if len(packings) > 1 and "new" in packings:
        return "mixed packing"
    return _PACKINGS["flat" if packings == {"flat"} else "old" if "old" in packings else "new"]


def _read_header(data: bytes, limits: Limits) -> _Header:
    """Everything before the first texel."""
    settings = _Settings()
    line, position = _next_line(data, 0)
    while line:
        settings.read(line)
        line, position = _next_line(data, position)
    matrix = settings.rec709_from_stored()

    line, position = _next_line(data, position)
    size = _SIZE_LINE.fullmatch(line)
    if size is None or size[2] == size[5]:
        raise LightError(
            f"size line {_shown(line)}; one like '-Y 512 +X 1024' must follow the empty line: re-export it"
        )
    scanlines, length = int(size[3]), int(size[6])
    columns = size[2] == b"X"
    limits.check_size(*((scanlines, length) if columns else (length, scanlines)))
    reversal = {b"Y": b"+", b"X": b"-"}  # +Y counts upwards, and rows are stored here from the top
    return _Header(
        first_texel=position,
        scanlines=scanlines,
        length=length,
        column_by_column=columns,
        reversed_scanlines=size[1] == reversal[size[2]],
        reversed_texels=size[4] == reversal[size[5]],
        channels=settings.channels,
        rec709_from_stored=matrix,
        notes=settings.notes(),
    )


def _next_line(data: bytes, start: int) -> tuple[bytes, int]:
    """The header line at `start` without its LF or CR LF, and where the next one begins."""
    end = data.find(b"\n", start, MAX_HEADER_BYTES)
    if end >= 0:
        return data[start:end].removesuffix(b"\r"), end + 1
    if len(data) >= MAX_HEADER_BYTES:
        raise LightError(
            f"no size line in the first {MAX_HEADER_BYTES} bytes, the longest header allowed: re-export it"
        )
    raise LightError(f"the header is cut short at byte {len(data)}, before its size line: fetch the file again")


def _numbers(line: bytes, count: int) -> NDArray[np.float64]:
    """The first `count` numbers after the equals sign; none at all if one of them is no number."""
    try:
        return np.array([float(word) for word in line.partition(b"=")[2].split()[:count]])
    except ValueError:
        return np.array([])


def _positive_numbers(line: bytes, count: int) -> NDArray[np.float64]:
    numbers = _numbers(line, count)
    if len(numbers) != count or not np.all(np.isfinite(numbers) & (numbers > 0.0)):
        raise LightError(f"{_shown(line)}: expected {count} finite number(s) above 0; correct the header")
    return numbers


def _shown(line: bytes) -> str:
    """A line of the file made safe for one line of a message: escaped, quoted, at most 60 bytes."""
    return repr(line[:60])[1:] + ("..." if len(line) > 60 else "")
