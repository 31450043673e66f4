"""What shviewer.lights.images.display.gain_map promises: an Ultra HDR picture is HDR, and what is not read is said."""

import io

import numpy as np
import pytest
from helpers import from_srgb
from lights.images.hdr_files import assert_same
from lights.images.ldr_files import (
    ISO,
    LINEAR_CURVE,
    P3_COLUMNS,
    SRGB_COLUMNS,
    exif,
    gain_map_iso,
    gain_map_xmp,
    icc_profile,
    saved_by_pillow,
    segment,
    ultra_hdr,
    with_segments,
    xmp,
    xmp_packet,
)
from PIL import Image

from shviewer.limits import Limits

RNG = np.random.default_rng(7)
PICTURE = np.repeat(np.repeat(RNG.integers(0, 256, (4, 8, 3), np.uint8), 8, axis=0), 8, axis=1)
MAP = np.repeat(np.repeat(RNG.integers(0, 256, (4, 8, 3), np.uint8), 8, axis=0), 8, axis=1)
ONE = {"GainMapMax": 3, "HDRCapacityMax": 3}
THREE = {
    "GainMapMin": [-0.5, 0.0, 0.25],
    "GainMapMax": [3.0, 4.0, 2.0],
    "Gamma": [1.0, 0.5, 2.0],
    "OffsetSDR": [0.015625, 0.0, 0.5],
    "OffsetHDR": [0.015625, 0.25, 0.0],
    "HDRCapacityMax": 4.0,
}


def jpeg(codes, **options):
    return saved_by_pillow(codes, "JPEG", quality=100, subsampling=0 if codes.ndim == 3 else -1, **options)


def codes_of(data):
    """The codes that are in the file, by Pillow."""
    return np.asarray(Image.open(io.BytesIO(data))).astype(np.float64)


def formula(light, share, low, high, gamma, base, alternate):
    """The recipe of the specification, a channel at a time in float64."""
    channels = []
    for i in range(3):
        gain = np.exp2(low[i] + (high[i] - low[i]) * share[..., i] ** (1 / gamma[i]))
        channels.append(np.maximum((light[..., i] + base[i]) * gain - alternate[i], 0))
    return np.stack(channels, axis=-1)


def three(settings):
    defaults = {"GainMapMin": 0.0, "Gamma": 1.0, "OffsetSDR": 1 / 64, "OffsetHDR": 1 / 64}
    names = ("GainMapMin", "GainMapMax", "Gamma", "OffsetSDR", "OffsetHDR")
    return [np.broadcast_to({**defaults, **settings}[name], 3) for name in names]


CHANNELS = [tuple(float(field[i]) for field in three(THREE)) for i in range(3)]
WAYS = {
    "XMP, one number": (gain_map_xmp(**ONE), ONE),
    "XMP, three numbers": (gain_map_xmp(**THREE), THREE),
    "ISO, one channel": (gain_map_iso([(0.0, 3.0, 1.0, 1 / 64, 1 / 64)], 3.0), ONE),
    "ISO, three channels": (gain_map_iso(CHANNELS, 4.0), THREE),
    "ISO, one denominator": (gain_map_iso(CHANNELS, 4.0, denominator=1 << 20), THREE),
}


@pytest.mark.parametrize(("metadata", "settings"), WAYS.values(), ids=WAYS)
@pytest.mark.parametrize("grey", [False, True])
def test_a_gain_map_is_applied_at_its_full_headroom(read, metadata, settings, grey):
    picture, gain_map = jpeg(PICTURE), jpeg(MAP[..., 0].copy() if grey else MAP)
    image = read(ultra_hdr(picture, gain_map, metadata), "light.jpg")
    share = codes_of(gain_map).reshape(*MAP.shape[:2], -1) / 255
    expected = formula(from_srgb(codes_of(picture) / 255), np.broadcast_to(share, PICTURE.shape), *three(settings))
    np.testing.assert_allclose(image.pixels, expected, rtol=1e-5, atol=1e-6)  # float32 in powers and differences
    assert image.encoding == "JPEG, 8 bit sRGB with a gain map (HDR)"
    stops = settings["HDRCapacityMax"]
    assert f"gain map at full headroom, linearised: what was brighter than {2**stops:g} times white" in image.notes[0]


def test_a_coarse_map_is_interpolated_between_its_texels(read):
    """A ramp in steps of 8 texels becomes a ramp: linear between the centres, constant beyond the outermost."""
    ramp = np.tile(np.arange(0, 256, 36, dtype=np.uint8)[:8], (4, 1))
    picture, gain_map = jpeg(np.full((32, 64, 3), 255, np.uint8)), jpeg(ramp)
    settings = {"GainMapMax": 1, "OffsetSDR": 0, "OffsetHDR": 0, "HDRCapacityMax": 1}
    image = read(ultra_hdr(picture, gain_map, gain_map_xmp(**settings)), "light.jpg")
    centres = np.clip((np.arange(64) + 0.5) / 8 - 0.5, 0, 7)
    expected = np.exp2(np.interp(centres, np.arange(8), codes_of(gain_map)[0]) / 255)
    np.testing.assert_allclose(image.pixels[5, :, 1], expected, rtol=1e-5)


def test_both_ways_to_say_it_are_one_light_and_iso_comes_first(read):
    picture, gain_map = jpeg(PICTURE), jpeg(MAP)
    both = gain_map_xmp(GainMapMax=1, HDRCapacityMax=1) + WAYS["ISO, three channels"][0]
    assert_same(
        read(ultra_hdr(picture, gain_map, both), "light.jpg").pixels,
        read(ultra_hdr(picture, gain_map, WAYS["XMP, three numbers"][0]), "light.jpg").pixels,
    )


BETWEEN = {
    "zeros": bytes(1000),
    "a preview": saved_by_pillow(PICTURE[:16, :16].copy(), "JPEG"),
    "what begins like a picture": b"\xff\xd8\xff\xe0\xff\xff",
}


@pytest.mark.parametrize("between", BETWEEN.values(), ids=BETWEEN)
def test_the_map_is_found_wherever_it_follows(read, between):
    plain = ultra_hdr(jpeg(PICTURE), jpeg(MAP), gain_map_xmp(**ONE))
    found = read(ultra_hdr(jpeg(PICTURE), jpeg(MAP), gain_map_xmp(**ONE), between), "light.jpg")
    assert_same(found.pixels, read(plain, "light.jpg").pixels)


def test_picture_and_map_are_turned_together(read):
    data = ultra_hdr(jpeg(PICTURE, exif=exif(6)), jpeg(MAP), gain_map_xmp(**ONE))
    upright = read(ultra_hdr(jpeg(PICTURE), jpeg(MAP), gain_map_xmp(**ONE)), "light.jpg").pixels
    assert_same(read(data, "light.jpg").pixels, np.rot90(upright, -1))


def test_the_gain_belongs_to_the_primaries_that_its_metadata_name(read):
    """In the picture's (the flag of ISO, and XMP) or in those of the map's own profile."""
    p3, linear_srgb = icc_profile("P3", P3_COLUMNS), icc_profile("s", SRGB_COLUMNS, (LINEAR_CURVE,))
    picture = jpeg(PICTURE, icc_profile=p3)
    light = from_srgb(codes_of(picture) / 255)
    srgb, wide = np.transpose(SRGB_COLUMNS), np.transpose(P3_COLUMNS)
    to_709 = np.linalg.inv(srgb) @ wide
    numbers = [np.full(3, v) for v in (0.0, 3.0, 1.0, 1 / 64, 1 / 64)]
    gain_map = jpeg(MAP, icc_profile=linear_srgb)
    share = codes_of(gain_map) / 255
    channel = [(0.0, 3.0, 1.0, 1 / 64, 1 / 64)]
    in_its_own = read(ultra_hdr(picture, gain_map, gain_map_iso(channel, 3.0)), "light.jpg").pixels
    np.testing.assert_allclose(in_its_own, formula(light, share, *numbers) @ to_709.T, rtol=0, atol=3e-3)
    in_the_maps = read(ultra_hdr(picture, gain_map, gain_map_iso(channel, 3.0, flags=0)), "light.jpg").pixels
    np.testing.assert_allclose(in_the_maps, formula(light @ to_709.T, share, *numbers), rtol=0, atol=3e-3)
    assert np.abs(in_its_own - in_the_maps).max() > 0.1


APPLE = xmp(b"<x xmlns:HDRGainMap='http://ns.apple.com/HDRGainMap/1.0/'/>")
ENTITIES = "<!DOCTYPE x [<!ENTITY a '9'><!ENTITY b '&a;&a;&a;&a;&a;&a;'>]>"
NOT_READ = {
    "Apple's kind": (APPLE, "Apple's own kind"),
    "an HDR base in XMP": (gain_map_xmp(**ONE, BaseRenditionIsHDR="True"), "the picture itself is the HDR one"),
    "an HDR base in ISO": (gain_map_iso([(0, 3, 1, 0, 0)], 3, flags=0x44), "the picture itself is the HDR one"),
    "a version to come": (gain_map_iso([(0, 3, 1, 0, 0)], 3, version=1), "version 1 of ISO 21496-1"),
    "ISO cut short": (segment(0xE2, ISO + bytes(9)), "its numbers are cut short"),
    "no denominator": (segment(0xE2, ISO + b"\0\0\0\0\x40" + bytes(56)), "its numbers make no sense"),
    "no maximum": (gain_map_xmp(HDRCapacityMax=3), "no number GainMapMax"),
    "no number": (gain_map_xmp(GainMapMax="bright", HDRCapacityMax=3), "no number GainMapMax"),
    "too many numbers": (gain_map_xmp(GainMapMax=[1] * 4, HDRCapacityMax=3), "no number GainMapMax"),
    "a thousand stops": (gain_map_xmp(GainMapMax=1000, HDRCapacityMax=3), "its numbers make no sense"),
    "not a number": (gain_map_xmp(GainMapMax="nan", HDRCapacityMax=3), "its numbers make no sense"),
    "gamma 0": (gain_map_xmp(**ONE, Gamma=0), "its numbers make no sense"),
    "entities": (xmp(xmp_packet("hdrgm:GainMapMax='&b;'", head=ENTITIES)), "it does not follow the picture"),
    "no metadata": (b"", "it does not follow the picture"),
}


@pytest.mark.parametrize(("metadata", "reason"), NOT_READ.values(), ids=NOT_READ)
def test_a_gain_map_that_is_not_read_is_said_to_be_not_read_and_why(read, metadata, reason):
    picture = jpeg(PICTURE)
    image = read(ultra_hdr(picture, jpeg(MAP), metadata), "light.jpg")
    assert_same(image.pixels, read(picture, "light.jpg").pixels)
    assert image.notes[1].startswith("its gain map is not read (")
    assert reason in image.notes[1]
    assert image.encoding == "JPEG, 8 bit sRGB (LDR)"


def test_a_map_that_is_cut_short_or_too_large_is_not_read(read):
    whole = ultra_hdr(jpeg(PICTURE), jpeg(MAP), gain_map_xmp(**ONE))
    assert "its gain map is not read (it does not follow" in read(whole[: -len(jpeg(MAP)) // 2], "light.jpg").notes[1]
    broken = whole.replace(b"\xff\xd9", b"") + b"\xff\xd9"
    assert "its gain map is not read" in " ".join(read(broken[:-200], "light.jpg").notes)
    large = ultra_hdr(jpeg(PICTURE), jpeg(np.zeros((64, 128), np.uint8)), gain_map_xmp(**ONE))
    image = read(large, "light.jpg", limits=Limits(side=64))
    assert "its gain map is not read (image of 128 x 64 texels" in image.notes[1]


def test_a_list_of_pictures_without_a_gain_map_says_nothing(read):
    """Stereo pairs and previews."""
    picture = with_segments(jpeg(PICTURE), segment(0xE2, b"MPF\0" + bytes(80)))
    assert len(read(picture + jpeg(MAP), "light.jpg").notes) == 1
