"""The scanlines of a Radiance picture: from packed bytes to planes of mantissas and exponents.

A scanline comes in one of two packings, and a file may mix them:
    new  2, 2, length (big endian, 15 bits), then each of the four channels by itself in packets: a byte n <= 128
         and n literal bytes, or a byte n > 128 and one byte that stands n - 128 times; 8 to 32767 texels only
    old  texels one after the other, where (1, 1, 1, n) repeats the one before n times; k such markers in a row are
         the digits of one count, base 256, lowest first. Without a marker it is what others call a flat file.

The new packing is the PackBits of TIFF with other numbers in the first bytes of its packets. So those bytes are
translated, and Pillow does the unpacking. To find them, packets must be walked one by one. All scanlines are walked at
once: one numpy step takes the next packet of each. The beginning of a scanline is known only when the one before has been
walked; so everything that looks like a beginning is walked, and beginnings that no walk confirms are dropped. Data that
cannot be read so (other packings, damage, a handful of scanlines) are read scanline by scanline.

Source
    [R] Radiance File Formats, radsite.lbl.gov/radiance/refer/filefmts.pdf, "Picture File Format (.hdr suffix)"
    [T] TIFF 6.0, section 9, PackBits
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError

Packing = Literal["flat", "old", "new"]

_NEW_PACKING_LENGTHS = range(8, 32768)
_NEW_PACKING_HEADER = 4  # bytes
_LONGEST_PACKET = 128  # values
_LONGEST_MARKER_CHAIN = 4
_TEXELS_OF_A_BLOCK = 2**16  # its planes and what they become fit the second-level cache
_SEARCHED_AT_ONCE = 2**20  # bytes
_FEWEST_WALKED_AT_ONCE = 64  # scanlines; with fewer a step in numpy costs more than Python's
_BEGINNINGS_PER_SCANLINE = 4  # true and false together; with more, walking them all costs more than Python's loop

_CODES = np.arange(256)
_VALUES = np.where(_CODES > 128, _CODES - 128, _CODES).astype(np.int64)  # that a packet stands for
_VALUES[0] = 2**20  # more than any scanline takes: a packet without values ends its walk as damaged
_BYTES = np.where(_CODES > 128, 2, 1 + _CODES)  # of a packet
_NO_PACKET = 128  # PackBits skips it [T]
_PACKBITS = np.where(_CODES > 129, 257 + 128 - _CODES, np.where(_CODES == 129, 0, _CODES - 1)).astype(np.uint8)
_PACKBITS_OF = _PACKBITS.tobytes()


def check_enough_bytes(data: bytes, position: int, scanlines: int, length: int) -> None:
    """LightError if the bytes from `position` on are too few for the scanlines; asked before memory of their size is taken."""
    shortest = scanlines * (4 if length == 1 else 8)  # bytes: one texel, and a marker that repeats it
    if len(data) - position < shortest:
        raise LightError(
            f"{len(data) - position} bytes of texels; {scanlines} scanlines take at least {shortest}:"
            " the file is cut short, fetch it again"
        )


def read_scanlines(
    data: bytes, position: int, scanlines: int, length: int
) -> Iterator[tuple[Packing, NDArray[np.uint8]]]:
    """Blocks of scanlines, from first to last: the packing, and red, green, blue and exponents (rows, 4, length).

    data: the whole file, its texels from `position` on; scanlines of `length` texels each.
    Raises LightError with the number of the scanline that is damaged or cut short, once the blocks before it are out.
    """
    row = 0
    newly_packed = length in _NEW_PACKING_LENGTHS and data.startswith(_new_packing_header(length), position)
    if newly_packed and scanlines >= _FEWEST_WALKED_AT_ONCE:
        packbits, edges = _walk_scanlines(data, position, scanlines, length)
        rows = max(1, _TEXELS_OF_A_BLOCK // length)
        while row < len(edges) - 1:
            last = min(row + rows, len(edges) - 1)
            planes = _unpack(packbits[edges[row] : edges[last]], length, last - row)
            if planes is None:
                break
            yield "new", planes
            row = last
        position += int(edges[row])
        del packbits
    for i in range(row, scanlines):
        try:
            packing, planes, position = _read_scanline(data, position, length)
        except IndexError:
            raise LightError(
                f"cut short in scanline {i} of {scanlines} (counted from 0): fetch the file again"
            ) from None
        except LightError as error:
            raise LightError(f"damaged scanline {i} (counted from 0): {error}; fetch the file again") from None
        yield packing, planes


# ------------------------------------------------------------------------------------------- new packing, all at once


def _walk_scanlines(
    data: bytes, position: int, scanlines: int, length: int
) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """The scanlines in the new packing that follow `position`, up to the first that is not whole, as PackBits.

    Returns their bytes and the (m + 1,) offsets in them where m scanlines begin and the last one ends.
    """
    longest = scanlines * (_NEW_PACKING_HEADER + 8 * length)  # bytes: a packet for every value
    stream = np.frombuffer(data, np.uint8)[position : position + longest]
    most = _BEGINNINGS_PER_SCANLINE * scanlines
    found = _find_beginnings(stream, length, most + 1)
    if len(found) > most:
        return stream, np.zeros(1, np.int64)
    packbits, ends = _walk(stream, found, length)

    end_of = dict(zip(found.tolist(), ends.tolist(), strict=True))
    edges = [0]
    while len(edges) <= scanlines and (end := end_of.get(edges[-1], -1)) >= 0:
        edges.append(end)
    if len(edges) - 1 < len(found):  # walks from false beginnings have left translated bytes behind
        packbits, _ = _walk(stream, np.array(edges[:-1], np.int64), length)
    return packbits, np.array(edges)


def _new_packing_header(length: int) -> bytes:
    """The bytes with which every scanline in the new packing begins."""
    return bytes((2, 2, length >> 8, length & 255))


def _find_beginnings(stream: NDArray[np.uint8], length: int, most: int) -> NDArray[np.int64]:
    """Up to `most` places that look like the beginning of a scanline. Block by block this is faster than bytes.find."""
    header = _new_packing_header(length)
    found, count = [], 0
    for start in range(0, len(stream), _SEARCHED_AT_ONCE):
        places = start + np.flatnonzero(stream[start : start + _SEARCHED_AT_ONCE] == header[0])
        places = places[places <= len(stream) - len(header)]
        for i in range(1, len(header)):
            places = places[stream[places + i] == header[i]]
        found.append(places[: most - count])
        count += len(found[-1])
        if count == most:
            break
    return np.concatenate(found) if found else np.array([], np.int64)


def _walk(
    stream: NDArray[np.uint8], beginnings: NDArray[np.int64], length: int
) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Walk from packet to packet in all scanlines at once.

    Returns the stream with the packets as PackBits, and where each scanline ends; -1 for one that is not whole. A
    packet across two channels is not noticed.
    """
    packbits = stream.copy()
    packbits[beginnings[:, None] + np.arange(_NEW_PACKING_HEADER)] = _NO_PACKET
    ends = np.full(len(beginnings), -1)
    walk = np.arange(len(beginnings))
    position = beginnings + _NEW_PACKING_HEADER
    left = np.full(len(beginnings), 4 * length)  # values to come
    while len(walk):
        for _ in range(max(1, int(left.min()) // _LONGEST_PACKET)):  # none can end before
            code = stream.take(position, mode="clip")
            packbits.put(position, _PACKBITS.take(code), mode="clip")
            position += _BYTES.take(code)
            left -= _VALUES.take(code)
        whole = (left == 0) & (position <= len(stream))
        ends[walk[whole]] = position[whole]
        going = left > 0
        if not going.all():
            walk, position, left = walk[going], position[going], left[going]
    return packbits, ends


def _unpack(packbits: NDArray[np.uint8] | bytearray, length: int, rows: int) -> NDArray[np.uint8] | None:
    """(rows, 4, length) from PackBits; None if a packet goes past the end of its channel, as Pillow cuts it off."""
    from PIL import Image  # here, so that lights without such a file start faster

    try:
        image = Image.frombytes("L", (length, 4 * rows), packbits, "packbits", "L")
    except ValueError:  # so there are not enough values in the end
        return None
    return np.asarray(image).reshape(rows, 4, length)


# ------------------------------------------------------------------------------------------------- one after the other


def _read_scanline(data: bytes, position: int, length: int) -> tuple[Packing, NDArray[np.uint8], int]:
    """One scanline: its packing, its values (1, 4, length), and the next position; IndexError where the data end."""
    if length in _NEW_PACKING_LENGTHS and data[position : position + 2] == b"\2\2" and data[position + 2] < 128:
        planes, position = _read_new_packing(data, position, length)
        return "new", planes, position
    texels, after = _read_old_packing(data, position, length)
    return "flat" if after == position + 4 * length else "old", texels.T[None], after


def _read_new_packing(data: bytes, position: int, length: int) -> tuple[NDArray[np.uint8], int]:
    """Values (1, 4, length) and the next position; IndexError where the data end."""
    stated = data[position + 2] << 8 | data[position + 3]
    if stated != length:
        raise LightError(f"it states {stated} texels where the header has {length}")
    first = position + _NEW_PACKING_HEADER
    packbits, place = bytearray(data[first : first + 8 * length]), 0
    for _ in range(4):
        filled = 0
        while filled < length:
            code = packbits[place]
            packbits[place] = _PACKBITS_OF[code]
            if code > 128:
                filled += code - 128
                place += 2
            elif code:
                filled += code
                place += 1 + code
            else:
                raise LightError(f"packet of length 0 at byte {first + place}")
        if filled > length:
            raise LightError(f"packet before byte {first + place} runs past the end of its channel")
    planes = _unpack(packbits[:place], length, 1)
    if planes is None:
        raise IndexError
    return planes, first + place


def _read_old_packing(data: bytes, position: int, length: int) -> tuple[NDArray[np.uint8], int]:
    """Texels (length, 4) and the next position; IndexError where the data end."""
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
