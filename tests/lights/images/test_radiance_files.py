"""What shviewer.lights.images.radiance_files promises about files and about bad values."""

import errno
import os
import threading
from pathlib import Path

import numpy as np
import pytest
from lights.images.hdr_files import (
    FORMAT,
    GOLDEN,
    GOLDEN_PIXELS,
    assert_same,
    checked_message,
    exr_file,
    halves,
    hdr_file,
    radiance_of,
    random_texels,
)
from places import ASSETS

from shviewer import files
from shviewer.errors import LightError
from shviewer.lights.images import radiance_files
from shviewer.lights.images.radiance_files import IMAGE_SUFFIXES, decode_radiance_image, read_radiance_image
from shviewer.lights.reading import Reading
from shviewer.limits import Limits

ENVIRONMENTS = ASSETS / "environments"
TEXELS = random_texels(8, 16)


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


@pytest.mark.parametrize("value", [3e38, -3e38])
@pytest.mark.parametrize("size", [(16, 32), (48, 64), (64, 48), (32, 48), (32, 32), (8, 48)])
def test_radiance_near_the_end_of_float32_is_refused_without_a_warning(refusal, value, size):
    """In the shape of every layout; warnings are errors in this test run."""
    pixels = np.full((*size, 3), value, np.float32)
    assert "its largest radiance is 3e+38" in refusal(exr_file({"RGB": pixels}), "light.exr")


def test_the_brightest_texels_of_a_picture_are_those_that_count(read, refusal):
    """Where a decoder knows a bound of the values, they are looked at only above the limit."""
    texels = TEXELS.copy()
    texels[3, 5] = (1, 1, 1, 236)  # 2**100, just above the limit of 1e30
    assert "its largest radiance is 1.27e+30" in refusal(hdr_file(texels))
    texels[3, 5] = (1, 1, 1, 235)
    assert read(hdr_file(texels)).pixels.max() == np.float32(2.0**99)


# --------------------------------------------------------------------------------------- files that are not images


@pytest.mark.parametrize(
    ("data", "fragment"),
    [
        (b"", "empty"),
        (b"GIF89a" + bytes(50), "seems to be a GIF file"),
        (b"II*\0" + bytes(50), "holds TIFF; rename it to end in .tif"),
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
    assert "named .jpeg but holds PNG; rename it to end in .png" in refusal(b"\x89PNG" + bytes(50), "light.jpeg")
    assert "named .png but holds JPEG; rename it to end in .jpg" in refusal(b"\xff\xd8\xff" + bytes(50), "light.png")


def test_a_file_of_no_known_kind_is_told_which_kinds_there_are(refusal):
    for data in (b"GIF89a", b"nothing known"):
        assert ".hdr (Radiance), .exr (OpenEXR), .png or .jpg" in refusal(data)


def test_every_kind_has_its_suffixes():
    assert {".hdr", ".pic", ".exr", ".png", ".jpg", ".jpeg"} <= set(IMAGE_SUFFIXES)


def test_bytes_in_memory_are_read_as_a_file_is(read):
    bad = exr_file({"RGB": bad_image()})
    image = decode_radiance_image(bad, "light.exr", Reading(sanitize=True))
    file = read(bad, "light.exr", sanitize=True)
    assert_same(image.pixels, file.pixels)
    assert (image.encoding, image.notes) == (file.encoding, file.notes)
    with pytest.raises(LightError, match=r"^folder/light\.hdr: named \.hdr but holds OpenEXR"):
        decode_radiance_image(bad, "folder/light.hdr")
    with pytest.raises(LightError, match=r"^light: .* the limit is 8"):
        decode_radiance_image(GOLDEN, "light", Reading(limits=Limits(texels=8)))


def test_running_out_of_memory_is_said_in_one_line(monkeypatch):
    def starved(*arguments):
        raise MemoryError

    monkeypatch.setattr(radiance_files, "_decoded", starved)
    with pytest.raises(LightError, match=r"^light\.hdr: not enough memory"):
        decode_radiance_image(GOLDEN, "light.hdr")


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
            read_radiance_image(path, Reading(limits=Limits(pipe_seconds=0)))
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
        patch.setattr(files.os, "open", lambda *arguments: opened.append(arguments))
        refused_within_five_seconds(Path("/dev/null"))
    assert not opened


def test_a_pipe_put_in_the_place_of_a_file_does_not_block(tmp_path, monkeypatch):
    os.mkfifo(tmp_path / "pipe.hdr")
    (tmp_path / "file.hdr").write_bytes(GOLDEN)
    status = os.stat(tmp_path / "file.hdr")
    with monkeypatch.context() as patch:
        patch.setattr(files.os, "stat", lambda path: status)
        assert "a pipe, socket or device" in refused_within_five_seconds(tmp_path / "pipe.hdr")


def test_a_file_that_may_not_be_read_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "light.hdr"
    path.write_bytes(GOLDEN)

    def denied(*arguments):
        raise PermissionError(errno.EACCES, "Permission denied")  # chmod would not stop root

    monkeypatch.setattr(files.os, "open", denied)
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

    monkeypatch.setattr(files.os, "fstat", changing_fstat)
    with pytest.raises(LightError, match="changed meanwhile"):
        read_radiance_image(path)


def test_a_file_beyond_the_limit_is_refused_unread(tmp_path, read, refusal):
    path = tmp_path / "large.hdr"
    path.write_bytes(GOLDEN)
    limit = 512 * 2**20
    os.truncate(path, limit + 1)  # sparse, takes no room
    with pytest.raises(LightError, match=f"{limit + 1} bytes; the limit is {limit}"):
        read_radiance_image(path)
    tight = Limits(file_bytes=len(GOLDEN))
    read(GOLDEN, limits=tight)
    assert "the limit is" in refusal(GOLDEN + b"\0", limits=tight)


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
