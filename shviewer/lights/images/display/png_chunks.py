"""The container of a PNG: its chunks, their checksums, whether all texels are there, and a plain file of the rest.

Pillow does not check enough: it leaves missing texels black, decodes damaged ones, and believes the last of several
headers and the rectangles of animations.

Source
    [PNG] Portable Network Graphics, third edition, 5.3 (chunks), 8 (interlacing), 11.2.1 (the header)
"""

from __future__ import annotations

import struct
import zlib

from shviewer.errors import LightError
from shviewer.lights.images.display.codes import damaged
from shviewer.limits import Limits

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_MOST_CHUNKS = 2**18  # encoders write one for each 8 KiB or more
_PLAIN = (b"IHDR", b"iCCP", b"PLTE", b"tRNS", b"eXIf")
_XMP = b"XML:com.adobe.xmp\0"
_LONGEST_XMP = 2**20  # bytes
_AT_ONCE = 2**14  # bytes, which inflate to 16 MiB at most

_SAMPLES = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}  # of a texel, by colour type
_ADAM7 = ((0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4), (2, 0, 4, 2), (0, 1, 2, 2), (1, 0, 2, 1))
"""The first row and column and the steps of rows and columns, for each pass of an interlaced image."""


def read_chunks(data: bytes) -> tuple[dict[bytes, bytes], list[memoryview]]:
    """Type -> content of the first chunk of that type, of text only XMP, and the pieces of the image.

    LightError if a checksum is wrong or the end is missing.
    """
    if not data.startswith(_SIGNATURE):
        raise damaged("its signature is not that of a PNG")
    chunks: dict[bytes, bytes] = {}
    compressed = []
    position, view = len(_SIGNATURE), memoryview(data)
    for _ in range(_MOST_CHUNKS):
        if len(data) - position < 12:
            raise damaged(f"it ends at byte {len(data)} without an IEND chunk")
        length, kind = struct.unpack_from(">I4s", data, position)
        end = position + 8 + length
        if end + 4 > len(data):
            raise damaged(f"the chunk at byte {position} goes past the end of the file")
        if zlib.crc32(view[position + 4 : end]) != struct.unpack_from(">I", data, end)[0]:
            raise damaged(f"the chunk at byte {position} does not match its checksum")
        if kind != b"IHDR" and b"IHDR" not in chunks:
            raise damaged("it does not begin with an IHDR chunk")
        if kind == b"IDAT":
            compressed.append(view[position + 8 : end])
        elif kind != b"iTXt" or data.startswith(_XMP, position + 8):
            chunks.setdefault(kind, data[position + 8 : end])
        if kind == b"IEND":
            return chunks, compressed
        position = end + 4
    raise LightError(f"more than {_MOST_CHUNKS} chunks; no picture needs as many: export it again")


def check_texels(header: bytes, compressed: list[memoryview], limits: Limits) -> None:
    """LightError if the image is too large, or its pieces inflate to too few bytes: Pillow would leave the rest black."""
    if len(header) != 13 or header[9] not in _SAMPLES:
        raise damaged("its IHDR chunk is not that of an image")
    width, height, bits, colour_type, _, _, interlaced = struct.unpack(">IIBBBBB", header)
    limits.check_image(width, height, 28 * width * height + 4 * sum(map(len, compressed)))  # 16 bit RGBA: 28
    passes = _ADAM7 if interlaced else ((0, 0, 1, 1),)
    sizes = [(-(-(height - top) // down), -(-(width - left) // right)) for top, left, down, right in passes]
    missing = sum(
        rows * (1 + -(-columns * bits * _SAMPLES[colour_type] // 8)) for rows, columns in sizes if columns > 0
    )
    inflater = zlib.decompressobj()
    try:
        for piece in compressed:
            for start in range(0, len(piece), _AT_ONCE):
                if missing > 0 and not inflater.eof:
                    missing -= len(inflater.decompress(piece[start : start + _AT_ONCE]))
    except zlib.error as error:
        raise damaged(str(error)) from None
    if missing > 0:
        raise damaged(f"the last {missing} bytes of its texels are missing")


def xmp_in(chunks: dict[bytes, bytes]) -> bytes:
    """The XMP packet of a PNG [PNG, 11.3.3.4]; empty if there is none that can be read."""
    content = chunks.get(b"iTXt", b"")[len(_XMP) :]  # whether compressed, how, language, translated keyword, text
    text = content[2:].split(b"\0", 2)[-1]
    if content[:1] != b"\1":
        return text[:_LONGEST_XMP]
    try:
        return zlib.decompressobj().decompress(text, _LONGEST_XMP)
    except zlib.error:
        return b""


def plain_png(chunks: dict[bytes, bytes], compressed: list[memoryview]) -> bytes:
    """A PNG with only the image and the chunks that its colours and its orientation depend on, each once."""
    parts = [_chunk(kind, chunks[kind]) for kind in _PLAIN if kind in chunks]
    return b"".join((_SIGNATURE, *parts, _chunk(b"IDAT", b"".join(compressed)), _chunk(b"IEND", b"")))


def _chunk(kind: bytes, content: bytes) -> bytes:
    return b"".join(
        (struct.pack(">I", len(content)), kind, content, struct.pack(">I", zlib.crc32(content, zlib.crc32(kind))))
    )
