"""Makes .hdr and .exr files for the tests: a slow encoder that shares nothing with the decoder under test."""

import io
import struct
from itertools import groupby

import numpy as np
import OpenEXR

from shviewer.errors import LightError

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


def one_value_packets(scanlines, length):
    """The bytes of a black-and-white picture in the new packing, at its longest: every value a packet by itself."""
    scanline = bytes((2, 2, length // 256, length % 256)) + b"\1\x80" * 4 * length
    return b"#?RADIANCE\n\n-Y %d +X %d\n" % (scanlines, length) + scanline * scanlines


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


def raw_exr_header(channels, data_window, *, display_window=None, flags=0, compression=0, kind=2, more=None):
    """The header of an OpenEXR file, whatever the library would write.

    channels: (name, subsampling) in alphabetical order, all of one kind (1: half, 2: float). more: name -> (type, value).
    """
    listed = [name.encode() + b"\0" + struct.pack("<4i", kind, 0, step, step) for name, step in channels]
    attributes = {
        "channels": ("chlist", b"".join(listed) + b"\0"),
        "compression": ("compression", bytes((compression,))),
        "dataWindow": ("box2i", struct.pack("<4i", *data_window)),
        "displayWindow": ("box2i", struct.pack("<4i", *(display_window or data_window))),
        "lineOrder": ("lineOrder", b"\0"),
        "pixelAspectRatio": ("float", struct.pack("<f", 1)),
        "screenWindowCenter": ("v2f", bytes(8)),
        "screenWindowWidth": ("float", struct.pack("<f", 1)),
        **(more or {}),
    }
    written = [
        f"{name}\0{of}\0".encode() + struct.pack("<i", len(data)) + data for name, (of, data) in attributes.items()
    ]
    return struct.pack("<II", 20000630, 2 | flags) + b"".join(written) + b"\0"


def bare_exr(data_window=(0, 0, 7, 3), display_window=None, deep=False, channels=(("B", 1), ("G", 1), ("R", 1))):
    """An OpenEXR file of a header and an empty chunk table. channels: (name, subsampling) in alphabetical order."""
    chunks = 4
    more = {
        "chunkCount": ("int", struct.pack("<i", chunks)),
        "name": ("string", b"only"),
        "type": ("string", b"deepscanline" if deep else b"scanlineimage"),
        "version": ("int", struct.pack("<i", 1)),
    }
    flags = 0x800 if deep else 0
    return raw_exr_header(channels, data_window, display_window=display_window, flags=flags, more=more) + bytes(
        8 * chunks
    )


def assert_same(pixels, expected):
    np.testing.assert_array_equal(pixels, np.asarray(expected).astype(np.float32))
    assert pixels.dtype == np.float32
    assert pixels.flags.c_contiguous
    assert pixels.flags.writeable


def halves(height=4, width=8, seed=1):
    return np.random.default_rng(seed).random((height, width, 3)).astype(np.float16)


# Two scanlines of eight texels, written out by hand from the format's description.
GOLDEN = (
    b"#?RADIANCE\n# by hand\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n"
    b"\x02\x02\x00\x08"  # new packing, eight texels
    b"\x88\x80"  # red: 128 eight times
    b"\x08\x00\x10\x20\x40\x80\xa0\xc0\xff"  # green: eight literals
    b"\x84\x40\x04\x01\x02\x03\x04"  # blue: 64 four times, four literals
    b"\x88\x81"  # exponent: 129 eight times, one step is 2**-7
    b"\x80\x40\x20\x88\x01\x01\x01\x03"  # old packing: exponent 136, one step is 1; three more of it
    b"\x80\x80\x80\x00"  # exponent 0 is black, whatever the mantissas
    b"\xff\x00\x01\x80\x01\x01\x01\x02"  # exponent 128, one step is 2**-8; two more of it
)
GOLDEN_PIXELS = [
    [
        [1.0, 0.0, 0.5],
        [1.0, 0.125, 0.5],
        [1.0, 0.25, 0.5],
        [1.0, 0.5, 0.5],
        [1.0, 1.0, 0.0078125],
        [1.0, 1.25, 0.015625],
        [1.0, 1.5, 0.0234375],
        [1.0, 1.9921875, 0.03125],
    ],
    [*[[128.0, 64.0, 32.0]] * 4, [0.0, 0.0, 0.0], *[[0.99609375, 0.0, 0.00390625]] * 3],
]


def checked_message(error, name):
    message = str(error)
    assert message.isprintable()
    assert name in message.split(": ")[0]
    return message


def mutated(seed_bytes, rng):
    """A copy with one to eight bytes changed, a piece cut out, doubled or inserted; sizes stay small."""
    data = bytearray(seed_bytes)
    for _ in range(rng.integers(1, 9)):
        place = int(rng.integers(0, len(data)))
        match rng.integers(0, 6):
            case 0 | 1 | 2:
                data[place] = rng.choice([0, 1, 2, 127, 128, 129, 255, int(rng.integers(0, 256))])
            case 3:
                del data[place : place + int(rng.integers(1, 9))]
            case 4:
                data[place:place] = data[place : place + int(rng.integers(1, 9))]
            case 5:
                data[place:place] = rng.bytes(int(rng.integers(1, 5)))
    return bytes(data)


def outcomes(read, seed_bytes, count, name):
    """How many of `count` mutations were read and refused; anything else than these two fails."""
    rng = np.random.default_rng(0)
    accepted = 0
    for _ in range(count):
        try:
            image = read(mutated(seed_bytes, rng), name)
        except LightError as error:
            checked_message(error, name)
        else:
            accepted += 1
            assert np.isfinite(image.pixels).all()
    return accepted, count - accepted
