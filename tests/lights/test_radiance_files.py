"""What shviewer.lights.radiance_files promises about .hdr and .exr files.

Pixels are compared exactly wherever the format stores them exactly; any tolerance says where it comes from.
"""

import errno
import os
import sys
import threading
import time
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from hdr_files import (
    FORMAT,
    ORIENTATIONS,
    PACKINGS,
    bare_exr,
    exr_file,
    exr_part,
    exr_parts,
    hdr_file,
    radiance_of,
    random_texels,
    window,
)

from shviewer.errors import LightError
from shviewer.lights import radiance_files
from shviewer.lights.image_limits import MAX_FILE_BYTES, MAX_HEADER_BYTES, check_size
from shviewer.lights.radiance_files import read_radiance_image

ENVIRONMENTS = Path(__file__).parents[2] / "assets" / "environments"
TEXELS = random_texels(8, 16)
ONE_ROUNDING = 2.0**-24  # relative, float32

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


@pytest.fixture
def read(tmp_path):
    """Reads bytes as if they were a file of that name."""

    def read_bytes(data, name="light.hdr", **options):
        path = tmp_path / name
        path.write_bytes(data)
        return read_radiance_image(path, **options)

    return read_bytes


@pytest.fixture
def refusal(read):
    """The message with which bytes are refused: one line that begins with the file."""

    def refuse(data, name="light.hdr", **options):
        with pytest.raises(LightError) as caught:
            read(data, name, **options)
        return checked_message(caught.value, name)

    return refuse


def checked_message(error, name):
    message = str(error)
    assert "\n" not in message
    assert name in message.split(": ")[0]
    return message


def assert_same(pixels, expected):
    np.testing.assert_array_equal(pixels, np.asarray(expected).astype(np.float32))
    assert pixels.dtype == np.float32
    assert pixels.flags.c_contiguous
    assert pixels.flags.writeable


def halves(height=4, width=8, seed=1):
    return np.random.default_rng(seed).random((height, width, 3)).astype(np.float16)


# ------------------------------------------------------------------------------------------------- .hdr, valid files


def test_a_file_written_by_hand_gives_the_values_worked_out_by_hand(read):
    image = read(GOLDEN)
    assert_same(image.pixels, GOLDEN_PIXELS)
    assert image.notes == ("8 x 2 is not 2:1; a cube cross or an angular map read as lat-long? Used as it is",)


@pytest.mark.parametrize("packing", PACKINGS)
def test_every_packing_gives_every_value_exactly(read, packing):
    image = read(hdr_file(TEXELS, packing))
    assert_same(image.pixels, radiance_of(TEXELS))
    assert image.notes == ()


@pytest.mark.parametrize("packing", PACKINGS)
@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_a_rotated_scanline_order_is_undone(read, orientation, packing):
    texels = random_texels(9, 13, seed=2)
    assert_same(read(hdr_file(texels, packing, orientation)).pixels, radiance_of(texels))


@pytest.mark.parametrize(
    "size", [(1, 1), (2, 3), (3, 1), (1, 7), (1, 8), (8, 1), (1, 127), (1, 128), (1, 129), (2, 300)]
)
@pytest.mark.parametrize("packing", PACKINGS)
def test_any_size_is_read(read, size, packing):
    texels = random_texels(*size, seed=3)
    allowed = packing if packing != "new" or size[1] >= 8 else "old"
    assert_same(read(hdr_file(texels, allowed)).pixels, radiance_of(texels))


@pytest.mark.parametrize(("width", "packing"), [(32767, "new"), (32767, "old"), (32768, "flat"), (32768, "old")])
def test_the_longest_scanlines_are_read(read, width, packing):
    texels = random_texels(1, width, seed=4)
    assert_same(read(hdr_file(texels, packing)).pixels, radiance_of(texels))


@pytest.mark.parametrize("width", [7, 32768])
def test_two_twos_begin_an_ordinary_texel_where_the_new_packing_does_not_exist(read, width):
    texels = random_texels(1, width, seed=5)
    texels[0, 0] = (2, 2, width >> 8 & 127, width & 255)
    assert_same(read(hdr_file(texels, "flat")).pixels, radiance_of(texels))


def test_two_twos_and_a_high_bit_begin_an_ordinary_texel(read):
    texels = random_texels(1, 16, seed=5)
    texels[0, 0] = (2, 2, 200, 130)
    assert_same(read(hdr_file(texels, "flat")).pixels, radiance_of(texels))


@pytest.mark.parametrize("run", [2, 255, 256, 257, 512, 20000])
def test_a_long_run_in_the_old_packing_is_counted_in_base_256(read, run):
    texels = random_texels(1, run + 3, seed=6)
    texels[0, 1 : 1 + run] = (9, 200, 7, 130)
    assert_same(read(hdr_file(texels, "old")).pixels, radiance_of(texels))


def test_a_marker_of_zero_repeats_nothing_but_is_a_digit(read):
    colours = [bytes((128, value, 0, 136)) for value in range(8)]
    nothing, one = b"\1\1\1\0", b"\1\1\1\1"
    texels = b"".join(colour + 4 * nothing for colour in colours[:7]) + colours[7]
    pixels = read(b"#?RADIANCE\n\n-Y 1 +X 8\n" + texels).pixels
    assert_same(pixels, [[[128, value, 0] for value in range(8)]])
    pixels = read(b"#?RADIANCE\n\n-Y 1 +X 257\n" + colours[5] + nothing + one).pixels
    assert_same(pixels, [[[128, 5, 0]] * 257])


def test_every_exponent_is_exact(read):
    texels = np.full((1, 256, 4), 200, np.uint8)
    texels[0, :, 1], texels[0, :, 2], texels[0, :, 3] = 1, 255, np.arange(256)
    pixels = read(hdr_file(texels)).pixels
    np.testing.assert_array_equal(pixels.astype(np.float64), radiance_of(texels))
    assert pixels[0, 1, 1] == 2.0**-135  # subnormal in float32, not flushed
    assert pixels[0, 255, 2] == 255 * 2.0**119


@pytest.mark.parametrize(
    "changes",
    [
        {"magic": b"#?RGBE"},
        {"magic": b"#?rpict"},
        {"newline": b"\r\n"},
        {"settings": ()},
        {"settings": (b"#?RADIANCE", b"# Made with Adobe Photoshop", b"GAMMA=1", b"PRIMARIES=0 0 0 0 0 0 0 0", FORMAT)},
        {"settings": (FORMAT, b"", b"")[:1]},
        {"settings": (b"VIEW= -vtl -vp 0 0 0", b"SOFTWARE=x\xff", FORMAT + b" ", b"EXPOSURE=1", b"COLORCORR=1 1 1")},
        {"settings": (FORMAT, b"\tEXPOSURE=3", b" COLORCORR= 1 2 3", b"\tFORMAT=32-bit_rle_xyze")},
        {"settings": (FORMAT, b"#" + b"x" * 60000)},
    ],
    ids=["RGBE", "rpict", "CRLF", "no FORMAT", "Photoshop", "FORMAT", "settings", "indented history", "long comment"],
)
def test_header_variations_change_no_value_and_give_no_note(read, changes):
    image = read(hdr_file(TEXELS, **changes))
    assert_same(image.pixels, radiance_of(TEXELS))
    assert image.notes == ()


def test_bytes_after_the_last_scanline_are_tolerated(read):
    assert_same(read(hdr_file(TEXELS) + b"\2\2\0\x10 and more").pixels, radiance_of(TEXELS))


def test_scanlines_of_both_packings_may_alternate(read):
    ending = b"-Y 1 +X 16\n"
    rows = [hdr_file(TEXELS[y : y + 1], PACKINGS[y % 3]).partition(ending)[2] for y in range(8)]
    header = hdr_file(TEXELS[:1]).partition(ending)[0]
    assert_same(read(header + b"-Y 8 +X 16\n" + b"".join(rows)).pixels, radiance_of(TEXELS))


def test_all_exposures_and_colour_corrections_are_divided_out_with_a_note(read):
    settings = (FORMAT, b"EXPOSURE=  2.5", b"COLORCORR= 1 2 4", b"EXPOSURE=0.3 stops", b"COLORCORR=3 1 1")
    image = read(hdr_file(TEXELS, settings=settings))
    expected = radiance_of(TEXELS) / (0.75 * np.array([3.0, 2.0, 4.0]))
    np.testing.assert_allclose(image.pixels, expected, rtol=ONE_ROUNDING, atol=0)
    assert image.notes == ("EXPOSURE 0.75 divided out", "COLORCORR 3 2 4 divided out")


# ----------------------------------------------------------------------------------------------- .hdr, refused files


@pytest.mark.parametrize("packing", PACKINGS)
def test_every_truncation_is_refused(refusal, packing):
    whole = hdr_file(random_texels(3, 9, seed=7), packing)
    for length in range(len(whole)):
        refusal(whole[:length])


@pytest.mark.parametrize(
    ("settings", "fragment"),
    [
        ((b"FORMAT=32-bit_rle_xyze",), "FORMAT=32-bit_rle_xyze"),
        ((FORMAT, b"FORMAT=\x1b[2Jnonsense"), r"\x1b[2Jnonsense"),
        ((FORMAT, b"EXPOSURE=0"), "EXPOSURE=0"),
        ((FORMAT, b"EXPOSURE=-1"), "EXPOSURE=-1"),
        ((FORMAT, b"EXPOSURE=nan"), "EXPOSURE=nan"),
        ((FORMAT, b"EXPOSURE="), "EXPOSURE="),
        ((FORMAT, b"EXPOSURE=bright"), "EXPOSURE=bright"),
        ((FORMAT, b"COLORCORR=1 2"), "COLORCORR=1 2"),
        ((FORMAT, b"COLORCORR=1 inf 1"), "COLORCORR=1 inf 1"),
        ((FORMAT, b"EXPOSURE=1e200", b"EXPOSURE=1e200"), "multiply to"),
        ((FORMAT, b"EXPOSURE=1e-200", b"EXPOSURE=1e-200"), "multiply to"),
    ],
)
def test_a_setting_that_cannot_be_honoured_is_refused_by_name(refusal, settings, fragment):
    assert fragment in refusal(hdr_file(TEXELS, settings=settings))


@pytest.mark.parametrize(
    "size",
    [
        b"-Y 0 +X 4",
        b"-Y 4 +X 0",
        b"-Y -1 +X 4",
        b"-Y 4 +X 2147483648",
        b"-X 1000000000000000000 +Y 4",
        b"+Y 32769 +X 1",
    ],
)
def test_an_absurd_size_is_refused_with_its_number(refusal, size):
    message = refusal(b"#?RADIANCE\n\n" + size + b"\n" + bytes(100))
    assert size.split()[1].decode() in message or size.split()[3].decode() in message
    assert "1 to 32768" in message


@pytest.mark.parametrize(
    "size", [b"", b"-Y 4", b"-Y 4 +Y 4", b"-Y 4 +X four", b"-Y 4 +X 4 +X 4", b"-Y " + b"9" * 5000 + b" +X 4", b"4 8"]
)
def test_a_size_line_of_another_form_is_refused(refusal, size):
    assert "one like '-Y 512 +X 1024'" in refusal(b"#?RADIANCE\n\n" + size + b"\n" + bytes(100))


def test_sizes_are_limited_inclusively():
    check_size(32768, 4096)  # 2**27 texels
    check_size(1, 32768)
    for width, height in [(32768, 4097), (32769, 1), (1, 32769), (0, 1), (1, 0)]:
        with pytest.raises(LightError, match=f"{width} x {height}"):
            check_size(width, height)


def test_the_largest_size_claimed_by_a_small_file_is_refused_at_once(refusal):
    start = time.perf_counter()
    message = refusal(b"#?RADIANCE\n\n-Y 4096 +X 32767\n" + bytes(100))
    assert "100 bytes of texels; 4096 scanlines take at least 32768" in message
    assert time.perf_counter() - start < 0.5  # making 1.5 GB of pixels takes longer


def test_a_header_without_end_is_refused(refusal):
    assert str(MAX_HEADER_BYTES) in refusal(b"#?RADIANCE\n" + b"# comment\n" * 7000)
    assert str(MAX_HEADER_BYTES) in refusal(b"#?" + b"x" * 10**6)


def test_a_header_that_ends_beyond_the_limit_is_refused(refusal):
    assert str(MAX_HEADER_BYTES) in refusal(hdr_file(TEXELS, settings=(b"#" * MAX_HEADER_BYTES,)))


HEADER_OF_EIGHT = b"#?RADIANCE\n\n-Y 1 +X 8\n"


@pytest.mark.parametrize(
    ("scanline", "fragment"),
    [
        (b"\2\2\0\x08" + b"\0" * 64, "packet of length 0"),
        (b"\2\2\0\x08" + b"\x88\x01" + b"\0" * 64, "packet of length 0"),
        (b"\2\2\0\x09" + b"\x89\x01" * 4, "states 9 texels where the header has 8"),
        (b"\2\2\0\x08" + b"\x89\x01" * 4, "past the end of its channel"),
        (b"\2\2\0\x08" + b"\x09" + bytes(40), "past the end of its channel"),
        (b"\1\1\1\3" + b"\x80\x80\x80\x80" * 8, "none comes before it"),
        (b"\x80\x80\x80\x80\1\1\1\x08" + bytes(40), "past the end of the scanline"),
        (b"\x80\x80\x80\x80\1\1\1\0\1\1\1\1" + bytes(40), "past the end of the scanline"),
        (b"\x80\x80\x80\x80" + b"\1\1\1\0" * 40, "past the end of the scanline"),
    ],
)
def test_a_damaged_scanline_is_refused_with_the_reason(refusal, scanline, fragment):
    message = refusal(HEADER_OF_EIGHT + scanline)
    assert fragment in message
    assert "scanline 0" in message


# ------------------------------------------------------------------------------------------------ .exr, valid files

LOSSLESS = ("NO", "RLE", "ZIP", "ZIPS", "PIZ")


@pytest.mark.parametrize("compression", LOSSLESS)
@pytest.mark.parametrize("dtype", [np.float16, np.float32])
def test_a_lossless_openexr_file_gives_its_values_exactly(read, compression, dtype):
    pixels = halves(20, 40).astype(dtype)
    pixels[3, 5] = (1, 2, 3)
    data = exr_file({"RGB": pixels}, compression=getattr(OpenEXR, f"{compression}_COMPRESSION"))
    image = read(data, "light.exr")
    assert_same(image.pixels, pixels)
    assert image.notes == ()


@pytest.mark.parametrize("compression", ["DWAA", "DWAB", "PXR24", "B44"])
def test_a_lossy_openexr_file_gives_nearly_its_values(read, compression):
    y, x = np.mgrid[0:32, 0:64]
    pixels = np.stack([1 + x / 64, 2 + y / 32, 4 + (x + y) / 96], axis=2).astype(np.float16)
    data = exr_file({"RGB": pixels}, compression=getattr(OpenEXR, f"{compression}_COMPRESSION"))
    # B44 keeps 6 to 7 bits of a difference, DWA what the eye sees: below 1 % here, and channels differ by far more.
    np.testing.assert_allclose(read(data, "light.exr").pixels, pixels, rtol=0.01, atol=0)


@pytest.mark.parametrize("order", ["INCREASING_Y", "DECREASING_Y"])
def test_the_line_order_of_the_file_does_not_matter(read, order):
    pixels = halves(40, 80)
    data = exr_file({"RGB": pixels}, lineOrder=getattr(OpenEXR, order))
    assert_same(read(data, "light.exr").pixels, pixels)


def test_a_tiled_openexr_file_is_read(read):
    pixels = halves(40, 80)
    data = exr_file({"RGB": pixels}, type=OpenEXR.tiledimage, tiles=OpenEXR.TileDescription())
    assert_same(read(data, "light.exr").pixels, pixels)


def test_alpha_is_ignored(read):
    rgba = np.dstack([halves(), np.zeros((4, 8), np.float16)])
    image = read(exr_file({"RGBA": rgba}), "light.exr")
    assert_same(image.pixels, rgba[..., :3])
    assert image.notes == ()


def test_integers_are_taken_at_their_value(read):
    pixels = np.arange(96, dtype=np.uint32).reshape(4, 8, 3)
    assert_same(read(exr_file({"RGB": pixels}), "light.exr").pixels, pixels)


def test_channels_of_mixed_types_are_read(read):
    red, green, blue = halves().transpose(2, 0, 1).copy()
    data = exr_file({"R": red, "G": green.astype(np.float32), "B": (100 * blue).astype(np.uint32)})
    assert_same(read(data, "light.exr").pixels, np.dstack([red, green, (100 * blue).astype(np.uint32)]))


def test_a_luminance_file_is_grey(read):
    luminance = halves()[..., 0].copy()
    assert_same(read(exr_file({"Y": luminance}), "light.exr").pixels, np.dstack([luminance] * 3))


def test_the_only_layer_with_rgb_is_read_with_a_note(read):
    red, green, blue = halves().transpose(2, 0, 1).copy()
    data = exr_file(
        {"key.diffuse.R": red, "key.diffuse.G": green, "key.diffuse.B": blue, "depth.Z": red, "mask.R": red}
    )
    image = read(data, "light.exr")
    assert_same(image.pixels, np.dstack([red, green, blue]))
    assert image.notes == ("layer 'key.diffuse' read, the only one with R, G and B",)


def test_channels_without_a_layer_win_over_layers(read):
    red, green, blue = halves().transpose(2, 0, 1).copy()
    layer = {f"specular.{c}": np.zeros_like(red) for c in "RGB"}
    assert_same(read(exr_file({"R": red, "G": green, "B": blue, **layer}), "light.exr").pixels, halves())


def test_the_only_part_with_rgb_is_read(read):
    depth = exr_part("depth", {"Z": np.ones((4, 8), np.float32)})
    data = exr_parts(depth, exr_part("beauty", {"RGB": halves()}))
    assert_same(read(data, "light.exr").pixels, halves())


def test_texels_without_data_are_black_and_those_outside_are_dropped(read):
    pixels = halves(6, 12)
    data = exr_file({"RGB": pixels}, dataWindow=window(-2, 1, 9, 6), displayWindow=window(0, 0, 11, 5))
    image = read(data, "light.exr")
    expected = np.zeros((6, 12, 3))
    expected[1:6, 0:10] = pixels[0:5, 2:12]
    assert_same(image.pixels, expected)
    assert image.notes == (
        "data window smaller than display window: 22 texels without data are 0",
        "data window larger than display window: 22 texels outside are dropped",
    )


def test_a_display_window_off_the_origin_moves_nothing(read):
    pixels = halves(6, 12)
    both = window(-7, 100, 4, 105)
    image = read(exr_file({"RGB": pixels}, dataWindow=both, displayWindow=both), "light.exr")
    assert_same(image.pixels, pixels)
    assert image.notes == ()


def test_a_lat_long_attribute_is_welcome(read):
    assert_same(read(exr_file({"RGB": halves()}, envmap=OpenEXR.ENVMAP_LATLONG), "light.exr").pixels, halves())


# ----------------------------------------------------------------------------------------------- .exr, refused files

PLANE = np.ones((4, 8), np.float32)


@pytest.mark.parametrize(
    ("data", "fragment"),
    [
        (bare_exr(deep=True), "deep data"),
        (exr_file({"RGB": halves()}, envmap=OpenEXR.ENVMAP_CUBE), "cube map"),
        (exr_file({"Y": PLANE, "RY": PLANE, "BY": PLANE}), "luminance and chroma"),
        (bare_exr(channels=(("BY", 2), ("RY", 2), ("Y", 1))), "luminance and chroma"),
        (bare_exr(channels=(("B", 2), ("G", 1), ("R", 2))), "subsampled channels B, R;"),
        (exr_file({"Z": PLANE, "N.X": PLANE}), "no R, G and B among its channels N.X, Z;"),
        (exr_file({"R": PLANE, "G": PLANE}), "no R, G and B among its channels G, R;"),
        (
            exr_file({f"{layer}.{c}": PLANE for layer in "ab" for c in "RGB"}),
            "2 candidates among its channels a.B",
        ),
        (
            exr_parts(*(exr_part(name, {"RGB": halves()}) for name in ("left", "right"))),
            "left:B, left:G, left:R, right:B",
        ),
        (exr_file({f"n{i:02}": PLANE for i in range(20)}), "n11 and 8 more"),
        (
            exr_file({"RGB": halves()}, displayWindow=window(50, 0, 57, 3), dataWindow=window(0, 0, 7, 3)),
            "lies outside",
        ),
        (bare_exr((0, 0, 59999, 59999), (0, 0, 7, 3)), "data window of 60000 x 60000"),
        (bare_exr((0, 0, 7, 3), (0, 0, 32768, 3)), "display window of 32769 x 4"),
        (bare_exr((0, 0, 32767, 4095), channels=[(f"c{i}", 1) for i in range(5)]), "values in all channels"),
        (exr_file({"RGB": halves()}).replace(b"B\0", b"\xff\0", 1), "header unreadable"),
        (exr_parts(exr_part("a", {"RGB": halves()}), exr_part("b", {"Z": PLANE}))[:-10], "only 1 of 2 parts can"),
        (bare_exr((0, 0, -1, -1)), "damaged"),
        (bare_exr((-(2**31), 0, 2**31 - 1, 3)), "damaged"),
        (bare_exr(), "Unable to query scanline information"),
    ],
)
def test_an_openexr_file_that_is_no_flat_rgb_is_refused_by_name(refusal, capfd, data, fragment):
    assert fragment in refusal(data, "light.exr")
    assert capfd.readouterr() == ("", "")


def test_every_truncation_of_an_openexr_file_is_refused_and_the_library_kept_quiet(refusal, capfd):
    whole = exr_file({"RGB": halves()})
    for length in range(1, len(whole)):
        refusal(whole[:length], "light.exr")
    assert capfd.readouterr() == ("", "")


def test_stderr_works_again_after_a_damaged_file(refusal, capfd):
    refusal(bare_exr(), "light.exr")
    os.write(2, b"still here")
    assert capfd.readouterr().err == "still here"


def test_a_missing_library_is_named_with_the_command_that_installs_it(refusal, monkeypatch):
    data = exr_file({"RGB": halves()})
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    assert "pip install OpenEXR" in refusal(data, "light.exr")


# --------------------------------------------------------------------------------------------------- NaN, Inf, signs


def bad_image():
    """4 x 8; finite values 0 to 95 but for two NaN, three +Inf, one -Inf."""
    pixels = np.arange(96, dtype=np.float32).reshape(4, 8, 3)
    pixels[2, 3, 1] = pixels[3, 0, 0] = np.nan
    pixels[1, 6] = np.inf
    pixels[3, 7, 2] = -np.inf
    return pixels


def test_nan_and_infinity_are_refused_with_counts_and_the_first_place(refusal):
    message = refusal(exr_file({"RGB": bad_image()}), "light.exr")
    assert "2 NaN, 3 +Inf and 1 -Inf values, the first at row 1, column 6" in message
    assert "--sanitize" in message


def test_sanitising_replaces_what_is_not_finite_and_says_so(read):
    image = read(exr_file({"RGB": bad_image()}), "light.exr", sanitize=True)
    expected = bad_image()
    expected[2, 3, 1] = expected[3, 0, 0] = 0
    expected[1, 6] = 94  # value 95 was the -Inf
    expected[3, 7, 2] = 0
    assert_same(image.pixels, expected)
    assert image.notes == ("sanitised: 2 NaN -> 0, 3 +Inf -> 94, 1 -Inf -> 0",)


def test_an_infinite_half_is_no_radiance(refusal):
    pixels = halves()
    pixels[0, 2, 0] = np.float16(np.inf)
    assert "1 +Inf and 0 -Inf values, the first at row 0, column 2" in refusal(exr_file({"RGB": pixels}), "light.exr")


def test_an_exposure_that_overflows_float32_is_no_radiance(refusal):
    texels = np.full((1, 8, 4), 255, np.uint8)
    assert "24 +Inf" in refusal(hdr_file(texels, settings=(FORMAT, b"EXPOSURE=0.01")))


def test_an_image_without_a_finite_value_is_refused_even_when_sanitising(refusal):
    assert "not one finite value" in refusal(
        exr_file({"RGB": np.full((4, 8, 3), np.nan, np.float32)}), sanitize=True, name="a.exr"
    )


def test_negative_values_are_kept_with_a_note(read):
    pixels = np.ones((4, 8, 3), np.float32)
    pixels[1, 1], pixels[2, 2, 0] = -0.25, -3360
    image = read(exr_file({"RGB": pixels}), "light.exr")
    assert_same(image.pixels, pixels)
    assert image.notes == ("4 negative values, minimum -3360, kept",)


def test_sanitising_clamps_negative_values_with_a_note(read):
    pixels = np.ones((4, 8, 3), np.float32)
    pixels[1, 1, 2], pixels[0, 0, 0] = -0.25, np.nan
    image = read(exr_file({"RGB": pixels}), "light.exr", sanitize=True)
    assert image.pixels[1, 1, 2] == 0
    assert image.pixels.sum() == 94
    assert image.notes == ("sanitised: 1 NaN -> 0", "sanitised: 1 negative value, minimum -0.25 -> 0")


def test_sanitising_a_sound_image_changes_nothing(read):
    image = read(hdr_file(TEXELS), sanitize=True)
    assert_same(image.pixels, radiance_of(TEXELS))
    assert image.notes == ()


@pytest.mark.parametrize(
    ("size", "noted"), [((200, 400), False), ((200, 404), False), ((200, 405), True), ((5, 3), True)]
)
def test_an_image_that_is_not_two_to_one_gets_a_note_and_keeps_its_size(read, size, noted):
    image = read(hdr_file(random_texels(*size, seed=8), "flat"))
    assert image.pixels.shape == (*size, 3)
    assert [f"{size[1]} x {size[0]} is not 2:1" in note for note in image.notes] == [True] * noted


# --------------------------------------------------------------------------------------- files that are not images


@pytest.mark.parametrize(
    ("data", "fragment"),
    [
        (b"", "empty"),
        (b"\x89PNG\r\n\x1a\n" + bytes(50), "seems to be a PNG file"),
        (b"\xff\xd8\xff\xe0" + bytes(50), "seems to be a JPEG file"),
        (b"<!DOCTYPE html>", "HTML"),
        (b"version https://git-lfs.github.com/spec/v1\n", "Git LFS"),
        (b"\0\n\xffwhatever", r"\x00\n\xff"),
        (b"#", "b'#'"),
    ],
)
@pytest.mark.parametrize("name", ["light.hdr", "light.exr"])
def test_another_kind_of_file_is_refused_naming_what_it_seems_to_be(refusal, data, fragment, name):
    assert fragment in refusal(data, name)


def test_a_misleading_suffix_is_refused_with_the_right_one(refusal):
    assert "named .hdr but holds OpenEXR; rename it to end in .exr" in refusal(exr_file({"RGB": halves()}), "light.hdr")
    assert "named .exr but holds Radiance RGBE; rename it to end in .hdr" in refusal(GOLDEN, "light.exr")
    assert "rename it to end in .hdr" in refusal(GOLDEN, "LIGHT.EXR")


@pytest.mark.parametrize("name", ["LIGHT.HDR", "light.pic", "light", "light.dat", "ein Licht größer.hdr", "-"])
def test_a_suffix_that_does_not_mislead_is_accepted(read, name):
    assert_same(read(GOLDEN, name).pixels, GOLDEN_PIXELS)


@pytest.mark.parametrize(
    ("name", "shown"),
    [(b"a\nb.hdr", r"a\nb.hdr"), (b"a\xff.hdr", r"a\udcff.hdr"), ("größer.hdr".encode(), "größer.hdr")],
)
def test_a_name_is_shown_as_it_is_unless_it_is_no_text_of_one_line(tmp_path, name, shown):
    with pytest.raises(LightError) as caught:
        read_radiance_image(tmp_path / os.fsdecode(name))
    checked_message(caught.value, shown)


def refused_within_five_seconds(path):
    """The message; a reader that blocks fails the test rather than the test run."""
    caught = []

    def attempt():
        with pytest.raises(LightError) as info:
            read_radiance_image(path)
        caught.append(info.value)

    thread = threading.Thread(target=attempt, daemon=True)
    thread.start()
    thread.join(5)
    assert caught, "blocked or not refused"
    return checked_message(caught[0], str(path))


def test_what_is_not_a_regular_file_is_refused_without_blocking(tmp_path):
    os.mkfifo(tmp_path / "pipe.hdr")
    (tmp_path / "loop.hdr").symlink_to("loop.hdr")
    (tmp_path / "file").write_bytes(GOLDEN)
    assert "a pipe, socket or device" in refused_within_five_seconds(tmp_path / "pipe.hdr")
    assert "a pipe, socket or device" in refused_within_five_seconds(Path("/dev/zero"))
    assert "a directory" in refused_within_five_seconds(tmp_path)
    assert "symbolic link" in refused_within_five_seconds(tmp_path / "loop.hdr")
    assert "no such file" in refused_within_five_seconds(tmp_path / "missing.hdr")
    assert "no such file" in refused_within_five_seconds(tmp_path / "file" / "missing.hdr")
    assert "cannot be read" in refused_within_five_seconds(tmp_path / ("x" * 300))
    with pytest.raises(LightError, match="not a path"):
        read_radiance_image(Path("a\0b"))


def test_a_device_is_not_even_opened(monkeypatch):
    opened = []
    with monkeypatch.context() as patch:
        patch.setattr(radiance_files.os, "open", lambda *arguments: opened.append(arguments))
        refused_within_five_seconds(Path("/dev/null"))
    assert not opened


def test_a_pipe_put_in_the_place_of_a_file_does_not_block(tmp_path, monkeypatch):
    os.mkfifo(tmp_path / "pipe.hdr")
    (tmp_path / "file.hdr").write_bytes(GOLDEN)
    status = os.stat(tmp_path / "file.hdr")
    with monkeypatch.context() as patch:
        patch.setattr(radiance_files.os, "stat", lambda path: status)
        assert "a pipe, socket or device" in refused_within_five_seconds(tmp_path / "pipe.hdr")


def test_a_file_that_may_not_be_read_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "light.hdr"
    path.write_bytes(GOLDEN)

    def denied(*arguments):
        raise PermissionError(errno.EACCES, "Permission denied")  # chmod would not stop root

    monkeypatch.setattr(radiance_files.os, "open", denied)
    with pytest.raises(LightError, match="permission to read it is denied"):
        read_radiance_image(path)


@pytest.mark.parametrize("change", [-1, 1])
def test_a_file_that_changes_while_it_is_read_is_refused(tmp_path, monkeypatch, change):
    path = tmp_path / "light.hdr"
    path.write_bytes(GOLDEN)
    fstat = os.fstat

    def changing_fstat(descriptor):
        status = fstat(descriptor)
        os.truncate(path, len(GOLDEN) + change)
        return status

    monkeypatch.setattr(radiance_files.os, "fstat", changing_fstat)
    with pytest.raises(LightError, match="changed meanwhile"):
        read_radiance_image(path)


def test_a_file_beyond_the_limit_is_refused_unread(tmp_path, monkeypatch, read, refusal):
    path = tmp_path / "large.hdr"
    path.write_bytes(GOLDEN)
    os.truncate(path, MAX_FILE_BYTES + 1)  # sparse, takes no room
    with pytest.raises(LightError, match=f"{MAX_FILE_BYTES + 1} bytes; the limit is {MAX_FILE_BYTES}"):
        read_radiance_image(path)
    monkeypatch.setattr(radiance_files, "MAX_FILE_BYTES", len(GOLDEN))
    read(GOLDEN)
    assert "the limit is" in refusal(GOLDEN + b"\0")


# ----------------------------------------------------------------------------------------------------- hostile bytes


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


@pytest.mark.parametrize("packing", PACKINGS)
def test_two_thousand_damaged_hdr_files_are_refused_or_finite(read, packing):
    accepted, refused = outcomes(read, hdr_file(random_texels(4, 9, seed=9), packing), 2000, "light.hdr")
    assert min(accepted, refused) > 100  # else the mutations test one branch only


def test_three_hundred_damaged_openexr_files_are_refused_or_finite(read, capfd):
    accepted, refused = outcomes(read, exr_file({"RGB": halves()}), 300, "light.exr")
    assert min(accepted, refused) > 10
    assert capfd.readouterr() == ("", "")


def test_a_scanline_of_one_byte_packets_costs_no_more_than_twenty_ordinary_ones(read):
    scanline = b"\2\2\4\0" + b"\1\x80" * 4096
    start = time.perf_counter()
    image = read(b"#?RADIANCE\n\n-Y 512 +X 1024\n" + scanline * 512)
    assert time.perf_counter() - start < 20 * 0.080  # seconds; measured 0.36, an ordinary map of that size 0.03
    assert np.all(image.pixels == 128 * 2.0**-8)


# -------------------------------------------------------------------------------------------------------- real maps


def test_the_studio_map_agrees_with_its_published_statistics():
    """environments/manifest.json: extremes of the Rec. 709 luminance, and its mean weighted by cos(latitude)."""
    image = read_radiance_image(ENVIRONMENTS / "film_studio.exr")
    luminance = image.pixels.astype(np.float64) @ (0.2126, 0.7152, 0.0722)
    weights = np.cos((np.arange(512) + 0.5) / 512 * np.pi - np.pi / 2)
    figures = [luminance.min(), luminance.max(), np.average(luminance.mean(axis=1), weights=weights)]
    expected = [2.8690576553344726e-06, 110.922175, 0.3367307134067816]
    np.testing.assert_allclose(figures, expected, rtol=1e-9, atol=0)  # sums of 5e5 float64 in another order
    assert image.pixels.shape == (512, 1024, 3)
    assert image.notes == ("3 negative values, minimum -3.04e-06, kept",)


# Mean luminance of the 1024 x 512 originals (manifest.json); averaging keeps it but for the cos(latitude) of a row
# four times as high (8e-5 at most: 1 - sin(x)/x for x = pi/256, times the contrast) and RGBE's rounding.
@pytest.mark.parametrize(
    ("name", "mean", "largest"),
    [
        ("mud_road_puresky.hdr", 0.3668752311980577, 0.8223804687499999),
        ("venice_sunset.hdr", 0.4978629794741991, 2090.5280000000002),
        ("st_fagans_interior.hdr", 0.8258693874250954, 1110.9455999999998),
    ],
)
def test_a_reduced_map_has_the_mean_of_its_original_and_no_brighter_texel(name, mean, largest):
    image = read_radiance_image(ENVIRONMENTS / name)
    luminance = image.pixels.astype(np.float64) @ (0.2126, 0.7152, 0.0722)
    weights = np.cos((np.arange(128) + 0.5) / 128 * np.pi - np.pi / 2)
    np.testing.assert_allclose(np.average(luminance.mean(axis=1), weights=weights), mean, rtol=2e-4, atol=0)
    assert 0.9 * mean < luminance.max() <= largest
    assert image.pixels.shape == (128, 256, 3)
    assert image.notes == ()
