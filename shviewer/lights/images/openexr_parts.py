"""One part of a multi-part OpenEXR file as a file of its own.

The library decodes every part of a file, whichever is wanted: all passes of a rendering, and deep parts, whose size no
header tells. Here it is handed the bytes of the wanted part only. Nothing is decoded: chunks are copied as they are.

Source: openexr.com, "OpenEXR File Layout": the headers, a table of offsets per part, the chunks.
"""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from shviewer.lights.images.openexr_attributes import LONG_NAMES, TILED, Attribute, broken, count_in, read_attributes


def part_alone(data: bytes, index: int) -> bytes:
    """A single-part file with the header and the chunks of part `index`, from 0, of the multi-part file `data`.

    The part must be flat. Raises LightError if the bytes contradict themselves.
    """
    headers = read_attributes(data)
    if index >= len(headers):
        raise broken(f"part {index + 1} has no header")
    counts = [header.count(b"chunkCount") for header in headers]
    start, end, attributes = headers[index]
    tiled = attributes.get(b"type") == Attribute(b"string", b"tiledimage")

    table = headers[-1].end + 1 + 8 * sum(counts[:index])
    pieces = _chunks(data, table, counts[index], index, tiled)
    flags = (count_in(data[4:8]) & LONG_NAMES) | (TILED if tiled else 0)
    head = data[:4] + struct.pack("<I", 2 | flags) + data[start:end]
    sizes = np.array([len(piece) for piece in pieces], np.int64)
    starts = len(head) + 8 * len(pieces) + np.cumsum(sizes) - sizes
    return b"".join([head, starts.astype("<u8").tobytes(), *pieces])


def _chunks(data: bytes, at: int, count: int, index: int, tiled: bool) -> list[bytes]:
    """The chunks of a part, without their part number, as its table at `at` lists them."""
    if at + 8 * count > len(data):
        raise broken("the table of chunks ends behind the end of the file")
    starts = np.frombuffer(data, "<u8", count, at)
    fields = 16 if tiled else 4  # four coordinates of a tile, or the first y of the scanlines
    last = len(data) - (4 + fields + 4)
    if np.any(starts > max(0, last)) or last < 0:
        raise broken("a chunk begins behind the end of the file")
    begins = starts.astype(np.int64)
    if np.any(_integers_at(data, begins) != index):
        raise broken(f"chunks of part {index + 1} are missing")
    sizes = _integers_at(data, begins + 4 + fields)
    ends = begins + 4 + fields + 4 + sizes
    if np.any(sizes < 0) or np.any(ends > len(data)) or sizes.sum() > len(data):
        raise broken("chunks end behind the end of the file or overlap")
    return [data[begin + 4 : end] for begin, end in zip(begins.tolist(), ends.tolist(), strict=True)]


def _integers_at(data: bytes, places: NDArray[np.int64]) -> NDArray[np.int64]:
    """The 32-bit integers that begin at byte `places` (k,)."""
    fields: NDArray[np.uint8] = np.frombuffer(data, np.uint8)[places[:, None] + np.arange(4)]
    integers: NDArray[np.int32] = fields.view("<i4")[:, 0]
    return integers.astype(np.int64)
