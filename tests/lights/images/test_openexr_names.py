"""OpenEXR files whose channels, layers and strings have other names than the format's own, as programs write them."""

import numpy as np
import OpenEXR
import pytest
from lights.images.hdr_files import assert_same, exr_file, exr_part, exr_parts

from shviewer.errors import LightError
from shviewer.lights.find import find_light
from shviewer.lights.images.openexr import decode_openexr

PICTURE = np.random.default_rng(2).random((6, 12, 3)).astype(np.float16)


def channels(*names):
    """Red, green and blue of the picture under these names; the first alone if there is one."""
    return {name: PICTURE[..., i].copy() for i, name in enumerate(names)}


COLOURS = {
    "small letters": ("r", "g", "b"),
    "words": ("red", "green", "blue"),
    "Words": ("Red", "Green", "Blue"),
    "WORDS": ("RED", "GREEN", "BLUE"),
    "brackets": ("[red]", "[green]", "[blue]"),
    "a layer": ("rgba.red", "rgba.green", "rgba.blue"),
    "a layer and brackets": ("beauty[R]", "beauty[G]", "beauty[B]"),
    "a layer without a name": (".R", ".G", ".B"),
    "a layer without a name, small": (".r", ".g", ".b"),
}


@pytest.mark.parametrize("names", COLOURS.values(), ids=COLOURS)
@pytest.mark.parametrize("alpha", [{}, {"A": np.ones((6, 12), np.float16)}])
def test_colours_are_read_by_the_names_that_programs_give_them(read, names, alpha):
    image = read(exr_file({**channels(*names), **alpha}), "light.exr")
    assert_same(image.pixels, PICTURE)
    usual = names[0] in (".R", "beauty[R]")
    said = f"channels {', '.join(names)} taken for red, green and blue"
    assert (said in image.notes) != usual


@pytest.mark.parametrize("name", ["R", "G", "L", "l", "y", "gray", "Grey", "luminance", "Red", ".Y", "[Y]", "sun.L"])
def test_one_channel_alone_is_grey(read, name):
    image = read(exr_file({name: PICTURE[..., 0].copy(), "A": np.ones((6, 12), np.float16)}), "light.exr")
    assert_same(image.pixels, np.repeat(PICTURE[..., :1], 3, axis=2))
    assert "luminance" in image.encoding
    if name not in (".Y", "[Y]"):
        assert f"channel {name} taken for grey" in image.notes


@pytest.mark.parametrize(
    "names", [("x", "y", "z"), ("L", "a", "b*"), ("R", "G"), ("Z",), ("depth",), ("A",), ("u", "v")]
)
def test_channels_that_are_no_light_are_not_taken_for_one(refusal, names):
    data = exr_file({name: PICTURE[..., 0].copy() for name in names})
    assert "no R, G and B among its channels" in refusal(data, "light.exr")


def test_the_names_of_the_format_come_first(read):
    other = dict.fromkeys(("r", "g", "b", ".R", ".G", ".B", "[R]", "[G]", "[B]", "L"), 9 * PICTURE[..., 0])
    assert_same(read(exr_file({**channels("R", "G", "B"), **other}), "light.exr").pixels, PICTURE)
    layers = {
        **channels("beauty.R", "beauty.G", "beauty.B"),
        "red": other["r"],
        "green": other["r"],
        "blue": other["r"],
    }
    assert_same(read(exr_file(layers), "light.exr").pixels, PICTURE)
    grey = {"sky.Y": PICTURE[..., 0].copy(), "occlusion.R": other["r"]}
    assert_same(read(exr_file(grey), "light.exr").pixels, np.repeat(PICTURE[..., :1], 3, axis=2))


def test_a_layer_with_unusual_names_can_be_named(read):
    layers = {**channels("sun.red", "sun.green", "sun.blue"), **{f"sky.{c}": 9 * PICTURE[..., 0] for c in "rgb"}}
    assert_same(read(exr_file(layers), "light.exr", "sun").pixels, PICTURE)


# ---------------------------------------------------------------------------------------------- strings in any encoding


def in_latin1(data, old, new):
    """The file with the bytes `new`, of the same length, in the place of the text `old`."""
    assert len(old) == len(new)
    assert old in data
    return data.replace(old, new)


CODECS = ("NO", "ZIP", "PIZ", "DWAA")


@pytest.mark.parametrize("codec", CODECS)
def test_strings_that_are_no_utf8_are_no_reason_to_refuse(read, codec):
    """An owner in Latin-1, a filler of 0xff, one of several texts, a name that outgrows 31 bytes: the texels stay."""
    compression = getattr(OpenEXR, f"{codec}_COMPRESSION")
    plain = exr_file({"RGB": PICTURE}, compression=compression)
    long = {"a" * 31: "x", "texts": ["QQ N", "R"]}
    data = exr_file({"RGB": PICTURE}, compression=compression, owner="QQ M", comments="z" * 300, **long)
    data = in_latin1(data, b"QQ M", b"\xa9 M\xfc")
    data = in_latin1(data, b"z" * 300, b"\xff" * 300)
    data = in_latin1(data, b"QQ N", b"\xa9 N\xfc")
    data = in_latin1(data, b"a" * 31 + b"\0", b"a" * 30 + b"\xfc\0")
    assert_same(read(data, "light.exr").pixels, read(plain, "light.exr").pixels)


@pytest.mark.parametrize("codec", CODECS)
def test_channels_whose_names_are_no_utf8_keep_their_order_and_their_texels(read, codec):
    """As every codec but the lossless ones treats R, G and B in a way of their own, what ends their names stays.

    Where one name is no UTF-8 none is taken for it: two letters of Latin-1 may be one of UTF-8.
    """
    compression = getattr(OpenEXR, f"{codec}_COMPRESSION")
    names = [f"{layer}.{c}" for layer in ("aa", "zyz", "zz") for c in "RGB"]
    layers = {name: (PICTURE[..., "RGB".index(name[-1])] + i // 3).astype(np.float16) for i, name in enumerate(names)}
    data = exr_file(layers, compression=compression)
    data = in_latin1(in_latin1(data, b"zyz.", "èz.".encode()), b"zz.", b"\xe8z.")
    for layer, label in (("aa", "aa"), ("zyz", "Ã¨z"), ("zz", "èz")):
        expected = decode_openexr(exr_file(layers, compression=compression), layer=layer).pixels
        assert_same(read(data, "light.exr", label).pixels, expected)


def test_parts_and_tiles_are_found_behind_headers_that_grew(read):
    parts = exr_parts(
        exr_part("sky", {"RGB": PICTURE}),
        exr_part("xyz", {"RGB": 2 * PICTURE}, comments="QQQQ"),
        exr_part("last", {"RGB": 3 * PICTURE}, owner="QQ M"),
    )
    data = in_latin1(in_latin1(parts, b"xyz", b"x\xffz"), b"QQ M", b"\xa9 M\xfc")
    for name, factor in (("sky", 1), ("xÿz", 2), ("last", 3)):
        assert_same(read(data, "light.exr", name).pixels, factor * PICTURE)
    tiles = OpenEXR.TileDescription()
    tiles.xSize = tiles.ySize = 4
    tiled = exr_file({"RGB": PICTURE}, type=OpenEXR.tiledimage, tiles=tiles, owner="QQ M")
    assert_same(read(in_latin1(tiled, b"QQ M", b"\xa9 M\xfc"), "light.exr").pixels, PICTURE)


def test_a_layer_that_is_not_ascii_is_shown_so_that_it_can_be_typed_back(tmp_path):
    path = tmp_path / "light.exr"
    layers = {f"{layer}.{c}": PICTURE[..., 0].copy() for layer in ("größe", "天", "a\nb") for c in "RGB"}
    path.write_bytes(exr_file(layers))
    with pytest.raises(LightError, match="3 layers to choose from") as caught:
        find_light(str(path))
    shown = str(caught.value).partition("choose from: ")[2].partition(";")[0].split(", ")
    assert shown == [r"a\nb", "größe", "天"]
    for name in shown:
        assert find_light(f"{path}:{name}").pixels.shape == PICTURE.shape


def test_a_header_that_is_broken_and_no_utf8_is_refused_or_read_whatever_the_bytes():
    rng = np.random.default_rng(4)
    seed = in_latin1(exr_file({"RGB": PICTURE}, owner="QQ M"), b"QQ M", b"\xa9 M\xfc")
    seeds = [
        seed,
        exr_parts(exr_part("a", {"RGB": PICTURE}), exr_part("b", {"RGB": PICTURE})).replace(b"B\0", b"\xff\0"),
    ]
    refusals = []
    for number in range(400):
        data = bytearray(seeds[number % 2])
        for place in rng.integers(4, min(len(data), 900), rng.integers(1, 6)):
            data[place] = rng.integers(0, 256)
        try:
            decode_openexr(bytes(data))
        except LightError as error:
            refusals.append(str(error))
    assert 50 < len(refusals) < 400
    assert all(text.isprintable() for text in refusals)
