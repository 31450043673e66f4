"""What shviewer.lights.images.openexr and its helpers promise about .exr files."""

import os
import struct
import subprocess
import sys
import tracemalloc
import warnings
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import numpy as np
import OpenEXR
import pytest
from lights.images.exr_files import (
    MIP_MAPPED,
    ONE_LEVEL,
    RIP_MAPPED,
    deep_part,
    luminance_chroma_exr,
    luminance_chroma_of,
    tiled_exr,
)
from lights.images.hdr_files import (
    assert_same,
    bare_exr,
    exr_file,
    exr_part,
    exr_parts,
    halves,
    mutated,
    outcomes,
    window,
)

from shviewer.errors import LightError
from shviewer.lights.images import openexr
from shviewer.lights.images.chromaticities import REC709, rec709_from
from shviewer.lights.images.openexr import decode_openexr
from shviewer.lights.images.openexr_parts import part_alone
from shviewer.limits import Limits

# ------------------------------------------------------------------------------------------------ .exr, valid files

LOSSLESS = ("NO", "RLE", "ZIP", "ZIPS", "PIZ", "HTJ2K32", "HTJ2K256", "ZSTD")


@pytest.mark.parametrize("compression", LOSSLESS)
@pytest.mark.parametrize("dtype", [np.float16, np.float32])
def test_a_lossless_openexr_file_gives_its_values_exactly(read, compression, dtype):
    pixels = halves(20, 40).astype(dtype)
    pixels[3, 5] = (1, 2, 3)
    data = exr_file({"RGB": pixels}, compression=getattr(OpenEXR, f"{compression}_COMPRESSION"))
    image = read(data, "light.exr")
    assert_same(image.pixels, pixels)
    assert image.notes == ()
    kind = "half" if dtype == np.float16 else "float"
    assert image.encoding == f"OpenEXR, {kind}, {compression.replace('NO', 'uncompressed')}"
    assert image.layout is None


@pytest.mark.parametrize("compression", ["DWAA", "DWAB", "PXR24", "B44", "B44A"])
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


@pytest.mark.parametrize("compression", LOSSLESS)
def test_a_tiled_openexr_file_is_read(read, compression):
    pixels = halves(40, 80)
    codec = getattr(OpenEXR, f"{compression}_COMPRESSION")
    data = exr_file({"RGB": pixels}, type=OpenEXR.tiledimage, tiles=OpenEXR.TileDescription(), compression=codec)
    image = read(data, "light.exr")
    assert_same(image.pixels, pixels)
    assert image.encoding.endswith(", tiled")


@pytest.mark.parametrize(
    ("mode", "word"), [(ONE_LEVEL, ""), (MIP_MAPPED, ", mip-mapped"), (RIP_MAPPED, ", rip-mapped")]
)
def test_of_several_levels_the_finest_is_read(read, mode, word):
    pixels = halves(37, 70)
    image = read(tiled_exr(pixels, mode), "light.exr")
    assert_same(image.pixels, pixels)
    assert image.encoding == f"OpenEXR, half, uncompressed, tiled{word}"


def test_every_half_keeps_its_value():
    patterns = np.arange(2**16, dtype=np.uint16).reshape(256, 256)
    halves_of_all_kinds = patterns.view(np.float16)
    decoded = decode_openexr(exr_file({"Y": halves_of_all_kinds}, compression=OpenEXR.NO_COMPRESSION)).pixels
    with np.errstate(invalid="ignore"):
        expected = halves_of_all_kinds.astype(np.float32)
    assert_same(decoded, np.dstack([expected] * 3))


def test_alpha_is_ignored(read):
    rgba = np.dstack([halves(), np.zeros((4, 8), np.float16)])
    image = read(exr_file({"RGBA": rgba}), "light.exr")
    assert_same(image.pixels, rgba[..., :3])
    assert image.notes == ()


def test_integers_are_taken_at_their_value(read):
    pixels = np.arange(96, dtype=np.uint32).reshape(4, 8, 3)
    image = read(exr_file({"RGB": pixels}), "light.exr")
    assert_same(image.pixels, pixels)
    assert image.encoding == "OpenEXR, uint, ZIP"
    assert image.notes == ("its texels are whole numbers (uint), taken as radiance",)


def test_channels_of_mixed_types_are_read(read):
    red, green, blue = halves().transpose(2, 0, 1).copy()
    data = exr_file({"R": red, "G": green.astype(np.float32), "B": (100 * blue).astype(np.uint32)})
    image = read(data, "light.exr")
    assert_same(image.pixels, np.dstack([red, green, (100 * blue).astype(np.uint32)]))
    assert image.encoding == "OpenEXR, half/float/uint, ZIP"


def test_a_luminance_file_is_grey(read):
    luminance = halves()[..., 0].copy()
    image = read(exr_file({"Y": luminance, "Z": luminance}, chromaticities=AP1), "light.exr")
    assert_same(image.pixels, np.dstack([luminance] * 3))
    assert image.encoding == "OpenEXR, half, ZIP, luminance"
    assert image.notes == ()


def test_a_lat_long_attribute_is_handed_on(read):
    image = read(exr_file({"RGB": halves()}, envmap=OpenEXR.ENVMAP_LATLONG), "light.exr")
    assert_same(image.pixels, halves())
    assert image.layout == "lat-long"


def test_a_cube_attribute_is_handed_on():
    pixels = halves(24, 4)
    image = decode_openexr(exr_file({"RGB": pixels}, envmap=OpenEXR.ENVMAP_CUBE))
    assert_same(image.pixels, pixels)
    assert image.layout == "cube"


# -------------------------------------------------------------------------------------------------- layers and parts


def layer(name, pixels):
    """Channels of a layer, "" for none."""
    prefix = f"{name}." if name else ""
    return {prefix + c: pixels[..., i].copy() for i, c in enumerate("RGB")}


@pytest.mark.parametrize("name", ["key.diffuse", "View Layer.Combined"])
def test_the_only_layer_with_colours_is_read_with_a_note(read, name):
    plane = halves()[..., 0].copy()
    data = exr_file({**layer(name, halves()), "depth.Z": plane, "mask.R": plane, "luma.Y": plane})
    image = read(data, "light.exr")
    assert_same(image.pixels, halves())
    assert image.notes == (f"layer {name} read, the only one with colours",)


def test_colours_in_a_layer_win_over_a_luminance_without(read):
    plane = halves()[..., 0].copy()
    assert_same(read(exr_file({**layer("diffuse", halves()), "Y": plane}), "light.exr").pixels, halves())


def test_channels_without_a_layer_win_over_layers(read):
    data = exr_file({**layer("", halves()), **layer("specular", 0 * halves())})
    assert_same(read(data, "light.exr").pixels, halves())


def test_a_named_layer_wins_over_channels_without(read):
    data = exr_file({**layer("", 0 * halves()), **layer("key.diffuse", halves()), **layer("key", 0 * halves())})
    image = read(data, "light.exr", layer="key.diffuse")
    assert_same(image.pixels, halves())
    assert image.notes == ()


def test_a_layer_of_luminance_can_be_named(read):
    plane = halves()[..., 0].copy()
    data = exr_file({**layer("", halves()), "mask.Y": plane})
    assert_same(read(data, "light.exr", layer="mask").pixels, np.dstack([plane] * 3))


def test_the_only_part_with_colours_is_read_and_counted(read):
    depth = exr_part("depth", {"Z": np.ones((4, 8), np.float32)})
    normals = exr_part("normals", {f"N.{c}": np.ones((4, 8), np.float32) for c in "XYZ"})
    image = read(exr_parts(depth, exr_part("beauty", {"RGB": halves()}), normals), "light.exr")
    assert_same(image.pixels, halves())
    assert image.encoding == "OpenEXR, half, ZIP, part 2 of 3"
    assert image.notes == ()


PLANE = np.ones((4, 8), np.float32)
FOUR_LIGHTS = exr_parts(
    exr_part("left", {"RGB": halves(seed=1)}),
    exr_part("right", {**layer("", halves(seed=2)), **layer("diffuse", halves(seed=3))}),
    exr_part("aside", layer("specular", halves(seed=4))),
)


@pytest.mark.parametrize(
    ("name", "seed"),
    [
        ("left", 1),
        ("right", 2),
        ("right:diffuse", 3),
        ("diffuse", 3),
        ("aside:specular", 4),
        ("specular", 4),
        ("aside", 4),
    ],
)
def test_a_part_or_layer_is_read_by_its_name(read, name, seed):
    assert_same(read(FOUR_LIGHTS, "light.exr", layer=name).pixels, halves(seed=seed))


@pytest.mark.parametrize("tiled", [False, True])
def test_parts_of_different_storage_are_taken_apart(read, tiled):
    tiles = {"type": OpenEXR.tiledimage, "tiles": OpenEXR.TileDescription()}
    shown = {"displayWindow": window(0, 0, 69, 69)}  # of all parts
    long_name = "a layer with a name of more than thirty-one letters"
    first, middle, last = halves(70, 40), halves(40, 70), halves(9, 7)
    data = exr_parts(
        exr_part("first", {"RGB": first}, compression=OpenEXR.ZIPS_COMPRESSION, **shown),
        exr_part("b", layer(long_name, middle), compression=OpenEXR.PIZ_COMPRESSION, **shown, **tiles if tiled else {}),
        exr_part("last", {"RGB": last}, **shown, **tiles),
    )
    image = read(data, "light.exr", layer=long_name)
    assert_same(image.pixels[:40].copy(), middle)
    assert image.encoding == f"OpenEXR, half, PIZ{', tiled' if tiled else ''}, part 2 of 3"
    assert_same(read(data, "light.exr", layer="first").pixels[:, :40].copy(), first)
    assert_same(read(data, "light.exr", layer="last").pixels[:9, :7].copy(), last)
    assert int.from_bytes(part_alone(data, 1)[4:8], "little") == 2 | 0x400 | (0x200 if tiled else 0)


def test_a_deep_part_does_not_hide_the_flat_one(read):
    data = exr_parts(deep_part("smoke"), exr_part("flat", {"RGB": halves()}))
    assert_same(read(data, "light.exr").pixels, halves())


def test_the_library_never_sees_the_parts_that_are_not_wanted(read):
    wrong = exr_part("wrong", {"RGB": halves(seed=2)}, compression=OpenEXR.PIZ_COMPRESSION)
    data = exr_parts(exr_part("right", {"RGB": halves()}, compression=OpenEXR.NO_COMPRESSION), wrong)
    assert_same(read(data[:-40], "light.exr", layer="right").pixels, halves())


@pytest.mark.parametrize("pixels", [np.empty((0, 0), np.float16), np.empty((4, 8), object)])
def test_a_library_that_returns_no_pixels_is_not_believed(monkeypatch, pixels):
    channel = SimpleNamespace(pixels=pixels)
    file = SimpleNamespace(parts=[SimpleNamespace(channels=dict.fromkeys("RGB", channel))])
    monkeypatch.setattr(openexr, "open_openexr", lambda *arguments, **options: file)
    with pytest.raises(LightError, match="channel R has no pixels"):
        decode_openexr(exr_file({"RGB": halves()}))


# ------------------------------------------------------------------------------------------------ luminance and chroma

WEIGHTS_709 = (0.2126, 0.7152, 0.0722)  # as published, rounded


def test_luminance_and_chroma_of_a_smooth_image_become_its_colours(read):
    y, x = np.mgrid[0:64, 0:128]
    pixels = np.stack([1 + x / 128, 2 + y / 64, 1.5 - (x + y) / 400], axis=2)
    planes = luminance_chroma_of(pixels, WEIGHTS_709)
    coarse = [plane[::2, ::2].astype(np.float32) for plane in planes[1:]]
    image = read(luminance_chroma_exr(planes[0].astype(np.float32), *coarse), "light.exr")
    # Linear interpolation of chroma errs by h**2/8 times its second derivative; the last texels repeat a sample.
    np.testing.assert_allclose(image.pixels[:-1, :-1], pixels[:-1, :-1], rtol=2e-4, atol=0)
    np.testing.assert_allclose(image.pixels, pixels, rtol=0.02, atol=0)
    np.testing.assert_allclose(image.pixels @ np.array(WEIGHTS_709), planes[0], rtol=2e-4, atol=0)
    assert image.encoding == "OpenEXR, float, ZIP, luminance-chroma"


@pytest.mark.parametrize("compression", ["NO", "RLE", "ZIPS", "ZIP", "PIZ", "HTJ2K32", "ZSTD"])
@pytest.mark.parametrize("origin", [(0, 0), (-4, 6)])
def test_chroma_stands_at_the_even_texels_and_is_the_mean_between(read, compression, origin):
    luminance = np.ones((4, 6), np.float16)
    red = np.array([[0.0, 1.0, 0.5], [-0.5, 0.25, 0.0]], np.float16)
    codec = getattr(OpenEXR, f"{compression}_COMPRESSION")
    data = luminance_chroma_exr(luminance, red, np.zeros_like(red), origin=origin, compression=codec)
    expected = [
        [0, 0.5, 1, 0.75, 0.5, 0.5],
        [-0.25, 0.1875, 0.625, 0.4375, 0.25, 0.25],
        [-0.5, -0.125, 0.25, 0.125, 0, 0],
        [-0.5, -0.125, 0.25, 0.125, 0, 0],
    ]
    pixels = read(data, "light.exr").pixels
    np.testing.assert_array_equal(pixels[..., 0], 1 + np.array(expected, np.float32))
    np.testing.assert_array_equal(pixels[..., 2], 1)


@pytest.mark.parametrize("step", [1, 4])
def test_chroma_of_another_resolution_is_read(read, step):
    luminance = np.full((8, 8), 2.0, np.float32)
    red = np.zeros((8 // step, 8 // step), np.float32)
    red[0, 0] = 0.5
    pixels = read(luminance_chroma_exr(luminance, red, 0 * red, step=step), "light.exr").pixels
    np.testing.assert_allclose(pixels[0, :, 0], 2 + np.clip(1 - np.arange(8) / step, 0, 1), rtol=0, atol=1e-6)


def test_a_saturated_lamp_makes_no_colour_negative():
    """Colours at the edge of what can be shown, and beside black: the case in which longer filters undershoot."""
    pixels = np.random.default_rng(0).choice([0.0, 0.001, 50.0], (32, 32, 3)) + 1e-6
    planes = luminance_chroma_of(pixels, WEIGHTS_709)
    coarse = [plane[::2, ::2].astype(np.float32) for plane in planes[1:]]
    decoded = decode_openexr(luminance_chroma_exr(planes[0].astype(np.float32), *coarse))
    # The weights of the test are rounded to 1e-4 and float32 to 1e-7, of values up to 50 / 0.07.
    assert decoded.pixels.min() > -0.1
    assert decoded.pixels.max() > 50


def test_the_weights_of_luminance_are_those_of_the_primaries_in_the_file():
    """Rec. 2020 has published weights; the colours come out as if the file had held RGB."""
    rec2020 = (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290)
    pixels = halves(8, 8).astype(np.float64) + 0.5
    planes = [plane.astype(np.float32) for plane in luminance_chroma_of(pixels, (0.2627, 0.6780, 0.0593))]
    decoded = decode_openexr(luminance_chroma_exr(*planes, step=1, chromaticities=rec2020))
    plain = decode_openexr(exr_file({"RGB": pixels.astype(np.float32)}, chromaticities=rec2020))
    np.testing.assert_allclose(decoded.pixels, plain.pixels, rtol=0, atol=5e-4)  # of the rounded weights
    assert decoded.notes == plain.notes != ()


def test_infinite_luminance_and_chroma_cause_no_warning():
    planes = [np.full((4, 4), value, np.float32) for value in (np.inf, -1, np.nan)]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        decoded = decode_openexr(luminance_chroma_exr(*planes, step=1))
    assert not np.isfinite(decoded.pixels).all()


# ----------------------------------------------------------------------------------------------------------- colours

AP1 = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)
AP1_NOTE = (
    "colours converted to Rec. 709 from the primaries (0.713, 0.293), (0.165, 0.83), (0.128, 0.044) and the white"
    " (0.3217, 0.3377)"
)


@pytest.mark.parametrize("attribute", [{"chromaticities": AP1}, {"colorInteropID": "lin_ap1_scene"}])
def test_other_primaries_are_converted_with_a_note(read, attribute):
    pixels = halves(70, 8)
    image = read(exr_file({"RGB": pixels}, **attribute), "light.exr")
    expected = pixels.astype(np.float64) @ rec709_from(np.reshape(AP1, (4, 2))).T
    np.testing.assert_allclose(image.pixels, expected, rtol=0, atol=1e-6)  # float32, of values up to 2
    assert image.notes[0] == AP1_NOTE


@pytest.mark.parametrize(
    "attribute",
    [
        {"chromaticities": tuple(REC709.ravel())},
        {"colorInteropID": "lin_rec709_scene"},
        {"colorInteropID": "unknown"},
        {"whiteLuminance": 100.0, "adoptedNeutral": np.array([0.3, 0.3], np.float32)},
    ],
)
def test_colours_that_are_rec_709_already_are_left_alone(read, attribute):
    image = read(exr_file({"RGB": halves()}, **attribute), "light.exr")
    assert_same(image.pixels, halves())
    assert image.notes == ()


def test_the_primaries_of_the_first_part_are_those_of_all():
    data = exr_parts(exr_part("a", {"Z": PLANE}, chromaticities=AP1), exr_part("b", {"RGB": halves()}))
    assert decode_openexr(data).notes == (AP1_NOTE,)


def test_an_infinite_value_does_not_spread_over_its_texel():
    pixels = halves().astype(np.float32)
    pixels[1, 2, 0], pixels[2, 3, 1] = np.inf, np.nan
    decoded = decode_openexr(exr_file({"RGB": pixels}, chromaticities=AP1)).pixels
    assert np.isposinf(decoded).sum() == np.isnan(decoded).sum() == 1
    assert_same(decoded[1, 2], pixels[1, 2])


# ----------------------------------------------------------------------------------------------------------- windows


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


# ----------------------------------------------------------------------------------------------- .exr, refused files


GREEN_IS_DARK = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1 / 3, 1 / 3)


@pytest.mark.parametrize(
    ("data", "fragment"),
    [
        (bare_exr(deep=True), "deep data"),
        (
            exr_parts(deep_part("smoke"), exr_part("depth", {"Z": PLANE})),
            "deep data (several samples per texel) in part smoke",
        ),
        (exr_file({"RY": PLANE, "BY": PLANE}), "no R, G and B among its channels BY, RY;"),
        (bare_exr(channels=(("BY", 2), ("RY", 2), ("Y", 2))), "subsampled channels Y;"),
        (luminance_chroma_exr(*[PLANE] * 3, step=1, chromaticities=GREEN_IS_DARK), "green of luminance"),
        (exr_file({"RGB": halves()}, chromaticities=(0.3,) * 8), "must span a triangle"),
        (bare_exr(channels=(("B", 2), ("G", 1), ("R", 2))), "subsampled channels B, R;"),
        (exr_file({f"N.{c}": PLANE for c in "XYZ"}), "no R, G and B among its channels N.X, N.Y, N.Z;"),
        (exr_file({"R": PLANE, "G": PLANE}), "no R, G and B among its channels G, R;"),
        (
            exr_file({f"{layer}.{c}": PLANE for layer in "ab" for c in "RGB"}),
            "2 layers to choose from: a, b; name one with FILE.exr:LAYER",
        ),
        (
            exr_parts(*(exr_part(name, {"RGB": halves()}) for name in ("left", "right"))),
            "2 layers to choose from: left, right;",
        ),
        (exr_file({f"n{i:02}": PLANE for i in range(20)}), "n11 and 8 more"),
        (
            exr_file({"RGB": halves()}, displayWindow=window(50, 0, 57, 3), dataWindow=window(0, 0, 7, 3)),
            "lies outside",
        ),
        (bare_exr((0, 0, 59999, 59999), (0, 0, 7, 3)), "data window of 60000 x 60000"),
        (bare_exr((0, 0, 7, 3), (0, 0, 32768, 3)), "display window of 32769 x 4"),
        (bare_exr((0, 0, 32767, 4095), channels=[(name, 1) for name in "ABGRZ"]), "values in all channels"),
        (exr_file({"RGB": halves()}).replace(b"B\0", b"\xff\0", 1), "no R, G and B among its channels G, R, ÿ"),
        (exr_parts(exr_part("a", {"Z": PLANE}), exr_part("b", {"RGB": halves()}))[:-10], "chunks end behind the end"),
        (bare_exr((0, 0, -1, -1)), "dataWindow from (0, 0) to (-1, -1) ends before it begins;"),
        (bare_exr((-(2**31), 0, 2**31 - 1, 3)), "damaged"),
        (bare_exr()[:8] + b"a\0a\0\0\0\0\0" * 2**16 + bare_exr()[8:], "more than 4096 attributes in a header"),
        (bare_exr((0, 0, 7, 3), (7, 0, 0, 3)), "displayWindow from (7, 0) to (0, 3) ends before it begins;"),
        (bare_exr((0, 0, 7, 3), (0, 0, 7, -1)), "displayWindow from (0, 0) to (7, -1) ends before it begins;"),
        (bare_exr().replace(b"displayWindow\0", b"displayHollow\0"), "no displayWindow in its header"),
        (bare_exr().replace(b"displayWindow\0box2i", b"displayWindow\0box2f"), "no displayWindow in its header"),
        (bare_exr().replace(b"dataWindow\0box2i", b"dataWindow\0box2f"), "no dataWindow in its header"),
        (bare_exr(), "Unable to query scanline information"),
    ],
)
def test_an_openexr_file_that_is_no_flat_rgb_is_refused_by_name(refusal, capfd, data, fragment):
    assert fragment in refusal(data, "light.exr")
    assert capfd.readouterr() == ("", "")


def test_a_window_is_read_from_the_header_and_from_nowhere_else(refusal):
    """The library takes a window of 64 x 64 for one that it does not find."""
    pixels = halves(64, 64)
    elsewhere = b"\0displayWindow\0box2i\0" + struct.pack("<5i", 16, 0, 0, 63, 63)
    data = exr_file({"RGB": pixels}, comments="#" * len(elsewhere)).replace(b"#" * len(elsewhere), elsewhere)
    own, comment = data.rindex(b"displayWindow\0box2i"), data.index(b"displayWindow\0box2i")
    assert comment < own
    spoilt = data[:own] + b"displayWindow\0box2j" + data[own + 19 :]
    assert_same(decode_openexr(data).pixels, pixels)
    assert "no displayWindow in its header" in refusal(spoilt, "light.exr")


def test_the_windows_of_every_part_are_needed(refusal):
    wrong = FOUR_LIGHTS[::-1].replace(b"displayWindow\0box2i"[::-1], b"displayWindow\0box2f"[::-1], 1)[::-1]
    assert "no displayWindow in its header" in refusal(wrong, "light.exr")


@pytest.mark.parametrize("mode", [ONE_LEVEL, MIP_MAPPED, RIP_MAPPED])
@pytest.mark.parametrize("side", [2**20, 2**24])
@pytest.mark.parametrize("down", [False, True])
def test_a_tile_far_larger_than_the_image_is_refused_before_anything_of_its_size_is_made(refusal, mode, side, down):
    tile = struct.pack("<2I", *((4, side) if down else (side, 4)))
    data = tiled_exr(halves(), mode, tile=4).replace(struct.pack("<2I", 4, 4), tile, 1)
    tracemalloc.start()
    message = refusal(data, "light.exr")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (
        f"tiles of {'4 x ' if down else ''}{side}{'' if down else ' x 4'} texels for a data window of 8 x 4;" in message
    )
    assert peak < 2**20


@pytest.mark.parametrize("side", [1, 64, 1024])
def test_a_tile_of_any_usual_size_is_read_however_small_the_image(read, side):
    pixels = halves()
    assert_same(read(tiled_exr(pixels, tile=side), "light.exr").pixels, pixels)


def test_a_single_tile_may_be_of_the_next_power_of_two(read):
    pixels = np.zeros((1100, 1100, 3), np.float16)
    pixels[-1, -1] = 1
    tiles = OpenEXR.TileDescription()
    tiles.xSize = tiles.ySize = 2048
    data = exr_file({"RGB": pixels}, type=OpenEXR.tiledimage, tiles=tiles)
    assert_same(read(data, "light.exr").pixels, pixels)


@pytest.mark.parametrize(
    ("data", "name", "fragment"),
    [
        (FOUR_LIGHTS, "up", "no layer up with colours or luminance; there are left, right, right:diffuse, aside:spec"),
        (FOUR_LIGHTS, "left:diffuse", "no layer left:diffuse with"),
        (exr_file({"RGB": halves()}), "up", "no layer up; it has no layers at all: leave the name out"),
        (exr_file({"Z": PLANE}), "up", "no R, G and B among its channels Z;"),
        (exr_parts(*(exr_part(name, layer("a", halves())) for name in "xy")), "a", "2 layers to choose from: x:a, y:a"),
        (exr_parts(deep_part("smoke"), exr_part("flat", {"RGB": halves()})), "smoke", "deep data (several samples"),
        (FOUR_LIGHTS, "a\nb\u2028" + 99 * "c", "no layer a\\nb\\u2028ccc"),
    ],
)
def test_a_layer_that_cannot_be_chosen_is_refused_with_those_that_can(refusal, data, name, fragment):
    assert fragment in refusal(data, "light.exr", layer=name)


def test_the_limits_hold_for_the_wanted_part_only():
    shown = {"displayWindow": window(0, 0, 7, 3)}
    large = exr_part("large", {"Z": np.zeros((40, 80), np.float32)}, **shown)
    data = exr_parts(exr_part("small", {"RGB": halves()}, **shown), large)
    assert_same(decode_openexr(data, Limits(texels=100)).pixels, halves())
    with pytest.raises(LightError, match="data window of 8 x 4"):
        decode_openexr(data, Limits(texels=10))


@pytest.mark.parametrize("wanted", ["left", "right:diffuse"])
def test_every_truncation_of_a_file_of_several_parts_is_refused_or_right(wanted, capfd):
    whole = decode_openexr(FOUR_LIGHTS, layer=wanted).pixels
    for length in range(8, len(FOUR_LIGHTS)):
        try:
            pixels = decode_openexr(FOUR_LIGHTS[:length], layer=wanted).pixels
        except LightError:
            continue
        assert_same(pixels, whole)
    assert capfd.readouterr() == ("", "")


def test_parts_are_taken_apart_or_refused_whatever_the_bytes():
    rng = np.random.default_rng(0)
    refused = 0
    for _ in range(1000):
        data = mutated(FOUR_LIGHTS, rng)
        try:
            alone = part_alone(data, 2)
        except LightError:
            refused += 1
        else:
            assert len(alone) < 2 * len(data)
    assert 10 < refused < 990


def test_every_truncation_of_an_openexr_file_is_refused_and_the_library_kept_quiet(refusal, capfd):
    whole = exr_file({"RGB": halves()})
    for length in range(1, len(whole)):
        refusal(whole[:length], "light.exr")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("descriptor", [1, 2])
def test_what_is_printed_after_a_damaged_file_is_seen_again(refusal, capfd, descriptor):
    refusal(bare_exr(), "light.exr")
    os.write(descriptor, b"still here")
    assert capfd.readouterr()[descriptor - 1] == "still here"


CHATTY = """
import sys
from shviewer.lights.images.openexr import decode_openexr
sys.stdout.write("before ")
decode_openexr(sys.stdin.buffer.read())
sys.stdout.write("after")
"""


def chatty_exr():
    """Sound but for a field of HTJ2K's SIZ marker, of which the library warns through C's stdout."""
    data = bytearray(exr_file({"RGB": halves(40, 80)}, compression=OpenEXR.HTJ2K32_COMPRESSION))
    data[data.index(b"\xff\x4f\xff\x51") + 6] = 255
    return bytes(data)


def test_a_warning_of_htj2k_is_not_printed_not_even_at_exit():
    done = subprocess.run([sys.executable, "-c", CHATTY], input=chatty_exr(), capture_output=True, check=True)
    assert (done.stdout, done.stderr) == (b"before after", b"")


@pytest.mark.skipif(os.name == "nt", reason="no shell that closes streams")
@pytest.mark.parametrize(("closed", "printed"), [("1", b""), ("2", b"before after"), ("1 2", b"")])
def test_a_closed_stream_is_left_closed_and_nothing_printed_on_the_other(closed, printed):
    closing = " ".join(f"{descriptor}>&-" for descriptor in closed.split())
    quiet = CHATTY.replace("sys.stdout.write", "sys.stdout and sys.stdout.write")
    script = f'exec "$0" -c "$1" {closing}'
    damaged = chatty_exr()[:-100]
    for data in (chatty_exr(), damaged):
        done = subprocess.run(["sh", "-c", script, sys.executable, quiet], input=data, capture_output=True)
        assert done.stdout == printed.removesuffix(b"after" if data is damaged else b"")
        if data is not damaged:
            assert (done.returncode, done.stderr) == (0, b"")


NOT_STDOUT = """
import sys
from types import SimpleNamespace
from shviewer.lights.images.openexr_library import open_openexr
with open(sys.argv[1], "wb", buffering=0) as file:
    assert file.fileno() == 1
    printing = lambda *arguments, **options: file.write(b"kept") and SimpleNamespace(parts=[1])
    open_openexr(SimpleNamespace(File=printing), b"", header_only=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="no shell that closes streams")
def test_a_file_in_the_place_of_a_closed_stream_is_not_silenced(tmp_path):
    path = tmp_path / "file"
    script = 'exec "$0" -c "$1" "$2" >&-'
    subprocess.run(["sh", "-c", script, sys.executable, NOT_STDOUT, str(path)], check=True)
    assert path.read_bytes() == b"kept"


def test_two_threads_that_decode_leave_the_streams_as_they_were(capfd):
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(decode_openexr, [chatty_exr()] * 40))
    os.write(1, b"one")
    os.write(2, b"two")
    print("three", flush=True)
    assert capfd.readouterr() == ("onethree\n", "two")


def test_a_missing_library_is_named_with_the_command_that_installs_it(refusal, monkeypatch):
    data = exr_file({"RGB": halves()})
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    assert "pip install OpenEXR" in refusal(data, "light.exr")


@pytest.mark.parametrize(
    "seed_bytes",
    [
        exr_file({"RGB": halves()}),
        FOUR_LIGHTS,
        tiled_exr(halves(9, 20), MIP_MAPPED),
        luminance_chroma_exr(PLANE, PLANE[::2, ::2].copy(), 0 * PLANE[::2, ::2], chromaticities=AP1),
    ],
    ids=["plain", "parts", "mip-mapped", "luminance-chroma"],
)
def test_three_hundred_damaged_openexr_files_are_refused_or_finite(read, capfd, seed_bytes):
    def read_left(data, name):
        return read(data, name, layer="left" if seed_bytes.count(b"left") else "", sanitize=True)

    accepted, refused = outcomes(read_left, seed_bytes, 300, "light.exr")
    assert min(accepted, refused) > 10
    assert capfd.readouterr() == ("", "")
