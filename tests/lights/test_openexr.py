"""What shviewer.lights.decoders.openexr promises about .exr files."""

import os
import sys

import numpy as np
import OpenEXR
import pytest
from hdr_files import assert_same, bare_exr, exr_file, exr_part, exr_parts, halves, outcomes, window

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


def test_three_hundred_damaged_openexr_files_are_refused_or_finite(read, capfd):
    accepted, refused = outcomes(read, exr_file({"RGB": halves()}), 300, "light.exr")
    assert min(accepted, refused) > 10
    assert capfd.readouterr() == ("", "")
