"""The Radiance picture format: .hdr and .pic, RGBE and XYZE texels.

A texel is four bytes: three mantissas and one exponent e. A channel's value is mantissa * 2**(e - 136), and e = 0
is black. Writers and readers agree on this; only Radiance itself adds half a step to the mantissa.

Primaries. Radiance's own are near Rec. 709 but have another white (1/3, 1/3). No reader converts a file that states no
primaries: its RGB is taken as it is, here too. A file that states Radiance's own says what a silent one means, and some
libraries write them into every file: it is the same light. Other primaries are believed, and the colours adapted to
D65. XYZE counts as such an RGB written as XYZ: it becomes RGB with Radiance's primaries, as by ra_xyze -r, or with those
of Rec. 709 if the file states other primaries. Its unit is luminance, 179 lm/W times radiance.

Headers are read as they are found: with or without the empty line, in any line ending, behind a byte order mark. A
setting without sense is ignored with a note, since the texels do not depend on it.

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
from shviewer.lights.images.chromaticities import REC709, are_same, rec709_from, xyz_from_rgb
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.rgbe_scanlines import Packing, check_enough_bytes, read_scanlines
from shviewer.limits import DEFAULT_LIMITS, Limits

MAX_HEADER_BYTES = 64 * 2**10
_SIZE_LINE = re.compile(rb"\s*([+-])([XY])\s+([+-]?\d{1,30})\s+([+-])([XY])\s+([+-]?\d{1,30})\s*")
_FIRST_ENDING = re.compile(rb"[^\r\n]*\r(?!\n)")  # a CR alone
_DUE = "one like '-Y 512 +X 1024' must follow the header"
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
        self.exposure = np.ones(1)  # stored = radiance * exposure * colour_correction
        self.colour_correction = np.ones(3)
        self.primaries: NDArray[np.float64] | None = None  # (4, 2), stated and sensible; the last ones count [X]
        self.said: list[str] = []

    def read(self, line: bytes) -> None:
        """Read one header line. A setting counts only at the start of its line: indented ones are history."""
        key, _, value = line.partition(b"=")
        match key.rstrip():
            case b"FORMAT":
                if not value.strip():
                    self.said.append(f"{_shown(line)} ignored: RGBE assumed")
                elif value.strip().lower() not in _FORMATS:
                    raise LightError(
                        f"{_shown(line)}: only 32-bit_rle_rgbe and 32-bit_rle_xyze are read; convert it, e.g. with"
                        " ra_xyze -r"
                    )
                else:
                    self.channels = _FORMATS[value.strip().lower()]
            case b"EXPOSURE":
                self.exposure = self._times(line, self.exposure, 1)
            case b"COLORCORR":
                self.colour_correction = self._times(line, self.colour_correction, 3)
            case b"PRIMARIES":
                self._read_primaries(line)
            case b"GAMMA":
                numbers = _numbers(line, 1)
                if len(numbers) != 1 or numbers[0] != 1.0:
                    why = "the texels are linear by definition"
                    if len(numbers) == 1 and abs(numbers[0] - 1 / 2.2) < 1e-3:
                        why += "; if ImageMagick wrote it, they are sRGB codes: make it anew with -colorspace RGB"
                    self.said.append(f"{_shown(line)} ignored: {why}")

    def _times(self, line: bytes, product: NDArray[np.float64], count: int) -> NDArray[np.float64]:
        """The product with the numbers of a line; without them, and with a note, if nothing can be divided by it."""
        numbers = _numbers(line, count)
        if len(numbers) == count and _can_divide(numbers):
            if _can_divide(product * numbers):
                if b"," in line:
                    self.said.append(f"{_shown(line)} read with a decimal comma")
                return product * numbers
            self.said.append(f"{_shown(line)} ignored: with the lines before it, it leaves the range of numbers")
        else:
            number = "one finite number" if count == 1 else f"{count} finite numbers"
            self.said.append(f"{_shown(line)} ignored: it is not {number} above 0")
        return product

    def _read_primaries(self, line: bytes) -> None:
        numbers = _numbers(line, 8)
        if len(numbers) != 8:
            self.said.append(f"{_shown(line)} ignored: it is not eight numbers")
        elif not np.any(numbers):
            self.said.append("PRIMARIES ignored: all are 0, as Photoshop writes them")
        else:
            try:
                rec709_from(numbers.reshape(4, 2))
            except LightError as error:
                self.said.append(f"PRIMARIES ignored: {str(error).rpartition(';')[0]}")
            else:
                own = are_same(numbers.reshape(4, 2), _RADIANCE)
                self.primaries = None if own else numbers.reshape(4, 2)
                if own:
                    self.said.append("PRIMARIES are Radiance's own: taken for Rec. 709, as in a file that states none")

    def rec709_from_stored(self) -> NDArray[np.float64] | None:
        """The matrix (3, 3) from stored values to linear Rec. 709; None for the identity."""
        divisor = self.exposure * self.colour_correction
        matrix = np.diag(1.0 / divisor)
        if self.channels == "XYZE":
            rgb = np.linalg.inv(xyz_from_rgb(_RADIANCE)) if self.primaries is None else rec709_from(_XYZ)
            matrix = rgb / _WHITE_EFFICACY @ matrix
        elif self.primaries is not None and not are_same(self.primaries, REC709):
            matrix = rec709_from(self.primaries) @ matrix
        return None if np.array_equal(matrix, np.eye(3)) else matrix

    def notes(self) -> tuple[str, ...]:
        notes = []
        if self.exposure[0] != 1.0:
            notes.append(f"EXPOSURE {self.exposure[0]:g} divided out")
        if np.any(self.colour_correction != 1.0):
            notes.append("COLORCORR {:g} {:g} {:g} divided out".format(*self.colour_correction))
        if self.channels == "XYZE":
            target = "RGB of Radiance's primaries" if self.primaries is None else "Rec. 709"
            notes.append(f"XYZE converted to {target}, 179 lm/W")
        elif self.primaries is not None and not are_same(self.primaries, REC709):
            notes.append("PRIMARIES {} converted to Rec. 709".format(" ".join(f"{x:g}" for x in self.primaries.flat)))
        return (*notes, *self.said)


# An exposure that overflows is refused, and so is infinite radiance.
@np.errstate(over="ignore", under="ignore", divide="ignore")
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
    row = highest = 0
    for packing, planes in read_scanlines(data, header.first_texel, header.scanlines, header.length):
        _convert(planes, header.rec709_from_stored, scanlines[row : row + len(planes)])
        packings.add(packing)
        highest = max(highest, int(planes[:, 3].max()))
        row += len(planes)
    largest = None if header.rec709_from_stored is not None else 255.0 * float(_VALUE_OF_ONE_STEP[highest])
    encoding = f"Radiance {header.channels}, {_in_words(packings)}"
    return Decoded(pixels, encoding, header.notes, largest=largest)


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
    ended = False  # by an empty line, after which nothing but the size is due
    while not (size := _SIZE_LINE.fullmatch(line.upper())) or size[2] == size[5]:
        if ended and line and not line.startswith(b"#") and b"=" not in line:
            raise LightError(f"size line {_shown(line)}; {_DUE}: re-export it")
        ended = ended or not line
        settings.read(line)
        line, position = _next_line(data, position)
    scanlines, length = int(size[3]), int(size[6])
    columns = size[2] == b"X"
    decoding = 12 * scanlines * length + 3 * len(data)
    limits.check_image(*((scanlines, length) if columns else (length, scanlines)), decoding)
    reversal = {b"Y": b"+", b"X": b"-"}  # +Y counts upwards, and rows are stored here from the top
    return _Header(
        first_texel=position,
        scanlines=scanlines,
        length=length,
        column_by_column=columns,
        reversed_scanlines=size[1] == reversal[size[2]],
        reversed_texels=size[4] == reversal[size[5]],
        channels=settings.channels,
        rec709_from_stored=settings.rec709_from_stored(),
        notes=settings.notes(),
    )


def _next_line(data: bytes, start: int) -> tuple[bytes, int]:
    """The header line at `start` without its LF, CR LF or (if the first line ends so) CR, and where the next one begins."""
    ending = b"\r" if _FIRST_ENDING.match(data, 0, MAX_HEADER_BYTES) else b"\n"
    end = data.find(ending, start, MAX_HEADER_BYTES)
    if end >= 0:
        return data[start:end].removesuffix(b"\r"), end + 1
    if len(data) >= MAX_HEADER_BYTES:
        raise LightError(
            f"no size line in the first {MAX_HEADER_BYTES} bytes, the longest header allowed; {_DUE}: re-export it"
        )
    raise LightError(f"the header is cut short at byte {len(data)}, before its size line; {_DUE}: fetch the file again")


def _numbers(line: bytes, count: int) -> NDArray[np.float64]:
    """The first `count` numbers after the equals sign, with a decimal comma too; none at all if one of them is no number."""
    try:
        return np.array([float(word.replace(b",", b".")) for word in line.partition(b"=")[2].split()[:count]])
    except ValueError:
        return np.array([])


def _can_divide(numbers: NDArray[np.float64]) -> bool:
    """Whether all numbers and their reciprocals are finite and above 0."""
    return bool(np.all(np.isfinite(numbers) & (numbers > 0.0) & np.isfinite(1.0 / numbers)))


def _shown(line: bytes) -> str:
    """A line of the file made safe for one line of a message: escaped, quoted, at most 60 bytes."""
    return repr(line[:60])[1:] + ("..." if len(line) > 60 else "")
