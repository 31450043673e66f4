"""Images as programs write them, and what is made of them: rows of a table in the guide, each of which is a test.

Every file is made here, small, as the program writes it: the programs themselves are not needed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from lights.images.hdr_files import exr_file
from lights.images.ldr_files import (
    LINEAR_CURVE,
    P3_COLUMNS,
    SRGB_COLUMNS,
    gain_map_iso,
    gain_map_xmp,
    gpano,
    icc_profile,
    saved_by_pillow,
    segment,
    ultra_hdr,
    with_segments,
    xmp,
)
from lights.images.other_files import dds_file, npy_file, pfm_file, psd_file, tiff_file
from numpy.typing import NDArray

from shviewer.lights.layouts.arrangements import HORIZONTAL_CROSS, PACK, VERTICAL_CROSS, Arrangement
from shviewer.lights.layouts.cube import CubeLayout

GREY = ((128 / 255 + 0.055) / 1.055) ** 2.4
"""The linear value of the sRGB code 128."""


class Found(NamedTuple):
    program: str
    writes: str
    becomes: str
    """What is made of it, in words; the light has the mean, and its notes or its refusal say `said`."""
    name: str
    data: Callable[[], bytes]
    mean: tuple[float, float, float] | None
    """The mean of the light; None for a file that is refused."""
    said: str = ""


def found_images() -> tuple[Found, ...]:
    return (*_hdr(), *_exr(), *_jpeg(), *_profiles(), *_cubes(), *_others())


def table() -> str:
    """The rows as the guide has them."""
    rows = [f"| {row.program} | {row.writes} | {row.becomes} |" for row in found_images()]
    return "\n".join(["", "| program | writes | is read as |", "|---|---|---|", *rows, "", ""])


def _hdr() -> tuple[Found, ...]:
    base = (1.0, 0.5, 0.25)

    def file(header: bytes) -> Callable[[], bytes]:
        return lambda: header + b"-Y 8 +X 16\n" + bytes((128, 64, 32, 129)) * 128

    def set_to(line: bytes) -> Callable[[], bytes]:
        return file(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + line + b"\n\n")

    own = b"PRIMARIES= 0.6400 0.3300 0.2900 0.6000 0.1500 0.0600 0.3333 0.3333"
    return (
        Found("FreeImage up to 3.17", "`.hdr` with `EXPOSURE=0`", "the line is ignored, with a note",
              "a.hdr", set_to(b"EXPOSURE=0"), base, "'EXPOSURE=0' ignored"),
        Found("programs in a language with decimal commas", "`.hdr` with `EXPOSURE=2,000000`", "a decimal comma",
              "a.hdr", set_to(b"EXPOSURE=2,000000"), (0.5, 0.25, 0.125), "decimal comma"),
        Found("Radiance and its libraries", "`.hdr` with Radiance's own `PRIMARIES`",
              "the light of a file that states none: taken for Rec. 709", "a.hdr", set_to(own), base, "Radiance's own"),
        Found("Photoshop", "`.hdr` with the magic twice and `PRIMARIES=0 0 0 0 0 0 0 0`",
              "the primaries are ignored, with a note", "a.hdr",
              file(b"#?RADIANCE\n# Made with Adobe Photoshop\nGAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\n"
                   b"FORMAT=32-bit_rle_rgbe\n#?RADIANCE\n\n"), base, "as Photoshop writes them"),
        Found("ImageMagick", "`.hdr` of a picture for a display, with `GAMMA=0.454545`",
              "linear, as the format has it; the note names `-colorspace RGB`", "a.hdr",
              set_to(b"GAMMA=0.454545"), base, "-colorspace RGB"),
        Found("writers of their own", "`.hdr` without the empty line, with two, with CR, with a byte order mark",
              "as if it had one", "a.hdr", file(b"\xef\xbb\xbf#?RGBE\r\nFORMAT=32-bit_rle_rgbe\r\n"), base),
    )  # fmt: skip


def _exr() -> tuple[Found, ...]:
    plane = np.full((8, 16), 0.5, np.float32)

    def named(*names: str, **header: object) -> Callable[[], bytes]:
        return lambda: exr_file({name: plane * 2.0**-i for i, name in enumerate(names)}, **header)

    def latin1() -> bytes:
        data: bytes = named("R", "G", "B", owner="QQ M")()
        return data.replace(b"QQ M", b"\xa9 M\xfc")

    colours, grey = (0.5, 0.25, 0.125), (0.5, 0.5, 0.5)
    return (
        Found("renderers and compositors", "`.exr` with channels `r g b`, `red green blue`, `[red]`, `rgba.red`",
              "red, green and blue, with a note", "a.exr", named("red", "green", "blue"), colours, "taken for red"),
        Found("programs with a layer of no name", "`.exr` with channels `.R .G .B`", "red, green and blue",
              "a.exr", named(".R", ".G", ".B"), colours),
        Found("masks and single passes", "`.exr` with one channel: `L`, `gray`, `luminance`, `R`",
              "grey, with a note", "a.exr", named("L"), grey, "channel L taken for grey"),
        Found("geometry passes", "`.exr` with `X Y Z`, `Z` or `u v` alone", "refused: no light",
              "a.exr", named("X", "Y", "Z"), None, "no R, G and B among its channels"),
        Found("older Windows programs", "`.exr` with strings in Latin-1", "its texels; layers can be named as they are shown",
              "a.exr", latin1, colours),
    )  # fmt: skip


def _jpeg() -> tuple[Found, ...]:
    grey = saved_by_pillow(np.full((64, 128, 3), 128, np.uint8), "JPEG")
    gain_map = saved_by_pillow(np.full((32, 64), 255, np.uint8), "JPEG")
    part = with_segments(grey, xmp(gpano((256, 128), (128, 64), 64, 32)))
    numbers = {"GainMapMax": 3, "HDRCapacityMax": 3, "OffsetSDR": 0, "OffsetHDR": 0}
    by_xmp = ultra_hdr(grey, gain_map, gain_map_xmp(**numbers))
    by_iso = ultra_hdr(grey, gain_map, gain_map_iso([(0, 3, 1, 0, 0)], 3))
    apple = ultra_hdr(grey, gain_map, xmp(b"<x xmlns:HDRGainMap='http://ns.apple.com/HDRGainMap/1.0/'/>"))
    lit = np.sqrt(0.5) / 2 * GREY  # half the azimuths, between 45 and 135 degrees from the pole
    return (
        Found("phones", "`.jpg` with a video or a preview behind the picture", "the picture alone",
              "a.jpg", lambda: grey + b"\xff\xda\0\0\0\x18ftypmp42", (GREY,) * 3),
        Found("panorama apps", "`.jpg` without its end marker", "the picture, as all of its scanlines are there",
              "a.jpg", lambda: grey[:-2], (GREY,) * 3),
        Found("a broken download", "`.jpg` cut short, with an end marker or without", "refused",
              "a.jpg", lambda: grey[:-40] + b"\xff\xd9", None, "cut short"),
        Found("photo sphere apps, exiftool", "`.jpg` or `.png` with a part of a sphere in its XMP (GPano)",
              "placed where it says, the rest black", "a.jpg", lambda: part, (lit,) * 3, "the rest is black"),
        Found("Android, Lightroom, gainmap-js", "Ultra HDR `.jpg`: a gain map described in XMP",
              "HDR, at the map's full headroom", "a.jpg", lambda: by_xmp, (8 * GREY,) * 3, "8 times white"),
        Found("libultrahdr 1.2 and later", "Ultra HDR `.jpg`: a gain map described by ISO 21496-1",
              "HDR, at the map's full headroom", "a.jpg", lambda: by_iso, (8 * GREY,) * 3, "8 times white"),
        Found("iPhones", "`.jpg` with Apple's own gain map", "its SDR half; the note says that the map is not read",
              "a.jpg", lambda: apple, (GREY,) * 3, "its gain map is not read (Apple's own kind)"),
        Found("stereo cameras, previews", "`.jpg` with several pictures (MPF)", "the first", "a.jpg",
              lambda: with_segments(grey, segment(0xE2, b"MPF\0" + bytes(80))) + gain_map, (GREY,) * 3),
    )  # fmt: skip


def _cubes() -> tuple[Found, ...]:
    """The light 0.5 + 0.4 d + 0.3 d.z**2 of each axis, so that its mean tells the layout."""

    def image(arrangement: Arrangement, checks: bool = False, border: int = 0) -> NDArray[np.float32]:
        layout = CubeLayout(arrangement, 32)
        shape = (32 * arrangement.rows, 32 * arrangement.columns)
        rows, columns = np.indices(shape)
        places = layout.centres(rows.ravel(), columns.ravel()).reshape(*shape, 3)
        light = 0.5 + 0.4 * places + 0.3 * places[..., 2:] ** 2
        empty = ((rows // 4 + columns // 4) % 2)[..., None] if checks else 0.0
        light = np.where(layout.solid_angles()[..., None] > 0, light, empty)
        return np.pad(light, ((border, border), (border, border), (0, 0))).astype(np.float32)

    def file(*arguments: Any) -> Callable[[], bytes]:
        return lambda: exr_file({"RGB": image(*arguments)})

    mean = (0.6, 0.6, 0.6)
    fit = "faces fit together"
    return (
        Found("HDRShop, ffmpeg, converters in the web", "a cross of 4:3 or 3:4, its empty cells of one colour", "a cube",
              "a.exr", file(HORIZONTAL_CROSS), mean, "is taken as a cube, horizontal cross"),
        Found("converters in the web", "a cross with a checkerboard or text in its empty cells",
              "a cube, if its faces fit together", "a.exr", file(HORIZONTAL_CROSS, True), mean, fit),
        Found("converters in the web", "a cross within a border", "a cube, the border cut off", "a.exr",
              file(VERTICAL_CROSS, False, 5), mean, "within a border"),
        Found("ffmpeg, `v360=e:c3x2`", "a pack of 3 x 2 faces", "a cube, if its faces fit together", "a.exr",
              file(PACK), mean, fit),
    )  # fmt: skip


def _profiles() -> tuple[Found, ...]:
    codes = np.full((8, 16, 3), 128, np.uint8)
    red = codes * np.uint8((1, 0, 0))
    linear = icc_profile("GIMP built-in Linear sRGB", SRGB_COLUMNS, (LINEAR_CURVE,))
    wide = icc_profile("Display P3", P3_COLUMNS)
    tables = icc_profile("Printer", (), (), more=((b"A2B0", b"mft2" + bytes(60)),))
    # Red of Display P3 in Rec. 709, from the chromaticities of both.
    p3_red = (1.2249 * GREY, -0.0420 * GREY, -0.0196 * GREY)

    def png(pixels: np.ndarray, profile: bytes) -> Callable[[], bytes]:
        return lambda: saved_by_pillow(pixels, icc_profile=profile)

    return (
        Found("GIMP", "`.png` or `.jpg` with the profile \"GIMP built-in Linear sRGB\"", "linear, whatever its name says",
              "a.png", png(codes, linear), (128 / 255,) * 3, "is honoured: linear"),
        Found("phones, macOS", "`.png` or `.jpg` with the profile \"Display P3\"", "converted to Rec. 709",
              "a.png", png(red, wide), p3_red, "converted to Rec. 709"),
        Found("printer drivers, scanners", "`.png` or `.jpg` with a profile of tables",
              "taken for sRGB, and said to be", "a.png", png(codes, tables), (GREY,) * 3, "is ignored"),
    )  # fmt: skip


def _others() -> tuple[Found, ...]:
    column = np.full((8, 16, 3), 0.5, np.float32)
    column[:4] = (1, 0.5, 0.25)  # what is above
    mean = (0.75, 0.5, 0.375)
    codes = np.full((8, 16, 3), 128 * 257, np.uint16)
    cube = np.tile(np.array([1, 0.5, 0.25, 1], np.float16), (6, 4, 4, 1))
    return (
        Found(
            "HDRShop and Debevec's light probes",
            "`.pfm`, the lowest row first",
            "that, with a note; angular with a disc",
            "a.pfm",
            lambda: pfm_file(column),
            mean,
            "the lowest row first",
        ),
        Found(
            "ffmpeg, libvips",
            "`.pfm`, the top row first",
            "upside down, which a note warns of",
            "a.pfm",
            lambda: pfm_file(column[::-1]),
            mean,
            "upside down if ffmpeg or libvips wrote it",
        ),
        Found(
            "programs that use Direct3D",
            "`.dds` of halfs or floats, a cube",
            "the cube of Direct3D, with the front ahead",
            "a.dds",
            lambda: dds_file(cube, dxgi=10),
            (1, 0.5, 0.25),
            "alpha dropped",
        ),
        Found(
            "NumPy", "`.npy` of floats (height, width, 3)", "a lat-long image", "a.npy", lambda: npy_file(column), mean
        ),
        Found(
            "NumPy",
            "`.npy` of integers (height, width, 3)",
            "refused: codes are no radiance",
            "a.npy",
            lambda: npy_file(codes),
            None,
            "linearise and convert it",
        ),
        Found(
            "ImageMagick, ffmpeg, libvips",
            "`.tif` of 8 or 16 bit",
            "sRGB codes, with a note",
            "a.tif",
            lambda: tiff_file(codes),
            (GREY,) * 3,
            "16 bit sRGB, linearised",
        ),
        Found(
            "oiiotool, libvips",
            "`.tif` of halfs, floats or doubles",
            "linear light",
            "a.tif",
            lambda: tiff_file(column),
            mean,
        ),
        Found("Photoshop", "`.psd` of 32 bit", "linear light", "a.psd", lambda: psd_file(column), mean),
        Found(
            "ImageMagick",
            "`.tif` of CMYK or Lab",
            "refused: export it as RGB",
            "a.tif",
            lambda: tiff_file(codes, photometric=8),
            None,
            "neither RGB nor grey",
        ),
    )
