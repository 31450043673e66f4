"""Crosses with something in their empty cells, packs and borders: recognised where it is certain, else lat-long with a note."""

from functools import cache

import numpy as np
import pytest
from PIL import Image, ImageDraw

from shviewer.lights.find import find_light
from shviewer.lights.layouts.arrangements import HORIZONTAL_CROSS, PACK, TALL_PACK, VERTICAL_CROSS, Arrangement
from shviewer.lights.layouts.cube import CubeLayout
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.recognise import recognise

MAPS = ("venice_sunset", "mud_road_puresky", "st_fagans_interior", "film_studio")
CROSSES = (HORIZONTAL_CROSS, VERTICAL_CROSS)
SIZE = 64


@cache
def seen(name, arrangement, size=SIZE):
    """A map in some arrangement, each texel the mean of nine places; 0 in empty cells. Do not change it."""
    fine = CubeLayout(arrangement, 3 * size)
    rows, columns = np.mgrid[0 : arrangement.rows * 3 * size, 0 : arrangement.columns * 3 * size]
    light = find_light(name).radiance(fine.centres(rows.ravel(), columns.ravel()))
    pixels = light.reshape(arrangement.rows * size, 3, arrangement.columns * size, 3, 3).mean(axis=(1, 3))
    for row, column in empty_cells(arrangement):
        pixels[row * size : (row + 1) * size, column * size : (column + 1) * size] = 0
    return pixels.astype(np.float32)


def empty_cells(arrangement):
    faces = {(face.row, face.column) for face in arrangement.faces}
    return [cell for cell in np.ndindex(arrangement.rows, arrangement.columns) if cell not in faces]


def filled(pixels, arrangement, content):
    """content: (size, size) or (size, size, 3), in all empty cells."""
    size, pixels = len(content), pixels.copy()
    for row, column in empty_cells(arrangement):
        pixels[row * size : (row + 1) * size, column * size : (column + 1) * size] = np.reshape(
            content, (size, size, -1)
        )
    return pixels


def checkerboard():
    rows, columns = np.mgrid[0:SIZE, 0:SIZE] // 8
    return 0.4 + 0.4 * ((rows + columns) % 2)


def text():
    page = Image.new("L", (SIZE, SIZE))
    ImageDraw.Draw(page).multiline_text((2, 2), "front\nleft\nsky.exr\n64 x 64", fill=255)
    return np.asarray(page) / 255


def lat_long(name, height, width):
    theta, phi = np.pi * (np.arange(height) + 0.5) / height, np.pi * (1 - 2 * (np.arange(width) + 0.5) / width)
    x, y, z = np.sin(theta)[:, None] * np.cos(phi), np.sin(theta)[:, None] * np.sin(phi), np.cos(theta)[:, None]
    directions = np.stack(np.broadcast_arrays(x, y, z), axis=-1).reshape(-1, 3)
    return find_light(name).radiance(directions).reshape(height, width, 3).astype(np.float32)


@pytest.mark.parametrize("content", [checkerboard(), text(), np.random.default_rng(0).random((SIZE, SIZE, 3))])
@pytest.mark.parametrize("arrangement", CROSSES, ids=lambda it: it.name)
@pytest.mark.parametrize("name", MAPS)
def test_a_cross_with_something_in_its_empty_cells_is_recognised_by_its_seams(name, arrangement, content):
    layout, (note,), _ = recognise(filled(seen(name, arrangement), arrangement, content), None, "auto")
    assert layout == CubeLayout(arrangement, SIZE)
    assert f"is taken as a cube, {arrangement.name}, since its faces fit together" in note


@pytest.mark.parametrize("arrangement", [PACK, TALL_PACK], ids=lambda it: it.name)
@pytest.mark.parametrize("name", MAPS)
def test_a_pack_is_recognised_by_its_seams(name, arrangement):
    layout, (note,), _ = recognise(seen(name, arrangement), None, "auto")
    assert layout == CubeLayout(arrangement, SIZE)
    assert arrangement.name in note


@pytest.mark.parametrize("arrangement", [*CROSSES, PACK, TALL_PACK], ids=lambda it: it.name)
@pytest.mark.parametrize("name", MAPS)
def test_a_map_of_that_shape_that_is_no_cube_is_lat_long_with_a_note(name, arrangement):
    pixels = lat_long(name, arrangement.rows * SIZE, arrangement.columns * SIZE)
    layout, (note,), _ = recognise(pixels, None, "auto")
    assert layout == LatLongLayout(*pixels.shape[:2])
    assert "--layout cube if it is one" in note


def with_faces(arrangement, order, turns=None):
    """The pack with its faces in another order, some turned by quarters."""
    pixels = seen("venice_sunset", arrangement)
    cells = [(face.row * SIZE, face.column * SIZE) for face in arrangement.faces]
    faces = [np.rot90(pixels[r : r + SIZE, c : c + SIZE], (turns or {}).get(i, 0)) for i, (r, c) in enumerate(cells)]
    result = np.zeros_like(pixels)
    for (r, c), i in zip(cells, order, strict=True):
        result[r : r + SIZE, c : c + SIZE] = faces[i]
    return result


@pytest.mark.parametrize(
    ("order", "turns"),
    [
        ((1, 0, 2, 3, 4, 5), {}),
        ((0, 1, 3, 2, 4, 5), {}),
        ((0, 1, 2, 3, 5, 4), {}),
        ((1, 4, 0, 3, 5, 2), {}),
        (range(6), {2: 2}),
        (range(6), {3: 1}),
        (range(6), {0: 1}),
    ],
)
def test_faces_in_another_order_or_turned_are_not_taken_for_this_one(order, turns):
    layout, (note,), _ = recognise(with_faces(PACK, order, turns), None, "auto")
    assert isinstance(layout, LatLongLayout)
    assert "no pack of a cube" in note


@pytest.mark.parametrize(
    "pixels",
    [
        np.ones((128, 192, 3), np.float32),
        np.random.default_rng(1).random((128, 192, 3)).astype(np.float32),
        np.zeros((128, 192, 3), np.float32),
        np.full((128, 192, 3), -1, np.float32),
    ],
    ids=["white", "noise", "black", "negative"],
)
def test_an_image_whose_borders_prove_nothing_is_no_pack(pixels):
    assert isinstance(recognise(pixels, None, "auto").layout, LatLongLayout)


@pytest.mark.parametrize("colour", [0.0, 1.0, (1, 0, 1)], ids=["black", "white", "magenta"])
@pytest.mark.parametrize("width", [1, 5, 40])
@pytest.mark.parametrize("content", [np.zeros((SIZE, SIZE)), checkerboard()], ids=["black", "checkerboard"])
@pytest.mark.parametrize("arrangement", CROSSES, ids=lambda it: it.name)
def test_a_border_around_a_cross_is_cut_off(arrangement, content, width, colour):
    cross = filled(seen("venice_sunset", arrangement), arrangement, content)
    framed = np.empty((len(cross) + 2 * width, cross.shape[1] + 2 * width, 3), np.float32)
    framed[:] = colour
    framed[width:-width, width:-width] = cross
    layout, (note,), pixels = recognise(framed, None, "auto")
    assert layout == CubeLayout(arrangement, SIZE)
    np.testing.assert_array_equal(pixels, cross)
    assert f"of {cross.shape[1]} x {len(cross)} within a border" in note
    asked, _, same = recognise(framed, None, "cube")
    assert asked == layout
    np.testing.assert_array_equal(same, cross)


def test_a_border_around_a_lat_long_map_is_part_of_it():
    """What is certain: a cross. A frame around anything else may be meant."""
    pixels = np.zeros((70, 134, 3), np.float32)
    pixels[3:-3, 3:-3] = lat_long("venice_sunset", 64, 128)
    layout, (note,), same = recognise(pixels, None, "auto")
    assert layout == LatLongLayout(70, 134)
    assert same is pixels
    assert "is not 2:1" in note


def test_a_pack_is_the_light_of_the_map_it_was_made_of():
    pack: Arrangement = PACK
    light = find_light("venice_sunset")
    coefficients = recognise(seen("venice_sunset", pack), None, "auto").layout.project(seen("venice_sunset", pack), 3)
    np.testing.assert_allclose(coefficients, light.coefficients(3), rtol=0, atol=0.02 * light.coefficients(1).max())
