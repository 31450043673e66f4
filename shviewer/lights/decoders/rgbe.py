"""The Radiance picture format: .hdr and .pic, RGBE texels.

A texel is four bytes: three mantissas and one exponent e. A channel's value is mantissa * 2**(e - 136), and e = 0
is black. The files of the wild agree on this; Radiance itself adds half a step to the mantissa, nobody else does.

A scanline comes in one of two packings, and a file may mix them:
    new  2, 2, length (big endian, 15 bits), then each of the four channels by itself in packets: a byte n <= 128
         and n literal bytes, or a byte n > 128 and one byte that stands n - 128 times; 8 to 32767 texels only
    old  texels one after the other, where (1, 1, 1, n) repeats the one before n times; k such markers in a row are
         the digits of one count, base 256, lowest first. Without a marker it is what others call a flat file.

Source
    [R] Radiance File Formats, radsite.lbl.gov/radiance/refer/filefmts.pdf, "Picture File Format (.hdr suffix)"
"""

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.decoders.decoded import Decoded
from shviewer.lights.decoders.limits import DEFAULT_LIMITS, MAX_HEADER_BYTES, Limits

_NEW_PACKING_LENGTHS = range(8, 32768)
_LONGEST_MARKER_CHAIN = 4
_SIZE_LINE = re.compile(rb"\s*([+-])([XY])\s+([+-]?\d{1,30})\s+([+-])([XY])\s+([+-]?\d{1,30})\s*")

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
    exposure: float  # stored = radiance * exposure * colour_correction
    colour_correction: NDArray[np.float64]  # (3,)


@np.errstate(over="ignore", under="ignore")  # an exposure that overflows is refused, and so is infinite radiance
def decode_rgbe(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded:
    """The radiance in a .hdr file, and what its reader should be told.

    data: the whole file; bytes after the last scanline are allowed.
    Raises LightError, without the name of the file, if it is cut short, damaged or not RGBE.
    """
    header = _read_header(data, limits)
    rgbe = _read_scanlines(data, header)
    if header.reversed_scanlines:
        rgbe = rgbe[::-1]
    if header.reversed_texels:
        rgbe = rgbe[:, ::-1]
    if header.column_by_column:
        rgbe = rgbe.swapaxes(0, 1)

    pixels = np.empty((*rgbe.shape[:2], 3), np.float32)
    np.multiply(rgbe[..., :3], _VALUE_OF_ONE_STEP[rgbe[..., 3:]], out=pixels)
    divisor = header.exposure * header.colour_correction
    if np.any(divisor != 1.0):
        np.divide(pixels, divisor, out=pixels, casting="same_kind")

    notes = []
    if header.exposure != 1.0:
        notes.append(f"EXPOSURE {header.exposure:g} divided out")
    if np.any(header.colour_correction != 1.0):
        notes.append("COLORCORR {:g} {:g} {:g} divided out".format(*header.colour_correction))
    return Decoded(pixels, "Radiance RGBE", tuple(notes))


def _read_header(data: bytes, limits: Limits) -> _Header:
    """Everything before the first texel. A setting counts only at the start of its line: indented ones are history."""
    exposure, colour_correction = 1.0, np.ones(3)
    line, position = _next_line(data, 0)
    while line:
        key, _, value = line.partition(b"=")
        if key == b"FORMAT" and value.strip() != b"32-bit_rle_rgbe":
            raise LightError(f"{_shown(line)}: only 32-bit_rle_rgbe is read; convert it, e.g. with ra_xyze -r")
        if key == b"EXPOSURE":
            exposure *= _positive_numbers(line, 1)[0]
        if key == b"COLORCORR":
            colour_correction *= _positive_numbers(line, 3)
        line, position = _next_line(data, position)
    divisor = exposure * colour_correction
    if not np.all(np.isfinite(divisor) & (divisor > 0.0)):
        raise LightError(f"EXPOSURE and COLORCORR multiply to {divisor}; that must be finite and above 0: correct them")

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
        exposure=exposure,
        colour_correction=colour_correction,
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


def _positive_numbers(line: bytes, count: int) -> NDArray[np.float64]:
    """The first `count` numbers after the equals sign."""
    try:
        numbers = np.array([float(word) for word in line.partition(b"=")[2].split()[:count]])
    except ValueError:
        numbers = np.array([])
    if len(numbers) != count or not np.all(np.isfinite(numbers) & (numbers > 0.0)):
        raise LightError(f"{_shown(line)}: expected {count} finite number(s) above 0; correct the header")
    return numbers


def _shown(line: bytes) -> str:
    """A line of the file made safe for one line of a message: escaped, quoted, at most 60 bytes."""
    return repr(line[:60])[1:] + ("..." if len(line) > 60 else "")


def _read_scanlines(data: bytes, header: _Header) -> NDArray[np.uint8]:
    """(scanlines, length, 4) uint8 in the order of the file."""
    length, position = header.length, header.first_texel
    shortest = header.scanlines * (4 if length == 1 else 8)  # bytes: one texel, and a marker that repeats it
    if len(data) - position < shortest:
        raise LightError(
            f"{len(data) - position} bytes of texels; {header.scanlines} scanlines take at least {shortest}:"
            " the file is cut short, fetch it again"
        )
    rgbe = np.empty((header.scanlines, length, 4), np.uint8)
    for row in range(header.scanlines):
        try:
            if length in _NEW_PACKING_LENGTHS and data[position : position + 2] == b"\2\2" and data[position + 2] < 128:
                planes, position = _read_new_packing(data, position, length)
                rgbe[row] = np.frombuffer(planes, np.uint8).reshape(4, length).T
            else:
                rgbe[row], position = _read_old_packing(data, position, length)
        except IndexError:
            raise LightError(
                f"cut short in scanline {row} of {header.scanlines} (counted from 0): fetch the file again"
            ) from None
        except LightError as error:
            raise LightError(f"damaged scanline {row} (counted from 0): {error}; fetch the file again") from None
    return rgbe


def _read_new_packing(data: bytes, position: int, length: int) -> tuple[bytearray, int]:
    """Four channels of `length` bytes, one after the other, and the next position.

    IndexError where the data end: a slice that is too short leaves its channel unfilled, so the next byte is asked for.
    """
    stated = data[position + 2] << 8 | data[position + 3]
    if stated != length:
        raise LightError(f"it states {stated} texels where the header has {length}")
    planes, position = bytearray(), position + 4
    for end in range(length, 4 * length + 1, length):
        while len(planes) < end:
            code = data[position]
            if code > 128:
                planes += data[position + 1 : position + 2] * (code - 128)
                position += 2
            elif code:
                planes += data[position + 1 : position + 1 + code]
                position += 1 + code
            else:
                raise LightError(f"packet of length 0 at byte {position}")
        if len(planes) > end:
            raise LightError(f"packet before byte {position} runs past the end of its channel")
    return planes, position


def _read_old_packing(data: bytes, position: int, length: int) -> tuple[NDArray[np.uint8], int]:
    """(length, 4) texels and the next position; IndexError where the data end."""
    quads = _quads(data, position, length)
    marker = _is_marker(quads)
    if not marker.any():
        if len(quads) < length:
            raise IndexError
        return quads, position + 4 * length
    if marker[0]:
        raise LightError(f"byte {position} repeats a texel, but none comes before it")

    quads = _quads(data, position, length * (1 + _LONGEST_MARKER_CHAIN))  # every texel and all its markers
    marker = _is_marker(quads)
    index = np.arange(len(quads))
    texel = np.maximum.accumulate(np.where(marker, 0, index))  # the latest one that is no marker
    digit = index - texel - 1
    repeats = np.where(marker, quads[:, 3].astype(np.int64) << 8 * np.clip(digit, 0, _LONGEST_MARKER_CHAIN - 1), 1)
    repeats[digit >= _LONGEST_MARKER_CHAIN] = length + 1  # a count that long fits no scanline, whatever its digits
    filled = np.cumsum(repeats)
    last = int(np.searchsorted(filled, length))
    if last == len(quads):
        raise IndexError
    if filled[last] > length:
        raise LightError(f"the run at byte {position + 4 * last} goes past the end of the scanline")
    return quads[np.repeat(texel[: last + 1], repeats[: last + 1])], position + 4 * (last + 1)


def _quads(data: bytes, position: int, count: int) -> NDArray[np.uint8]:
    """Up to `count` groups of four bytes, (n, 4); fewer where the data end."""
    count = min(count, (len(data) - position) // 4)
    return np.frombuffer(data, np.uint8, 4 * max(count, 0), min(position, len(data))).reshape(-1, 4)


def _is_marker(quads: NDArray[np.uint8]) -> NDArray[np.bool_]:
    return np.asarray((quads[:, 0] == 1) & (quads[:, 1] == 1) & (quads[:, 2] == 1))
