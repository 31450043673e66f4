"""One part of a multi-part OpenEXR file as a file of its own.

The library decodes every part of a file, whichever is wanted: all passes of a rendering, and deep parts, whose size no
header tells. Here only the wanted part's bytes are handed to it. Nothing is decoded: chunks are copied as they are.

Source: openexr.com, "OpenEXR File Layout": headers of name, type, size, value; a table of offsets per part; chunks.
"""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError

_TILED, _LONG_NAMES = 0x200, 0x400  # flags of the version field
_LONGEST_NAME = 255


def part_alone(data: bytes, index: int) -> bytes:
    """A single-part file with the header and the chunks of part `index`, from 0, of the multi-part file `data`.

    The part must be flat. Raises LightError if the bytes contradict themselves.
    """
    headers: list[tuple[int, int, dict[bytes, bytes]]] = []
    at = 8
    while not headers or data[at : at + 1] != b"\0":
        start = at
        attributes, at = _header(data, start)
        headers.append((start, at, attributes))
    at += 1
    if index >= len(headers):
        raise _broken(f"part {index + 1} has no header")
    counts = [_integer(attributes.get(b"chunkCount", b"")) for _, _, attributes in headers]
    start, end, attributes = headers[index]
    tiled = attributes.get(b"type") == b"tiledimage"

    pieces = _chunks(data, at + 8 * sum(counts[:index]), counts[index], index, tiled)
    flags = (_integer(data[4:8]) & _LONG_NAMES) | (_TILED if tiled else 0)
    head = data[:4] + struct.pack("<I", 2 | flags) + data[start:end]
    sizes = np.array([len(piece) for piece in pieces], np.int64)
    table = len(head) + 8 * len(pieces) + np.cumsum(sizes) - sizes
    return b"".join([head, table.astype("<u8").tobytes(), *pieces])


def _header(data: bytes, at: int) -> tuple[dict[bytes, bytes], int]:
    """The attributes by name, and where the header ends."""
    attributes: dict[bytes, bytes] = {}
    while True:
        name, at = _text(data, at)
        if not name:
            return attributes, at
        _, at = _text(data, at)
        size = _integer(data[at : at + 4])
        if at + 4 + size > len(data):
            raise _broken("an attribute ends behind its end")
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size


def _text(data: bytes, at: int) -> tuple[bytes, int]:
    end = data.find(b"\0", at, at + _LONGEST_NAME + 1)
    if end < 0:
        raise _broken("a header does not end")
    return data[at:end], end + 1


def _integer(field: bytes) -> int:
    """A count: four bytes, not negative."""
    if len(field) != 4 or field[3] > 127:
        raise _broken("a count in a header is none")
    return int.from_bytes(field, "little")


def _chunks(data: bytes, at: int, count: int, index: int, tiled: bool) -> list[bytes]:
    """The chunks of a part without the part's number, in the order of its table, which is at `at`."""
    if at + 8 * count > len(data):
        raise _broken("the table of chunks ends behind its end")
    starts = np.frombuffer(data, "<u8", count, at)
    fields = 16 if tiled else 4  # four coordinates of a tile, or the first y of the scanlines
    last = len(data) - (4 + fields + 4)
    if np.any(starts > max(0, last)) or last < 0:
        raise _broken("a chunk begins behind its end")
    begins = starts.astype(np.int64)
    if np.any(_integers_at(data, begins) != index):
        raise _broken(f"chunks of part {index + 1} are missing")
    sizes = _integers_at(data, begins + 4 + fields)
    ends = begins + 4 + fields + 4 + sizes
    if np.any(sizes < 0) or np.any(ends > len(data)) or sizes.sum() > len(data):
        raise _broken("chunks end behind its end or overlap")
    return [data[begin + 4 : end] for begin, end in zip(begins.tolist(), ends.tolist(), strict=True)]


def _integers_at(data: bytes, places: NDArray[np.int64]) -> NDArray[np.int64]:
    """The 32-bit integers that begin at byte `places` (k,)."""
    fields: NDArray[np.uint8] = np.frombuffer(data, np.uint8)[places[:, None] + np.arange(4)]
    integers: NDArray[np.int32] = fields.view("<i4")[:, 0]
    return integers.astype(np.int64)


def _broken(reason: str) -> LightError:
    return LightError(f"damaged or cut short, of several parts: {reason}; fetch or export the file again")
