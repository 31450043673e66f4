"""Where a JPEG ends: what follows its first image does not matter, and what is cut short is refused whatever follows."""

import struct

import numpy as np
import pytest
from lights.images.hdr_files import assert_same
from lights.images.ldr_files import exif, saved_by_pillow, segment, with_segments
from PIL import ImageFile

from shviewer.errors import LightError

RNG = np.random.default_rng(5)
_Y, _X = np.mgrid[0:48, 0:72]
PICTURE = np.stack([_X * 3, _Y * 5, _X + _Y], axis=2).astype(np.uint8)
PICTURE[10:30, 20:50] = RNG.integers(0, 256, (20, 30, 3))
WAYS = {
    "baseline": {},
    "its own tables": {"optimize": True},
    "fine chroma": {"subsampling": 0, "quality": 95},
    "restarts": {"restart_marker_rows": 1},
    "progressive": {"progressive": True},
    "progressive with restarts": {"progressive": True, "restart_marker_rows": 1},
}
END = b"\xff\xd9"


def jpeg(way="baseline", picture=PICTURE):
    return saved_by_pillow(picture, "JPEG", **WAYS[way])


BEHIND = {
    "two bytes": b"\xff\xda",
    "text": b"more",
    "400 kB of anything": RNG.bytes(400_000),
    "another picture": jpeg(picture=255 - PICTURE),
    "a video": b"\0\0\0\x18ftypmp42" + RNG.bytes(5000),
}


@pytest.mark.parametrize("behind", BEHIND.values(), ids=BEHIND)
@pytest.mark.parametrize("way", WAYS)
def test_what_follows_the_end_of_the_first_image_does_not_matter(read, way, behind):
    assert_same(read(jpeg(way) + behind, "light.jpg").pixels, read(jpeg(way), "light.jpg").pixels)


@pytest.mark.parametrize("way", WAYS)
def test_a_picture_without_its_end_marker_is_read_if_its_scanlines_are_all_there(read, way):
    whole = read(jpeg(way), "light.jpg").pixels
    assert_same(read(jpeg(way)[:-2], "light.jpg").pixels, whole)
    assert_same(read(jpeg(way)[:-2] + jpeg(picture=255 - PICTURE), "light.jpg").pixels, whole)


@pytest.mark.parametrize("lenient", [False, True])
@pytest.mark.parametrize("end", [b"", END, END + b"\xff\xda", jpeg()], ids=["nothing", "an end", "more", "a picture"])
@pytest.mark.parametrize("way", WAYS)
def test_what_is_cut_short_is_refused_whatever_stands_at_its_end(refusal, monkeypatch, way, end, lenient):
    """Some cuts behind the beginning of the first scan, and all of the last ones, where hardly anything is missing."""
    monkeypatch.setattr(ImageFile, "LOAD_TRUNCATED_IMAGES", lenient)
    data = jpeg(way)
    step = 11 if not lenient and end == END else 97
    for length in [*range(data.index(b"\xff\xda"), len(data) - 2, step), *range(len(data) - 20, len(data) - 2)]:
        assert "cut short" in refusal(data[:length] + end, "light.jpg")


def test_a_cut_that_only_meets_the_padding_beyond_the_border_is_none(read):
    """A picture of 8 x 4 is coded in blocks of 16 x 16."""
    data = jpeg(picture=PICTURE[:4, :8])
    whole, same = read(data, "light.jpg").pixels, 0
    for length in range(len(data) - 2):
        try:
            found = read(data[:length] + END, "light.jpg").pixels
        except LightError:
            continue
        assert_same(found, whole)
        same += 1
    assert same < 60


def test_a_progressive_picture_without_its_last_scan_is_refused(refusal):
    data = jpeg("progressive")
    places = [place for place in range(len(data)) if data.startswith(b"\xff\xda", place)]
    for scans_header in places[1:]:
        before = data.rfind(b"\xff\xc4", 0, scans_header)  # the tables of the scan
        assert "it ends before its last scan" in refusal(data[:before] + END, "light.jpg")


def test_marker_segments_that_look_like_an_end_or_a_scan_are_stepped_over(read):
    data = with_segments(jpeg(), segment(0xED, b"\xff\xd9\xff\xda\xff\xd8" * 50), segment(0xFE, b"\xff\xd9"))
    assert_same(read(data, "light.jpg").pixels, read(jpeg(), "light.jpg").pixels)


def test_fill_bytes_before_a_marker_are_stepped_over(read):
    data = jpeg()
    scan = data.index(b"\xff\xda")
    filled = data[:scan] + b"\xff\xff" + data[scan:-2] + b"\xff\xff" + data[-2:]
    assert_same(read(filled, "light.jpg").pixels, read(data, "light.jpg").pixels)


def test_a_scan_header_that_is_nonsense_in_a_baseline_picture_is_no_reason_to_refuse(read):
    """Some cameras write 0 for the last coefficient; libjpeg only warns."""
    data = bytearray(jpeg())
    place = data.index(b"\xff\xda") + 2
    size = struct.unpack_from(">H", data, place)[0]
    data[place + size - 2] = 0
    assert_same(read(bytes(data), "light.jpg").pixels, read(jpeg(), "light.jpg").pixels)


def test_more_scans_than_any_picture_needs_are_refused(refusal):
    data = jpeg("progressive")
    assert "more than 100 scans" in refusal(data[:-2] + data[data.rfind(b"\xff\xda") : -2] * 100 + END, "light.jpg")


def test_a_turned_picture_with_a_trailer_stands_upright(read):
    data = saved_by_pillow(PICTURE, "JPEG", exif=exif(6)) + RNG.bytes(1000)
    assert_same(read(data, "light.jpg").pixels, np.rot90(read(jpeg(), "light.jpg").pixels, -1))
