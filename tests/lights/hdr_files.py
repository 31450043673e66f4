"""Makes .hdr and .exr files for the tests: a slow encoder that shares nothing with the decoder under test."""

import io
import struct
from itertools import groupby

import numpy as np
import OpenEXR

ORIENTATIONS = ("-Y +X", "-Y -X", "+Y +X", "+Y -X", "+X -Y", "+X +Y", "-X -Y", "-X +Y")
PACKINGS = ("flat", "old", "new")
FORMAT = b"FORMAT=32-bit_rle_rgbe"


def random_texels(height, width, seed=0):
    """(height, width, 4) uint8 RGBE as an encoder writes it: runs, black texels, brightest channel at 128 or more."""
    rng = np.random.default_rng(seed)
    texels = rng.integers(0, 256, (height, width, 4), np.uint8)
    np.put_along_axis(
        texels, rng.integers(0, 3, (height, width, 1)), rng.integers(128, 256, (height, width, 1)), axis=2
    )
    texels[..., 3] = rng.integers(100, 150, (height, width))
    texels[rng.random((height, width)) < 0.1] = 0
    for row in texels:
        start = rng.integers(0, width)
        row[start : start + rng.integers(1, width + 1)] = row[start]
    return texels


def radiance_of(texels):
    """(..., 4) RGBE -> (..., 3) float64, the definition."""
    exponent = texels[..., 3:].astype(int)
    return np.where(exponent == 0, 0.0, texels[..., :3] * 2.0 ** (exponent - 136.0))


def hdr_file(texels, packing="new", orientation="-Y +X", settings=(FORMAT,), magic=b"#?RADIANCE", newline=b"\n"):
    """The bytes of a picture whose texels[0, 0] is at the top left."""
    height, width = texels.shape[:2]
    places = {
        "-Y": [(y, None) for y in range(height)],
        "+Y": [(y, None) for y in reversed(range(height))],
        "+X": [(None, x) for x in range(width)],
        "-X": [(None, x) for x in reversed(range(width))],
    }
    slow, fast = (places[axis] for axis in orientation.split())
    scanlines = []
    for y, x in slow:
        scanlines.append([tuple(texels[y if v is None else v, x if u is None else u].tolist()) for v, u in fast])
    header = newline.join([magic, *settings, b""]) + newline
    slow_name, fast_name = orientation.encode().split()
    size = b"%s %d %s %d" % (slow_name, len(slow), fast_name, len(fast)) + newline
    return header + size + b"".join(pack(scanline, packing) for scanline in scanlines)


def pack(scanline, packing):
    """The bytes of one scanline, a list of (r, g, b, e)."""
    if packing == "flat":
        return b"".join(map(bytes, scanline))
    if packing == "old":
        packed = b""
        for texel, run in groupby(scanline):
            repeats = len(list(run)) - 1
            packed += bytes(texel)
            while repeats:
                packed += bytes((1, 1, 1, repeats % 256))
                repeats //= 256
        return packed
    packed = bytes((2, 2, len(scanline) // 256, len(scanline) % 256))
    for channel in zip(*scanline, strict=True):
        for value, run in groupby(channel):
            length = len(list(run))
            while length > 2:
                packed += bytes((128 + min(length, 127), value))
                length -= min(length, 127)
            packed += bytes((length, *[value] * length)) if length else b""
    return packed


def exr_file(channels, **header):
    """The bytes of an OpenEXR file with one part; channels: name -> array."""
    return exr_parts(OpenEXR.Part(_exr_header(header), channels, "only"))


def exr_parts(*parts):
    written = io.BytesIO()
    OpenEXR.File(list(parts)).write(written)
    return written.getvalue()


def exr_part(name, channels, **header):
    return OpenEXR.Part(_exr_header(header), channels, name)


def _exr_header(settings):
    return {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION, **settings}


def window(left, top, right, bottom):
    return (np.array([left, top], np.int32), np.array([right, bottom], np.int32))


def bare_exr(data_window=(0, 0, 7, 3), display_window=None, deep=False, channels=(("B", 1), ("G", 1), ("R", 1))):
    """An OpenEXR file of a header and an empty chunk table, for headers that the library would not write.

    channels: (name, subsampling) in alphabetical order.
    """

    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value

    entries = [name.encode() + b"\0" + struct.pack("<iB3xii", 2, 0, step, step) for name, step in channels]
    chunks = 4
    return (
        struct.pack("<II", 20000630, 2 | (0x800 if deep else 0))
        + attribute(b"channels", b"chlist", b"".join(entries) + b"\0")
        + attribute(b"chunkCount", b"int", struct.pack("<i", chunks))
        + attribute(b"compression", b"compression", b"\0")
        + attribute(b"dataWindow", b"box2i", struct.pack("<4i", *data_window))
        + attribute(b"displayWindow", b"box2i", struct.pack("<4i", *(display_window or data_window)))
        + attribute(b"lineOrder", b"lineOrder", b"\0")
        + attribute(b"name", b"string", b"only")
        + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1.0))
        + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0.0, 0.0))
        + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1.0))
        + attribute(b"type", b"string", b"deepscanline" if deep else b"scanlineimage")
        + attribute(b"version", b"int", struct.pack("<i", 1))
        + b"\0"
        + bytes(8 * chunks)
    )
