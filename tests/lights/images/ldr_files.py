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


# ------------------------------------------------------------------------------------------------ what stands in markers


def segment(marker, content):
    return bytes((0xFF, marker)) + struct.pack(">H", len(content) + 2) + content


def with_segments(jpeg, *segments):
    """The segments behind the start of the image."""
    return jpeg[:2] + b"".join(segments) + jpeg[2:]


def xmp_packet(attributes="", elements="", head=""):
    """A packet with one description. head: what stands before the root."""
    return (
        f"{head}<x:xmpmeta xmlns:x='adobe:ns:meta/'><rdf:RDF xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'>"
        "<rdf:Description xmlns:GPano='http://ns.google.com/photos/1.0/panorama/'"
        f" xmlns:hdrgm='http://ns.adobe.com/hdr-gain-map/1.0/' {attributes}>{elements}</rdf:Description></rdf:RDF></x:xmpmeta>"
    ).encode()


def xmp(packet):
    """The segment of a packet."""
    return segment(0xE1, b"http://ns.adobe.com/xap/1.0/\0" + packet)


def gpano(full, size, left, top, more=""):
    """The packet of a photo sphere: the whole sphere, width and height, and the picture's size and place in it."""
    names = (
        "FullPanoWidthPixels",
        "FullPanoHeightPixels",
        "CroppedAreaImageWidthPixels",
        "CroppedAreaImageHeightPixels",
    )
    names += ("CroppedAreaLeftPixels", "CroppedAreaTopPixels")
    numbers = zip(names, (*full, *size, left, top), strict=True)
    return xmp_packet(
        "GPano:ProjectionType='equirectangular' " + " ".join(f"GPano:{n}='{v}'" for n, v in numbers) + more
    )


ISO = b"urn:iso:std:iso:ts:21496:-1\0"


def gain_map_xmp(**settings):
    """The segment with which a map says what its values mean; a list for three channels."""
    elements = "".join(
        f"<hdrgm:{name}><rdf:Seq>{''.join(f'<rdf:li>{v}</rdf:li>' for v in value)}</rdf:Seq></hdrgm:{name}>"
        for name, value in settings.items()
        if isinstance(value, list)
    )
    attributes = " ".join(f"hdrgm:{n}='{v}'" for n, v in settings.items() if not isinstance(v, list))
    return xmp(xmp_packet("hdrgm:Version='1.0' " + attributes, elements))


def gain_map_iso(channels, headroom, flags=0x40, denominator=None, version=0):
    """The same as ISO 21496-1; channels: (minimum, maximum, gamma, base offset, alternate offset) each, in 4096ths."""
    values = [(0, False), (headroom, False)]
    for numbers in channels:
        values += zip(numbers, (True, True, False, True, True), strict=True)
    flags |= (0x80 if len(channels) == 3 else 0) | (0x08 if denominator else 0)
    payload = struct.pack(">HHB", version, 0, flags) + (struct.pack(">I", denominator) if denominator else b"")
    for value, signed in values:
        payload += struct.pack(">i" if signed else ">I", round(value * (denominator or 4096)))
        payload += b"" if denominator else struct.pack(">I", 4096)
    return segment(0xE2, ISO + payload)


def ultra_hdr(picture, gain_map, metadata, between=b""):
    """A picture followed by its map, both JPEGs; metadata: the map's segment."""
    announced = (xmp(xmp_packet("hdrgm:Version='1.0'")), segment(0xE2, ISO + bytes(4)))
    return with_segments(picture, *announced) + between + with_segments(gain_map, metadata)


# --------------------------------------------------------------------------------------------------------- ICC profiles

SRGB_COLUMNS = ((0.4360, 0.2225, 0.0139), (0.3851, 0.7169, 0.0971), (0.1431, 0.0606, 0.7141))
P3_COLUMNS = ((0.5151, 0.2412, -0.0011), (0.2920, 0.6922, 0.0419), (0.1571, 0.0666, 0.7841))
ADOBE_COLUMNS = ((0.6097, 0.3111, 0.0195), (0.2053, 0.6257, 0.0609), (0.1492, 0.0632, 0.7446))
"""XYZ of red, green and blue, adapted to D50, as profiles of these spaces state them."""


def fixed(*numbers):
    return struct.pack(f">{len(numbers)}i", *(round(number * 65536) for number in numbers))


def gamma_curve(gamma):
    return b"curv" + bytes(4) + struct.pack(">IH", 1, round(gamma * 256))


def table_curve(values):
    return b"curv" + bytes(4) + struct.pack(f">I{len(values)}H", len(values), *(round(v * 65535) for v in values))


def parametric_curve(kind, *numbers):
    return b"para" + bytes(4) + struct.pack(">HH", kind, 0) + fixed(*numbers)


LINEAR_CURVE = b"curv" + bytes(8)
SRGB_CURVE = parametric_curve(3, 2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)


def icc_profile(name, columns=SRGB_COLUMNS, curves=(SRGB_CURVE,), colours=b"RGB ", more=()):
    """A profile of version 4 with a matrix and one curve, or three; without columns, of grey."""
    text = struct.pack(">II4sII", 1, 12, b"enUS", 2 * len(name), 28) + name.encode("utf-16-be")
    tags = [(b"desc", b"mluc" + bytes(4) + text)]
    tags += [(b"wtpt", b"XYZ " + bytes(4) + fixed(0.9642, 1.0, 0.8249)), (b"cprt", b"text" + bytes(4) + b"none\0")]
    if columns:
        tags += [
            (c + b"XYZ", b"XYZ " + bytes(4) + fixed(*xyz)) for c, xyz in zip((b"r", b"g", b"b"), columns, strict=True)
        ]
        tags += [(c + b"TRC", curves[i % len(curves)]) for i, c in enumerate((b"r", b"g", b"b"))]
    elif curves:
        tags += [(b"kTRC", curves[0])]
    tags += more
    table, contents = struct.pack(">I", len(tags)), b""
    for signature, content in tags:
        table += struct.pack(">4sII", signature, 132 + 12 * len(tags) + len(contents), len(content))
        contents += content + bytes(-len(content) % 4)
    size = 132 + 12 * len(tags) + len(contents)
    head = struct.pack(">I4sI4s4s4s12s4s", size, b"lcms", 0x04300000, b"mntr", colours, b"XYZ ", bytes(12), b"acsp")
    return head.ljust(68, b"\0") + fixed(0.9642, 1.0, 0.8249) + bytes(48) + table + contents
