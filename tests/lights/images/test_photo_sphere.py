"""What shviewer.lights.images.display.photo_sphere promises: a part of a sphere is placed where it says."""

import re
import zlib

import numpy as np
import pytest
from lights.images.hdr_files import assert_same
from lights.images.ldr_files import RGB, exif, gpano, png_file, saved_by_pillow, with_segments, xmp, xmp_packet

from shviewer.lights.find import find_light
from shviewer.limits import Limits

RNG = np.random.default_rng(11)
PICTURE = np.full((16, 32, 3), 188, np.uint8)
CODES = RNG.integers(0, 256, (16, 32, 3), np.uint8)
PART = gpano((64, 32), (32, 16), 16, 8)
NAME = "light.jpg"


def jpeg(packet, codes=CODES, **options):
    return with_segments(saved_by_pillow(codes, "JPEG", **options), xmp(packet))


def png(packet, compressed=False):
    text = zlib.compress(packet) if compressed else packet
    content = b"XML:com.adobe.xmp\0" + bytes((compressed, 0)) + b"\0\0" + text
    return png_file(CODES, RGB, extra=[(b"iTXt", b"Title\0\0\0\0\0light"), (b"iTXt", content)])


def elements(packet):
    """The same packet with its properties as elements."""
    names = re.findall(r"GPano:(\w+)='([^']*)'", packet.decode())
    return xmp_packet("", "".join(f"<GPano:{name}> {value} </GPano:{name}>" for name, value in names))


@pytest.mark.parametrize(
    ("data", "name"),
    [(jpeg(PART), NAME), (jpeg(elements(PART)), NAME), (png(PART), "a.png"), (png(PART, True), "a.png")],
)
def test_a_part_of_a_sphere_is_placed_and_the_rest_is_black(read, data, name):
    image = read(data, name)
    alone = read(saved_by_pillow(CODES, "JPEG") if name == NAME else png_file(CODES, RGB), name).pixels
    assert image.pixels.shape == (32, 64, 3)
    assert_same(np.ascontiguousarray(image.pixels[8:24, 16:48]), alone)
    assert image.pixels.sum(dtype=np.float64) == pytest.approx(alone.sum(dtype=np.float64), rel=1e-6)
    assert image.layout == "lat-long"
    assert "32 x 16 texels placed at column 16, row 8 of 64 x 32, the rest is black" in image.notes[-1]


def test_the_light_of_a_part_is_that_of_its_solid_angle(tmp_path):
    """Half the azimuths, between 45 and 135 degrees from the pole: 0.3536 of the sphere."""
    path = tmp_path / NAME
    path.write_bytes(jpeg(PART, PICTURE))
    light = find_light(str(path))
    code = light.pixels.max()
    mean = light.coefficients(1)[0] / np.sqrt(4 * np.pi)
    np.testing.assert_allclose(mean, code * np.sqrt(0.5) / 2, rtol=1e-5)


def test_a_picture_made_smaller_since_keeps_its_place(read):
    image = read(jpeg(gpano((640, 320), (320, 160), 160, 80)), NAME)
    assert_same(image.pixels, read(jpeg(PART), NAME).pixels)


def test_a_whole_sphere_is_said_to_be_lat_long_without_a_word(read):
    image = read(jpeg(gpano((32, 16), (32, 16), 0, 0)), NAME)
    assert image.layout == "lat-long"
    assert len(image.notes) == 1
    assert read(jpeg(xmp_packet("GPano:ProjectionType='equirectangular'")), NAME).layout == "lat-long"


def test_a_picture_taken_sideways_is_placed_upright(read):
    image = read(jpeg(gpano((32, 64), (16, 32), 4, 20), exif=exif(6)), NAME)
    alone = read(saved_by_pillow(CODES, "JPEG", exif=exif(6)), NAME).pixels
    assert_same(np.ascontiguousarray(image.pixels[20:52, 4:20]), alone)


def test_a_sphere_that_is_not_level_is_said_to_be_taken_as_level(read):
    image = read(jpeg(gpano((64, 32), (32, 16), 16, 8, " GPano:PosePitchDegrees='-3.5'")), NAME)
    assert image.notes[-1] == "its XMP (GPano) states a pitch of -3.5 and a roll of 0 degrees: not applied"


NONSENSE = {
    "a part larger than the sphere": gpano((16, 8), (32, 16), 0, 0),
    "a part beyond the border": gpano((64, 32), (32, 16), 40, 8),
    "a negative place": gpano((64, 32), (32, 16), -1, 8),
    "no size": gpano((64, 32), (0, 16), 0, 8),
    "no number": gpano((64, "many"), (32, 16), 16, 8),
    "infinity": gpano(("inf", 32), (32, 16), 16, 8),
    "a number too few": xmp_packet("GPano:FullPanoWidthPixels='64' GPano:FullPanoHeightPixels='32'"),
}


@pytest.mark.parametrize("packet", NONSENSE.values(), ids=NONSENSE)
def test_numbers_that_are_no_part_of_a_sphere_are_ignored_with_a_note(read, packet):
    image = read(jpeg(packet), NAME)
    assert_same(image.pixels, read(saved_by_pillow(CODES, "JPEG"), NAME).pixels)
    assert image.notes[-1] == "its XMP (GPano) is ignored: its numbers are no part of a sphere"
    assert image.layout is None


def test_another_projection_is_not_placed_and_said_not_to_be_read(read):
    image = read(jpeg(PART.replace(b"equirectangular", b"cylindrical")), NAME)
    assert image.notes[-1] == "its XMP (GPano) states the projection 'cylindrical', which is not read"
    assert image.layout is None


UNREADABLE = {
    "entities": PART.replace(b"<x:xmpmeta", b"<!DOCTYPE x [<!ENTITY a 'aaaa'>]><x:xmpmeta", 1),
    "no XML": PART[:-20],
    "bytes that are no text": b"\xff\xfe\0<",
    "deeply nested": b"<a>" * 20_000,
}


@pytest.mark.parametrize("packet", UNREADABLE.values(), ids=UNREADABLE)
def test_a_packet_that_is_no_plain_xml_is_no_reason_to_refuse(read, packet):
    assert_same(read(jpeg(packet), NAME).pixels, read(saved_by_pillow(CODES, "JPEG"), NAME).pixels)


def test_a_sphere_beyond_the_limits_is_refused_before_memory_is_taken(refusal):
    message = refusal(jpeg(gpano((1_000_000, 500_000), (32, 16), 0, 0)), NAME)
    assert "photo sphere of 1000000 x 500000 texels; a side must be 1 to 32768" in message
    assert "the limit is 1000" in refusal(jpeg(PART), NAME, limits=Limits(texels=1000))
