"""Makes .png and .jpg files for the tests, the PNGs chunk by chunk as [PNG] says, for what no encoder here would write."""

import io
import struct
import zlib

import numpy as np
from PIL import Image

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
GREY, RGB, PALETTE, GREY_ALPHA, RGBA = 0, 2, 3, 4, 6
_SAMPLES = {GREY: 1, RGB: 3, PALETTE: 1, GREY_ALPHA: 2, RGBA: 4}

_ADAM7 = ((0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4), (2, 0, 4, 2), (0, 1, 2, 2), (1, 0, 2, 1))
"""First row, first column, step of rows, step of columns of each pass."""


def chunk(kind, content):
    checksum = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)


def png_file(codes, colour_type, bits=8, extra=(), interlaced=False, after=()):
    """codes: (height, width, samples) integers; extra: (type, content) of chunks before the image, after: behind it."""
    codes = np.asarray(codes).reshape(*np.shape(codes)[:2], -1)
    assert codes.shape[2] == _SAMPLES[colour_type]
    height, width = codes.shape[:2]
    header = struct.pack(">IIBBBBB", width, height, bits, colour_type, 0, 0, interlaced)
    passes = _ADAM7 if interlaced else ((0, 0, 1, 1),)
    rows = [row for top, left, down, right in passes for row in codes[top::down, left::right] if row.size]
    texels = zlib.compress(b"".join(b"\0" + _packed(row, bits) for row in rows))
    return PNG_SIGNATURE + b"".join(
        chunk(kind, content) for kind, content in ((b"IHDR", header), *extra, (b"IDAT", texels), *after, (b"IEND", b""))
    )


def _packed(row, bits):
    if bits == 16:
        return row.astype(">u2").tobytes()
    places = np.arange(bits - 1, -1, -1)
    return np.packbits(row.reshape(-1, 1) >> places & 1).tobytes()


def saved_by_pillow(codes, kind="PNG", mode=None, **options):
    """The file Pillow makes of uint8 codes."""
    written = io.BytesIO()
    Image.fromarray(codes, mode).save(written, kind, **options)
    return written.getvalue()


def exif(orientation):
    """The EXIF block of that orientation alone."""
    block = Image.Exif()
    block[0x0112] = orientation
    return block.tobytes()
