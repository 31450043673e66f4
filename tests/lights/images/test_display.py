"""What shviewer.lights.images.display promises about PNG and JPEG files."""

import io
import struct
import subprocess
import sys
import warnings
import zlib

import numpy as np
import pytest
from lights.images.hdr_files import assert_same
from lights.images.ldr_files import GREY, GREY_ALPHA, PALETTE, RGB, RGBA, chunk, exif, png_file, saved_by_pillow
from PIL import Image, ImageFile, ImageOps

from shviewer.lights.images.chromaticities import REC709, rec709_from
from shviewer.limits import Limits

DISPLAY_P3 = ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), (0.3127, 0.3290))
REC2020 = ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), (0.3127, 0.3290))
EBU = ((0.64, 0.33), (0.29, 0.60), (0.15, 0.06), (0.3127, 0.3290))
RNG = np.random.default_rng(0)
CODES = RNG.integers(0, 256, (4, 8, 3), np.uint8)
DEEP = RNG.integers(0, 65536, (4, 8, 3), np.uint16)
SMOOTH = np.stack(np.broadcast_arrays(np.arange(40, 168, 4), np.arange(200, 72, -8)[:, None], 90), axis=2).astype(
    np.uint8
)


def light_of(codes, bits=8):
    """IEC 61966-2-1, a value at a time in float64."""

    def linear(code):
        encoded = code / (2**bits - 1)
        return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4

    return np.vectorize(linear)(np.asarray(codes, int))


def assert_light_of(pixels, codes, bits=8):
    """The table is float64 rounded once to float32, so its values are those of the definition exactly."""
    assert_same(pixels, light_of(codes, bits))


def rgb(grey):
    return np.repeat(np.asarray(grey).reshape(*grey.shape[:2], 1), 3, axis=2)


# ------------------------------------------------------------------------------------------------------ depths, colours


def test_a_png_gives_the_light_its_codes_stand_for(read):
    image = read(png_file(CODES, RGB), "light.png")
    assert_light_of(image.pixels, CODES)
    assert image.encoding == "PNG, 8 bit sRGB (LDR)"
    assert image.layout is None


def test_the_curve_is_that_of_srgb_at_known_codes(read):
    codes = np.array([[0, 10, 11, 128, 188, 255]], np.uint8)
    # 0.040449936 is the last code of the straight part in float, 10/255/12.92; 188 is middle grey of linear 0.5.
    expected = [0.0, 0.003035269835, 0.003346535764, 0.215860500, 0.502886458, 1.0]
    pixels = read(png_file(codes, GREY), "light.png").pixels
    np.testing.assert_allclose(pixels[0, :, 0], expected, rtol=1e-7, atol=0)  # float32, and ten digits above


def test_it_is_said_that_what_was_brighter_than_white_is_lost(read):
    for data, name, depth in (
        (png_file(CODES, RGB), "a.png", "8 bit"),
        (png_file(DEEP, RGB, 16), "a.png", "16 bit"),
        (saved_by_pillow(CODES, "JPEG"), "a.jpg", "8 bit"),
    ):
        (note,) = read(data, name).notes
        assert note.startswith(f"{depth} sRGB, linearised: ")
        assert "brighter than white is lost" in note
        assert "sun" in note


def test_sixteen_bits_are_read_in_full(read):
    for codes, colour_type in ((DEEP, RGB), (DEEP[..., :1], GREY)):
        image = read(png_file(codes, colour_type, 16), "light.png")
        assert_light_of(image.pixels, codes if colour_type == RGB else rgb(codes), 16)
        assert image.encoding == "PNG, 16 bit sRGB (LDR)"


@pytest.mark.parametrize("bits", [8, 16])
def test_alpha_is_dropped_with_a_note(read, bits):
    codes = (CODES if bits == 8 else DEEP).astype(int)
    alpha = RNG.integers(0, 2**bits, (4, 8, 1))
    for data, expected in (
        (png_file(np.dstack([codes, alpha]), RGBA, bits), codes),
        (png_file(np.dstack([codes[..., :1], alpha]), GREY_ALPHA, bits), rgb(codes[..., :1])),
    ):
        image = read(data, "light.png")
        assert_light_of(image.pixels, expected, bits)
        assert image.notes[1:] == ("alpha dropped",)


def test_a_transparent_colour_is_alpha_too(read):
    image = read(png_file(CODES, RGB, extra=[(b"tRNS", struct.pack(">3H", *CODES[0, 0]))]), "light.png")
    assert_light_of(image.pixels, CODES)
    assert "alpha dropped" in image.notes


@pytest.mark.parametrize("bits", [1, 2, 4])
def test_grey_of_few_bits_spans_black_to_white(read, bits):
    codes = RNG.integers(0, 2**bits, (3, 13, 1))
    image = read(png_file(codes, GREY, bits), "light.png")
    assert_light_of(image.pixels, rgb(codes * (255 // (2**bits - 1))))


@pytest.mark.parametrize("bits", [1, 2, 4, 8])
def test_a_palette_gives_its_colours(read, bits):
    palette = RNG.integers(0, 256, (2**bits, 3), np.uint8)
    codes = RNG.integers(0, 2**bits, (3, 13, 1))
    image = read(png_file(codes, PALETTE, bits, extra=[(b"PLTE", palette.tobytes())]), "light.png")
    assert_light_of(image.pixels, palette[codes[..., 0]])
    assert "alpha dropped" not in image.notes


@pytest.mark.parametrize(("codes", "bits"), [(CODES, 8), (DEEP, 16)])
def test_an_interlaced_png_is_read(read, codes, bits):
    codes = np.tile(codes, (3, 2, 1))[:11, :13]
    assert_light_of(read(png_file(codes, RGB, bits, interlaced=True), "light.png").pixels, codes, bits)


def test_every_row_filter_of_sixteen_bits_is_undone(read):
    """Filters act on bytes, so the high and the low bytes must come out of one and the same row."""
    codes = np.repeat(np.arange(5 * 300, dtype=np.uint16).reshape(5, 300, 1) * 43, 3, axis=2)
    header = struct.pack(">IIBBBBB", 300, 5, 16, RGB, 0, 0, 0)
    stored = codes.astype(">u2").reshape(5, -1).view(np.uint8).astype(int)
    left = np.pad(stored, ((0, 0), (6, 0)))[:, :-6]
    up = np.pad(stored, ((1, 0), (0, 0)))[:-1]
    corner = np.pad(left, ((1, 0), (0, 0)))[:-1]
    guess = left + up - corner
    distances = np.abs(guess - np.stack([left, up, corner]))
    paeth = np.choose(distances.argmin(axis=0), [left, up, corner])
    predicted = (np.zeros_like(stored), left, up, (left + up) // 2, paeth)
    rows = [bytes([k]) + ((stored - predicted[k])[k] % 256).astype(np.uint8).tobytes() for k in range(5)]
    data = png_file(codes, RGB, 16)
    filtered = data[:8] + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(rows))) + chunk(b"IEND", b"")
    assert_light_of(read(filtered, "light.png").pixels, codes, 16)


def test_a_jpeg_gives_nearly_the_light_it_was_made_of(read):
    image = read(saved_by_pillow(SMOOTH, "JPEG", quality=98, subsampling=0), "light.jpg")
    # Quality 98 quantises by 1 or 2: codes here are off by 2 at most, and the curve's slope is at most 2.3 / 255.
    np.testing.assert_allclose(image.pixels, light_of(SMOOTH), rtol=0, atol=2 * 2.3 / 255)
    assert image.encoding == "JPEG, 8 bit sRGB (LDR)"
    assert image.pixels.dtype == np.float32
    assert image.pixels.flags.c_contiguous


@pytest.mark.parametrize("options", [{"progressive": True}, {"subsampling": 2}, {"restart_marker_rows": 1}])
def test_the_ways_to_write_a_jpeg_are_read(read, options):
    image = read(saved_by_pillow(SMOOTH, "JPEG", quality=95, **options), "light.jpeg")
    np.testing.assert_allclose(image.pixels, light_of(SMOOTH), rtol=0, atol=0.08)  # chroma at half the size


def test_a_grey_jpeg_has_three_equal_channels(read):
    image = read(saved_by_pillow(SMOOTH[..., 0], "JPEG", quality=98), "light.jpg")
    assert image.pixels.shape == SMOOTH.shape
    assert (image.pixels == image.pixels[..., :1]).all()


def test_cmyk_is_refused_by_name(refusal):
    data = saved_by_pillow(RNG.integers(0, 256, (8, 8, 4), np.uint8), "JPEG", mode="CMYK")
    assert "colours in CMYK; only RGB and grey are read: convert it to RGB" in refusal(data, "light.jpg")


# --------------------------------------------------------------------------------------------------------- orientation


@pytest.mark.parametrize("orientation", range(1, 9))
def test_exif_orientation_is_applied(read, orientation):
    """Against Pillow's own way to turn an image."""
    block = exif(orientation)
    data = saved_by_pillow(CODES, exif=block)
    with Image.open(io.BytesIO(data)) as stored:
        upright = np.asarray(ImageOps.exif_transpose(stored))
    image = read(data, "light.png")
    assert_light_of(image.pixels, upright)
    assert any(f"EXIF orientation is {orientation}" in note for note in image.notes) == (orientation != 1)


def test_a_jpeg_taken_sideways_stands_upright(read):
    upright = read(saved_by_pillow(SMOOTH, "JPEG"), "light.jpg").pixels
    sideways = read(saved_by_pillow(SMOOTH, "JPEG", exif=exif(6)), "light.jpg").pixels
    assert_same(sideways, np.rot90(upright, -1))


@pytest.mark.parametrize(
    "block", [b"Exif\0\0", b"Exif\0\0II*\0\xff\xff\xff\xff", b"Exif\0\0MM\0*\0\0\0\x08\0\1\1\x12", exif(9)]
)
def test_nonsense_in_the_exif_data_is_no_reason_to_refuse(read, block):
    data = saved_by_pillow(SMOOTH, "JPEG", exif=block)
    assert_same(read(data, "light.jpg").pixels, read(saved_by_pillow(SMOOTH, "JPEG"), "light.jpg").pixels)


# ------------------------------------------------------------------------------------------------------- colour chunks


def gamma(value):
    return (b"gAMA", struct.pack(">I", value))


def test_a_gamma_of_its_own_is_honoured_with_a_note(read):
    for value, expected in ((100000, CODES / 255), (50000, (CODES / 255) ** 2)):
        image = read(png_file(CODES, RGB, extra=[gamma(value)]), "light.png")
        np.testing.assert_allclose(image.pixels, expected, rtol=1e-7, atol=0)  # one rounding to float32
        assert f"its gAMA of {value / 1e5:g} is honoured" in image.notes
        assert image.encoding == f"PNG, 8 bit gamma {value / 1e5:g} (LDR)"


@pytest.mark.parametrize(
    "extra",
    [
        [gamma(45455)],
        [(b"sRGB", b"\0"), gamma(100000)],
        [(b"cICP", bytes((1, 13, 0, 1))), gamma(100000)],
    ],
)
def test_what_amounts_to_srgb_is_read_as_srgb_without_a_note(read, extra):
    image = read(png_file(CODES, RGB, extra=extra), "light.png")
    assert_light_of(image.pixels, CODES)
    assert len(image.notes) == 1


@pytest.mark.parametrize("value", [0, 1, 2**31])
def test_a_senseless_gamma_is_ignored_with_a_note(read, value):
    image = read(png_file(CODES, RGB, extra=[gamma(value)]), "light.png")
    assert_light_of(image.pixels, CODES)
    assert "is ignored, sRGB assumed" in image.notes[1]


@pytest.mark.parametrize(("transfer", "name"), [(16, "PQ"), (18, "HLG")])
def test_hdr_curves_are_refused_by_name(refusal, transfer, name):
    data = png_file(DEEP, RGB, 16, extra=[(b"cICP", bytes((9, transfer, 0, 1)))])
    assert f"coded in {name}" in refusal(data, "light.png")


@pytest.mark.parametrize(("primaries", "corners"), [(12, DISPLAY_P3), (9, REC2020), (5, EBU)])
def test_stated_primaries_are_converted_with_a_note(read, primaries, corners):
    expected = light_of(CODES) @ rec709_from(corners).T
    for extra in ([(b"cICP", bytes((primaries, 13, 0, 1)))], [chrm(corners)]):
        image = read(png_file(CODES, RGB, extra=extra), "light.png")
        np.testing.assert_allclose(image.pixels, expected, rtol=0, atol=1e-6)  # float32 sums of three
        assert "converted to Rec. 709" in image.notes[1]


def chrm(corners):
    red, green, blue, white = corners
    return (b"cHRM", struct.pack(">8I", *(round(1e5 * v) for xy in (white, red, green, blue) for v in xy)))


def test_primaries_that_are_not_read_are_said_to_be_taken_for_rec_709(read):
    image = read(png_file(CODES, RGB, extra=[(b"cICP", bytes((22, 13, 0, 1)))]), "light.png")
    assert_light_of(image.pixels, CODES)
    assert image.notes[1] == "its primaries (cICP 22) are taken for Rec. 709"
    image = read(png_file(CODES, RGB, extra=[chrm(((0.3, 0.3),) * 4)]), "light.png")
    assert_light_of(image.pixels, CODES)
    assert image.notes[1].startswith("its cHRM is ignored: chromaticities")


def test_of_gama_and_chrm_both_count(read):
    image = read(png_file(CODES, RGB, extra=[gamma(50000), chrm(REC2020)]), "light.png")
    np.testing.assert_allclose(image.pixels, (CODES / 255) ** 2 @ rec709_from(REC2020).T, rtol=0, atol=1e-6)
    assert len(image.notes) == 3 + (image.pixels.min() < 0)
    assert_light_of(read(png_file(CODES, RGB, extra=[chrm(REC709)]), "light.png").pixels, CODES)


@pytest.mark.parametrize(("transfer", "exponent"), [(8, 1.0), (4, 2.2), (5, 2.8)])
def test_a_curve_that_cicp_names_is_honoured(read, transfer, exponent):
    image = read(png_file(CODES, RGB, extra=[(b"cICP", bytes((1, transfer, 0, 1)))]), "light.png")
    np.testing.assert_allclose(image.pixels, (CODES / 255) ** exponent, rtol=1e-6)
    assert image.encoding == f"PNG, 8 bit {'linear' if exponent == 1 else f'gamma {exponent:g}'} (LDR)"


def test_a_curve_that_cicp_names_and_that_is_none_of_a_display_is_said_to_be_taken_for_srgb(read):
    image = read(png_file(CODES, RGB, extra=[(b"cICP", bytes((1, 1, 0, 1)))]), "light.png")
    assert_light_of(image.pixels, CODES)
    assert image.notes[1] == "its curve (cICP 1) is taken for that of sRGB"


def test_of_two_colour_chunks_only_the_one_that_counts_is_spoken_of(read):
    profile = (b"iCCP", b"odd\0\0" + zlib.compress(b"odd"))
    assert len(read(png_file(CODES, RGB, extra=[(b"cICP", bytes((1, 13, 0, 1))), profile]), "light.png").notes) == 1
    image = read(png_file(CODES, RGB, extra=[gamma(100000), profile]), "light.png")
    assert_light_of(image.pixels, CODES)
    assert image.notes[1:] == ("its colour profile (ICC) is ignored (it is no profile), sRGB assumed",)


# ------------------------------------------------------------------------------------------------- damage, limits, bombs


def test_of_an_animated_png_the_first_frame_is_read(read):
    frames = [Image.fromarray(frame) for frame in (255 - CODES, CODES)]
    data = saved_by_pillow(CODES, save_all=True, append_images=frames)
    image = read(data, "light.png")
    assert_light_of(image.pixels, CODES)
    assert "animated: only the first frame is read" in image.notes


def test_a_broken_animation_warns_nobody(read):
    """Pillow warns of it, and warnings are errors in this test run."""
    image = read(png_file(CODES, RGB, extra=[(b"acTL", bytes(8))]), "light.png")
    assert_light_of(image.pixels, CODES)


@pytest.mark.parametrize("lenient", [False, True])
def test_every_truncation_of_a_png_is_refused(refusal, monkeypatch, lenient):
    monkeypatch.setattr(ImageFile, "LOAD_TRUNCATED_IMAGES", lenient)
    data = png_file(CODES, RGB)
    for length in range(len(data)):
        refusal(data[:length], "light.png")


def test_a_jpeg_far_too_short_for_its_size_is_refused(read, refusal):
    """What is missing would come out grey, and take gigabytes."""
    data = bytearray(saved_by_pillow(SMOOTH, "JPEG"))
    place = data.index(b"\xff\xc0") + 5
    data[place : place + 4] = struct.pack(">HH", 4096, 8192)
    assert f"{len(data)} bytes cannot hold 8192 x 4096 texels" in refusal(bytes(data), "light.jpg")
    flat = saved_by_pillow(np.full((2048, 2048), 128, np.uint8), "JPEG", optimize=True)
    assert read(flat, "flat.jpg").pixels.shape == (2048, 2048, 3)


def test_a_changed_bit_anywhere_in_the_texels_of_a_png_is_refused(refusal):
    data = png_file(CODES, RGB)
    start = data.index(b"IDAT") + 4
    for place in range(start, data.index(b"IEND") - 8):
        broken = bytearray(data)
        broken[place] ^= 16
        assert "does not match its checksum" in refusal(bytes(broken), "light.png")


def test_bytes_after_the_end_do_not_matter(read):
    data = png_file(CODES, RGB)
    assert_same(read(data + b"more", "light.png").pixels, read(data, "light.png").pixels)


def test_a_damaged_signature_or_image_is_refused_in_one_line(refusal):
    assert "signature" in refusal(png_file(CODES, RGB).replace(b"\r\n", b"\n"), "light.png")
    assert "of its texels are missing" in refusal(png_file(CODES, RGB)[:33] + chunk(b"IEND", b""), "light.png")
    headless = png_file(CODES, RGB)[:8] + chunk(b"tEXt", b"") + png_file(CODES, RGB)[8:]
    assert "does not begin with an IHDR chunk" in refusal(headless, "light.png")
    header = struct.pack(">IIBBBBB", 8, 4, 3, RGB, 0, 0, 0)  # three bits
    texels = chunk(b"IDAT", zlib.compress(bytes(1000)))
    odd = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + texels + chunk(b"IEND", b"")
    assert "damaged or cut short, Pillow says" in refusal(odd, "light.png")
    assert "goes past the end of the file" in refusal(b"\xff\xd8\xff\xe0" + bytes(50), "light.jpg")


@pytest.mark.parametrize("interlaced", [False, True])
@pytest.mark.parametrize("bits", [1, 16])
def test_a_png_with_fewer_texels_than_its_header_says_is_refused(read, refusal, bits, interlaced):
    """Checksums are right, so Pillow would leave the missing rows black."""
    for height in (1, 2, 5, 9):
        for width in (1, 3, 9):
            data = png_file(np.ones((height, width, 1), int), GREY, bits, interlaced=interlaced)
            assert_light_of(
                read(data, "light.png").pixels, np.full((height, width, 3), 2**bits - 1 if bits == 1 else 1), bits
            )
            place, end = data.index(b"IDAT"), data.index(b"IEND") - 8
            texels = zlib.decompress(data[place + 4 : end])
            short = data[: place - 4] + chunk(b"IDAT", zlib.compress(texels[:-1])) + chunk(b"IEND", b"")
            assert "the last 1 bytes of its texels are missing" in refusal(short, "light.png")


def test_only_the_first_header_and_the_image_itself_count(read):
    """Pillow would take the size from the last header, and the place of the texels from an animation's frame."""
    tall = struct.pack(">IIBBBBB", 8, 512, 8, RGB, 0, 0, 0)
    frame = struct.pack(">5IHHBB", 0, 2, 2, 1, 1, 1, 1, 0, 0)
    for extra in ([(b"IHDR", tall)], [(b"acTL", struct.pack(">II", 2, 0)), (b"fcTL", frame)]):
        assert_light_of(read(png_file(CODES, RGB, extra=extra), "light.png").pixels, CODES)


def test_an_image_in_several_pieces_is_read_wherever_they_are(read):
    data = png_file(CODES, RGB)
    place, end = data.index(b"IDAT") - 4, data.index(b"IEND") - 4
    texels = data[place + 8 : end - 4]
    pieces = [chunk(b"IDAT", texels[:20]), chunk(b"tEXt", b""), chunk(b"IDAT", b""), chunk(b"IDAT", texels[20:])]
    assert_light_of(read(data[:place] + b"".join(pieces) + data[end:], "light.png").pixels, CODES)


def test_a_png_of_nothing_but_chunks_is_refused(refusal):
    many = png_file(CODES, RGB, after=[(b"tEXt", b"")] * 2**18)
    assert "more than 262144 chunks" in refusal(many, "light.png")


@pytest.mark.parametrize(("kind", "name"), [("PNG", "light.png"), ("JPEG", "light.jpg")])
def test_the_limits_are_checked_before_decoding(read, refusal, monkeypatch, kind, name):
    data = saved_by_pillow(CODES, kind)
    read(data, name, limits=Limits(side=8, texels=32))
    monkeypatch.setattr(ImageFile.ImageFile, "load", lambda self: pytest.fail("decoded"))
    assert "a side must be 1 to 7" in refusal(data, name, limits=Limits(side=7))
    assert "the limit is 31" in refusal(data, name, limits=Limits(texels=31))


def test_no_limit_but_the_readers_own_holds(read, monkeypatch):
    """Pillow would warn from MAX_IMAGE_PIXELS on and refuse from twice as many."""
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 4)
    for data, name in ((png_file(CODES, RGB), "light.png"), (saved_by_pillow(CODES, "JPEG"), "light.jpg")):
        assert read(data, name).pixels.shape == (4, 8, 3)


def test_no_warning_filter_is_left_behind(read):
    before = list(warnings.filters)
    read(png_file(CODES, RGB), "light.png")
    assert warnings.filters == before


def test_pillow_is_not_loaded_before_a_file_needs_it():
    code = "import sys, shviewer.lights.images.display.jpeg, shviewer.lights.images.display.png; sys.exit('PIL' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
