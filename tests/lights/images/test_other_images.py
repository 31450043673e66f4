"""Images in containers that are less usual for light: what they hold, which way up, and what is said of those that are broken.

The files are made here byte by byte, or by OpenImageIO's own writers, which are other code than its readers.
"""

from __future__ import annotations

import io
import os
import struct
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers import from_srgb, refusal
from lights.images.hdr_files import exr_file
from lights.images.ldr_files import LINEAR_CURVE, P3_COLUMNS, SRGB_COLUMNS, icc_profile, saved_by_pillow
from lights.images.other_files import dds_file, npy_file, pfm_file, psd_file, tiff_file
from PIL import Image, ImageOps

import shviewer
from shviewer.errors import LightError
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.images.radiance_files import decode_radiance_image
from shviewer.lights.reading import Reading
from shviewer.limits import Limits

IMAGE = np.random.default_rng(0).random((8, 16, 3)).astype(np.float32) * 4  # no two texels alike: any turn shows
CODES = np.random.default_rng(1).integers(0, 65536, (8, 16, 3)).astype(np.uint16)
HERE = Reading(isolated=False)
LDR = "16 bit sRGB, linearised: what was brighter than white is lost, so a sun will be too weak"
PFM = "the lowest row first, as PFM is defined: upside down if ffmpeg or libvips wrote it"


def linear(codes: np.ndarray) -> np.ndarray:
    return from_srgb(codes / np.iinfo(codes.dtype).max)


def read(path: Path, data: bytes, reading: Reading = HERE) -> EnvironmentLight:
    path.write_bytes(data)
    light = find_light(str(path), reading)
    assert isinstance(light, EnvironmentLight)
    return light


def refused(path: Path, data: bytes, reading: Reading = HERE) -> str:
    message = refusal(read, path, data, reading)
    assert message.startswith(str(path))
    return message


# ------------------------------------------------------------------------------------------------- portable float maps


@pytest.mark.parametrize(
    ("data", "image", "encoding"),
    [
        (pfm_file(IMAGE), IMAGE, "PFM, RGB, little-endian"),
        (pfm_file(IMAGE, ">", "1"), IMAGE, "PFM, RGB, big-endian"),
        (pfm_file(IMAGE[..., 0]), IMAGE[..., :1], "PFM, grey, little-endian"),
        (pfm_file(IMAGE, comment="# made by hand\n"), IMAGE, "PFM, RGB, little-endian"),
        (pfm_file(IMAGE).replace(b"\n", b"\r\n", 3), IMAGE, "PFM, RGB, little-endian"),
    ],
    ids=["little", "big", "grey", "comment", "crlf"],
)
def test_a_portable_float_map_has_its_lowest_row_first(data, image, encoding, tmp_path):
    light = read(tmp_path / "map.pfm", data)
    np.testing.assert_array_equal(light.pixels, np.broadcast_to(image, IMAGE.shape))
    assert (light.encoding, light.notes) == (encoding, (PFM,))


def test_the_scale_of_a_portable_float_map_is_applied_and_said(tmp_path):
    light = read(tmp_path / "map.pfm", pfm_file(IMAGE, scale="-2.5"))
    np.testing.assert_array_equal(light.pixels, IMAGE * np.float32(2.5))
    assert light.notes == (PFM, "multiplied by its scale, 2.5")


def test_a_light_probe_of_1998_is_an_angular_map_with_its_top_on_top(tmp_path):
    """A bright spot above the centre of the disc, half way to its edge: 90 degrees from the middle, so straight up."""
    y, x = np.mgrid[0:64, 0:64] - 31.5
    inside = np.hypot(x, y) <= 32
    probe = np.where(inside[..., None], np.float32(1) + np.zeros(3, np.float32), np.float32(0))
    probe[14:17, 31:33] = 50
    light = read(tmp_path / "grace_probe.pfm", pfm_file(probe))
    assert light.layout.name == "angular"
    assert light.landmarks()[0] @ [0, 0, 1] > 0.98


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (pfm_file(IMAGE)[:-1], "cut short: 1535 bytes of 1536"),
        (b"PF\n16 8\n0\n" + bytes(1536), "this header does not"),
        (b"PF\n16 8\n1e-+3\n" + bytes(1536), "this header does not"),
        (b"PF\n16\n", "this header does not"),
        (b"PF\n99999999 2\n-1\n", "a side must be 1 to 32768"),
        (b"PF\n30000 30000\n-1\n", "the limit is 134217728"),
        (pfm_file(np.full((8, 16, 3), np.nan, np.float32)), "384 NaN"),
        (pfm_file(IMAGE, scale="-1e39"), "384 +Inf"),
    ],
)
def test_a_broken_portable_float_map_is_one_line(data, says, tmp_path):
    assert says in refused(tmp_path / "map.pfm", data)


# ------------------------------------------------------------------------------------------------------------ arrays


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64, ">f4"])
def test_an_array_in_a_file_is_the_light_that_it_is_in_python(dtype, tmp_path):
    array = np.asfortranarray(IMAGE.astype(dtype))
    light = read(tmp_path / "image.npy", npy_file(array))
    given = shviewer.find_light(np.ascontiguousarray(array, np.float32))
    np.testing.assert_array_equal(light.coefficients(5), given.coefficients(5))
    assert light.pixels.flags.c_contiguous
    assert light.notes == ()
    assert light.layout.name == "lat-long"


def test_a_cross_in_an_array_is_lat_long_as_in_python_unless_its_layout_is_named(tmp_path):
    cross = np.zeros((16, 12, 3), np.float32)
    cross[4:8], cross[:, 4:8] = 1, 1
    assert read(tmp_path / "a.npy", npy_file(cross)).layout.name == "lat-long"
    assert read(tmp_path / "a.npy", npy_file(cross), Reading(layout="cube")).layout.name == "cube"


@pytest.mark.parametrize(
    ("array", "says"),
    [
        (np.zeros((8, 16, 3), np.uint8), "an image of type uint8; radiance is linear and floating-point"),
        (np.zeros((8, 16, 3), bool), "an image of type bool"),
        (np.zeros((8, 16, 4), np.float32), "an array of shape (8, 16, 4); an image is (height, width, 3)"),
        (np.zeros((2, 4, 3)), "float64"),
        (np.full((8, 16, 3), np.nan), "384 NaN"),
        (np.zeros((8, 16, 3), complex), "an image of type complex128"),
        (np.float64(1), "coefficients of type float64 and shape ()"),
        (np.zeros(9, "M8[s]"), "coefficients of type datetime64"),
        (np.zeros(9, "U3"), "coefficients of type <U3"),
        (np.zeros(9, bool), "coefficients of type bool"),
        (np.zeros(9, [("r", "f4")]), "coefficients of type [('r', '<f4')]"),
        (np.zeros((4, 2, 3, 3)), "shape (4, 2, 3, 3)"),
    ],
)  # fmt: skip
def test_an_array_of_anything_else_is_refused(array, says, tmp_path):
    if array.shape == (2, 4, 3):
        assert says in str(read(tmp_path / "a.npy", npy_file(array)).encoding)
        return
    assert says in refused(tmp_path / "a.npy", npy_file(array), Reading(convention="shviewer"))


def test_an_array_is_checked_before_memory_is_taken(tmp_path):
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f4", "fortran_order": False, "shape": (2**15, 2**15, 3)})
    assert "the limit is 134217728" in refused(tmp_path / "a.npy", header.getvalue())
    assert "no NPY" in refused(tmp_path / "b.npy", npy_file(IMAGE)[:-1])


# ------------------------------------------------------------------------------------------------------------ DDS

FACES = np.random.default_rng(2).random((6, 4, 4, 4)).astype(np.float32)
"""+X -X +Y -Y +Z -Z of Direct3D, which are our right, left, up, down, front and back."""
MIDDLES = np.array([[0, -1, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0]], float)


@pytest.mark.parametrize(
    ("data", "dtype"),
    [
        (dds_file(FACES.astype(np.float16), 113), "half"),
        (dds_file(FACES, 116), "float"),
        (dds_file(FACES.astype(np.float16), dxgi=10), "half"),
        (dds_file(FACES, dxgi=2), "float"),
        (dds_file(np.ascontiguousarray(FACES[..., :3]), dxgi=6), "float"),
        (dds_file(FACES, dxgi=2, levels=3), "float"),
    ],
    ids=["old-half", "old-float", "half", "float", "rgb", "mip-mapped"],
)
def test_a_cube_of_direct3d_stands_as_direct3d_has_it(data, dtype, tmp_path):
    light = read(tmp_path / "cube.dds", data)
    assert light.encoding == f"DDS, {dtype}, cube"
    assert light.layout.name == "cube"
    assert not [note for note in light.notes if "layout" in note]
    expected = FACES.astype(np.float16 if dtype == "half" else np.float32)
    for direction, face in zip(MIDDLES, expected, strict=True):
        assert any(
            np.array_equal(light.integrand(direction[None])[0], texel) for texel in face[1:3, 1:3, :3].reshape(-1, 3)
        )
    # within a face: the upper left of the front is up and to the left; up meets the front at its lower edge
    np.testing.assert_array_equal(light.integrand(np.array([[1, 0.9, 0.9]]))[0], expected[4, 0, 0, :3])
    np.testing.assert_array_equal(light.integrand(np.array([[0.9, 0.9, 1]]))[0], expected[2, 3, 0, :3])


def test_the_smallest_dds_are_read(tmp_path):
    """Their texels are fewer bytes than the longer of the two headers adds."""
    half = np.ones((1, 1, 4), np.float16)
    assert read(tmp_path / "a.dds", dds_file([half], 113, caps=0)).pixels.shape == (1, 1, 3)


def test_an_image_in_a_dds_is_lat_long(tmp_path):
    image = np.dstack([IMAGE, np.ones((8, 16), np.float32)])
    light = read(tmp_path / "map.dds", dds_file([image], dxgi=2, caps=0))
    np.testing.assert_array_equal(light.pixels, IMAGE)
    assert (light.encoding, light.notes, light.layout.name) == ("DDS, float", ("alpha dropped",), "lat-long")


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (dds_file(FACES, dxgi=2)[:-1], "cut short"),
        (b"DDS " + bytes(20), "24 bytes, which no DDS has"),
        (dds_file(FACES, dxgi=2, surfaces=2), "several textures"),
        (dds_file(FACES, dxgi=2, caps=0x7E00), "a cube of which faces are missing"),
        (dds_file(np.ones((6, 4, 2, 4), np.float32), dxgi=2), "faces of 2 x 4 texels; they are square"),
        (dds_file(FACES, 116, caps=0x200000), "a volume"),
        (
            dds_file((FACES[..., :1] * 255).astype(np.uint32), dxgi=67),
            "a variant that is not read (Unsupported DXGI format: 67)",
        ),
    ],
)
def test_a_broken_dds_is_one_line(data, says, tmp_path):
    assert says in refused(tmp_path / "cube.dds", data)


# ---------------------------------------------------------------------------------------------- through OpenImageIO


def written(name: str, pixels: np.ndarray, kind: str = "", **attributes: Any) -> bytes:
    """The bytes of an image written by OpenImageIO, whose suffix and type of texels are named."""
    oiio = pytest.importorskip("OpenImageIO", reason='OpenImageIO is missing: pip install "shviewer[formats]"')
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, kind or str(pixels.dtype).replace("float32", "float"))
    for key, value in attributes.items():
        if key in ("x", "y", "full_width", "full_height", "tile_width", "tile_height"):
            setattr(spec, key, value)
        else:
            spec.attribute(key.replace("__", ":"), value)
    path = f"written-{os.getpid()}.{name.rsplit('.')[-1]}"
    file = oiio.ImageOutput.create(path)
    assert file.open(path, spec), oiio.geterror()
    assert file.write_image(pixels), file.geterror()
    file.close()
    try:
        return Path(path).read_bytes()
    finally:
        Path(path).unlink()


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("kind", ["float", "double", "half"])
@pytest.mark.parametrize("compression", ["none", "zip", "lzw"])
def test_a_tiff_of_floats_is_linear(kind, compression, tmp_path):
    light = read(tmp_path / "a.tif", written("a.tif", IMAGE, kind, compression=compression))
    np.testing.assert_allclose(light.pixels, IMAGE, rtol=2**-11 if kind == "half" else 0)
    assert light.encoding in ("TIFF, float, taken as linear", "TIFF, double, taken as linear")
    assert light.notes == ()


@pytest.mark.parametrize(
    "attributes",
    [{}, {"compression": "lzw"}, {"planarconfig": "separate"}, {"tile_width": 16, "tile_height": 16}],
    ids=["plain", "lzw", "planar", "tiled"],
)
@pytest.mark.parametrize("suffix", ["tif", "psd", "bmp"])
def test_integers_are_srgb_codes_and_said_to_be(suffix, attributes, tmp_path):
    if suffix == "psd":
        data, codes = psd_file(CODES), CODES
    elif suffix == "bmp":
        codes = (CODES >> 8).astype(np.uint8)
        data = written("a.bmp", codes)
    else:
        data, codes = written("a.tif", CODES, **attributes), CODES
    light = read(tmp_path / f"a.{suffix}", data)
    np.testing.assert_allclose(light.pixels, linear(codes), rtol=1e-6)
    assert light.encoding == f"{ {'tif': 'TIFF'}.get(suffix, suffix.upper()) }, {codes.itemsize * 8} bit sRGB (LDR)"
    assert light.notes == (LDR.replace("16", str(codes.itemsize * 8)),)


def test_a_webp_is_upright_and_srgb(tmp_path):
    pytest.importorskip("OpenImageIO")
    codes = (CODES >> 8).astype(np.uint8)
    light = read(tmp_path / "a.webp", saved_by_pillow(codes, "WEBP", lossless=True))
    np.testing.assert_allclose(light.pixels, linear(codes), rtol=1e-6)
    assert light.encoding == "WebP, 8 bit sRGB (LDR)"


def test_a_dds_of_blocks_is_that_of_another_reader(tmp_path):
    """Pillow's, of Pillow's file; two decoders of S3TC may round differently."""
    pytest.importorskip("OpenImageIO")
    smooth = np.zeros((8, 16, 4), np.uint8)
    smooth[..., 0], smooth[..., 1], smooth[..., 3] = np.arange(16) * 16, np.arange(8)[:, None] * 32, 255
    data = saved_by_pillow(smooth, "DDS", pixel_format="DXT5")
    with Image.open(io.BytesIO(data)) as picture:
        theirs = linear(np.asarray(picture)[..., :3])
    np.testing.assert_allclose(read(tmp_path / "a.dds", data).pixels, theirs, atol=0.01)


def test_a_psd_of_32_bits_is_linear_light(tmp_path):
    light = read(tmp_path / "a.psd", psd_file(IMAGE))
    np.testing.assert_array_equal(light.pixels, IMAGE)
    assert light.encoding == "PSD, float, taken as linear"


def test_alpha_is_dropped_and_changes_no_colour(tmp_path):
    for pixels, expected in (
        (np.dstack([CODES, np.full((8, 16), 9999, np.uint16)]), linear(CODES)),
        (np.dstack([IMAGE, np.full((8, 16), 0.25, np.float32)]), IMAGE),
    ):
        light = read(tmp_path / "a.tif", written("a.tif", pixels, oiio__UnassociatedAlpha=1))
        np.testing.assert_allclose(light.pixels, expected, rtol=1e-6)
        assert light.notes[-1] == "alpha dropped"


@pytest.mark.parametrize("orientation", range(1, 9))
def test_an_orientation_is_applied(orientation, tmp_path):
    """As Pillow applies it to the same codes."""
    codes = (CODES >> 8).astype(np.uint8)
    light = read(
        tmp_path / "a.tif", written("a.tif", codes, Orientation=orientation), Reading(isolated=False, layout="lat-long")
    )
    picture = Image.fromarray(codes)
    picture.getexif()[0x0112] = orientation
    np.testing.assert_allclose(light.pixels, linear(np.asarray(ImageOps.exif_transpose(picture))), rtol=1e-6)
    assert (f"turned upright: its EXIF orientation is {orientation}" in light.notes) == (orientation != 1)


def test_a_part_of_a_panorama_is_placed(tmp_path):
    data = written("a.tif", IMAGE, x=4, y=2, full_width=32, full_height=16)
    light = read(tmp_path / "a.tif", data)
    np.testing.assert_array_equal(light.pixels, np.pad(IMAGE, ((2, 6), (4, 12), (0, 0))))
    assert light.notes == ("data window smaller than display window: 384 texels without data are 0",)


@pytest.mark.parametrize(
    ("options", "unsaid"),
    [
        ({}, ""),
        ({"levels": 3}, ""),
        ({"levels": 3}, "levels"),
        ({"dxgi": 28, "levels": 3}, "levels"),
        ({"dxgi": 28}, "cube"),
    ],
)
def test_a_cube_of_8_bit_stands_as_one_of_floats(options, unsaid, tmp_path):
    """unsaid: what is not in the flags of the header, as the number of levels and the longer header say the same."""
    pytest.importorskip("OpenImageIO")
    codes = (FACES * 255).astype(np.uint8)
    data = bytearray(dds_file(codes, **options))
    data[10] = 0x02 if "levels" in options and unsaid != "levels" else 0
    data[113] = 0 if unsaid == "cube" else 0xFE
    light = read(tmp_path / "a.dds", bytes(data))
    same = read(
        tmp_path / "b.dds",
        dds_file(np.concatenate([linear(codes[..., :3]), FACES[..., 3:]], 3).astype(np.float32), 116),
    )
    np.testing.assert_allclose(light.pixels, same.pixels, rtol=1e-6)
    assert light.layout == same.layout
    assert light.encoding == "DDS, 8 bit sRGB (LDR), cube"


def test_only_the_first_image_is_read_and_said_to_be(tmp_path):
    oiio = pytest.importorskip("OpenImageIO")
    specs = (oiio.ImageSpec(16, 8, 3, "float"),) * 2
    file = oiio.ImageOutput.create("two.tif")
    assert file.open("two.tif", specs)
    file.write_image(IMAGE)
    assert file.open("two.tif", specs[1], "AppendSubimage")
    file.write_image(2 * IMAGE)
    file.close()
    light = read(tmp_path / "a.tif", Path("two.tif").read_bytes())
    np.testing.assert_array_equal(light.pixels, IMAGE)
    assert light.notes == ("only the first of its images is read",)


def with_profile(pixels: np.ndarray, *profile: Any) -> bytes:
    return tiff_file(pixels, extra=[(34675, 7, icc_profile("test", *profile))])


def test_16_bits_are_linear_if_the_profile_of_the_file_says_so(tmp_path):
    pytest.importorskip("OpenImageIO")
    light = read(tmp_path / "a.tif", with_profile(CODES, SRGB_COLUMNS, (LINEAR_CURVE,)))
    np.testing.assert_allclose(light.pixels, CODES / 65535, rtol=1e-6)
    assert light.encoding == "TIFF, 16 bit linear (LDR)"


def test_floats_are_linear_whatever_their_profile_says_and_converted_from_its_primaries_if_it_is_linear(tmp_path):
    pytest.importorskip("OpenImageIO")
    wide = IMAGE.copy()
    wide[0, 0] = np.inf, 1, 1
    of_p3 = decode_radiance_image(
        with_profile(wide, P3_COLUMNS, (LINEAR_CURVE,)), "a.tif", Reading(True, isolated=False)
    )
    grey = np.broadcast_to(IMAGE[..., :1], IMAGE.shape)
    of_grey = read(tmp_path / "a.tif", with_profile(grey, P3_COLUMNS, (LINEAR_CURVE,)))
    np.testing.assert_allclose(of_grey.pixels, grey, rtol=1e-3)  # to the digits of a profile
    assert np.abs(of_p3.pixels[1:] - IMAGE[1:]).max() > 0.1
    assert any(note.startswith("sanitised: 1 +Inf ->") for note in of_p3.notes)  # it does not spread
    curved = read(tmp_path / "b.tif", with_profile(IMAGE, P3_COLUMNS))
    np.testing.assert_array_equal(curved.pixels, IMAGE)
    assert curved.notes == ("its colour profile (ICC) is ignored, Rec. 709 assumed",)


def test_a_text_of_no_known_encoding_in_a_tiff_harms_nothing(tmp_path):
    pytest.importorskip("OpenImageIO")
    light = read(tmp_path / "a.tif", tiff_file(CODES, extra=[(315, 2, b"\xa9 M\xfcller\xff\0"), (305, 2, b"\xc2\0")]))
    np.testing.assert_allclose(light.pixels, linear(CODES), rtol=1e-6)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: written("a.tif", IMAGE)[:-1000], "damaged or cut short"),
        (lambda: written("a.tif", np.dstack([CODES, CODES])), "channels R G B"),
        (lambda: tiff_file(CODES.astype(np.uint32)), "texels of type uint"),
        (
            lambda: tiff_file(np.dstack([CODES, CODES[..., :1]]), photometric=5),
            "neither RGB nor grey, such as CMYK or Lab",
        ),
        (lambda: tiff_file(CODES, width=2**20), "a side must be 1 to 32768"),
        (lambda: b"II*\0" + written("a.png", CODES), "damaged or cut short"),
    ],
)
def test_a_broken_or_strange_tiff_is_one_line(make, says, tmp_path):
    assert says in refused(tmp_path / "a.tif", make())


ROWS_PER_STRIP = struct.pack("<HHI", 278, 4, 1)


@pytest.mark.parametrize(
    ("name", "data", "says"),
    [
        (
            "a.tif",
            tiff_file(CODES).replace(ROWS_PER_STRIP + b"\x08", ROWS_PER_STRIP + b"\0"),
            "Could not open file: Bad value 0",
        ),
        ("a.psd", b"8BPS" + bytes(100), "invalid version failed to open: failed load_header"),
    ],
)
def test_a_refusal_names_no_file_but_that_of_the_user(name, data, says, tmp_path):
    pytest.importorskip("OpenImageIO")
    assert says in refused(tmp_path / name, data)


def test_a_part_larger_than_the_full_image_is_checked_too(tmp_path):
    data = written("a.tif", IMAGE, full_width=8, full_height=8)
    small = Reading(isolated=False, limits=Limits(side=8))
    assert "16 x 8 texels; a side must be 1 to 8" in refused(tmp_path / "a.tif", data, small)


def test_a_child_decodes_them_unless_told_otherwise_and_leaves_no_file_behind(tmp_path, monkeypatch):
    """Also one that dies with its file open: the folder is the parent's."""
    data = written("a.tif", CODES)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    here = decode_radiance_image(data, "a.tif", HERE)
    there = decode_radiance_image(data, "a.tif")
    np.testing.assert_array_equal(there.pixels, here.pixels)
    assert (there.encoding, there.notes) == (here.encoding, here.notes)
    (tmp_path / "OpenImageIO.py").write_text("from os import abort as ImageSpec\ndef attribute(*_): ...")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(LightError, match=r"crashed \(SIGABRT\)"):
        decode_radiance_image(data, "a.tif")
    assert not list(tmp_path.glob("shviewer-*"))


def test_without_openimageio_the_refusal_names_the_extra(tmp_path, monkeypatch):
    from shviewer.lights.images.others import openimageio

    monkeypatch.setattr(openimageio, "find_spec", lambda name: None)
    message = refused(tmp_path / "a.tif", b"II*\0" + bytes(100))
    assert message.endswith(
        'TIFF is read with an extra: pip install "shviewer[formats]", or convert it to .hdr or .exr'
    )
    assert "extra" in refused(tmp_path / "a.dds", dds_file((FACES * 255).astype(np.uint8)))
    read(tmp_path / "b.dds", dds_file(FACES, dxgi=2))  # what is read here needs none


def test_what_is_read_here_loads_no_openimageio(tmp_path):
    (tmp_path / "a.pfm").write_bytes(pfm_file(IMAGE))
    (tmp_path / "a.exr").write_bytes(exr_file({"RGB": IMAGE}))
    code = (
        "import sys, shviewer; [shviewer.find_light(p) for p in sys.argv[1:]]; assert 'OpenImageIO' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code, str(tmp_path / "a.pfm"), str(tmp_path / "a.exr")], check=True)


@pytest.mark.parametrize("suffix", [".tif", ".hdr", ".exr", ".png"])
def test_a_suffix_that_says_otherwise_is_a_mistake(suffix, tmp_path):
    assert f"named {suffix} but holds PFM; rename it to end in .pfm" in refused(
        tmp_path / f"a{suffix}", pfm_file(IMAGE)
    )


# -------------------------------------------------------------------------------------------------------- mutations


def test_a_mutation_of_these_is_an_image_or_one_line():
    """In one process, as the C++ of OpenImageIO is in the child; a crash is that child's."""
    seeds = {
        "a.pfm": pfm_file(IMAGE),
        "a.npy": npy_file(IMAGE),
        "a.dds": dds_file(FACES, dxgi=2),
        "b.dds": dds_file((FACES * 255).astype(np.uint8)),
        "a.tif": written("a.tif", CODES),
        "f.tif": written("f.tif", IMAGE, compression="zip"),
        "a.psd": psd_file(CODES),
        "a.bmp": written("a.bmp", (CODES >> 8).astype(np.uint8)),
    }
    random, small = np.random.default_rng(0), Reading(isolated=False, limits=Limits(texels=2**16))
    outcomes = {name: [0, 0] for name in seeds}
    for name, data in seeds.items():
        for attempt in range(150):
            spoilt = bytearray(data)
            if attempt % 3 == 0:
                spoilt = spoilt[: int(random.integers(1, len(data)))]
            for at in random.integers(0, min(len(spoilt), 160), int(random.integers(1, 4))):
                spoilt[at] = random.choice([0, 1, 255, int(random.integers(256))])
            said = ""
            try:
                image = decode_radiance_image(bytes(spoilt), name, small)
            except LightError as error:
                said = str(error)
            assert said.isprintable()
            assert said.startswith(name) if said else np.isfinite(image.pixels).all()
            outcomes[name][bool(said)] += 1
    assert all(min(counts) > 5 for counts in outcomes.values()), outcomes
