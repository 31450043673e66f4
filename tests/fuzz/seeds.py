"""The sound files that are mutated: every format, packing, codec and layout, made in memory and small.

Also three files after known faults of another reader of .hdr (stb_image, issues 317, 318 and 1223).
"""

from __future__ import annotations

import struct
import zlib
from functools import cache
from importlib.util import find_spec
from typing import Any

import numpy as np
import OpenEXR
from lights.images.hdr_files import exr_file, exr_part, exr_parts, hdr_file, random_texels, raw_exr_header, window
from lights.images.ldr_files import (
    GREY,
    GREY_ALPHA,
    P3_COLUMNS,
    PALETTE,
    RGB,
    RGBA,
    SRGB_CURVE,
    exif,
    gain_map_iso,
    gain_map_xmp,
    gamma_curve,
    gpano,
    icc_profile,
    png_file,
    saved_by_pillow,
    table_curve,
    ultra_hdr,
    with_segments,
    xmp,
)
from lights.images.other_files import dds_file, npy_file, pfm_file, psd_file, tiff_file
from numpy.typing import NDArray
from PIL import Image

CODECS = ("NO", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB", "HTJ2K32", "HTJ2K256", "ZSTD")

_STAMP = b'{"schema": 1, "light_argument": "green", "bands": 5, "world_from_view": [[1, 0, 0]]}'
"""The beginning of the text that a screenshot carries."""


@cache
def seeds() -> dict[str, bytes]:
    """Name -> file. The suffix is that of its kind."""
    return {**_hdr_seeds(), **_exr_seeds(), **_png_seeds(), **_jpeg_seeds(), **_other_seeds()}


def stb_seeds() -> dict[str, bytes]:
    """Name -> file that must be refused, and at once."""
    start = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"
    scanline = b"\x02\x02\x00\x08"
    return {
        # A run and a literal that go past the end of their channel, in the first and in the last one.
        "stb-317-run.hdr": start + b"-Y 1 +X 8\n" + scanline + b"\xff\x80" * 4,
        "stb-317-literal.hdr": start
        + b"-Y 1 +X 8\n"
        + scanline
        + b"\x88\x80" * 3
        + b"\x07"
        + bytes(7)
        + b"\x80"
        + bytes(128),
        # Sizes whose product with 4 or 12 bytes wraps in 32 bits: to a few bytes, to 0, to a negative number.
        "stb-318-wraps-to-little.hdr": start + b"-Y 65537 +X 65536\n" + scanline + bytes(4096),
        "stb-318-wraps-to-nothing.hdr": start + b"-Y 32768 +X 32768\n" + scanline + bytes(4096),
        "stb-318-turns-negative.hdr": start + b"-Y 2147483647 +X 2\n" + bytes(4096),
        # Packets of no texels, of which there may be any number without progress.
        "stb-1223-new.hdr": start + b"-Y 1 +X 8\n" + scanline + bytes(65536),
        "stb-1223-old.hdr": start + b"-Y 1 +X 8\n\x80\x80\x80\x80" + b"\1\1\1\0" * 16384,
    }


def _hdr_seeds() -> dict[str, bytes]:
    texels = random_texels(4, 12)
    exposed = (
        b"FORMAT=32-bit_rle_rgbe",
        b"EXPOSURE=2.5",
        b"COLORCORR=1 0.5 2",
        b"PRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .329",
    )
    xyze = (b"FORMAT=32-bit_rle_xyze",)
    return {
        "flat.hdr": hdr_file(texels, "flat"),
        "old.hdr": hdr_file(texels, "old"),
        "new.hdr": hdr_file(texels, "new"),
        "upside-down.hdr": hdr_file(texels, "new", "+Y -X"),
        "columns.hdr": hdr_file(random_texels(9, 10), "old", "-X +Y"),
        "xyze.hdr": hdr_file(texels, "new", settings=xyze),
        "exposed.hdr": hdr_file(texels, "flat", settings=exposed, magic=b"#?RGBE", newline=b"\r\n"),
        "as-found.hdr": b"\xef\xbb\xbf" + hdr_file(texels, "new", settings=(b"EXPOSURE=1,5", b"COLORCORR=0 0 0")),
        "small-letters.hdr": hdr_file(texels, "old", settings=(b"FORMAT=", b"\n")).replace(b"-Y", b"-y"),
        "carriage-returns.hdr": hdr_file(texels, "flat", newline=b"\r"),
        "one-texel.hdr": hdr_file(random_texels(1, 1), "flat"),
        "lat-long.hdr": hdr_file(random_texels(8, 16), "new"),
        "vertical-cross.hdr": hdr_file(random_texels(16, 12), "new"),
        "horizontal-cross.hdr": hdr_file(random_texels(9, 12), "old"),
        "strip.hdr": hdr_file(random_texels(3, 18), "new"),
        "vertical-strip.hdr": hdr_file(random_texels(18, 3), "flat"),
        "angular.hdr": hdr_file(random_texels(11, 11), "new"),
        "mirror-ball.hdr": hdr_file(random_texels(12, 12), "old"),
    }


def _exr_seeds() -> dict[str, bytes]:
    half, single = _picture(12, 24, np.float16), _picture(12, 24, np.float32)
    luminance = single[..., 0].copy()
    chroma = {name: OpenEXR.Channel(name, luminance, 2, 2) for name in ("BY", "RY")}
    layers = {f"{layer}.{c}": half[..., i].copy() for layer in ("diffuse", "sun") for i, c in enumerate("RGB")}
    tiles = OpenEXR.TileDescription()
    tiles.xSize = tiles.ySize = 8
    offset: dict[str, Any] = {"dataWindow": window(2, 1, 25, 12), "displayWindow": window(0, 0, 27, 13)}
    by_codec = {
        f"{codec.lower()}.exr": exr_file(
            {"RGB": single if codec == "PIZ" else half}, compression=getattr(OpenEXR, f"{codec}_COMPRESSION")
        )
        for codec in CODECS
        if hasattr(OpenEXR, f"{codec}_COMPRESSION")  # the newest need a recent library
    }
    return {
        **by_codec,
        "integers.exr": exr_file({"RGB": np.arange(96, dtype=np.uint32).reshape(4, 8, 3)}),
        "tiled.exr": exr_file({"RGB": half}, type=OpenEXR.tiledimage, tiles=tiles),
        "mip-mapped.exr": mip_mapped_exr(),
        "parts.exr": exr_parts(exr_part("light", {"RGB": half}), exr_part("depth", {"Z": luminance})),
        "layers.exr": exr_file({"RGB": half, **layers}),
        "grey.exr": exr_file({"Y": luminance}),
        "stamped.exr": exr_file({"RGB": half}, shviewer=_STAMP.decode()),
        "luminance-chroma.exr": exr_file({"Y": OpenEXR.Channel("Y", luminance, 1, 1), **chroma}),
        "chromaticities.exr": exr_file(
            {"RGB": half}, chromaticities=(0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329)
        ),
        "window.exr": exr_file({"RGB": half}, **offset),
        "cube.exr": exr_file({"RGB": _picture(24, 4, np.float16)}, envmap=OpenEXR.ENVMAP_CUBE),
        "lat-long.exr": exr_file({"RGB": half}, envmap=OpenEXR.ENVMAP_LATLONG),
        "angular.exr": exr_file({"RGB": _picture(10, 10, np.float16)}),
        "words.exr": exr_file({f"[{name}]": half[..., i].copy() for i, name in enumerate(("red", "green", "blue"))}),
        "latin-1.exr": exr_file({".R": luminance}, owner="QQ M", comments="QQ").replace(b"QQ", b"\xff\xfc"),
        "pack.exr": exr_file({"RGB": _picture(16, 24, np.float16)}),
        "framed-cross.exr": exr_file({"RGB": np.pad(_picture(16, 12, np.float16), ((1, 1), (1, 1), (0, 0)))}),
        "cross.exr": exr_file({"RGB": _picture(16, 12, np.float16)}),
    }


def _png_seeds() -> dict[str, bytes]:
    rng = np.random.default_rng(1)
    deep = rng.integers(0, 65536, (6, 12, 4))
    palette = [(b"PLTE", rng.bytes(48)), (b"tRNS", b"\0\x80")]
    frames = [(_picture(4, 8, np.float32) * 60 * k).astype(np.uint8) for k in (1, 2)]
    ramp = table_curve(np.linspace(0, 1, 9) ** 2)
    profile = icc_profile("P3", P3_COLUMNS, (gamma_curve(2.2), SRGB_CURVE, ramp))
    corners = struct.pack(">8I", 31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000)  # of Display P3
    part = gpano((24, 12), (12, 6), 6, 3)
    colour = [
        (b"gAMA", struct.pack(">I", 50000)),
        (b"cHRM", corners),
        (b"tEXt", b"Title\0light"),
    ]
    return {
        "stamped.png": png_file(
            rng.integers(0, 256, (4, 8, 3)),
            RGB,
            extra=[
                (b"iTXt", b"shviewer\0\0\0\0\0" + _STAMP),
                (b"zTXt", b"shviewer\0\0" + zlib.compress(bytes(10**6))),
            ],
        ),
        "colour.png": png_file(rng.integers(0, 256, (6, 12, 3)), RGB, extra=colour),
        "deep.png": png_file(deep[..., :3], RGB, 16, extra=[(b"sRGB", b"\0"), (b"cICP", bytes((1, 13, 0, 1)))]),
        "deep-alpha.png": png_file(deep, RGBA, 16, interlaced=True),
        "deep-grey-alpha.png": png_file(deep[..., :2], GREY_ALPHA, 16),
        "grey.png": png_file(rng.integers(0, 4, (9, 9)), GREY, 2, interlaced=True),
        "palette.png": png_file(
            rng.integers(0, 16, (12, 16)), PALETTE, 4, extra=palette, after=[(b"eXIf", exif(6)[6:])]
        ),
        "profile.png": saved_by_pillow(frames[0], icc_profile=profile),
        "sphere.png": png_file(
            rng.integers(0, 256, (6, 12, 3)), RGB, extra=[(b"iTXt", b"XML:com.adobe.xmp\0\0\0\0\0" + part)]
        ),
        "animated.png": saved_by_pillow(frames[0], save_all=True, append_images=[Image.fromarray(frames[1])]),
    }


def _jpeg_seeds() -> dict[str, bytes]:
    codes = (_picture(16, 32, np.float32) * 60).astype(np.uint8)
    gain = saved_by_pillow(codes[::2, ::2, 0].copy(), "JPEG")
    wide = saved_by_pillow(codes, "JPEG", icc_profile=icc_profile("P3", P3_COLUMNS))
    numbers = gain_map_xmp(GainMapMax=[2, 3, 4], HDRCapacityMax=4, Gamma=0.5)
    return {
        "baseline.jpg": saved_by_pillow(codes, "JPEG"),
        "progressive.jpg": saved_by_pillow(codes, "JPEG", progressive=True, exif=exif(6)),
        "trailer.jpg": saved_by_pillow(codes, "JPEG", optimize=True) + b"\xff\xda\0\0\0\x18ftypmp42",
        "sphere.jpg": with_segments(saved_by_pillow(codes, "JPEG"), xmp(gpano((64, 32), (32, 16), 16, 8))),
        "ultra-hdr-xmp.jpg": ultra_hdr(wide, gain, numbers),
        "ultra-hdr-iso.jpg": ultra_hdr(
            saved_by_pillow(codes, "JPEG"), gain, gain_map_iso([(0, 3, 1, 0.1, 0.1)] * 3, 3)
        ),
        "grey.jpg": saved_by_pillow(codes[..., 0].copy(), "JPEG", restart_marker_rows=1),
    }


def _other_seeds() -> dict[str, bytes]:
    """Those of OpenImageIO, whose bytes are written here, only where it is installed."""
    single, alpha = _picture(6, 12, np.float32), np.ones((6, 12, 1), np.float32)
    faces = np.concatenate([np.concatenate([_picture(4, 4, np.float32), np.ones((4, 4, 1), np.float32)], 2)[None]] * 6)
    ours = {
        "colour.pfm": pfm_file(single),
        "grey.pfm": pfm_file(single[..., 0], ">", "2"),
        "angular.pfm": pfm_file(_picture(10, 10, np.float32)),
        "float.dds": dds_file([np.dstack([single, alpha])], dxgi=2, caps=0),
        "half-cube.dds": dds_file(faces.astype(np.float16), dxgi=10),
        "mip-mapped-cube.dds": dds_file(faces, 116, levels=3),
        "float.npy": npy_file(single),
        "double.npy": npy_file(single.astype(np.float64)),
        "half.npy": npy_file(np.asfortranarray(single.astype(np.float16))),
    }
    if find_spec("OpenImageIO") is None:
        return ours
    codes = (single * 15000).astype(np.uint16)
    small = (codes >> 8).astype(np.uint8)
    return ours | {
        "codes.tif": tiff_file(codes),
        "float.tif": tiff_file(single),
        "turned.tif": tiff_file(small, orientation=6),
        "codes.psd": psd_file(codes),
        "float.psd": psd_file(single),
        "bytes.psd": psd_file(small),
        "codes.bmp": saved_by_pillow(small, "BMP"),
        "grey.bmp": saved_by_pillow(small[..., 0].copy(), "BMP"),
        "palette.bmp": saved_by_pillow(small[..., 0].copy() >> 7 > 0, "BMP"),
        "lossless.webp": saved_by_pillow(small, "WEBP", lossless=True),
        "lossy.webp": saved_by_pillow(small, "WEBP"),
        "alpha.webp": saved_by_pillow(np.dstack([small, small[..., :1]]), "WEBP", exif=exif(6)),
        "blocks.dds": saved_by_pillow(np.dstack([small, small[..., :1]]), "DDS", pixel_format="DXT5"),
    }


def _picture(height: int, width: int, dtype: type) -> NDArray[Any]:
    """(height, width, 3), 0 to about 4: smooth, flat and noisy places, so that every codec has something to do."""
    y, x = np.mgrid[0:height, 0:width]
    picture = np.stack([x / width, y / height, (x + y) / (width + height)], axis=2) + 0.5
    picture[: height // 3, : width // 3] = (1, 2, 4)
    picture[-1] = np.random.default_rng(height).random((width, 3))
    return picture.astype(dtype)


def mip_mapped_exr() -> bytes:
    """An uncompressed file of 8 x 4 texels in tiles of 4 x 4 with its levels, which the library's Python writes not."""
    width, height, side = 8, 4, 4
    tiles = {"tiles": ("tiledesc", struct.pack("<IIB", side, side, 1))}
    header = raw_exr_header([(c, 1) for c in "BGR"], (0, 0, width - 1, height - 1), flags=0x200, more=tiles)
    chunks = []
    for level in range(4):  # 8 x 4, 4 x 2, 2 x 1, 1 x 1
        columns, rows = max(width >> level, 1), max(height >> level, 1)
        for left in range(0, columns, side):
            across = min(side, columns - left)
            texels = np.full(3 * across * rows, level + 1, np.float32).tobytes()
            chunks.append(struct.pack("<5i", left // side, 0, level, level, len(texels)) + texels)
    first = len(header) + 8 * len(chunks)
    offsets = np.cumsum([first, *(len(chunk) for chunk in chunks[:-1])])
    return header + offsets.astype("<u8").tobytes() + b"".join(chunks)
