"""What shviewer.lights.decoders.rgbe promises about .hdr files.

Pixels are compared exactly wherever the format stores them exactly; any tolerance says where it comes from.
"""

import time

import numpy as np
import pytest
from hdr_files import (
    FORMAT,
    GOLDEN,
    GOLDEN_PIXELS,
    ORIENTATIONS,
    PACKINGS,
    assert_same,
    hdr_file,
    outcomes,
    radiance_of,
    random_texels,
)

from shviewer.errors import LightError
from shviewer.lights.decoders.limits import MAX_HEADER_BYTES, Limits

TEXELS = random_texels(8, 16)
ONE_ROUNDING = 2.0**-24  # relative, float32


def test_a_file_written_by_hand_gives_the_values_worked_out_by_hand(read):
    image = read(GOLDEN)
    assert_same(image.pixels, GOLDEN_PIXELS)
    assert image.notes == ()


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
    Limits().check_size(32768, 4096)  # 2**27 texels
    Limits().check_size(1, 32768)
    for width, height in [(32768, 4097), (32769, 1), (1, 32769), (0, 1), (1, 0)]:
        with pytest.raises(LightError, match=f"{width} x {height}"):
            Limits().check_size(width, height)


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


@pytest.mark.parametrize("packing", PACKINGS)
def test_two_thousand_damaged_hdr_files_are_refused_or_finite(read, packing):
    accepted, refused = outcomes(read, hdr_file(random_texels(4, 9, seed=9), packing), 2000, "light.hdr")
    assert min(accepted, refused) > 100  # else the mutations test one branch only


def test_a_scanline_of_one_byte_packets_costs_no_more_than_twenty_ordinary_ones(read):
    scanline = b"\2\2\4\0" + b"\1\x80" * 4096
    start = time.perf_counter()
    image = read(b"#?RADIANCE\n\n-Y 512 +X 1024\n" + scanline * 512)
    assert time.perf_counter() - start < 20 * 0.080  # seconds; measured 0.36, an ordinary map of that size 0.03
    assert np.all(image.pixels == 128 * 2.0**-8)
