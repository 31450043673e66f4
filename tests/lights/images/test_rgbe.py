"""What shviewer.lights.images.rgbe promises about .hdr files.

Pixels are compared exactly wherever the format stores them exactly; any tolerance says where it comes from.
"""

import tracemalloc

import numpy as np
import pytest
from lights.images.hdr_files import (
    FORMAT,
    GOLDEN,
    GOLDEN_PIXELS,
    ORIENTATIONS,
    PACKINGS,
    assert_same,
    hdr_file,
    mutated,
    one_value_packets,
    radiance_of,
    random_texels,
)

from shviewer.errors import LightError
from shviewer.lights.images import rgbe_scanlines
from shviewer.lights.images.chromaticities import rec709_from
from shviewer.lights.images.rgbe import MAX_HEADER_BYTES, decode_rgbe
from shviewer.limits import Limits

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


def test_every_exponent_is_exact():
    """Also those of which a reader of files refuses to make a light."""
    texels = np.full((1, 256, 4), 200, np.uint8)
    texels[0, :, 1], texels[0, :, 2], texels[0, :, 3] = 1, 255, np.arange(256)
    pixels = decode_rgbe(hdr_file(texels)).pixels
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
        {"settings": (b"#?RADIANCE", b"# Made with Adobe Photoshop", b"GAMMA=1", FORMAT)},
        {"settings": (b"PRIMARIES= .6400 .3300 .3000 .6000 .1500 .0600 .3127 .3290", b"PIXASPECT=0.5", FORMAT)},
        {"settings": (FORMAT, b"", b"")[:1]},
        {"settings": (b"VIEW= -vtl -vp 0 0 0", b"SOFTWARE=x\xff", FORMAT + b" ", b"EXPOSURE=1", b"COLORCORR=1 1 1")},
        {"settings": (FORMAT, b"\tEXPOSURE=3", b" COLORCORR= 1 2 3", b"\tFORMAT=32-bit_rle_xyze")},
        {"settings": (FORMAT, b"#" + b"x" * 60000)},
    ],
    ids=[
        "RGBE",
        "rpict",
        "CRLF",
        "no FORMAT",
        "Photoshop",
        "Rec. 709",
        "FORMAT",
        "settings",
        "indented history",
        "long comment",
    ],
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


@pytest.mark.parametrize(
    ("packings", "words"),
    [
        (("flat",), "Radiance RGBE, not packed"),
        (("old",), "Radiance RGBE, old run-length packing"),
        (("old", "flat"), "Radiance RGBE, old run-length packing"),
        (("new",), "Radiance RGBE, new run-length packing"),
        (("new", "flat"), "Radiance RGBE, mixed packing"),
        (("old", "new"), "Radiance RGBE, mixed packing"),
    ],
)
def test_the_encoding_names_the_packing(read, packings, words):
    texels = random_texels(8, 16)
    texels[:, :2] = texels[:, :1]  # a run in every scanline
    assert read(mixed(texels, packings)).encoding == words


def mixed(texels, packings):
    """A file whose scanlines take these packings in turn."""
    height, width = texels.shape[:2]
    ending = b"-Y 1 +X %d\n" % width
    rows = [hdr_file(texels[y : y + 1], packings[y % len(packings)]).partition(ending)[2] for y in range(height)]
    return b"#?RADIANCE\n\n-Y %d +X %d\n" % (height, width) + b"".join(rows)


# ------------------------------------------------------------------------------------- .hdr, many scanlines at once


@pytest.mark.parametrize("size", [(63, 9), (64, 9), (65, 8), (300, 300), (70, 5000)])
def test_many_scanlines_give_every_value_exactly(read, size):
    texels = random_texels(*size, seed=11)
    assert_same(read(hdr_file(texels)).pixels, radiance_of(texels))


@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_a_rotated_order_of_many_scanlines_is_undone(read, orientation):
    texels = random_texels(90, 110, seed=12)
    assert_same(read(hdr_file(texels, "new", orientation)).pixels, radiance_of(texels))


@pytest.mark.parametrize("decoys", [0, 1, 3, 4, 40])
def test_values_that_look_like_the_beginning_of_a_scanline_are_values(read, decoys):
    header = b"\2\2\0\xc8"  # 200 texels
    channel = (b"\4" + header) * decoys + b"\x81\x82" * (200 - 4 * decoys)
    file = b"#?RADIANCE\n\n-Y 80 +X 200\n" + (header + channel * 3 + b"\xff\x88\xc9\x88") * 80
    assert file.count(header) == 80 * (1 + 3 * decoys)
    expected = [2, 2, 0, 200] * decoys + [130] * (200 - 4 * decoys)
    assert_same(read(file).pixels, np.broadcast_to(np.array(expected)[:, None], (80, 200, 3)))


def test_texels_after_the_picture_are_no_part_of_it(read):
    texels = random_texels(80, 20, seed=14)
    assert_same(read(hdr_file(texels) + hdr_file(texels, settings=())).pixels, radiance_of(texels))


@pytest.mark.parametrize("packings", [("new", "old", "flat"), ("old", "new"), ("new",) * 70 + ("flat",) * 30])
def test_many_scanlines_of_all_packings_may_alternate(read, packings):
    texels = random_texels(100, 50, seed=15)
    assert_same(read(mixed(texels, packings)).pixels, radiance_of(texels))


def test_runs_of_every_length_and_packets_of_every_size_are_read(read):
    """A run of one, which no sensible encoder writes, is a packet like any other."""
    scanlines = b""
    for n in range(1, 129):
        run = min(n, 127)
        channel = bytes((128 + run, 7)) + b"\x81\x08" * (128 - run)
        literal = bytes((n, *range(n))) + b"\1\x09" * (128 - n)
        scanlines += b"\2\2\0\x80" + channel + literal + channel + b"\xff\x88\1\x88"
    pixels = read(b"#?RADIANCE\n\n-Y 128 +X 128\n" + scanlines).pixels
    for n in range(1, 129):
        run = min(n, 127)
        np.testing.assert_array_equal(pixels[n - 1, :, 0], [7] * run + [8] * (128 - run))
        np.testing.assert_array_equal(pixels[n - 1, :, 1], [*range(n)] + [9] * (128 - n))
        np.testing.assert_array_equal(pixels[n - 1, :, 2], pixels[n - 1, :, 0])


DAMAGE = {
    "packet of length 0": (b"\2\2\0\x08" + b"\x88\x01" + b"\0" * 64, "packet of length 0 at byte {6}"),
    "other length": (b"\2\2\0\x09" + b"\x89\x01" * 4, "it states 9 texels where the header has 8"),
    "run too long": (b"\2\2\0\x08" + b"\x89\x01" + b"\x87\1" + b"\x88\1" * 2, "packet before byte {6} runs past"),
    "literals too long": (b"\2\2\0\x08" + b"\x88\1" * 3 + b"\x09" + bytes(9), "packet before byte {20} runs past"),
}


@pytest.mark.parametrize(("scanline", "fragment"), DAMAGE.values(), ids=DAMAGE)
@pytest.mark.parametrize("before", [0, 1, 70, 99])
def test_damage_among_many_scanlines_is_refused_with_its_scanline_and_byte(refusal, scanline, fragment, before):
    whole = b"\2\2\0\x08" + b"\x88\x01" * 4
    header = b"#?RADIANCE\n\n-Y 100 +X 8\n"
    message = refusal(header + whole * before + scanline + whole * (99 - before))
    start = len(header) + len(whole) * before
    for offset in (6, 20):
        fragment = fragment.replace(f"{{{offset}}}", str(start + offset))
    assert fragment in message
    assert f"damaged scanline {before} " in message


@pytest.mark.parametrize("missing", [1, 2, 5, 300])
def test_many_scanlines_that_are_cut_short_are_refused_with_the_scanline(refusal, missing):
    whole = hdr_file(np.full((100, 8, 4), 130, np.uint8))  # 12 bytes a scanline, 8 texels in four packets
    assert f"cut short in scanline {99 - (missing - 1) // 12} of 100" in refusal(whole[:-missing])


@pytest.mark.parametrize("seed", range(3))
def test_many_scanlines_at_once_are_read_and_refused_as_one_after_the_other(read, monkeypatch, seed):
    """Whatever a mutation does: the same pixels, or the same words."""
    seed_bytes = hdr_file(random_texels(70, 9, seed=16 + seed))
    rng = np.random.default_rng(seed)
    files = [seed_bytes, *(mutated(seed_bytes, rng) for _ in range(200))]
    at_once = [outcome(read, file) for file in files]
    monkeypatch.setattr(rgbe_scanlines, "_FEWEST_WALKED_AT_ONCE", 10**9)
    assert at_once == [outcome(read, file) for file in files]


def outcome(read, file):
    try:
        return read(file).pixels.tobytes()
    except LightError as error:
        return str(error)


def test_packets_of_one_value_are_read(read):
    assert np.all(read(one_value_packets(128, 300)).pixels == 128 * 2.0**-8)


# --------------------------------------------------------------------------------------------- .hdr, colours and notes

XYZE = b"FORMAT=32-bit_rle_xyze"
REC2020 = b"PRIMARIES=0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290"
STANDARD = b"PRIMARIES= 0.6400 0.3300 0.2900 0.6000 0.1500 0.0600 0.3333 0.3333"  # as Radiance writes its own


def area(a, b, c):
    """Twice that of the triangle."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])


def xyz_of(rgb):
    """(..., 3) RGB of Radiance's primaries -> XYZ: the white is their centre of mass, and mass is X + Y + Z."""
    r, g, b, white = (0.64, 0.33), (0.29, 0.60), (0.15, 0.06), (1 / 3, 1 / 3)
    masses = np.array([area(white, g, b), area(r, white, b), area(r, g, white)]) / area(r, g, b) / white[1]
    return rgb @ (masses[:, None] * [(x, y, 1 - x - y) for x, y in (r, g, b)])


def test_the_ruler_knows_the_luminances_that_radiance_prints():
    np.testing.assert_allclose(xyz_of(np.eye(3))[:, 1], (0.265, 0.670, 0.065), rtol=0, atol=5e-4)


def test_xyze_becomes_the_rgb_that_radiance_converts_it_to(read):
    image = read(hdr_file(TEXELS, settings=(XYZE,)))
    stored = radiance_of(TEXELS)
    scale = np.abs(stored).max(axis=-1, keepdims=True)
    error = np.abs(179.0 * xyz_of(image.pixels.astype(np.float64)) - stored)
    assert np.all(error <= 1e-6 * scale)  # rounding to float32, up to three times in the sum
    assert image.encoding == "Radiance XYZE, new run-length packing"
    assert image.notes[0] == "XYZE converted to RGB of Radiance's primaries, 179 lm/W"


def test_an_rgbe_picture_written_as_xyze_gives_its_own_colours_again(read):
    """ra_xyze leaves the numbers in W and states the efficacy as an exposure of 1/179."""
    settings = (XYZE, b"EXPOSURE=%.17e" % (1 / 179))
    texels = np.array([[[85, 85, 85, 130], [200, 200, 200, 128]] * 8], np.uint8)
    grey = read(hdr_file(texels, settings=settings)).pixels
    np.testing.assert_allclose(grey, radiance_of(texels), rtol=1e-6, atol=0)  # the white of both is equal energy


def test_xyze_with_primaries_becomes_rec_709(read):
    """As if converted by ra_xyze -r, which states Radiance's primaries and an exposure of 179, and read again."""
    texels = random_texels(2, 8, seed=17)
    image = read(hdr_file(texels, settings=(XYZE, REC2020)))
    rgb = read(hdr_file(texels, settings=(XYZE,))).pixels
    expected = rgb @ rec709_from([[0.64, 0.33], [0.29, 0.60], [0.15, 0.06], [1 / 3, 1 / 3]]).T
    scale = np.abs(rgb).max(axis=-1, keepdims=True)
    assert np.all(np.abs(image.pixels - expected) <= 1e-6 * scale)  # float32
    assert image.notes[0] == "XYZE converted to Rec. 709, 179 lm/W"


def test_radiance_s_own_primaries_stated_are_the_light_of_a_file_that_states_none(read):
    for colours in (FORMAT, XYZE):
        image = read(hdr_file(TEXELS, settings=(colours, STANDARD)))
        assert_same(image.pixels, read(hdr_file(TEXELS, settings=(colours,))).pixels)
        assert "PRIMARIES are Radiance's own: taken for Rec. 709, as in a file that states none" in image.notes


def test_stated_primaries_are_converted_with_a_note(read):
    image = read(hdr_file(TEXELS, settings=(FORMAT, REC2020)))
    primaries = np.array([float(word) for word in REC2020.split(b"=")[1].split()]).reshape(4, 2)
    stored = radiance_of(TEXELS)
    expected = stored @ rec709_from(primaries).T
    scale = np.abs(stored).max(axis=-1, keepdims=True)
    assert np.all(np.abs(image.pixels - expected) <= 2 * ONE_ROUNDING * scale)
    assert image.notes[0].startswith("PRIMARIES 0.")
    assert image.notes[0].endswith("converted to Rec. 709")


@pytest.mark.parametrize(
    ("line", "note"),
    [
        (b"PRIMARIES=0 0 0 0 0 0 0 0", "PRIMARIES ignored: all are 0"),
        (b"PRIMARIES=0.64 0.33", "'PRIMARIES=0.64 0.33' ignored: it is not eight numbers"),
        (b"PRIMARIES=a b c d e f g h", "ignored: it is not eight numbers"),
        (b"PRIMARIES=nan 0.33 0.3 0.6 0.15 0.06 0.31 0.33", "PRIMARIES ignored: chromaticities (nan, 0.33)"),
        (b"PRIMARIES=1 1 1 1 1 1 1 1", "must span a triangle"),
        (b"GAMMA=2.2", "'GAMMA=2.2' ignored: the texels are linear by definition"),
        (b"GAMMA=0.454545", "if ImageMagick wrote it, they are sRGB codes: make it anew with -colorspace RGB"),
        (b"GAMMA=\x1b[2J", "\\x1b[2J' ignored"),
        (b"FORMAT=", "'FORMAT=' ignored"),
        (b"EXPOSURE=0", "'EXPOSURE=0' ignored: it is not one finite number above 0"),
        (b"EXPOSURE=-1", "'EXPOSURE=-1' ignored"),
        (b"EXPOSURE=nan", "'EXPOSURE=nan' ignored"),
        (b"EXPOSURE=", "'EXPOSURE=' ignored"),
        (b"EXPOSURE=bright", "'EXPOSURE=bright' ignored"),
        (b"EXPOSURE=1,000.5", "'EXPOSURE=1,000.5' ignored"),
        (b"EXPOSURE=5e-324", "'EXPOSURE=5e-324' ignored"),
        (b"COLORCORR=0 0 0", "'COLORCORR=0 0 0' ignored: it is not 3 finite numbers above 0"),
        (b"COLORCORR=1", "'COLORCORR=1' ignored"),
        (b"COLORCORR=1 inf 1", "'COLORCORR=1 inf 1' ignored"),
    ],
)
def test_a_setting_without_sense_is_ignored_with_a_note(read, line, note):
    image = read(hdr_file(TEXELS, settings=(FORMAT, line)))
    assert_same(image.pixels, radiance_of(TEXELS))
    assert len(image.notes) == 1
    assert note in image.notes[0]
    assert image.notes[0].isprintable()


@pytest.mark.parametrize("exposure", [b"1e200", b"1e-200"])
def test_an_exposure_that_leads_out_of_the_range_of_numbers_is_ignored_with_a_note(read, exposure):
    line = b"EXPOSURE=" + exposure
    alone, twice = (read(hdr_file(TEXELS, settings=(FORMAT, *[line] * n)), sanitize=True) for n in (1, 2))
    assert_same(twice.pixels, alone.pixels)
    assert f"'{line.decode()}' ignored: with the lines before it, it leaves the range of numbers" in twice.notes


@pytest.mark.parametrize("line", [b"EXPOSURE=2,50", b"EXPOSURE =2.5", b"COLORCORR=2,5 2,5 2,5"])
def test_a_comma_is_a_decimal_comma_where_one_number_is_due(read, line):
    image = read(hdr_file(TEXELS, settings=(FORMAT, line)))
    np.testing.assert_allclose(image.pixels, radiance_of(TEXELS) / 2.5, rtol=ONE_ROUNDING, atol=0)
    assert image.notes[0].endswith("divided out")
    assert any("read with a decimal comma" in note for note in image.notes) == (b"," in line)


# Sizes, behind the settings: as the format has them, and as programs write them.
HEADERS = {
    "an empty line": b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 8 +X 16\n",
    "two empty lines": b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n\n-Y 8 +X 16\n",
    "no empty line": b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n-Y 8 +X 16\n",
    "an empty line behind the magic": b"#?RADIANCE\n\nFORMAT=32-bit_rle_rgbe\n# made\nEXPOSURE=2\n\n-Y 8 +X 16\n",
    "CR LF": b"#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\nEXPOSURE=2\r\n\r\n-Y 8 +X 16\r\n",
    "CR alone": b"#?RADIANCE\rFORMAT=32-bit_rle_rgbe\rEXPOSURE=2\r\r-Y 8 +X 16\r",
    "small letters": b"#?radiance\nFORMAT=32-bit_RLE_rgbe\nEXPOSURE=2\n\n-y 8 +x 16\n",
    "a byte order mark": b"\xef\xbb\xbf#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 8 +X 16\n",
    "CR among LF": b"#?RADIANCE\n# a\rb\nEXPOSURE=2\n\n-Y 8 +X 16\n",
}


@pytest.mark.parametrize("header", HEADERS.values(), ids=HEADERS)
@pytest.mark.parametrize("first", [b"\x80", b"\n", b"\r"])
def test_a_header_is_read_as_programs_write_it(read, header, first):
    """The first texel may look like the end of a line."""
    texels = TEXELS.copy()
    texels[0, 0] = (first[0], 100, 200, 130)
    flat = hdr_file(texels, "flat").partition(b"-Y 8 +X 16\n")[2]
    assert_same(read(header + flat).pixels, radiance_of(texels) / 2)


# ----------------------------------------------------------------------------------------------- .hdr, refused files


@pytest.mark.parametrize(
    ("settings", "fragment"),
    [
        ((b"FORMAT=Radiance_rle_spectra",), "FORMAT=Radiance_rle_spectra"),
        ((FORMAT, b"FORMAT=\x1b[2Jnonsense"), r"\x1b[2Jnonsense"),
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
    tracemalloc.start()
    message = refusal(b"#?RADIANCE\n\n-Y 4096 +X 32767\n" + bytes(100))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert "100 bytes of texels; 4096 scanlines take at least 32768" in message
    assert peak < 2**22  # the pixels would be 1.5 GB


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
