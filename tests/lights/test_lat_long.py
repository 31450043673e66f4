"""What shviewer.lights.lat_long promises: where the texels of an image lie on the sphere, and what lies between them."""

import numpy as np
import pytest
from harmonics.independent import random_directions
from numpy.testing import assert_allclose

from shviewer.lights.lat_long import LatLongMap

SIZES = [(1, 1), (1, 2), (2, 4), (3, 6), (5, 10), (8, 6), (16, 32)]
ODD_SIZES = [(1, 1), (2, 3), (5, 7), (4, 1), (6, 11)]
FLOAT32 = 2.0**-22
"""Texels of size 1 are float32; the look-up itself is float64."""


def random_map(height, width, *, rows_on_poles=False, seed=0):
    texels = np.random.default_rng(seed).random((height, width, 3)).astype(np.float32)
    if rows_on_poles:
        texels[[0, -1]] = texels[[0, -1], :1]  # a function has one value at a pole
    return LatLongMap(texels, rows_on_poles)


def towards(theta, phi):
    """Directions (k, 3) for angles that broadcast."""
    theta, phi = np.broadcast_arrays(np.asarray(theta, dtype=float), np.asarray(phi, dtype=float))
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1).reshape(-1, 3)


def texel_centres(height, width):
    theta = np.pi * (np.arange(height) + 0.5) / height
    return towards(theta[:, None], np.pi * (1 - 2 * (np.arange(width) + 0.5) / width))


@pytest.mark.parametrize(("height", "width"), SIZES + ODD_SIZES)
def test_the_centre_of_a_texel_has_its_radiance(height, width):
    image = random_map(height, width)
    assert_allclose(image.sample(texel_centres(height, width)), image.texels.reshape(-1, 3), rtol=0, atol=1e-13)


@pytest.mark.parametrize(("height", "width"), [(2, 4), (3, 7), (9, 16)])
def test_rows_on_the_poles_have_their_radiance_there(height, width):
    image = random_map(height, width, rows_on_poles=True)
    theta = np.linspace(0, np.pi, height)
    d = towards(theta[:, None], np.pi * (1 - 2 * (np.arange(width) + 0.5) / width))
    assert_allclose(image.sample(d), image.texels.reshape(-1, 3), rtol=0, atol=1e-13)
    assert_allclose(image.sample(np.array([[0, 0, 1.0], [0, 0, -1.0]])), image.texels[[0, -1], 0], rtol=0, atol=1e-13)


@pytest.mark.parametrize(("height", "width"), SIZES + ODD_SIZES)
@pytest.mark.parametrize("rows_on_poles", [False, True])
def test_the_seam_does_not_show(height, width, rows_on_poles):
    image = random_map(height, width, rows_on_poles=rows_on_poles)
    theta, step = np.linspace(0.1, 3.0, 25), 1e-9
    before, after = image.sample(towards(theta, np.pi - step)), image.sample(towards(theta, -np.pi + step))
    assert_allclose(before, after, rtol=0, atol=4 * step * width)


@pytest.mark.parametrize(("height", "width"), SIZES)
@pytest.mark.parametrize("rows_on_poles", [False, True])
@pytest.mark.parametrize("pole", [0, np.pi])
def test_a_great_circle_crosses_the_pole_without_a_step(height, width, rows_on_poles, pole):
    image = random_map(height, width, rows_on_poles=rows_on_poles)
    phi, step = np.linspace(-3, 3, 25), 1e-9
    before, after = image.sample(towards(pole + step, phi)), image.sample(towards(pole - step, phi))
    assert_allclose(before, after, rtol=0, atol=8 * step * height)


@pytest.mark.parametrize(("height", "width"), [(2, 3), (5, 7), (6, 11)])
def test_a_great_circle_crosses_the_pole_of_an_image_of_odd_width_without_a_step(height, width):
    image = random_map(height, width)
    phi, step = np.linspace(-3, 3, 25), 1e-9
    before, after = image.sample(towards(step, phi)), image.sample(towards(-step, phi))
    assert_allclose(before, after, rtol=0, atol=8 * step * height)


@pytest.mark.parametrize(("height", "width"), SIZES)
def test_beyond_a_pole_comes_the_row_half_way_round(height, width):
    image = random_map(height, width)
    half_row = np.pi / height / 2
    phi = np.pi * (1 - 2 * (np.arange(width) + 0.5) / width)
    near_pole = image.sample(towards(1e-12, phi))
    opposite = np.roll(image.texels[0], width // 2, axis=0)
    assert_allclose(near_pole, 0.5 * image.texels[0] + 0.5 * opposite, rtol=0, atol=FLOAT32)
    quarter = image.sample(towards(np.pi - half_row / 2, phi))
    opposite = np.roll(image.texels[-1], width // 2, axis=0)
    assert_allclose(quarter, 0.75 * image.texels[-1] + 0.25 * opposite, rtol=0, atol=FLOAT32)


def test_the_centre_of_an_image_looks_along_x_and_its_left_half_along_y():
    texels = np.zeros((2, 4, 3), np.float32)
    texels[:, 1:3, 0] = 1  # the middle
    texels[:, :2, 1] = 1  # the left half
    texels[0, :, 2] = 1  # the top
    image = LatLongMap(texels)
    front, back, left, right = image.sample(towards(np.pi / 2, [0, np.pi, np.pi / 2, -np.pi / 2]))
    up, down = image.sample(towards([np.pi / 4, 3 * np.pi / 4], 0.3))
    assert (front[0], back[0]) == pytest.approx((1, 0))
    assert (left[1], right[1]) == pytest.approx((1, 0))
    assert (up[2], down[2]) == pytest.approx((1, 0))


@pytest.mark.parametrize("rows_on_poles", [False, True])
def test_one_texel_is_a_constant(rows_on_poles):
    image = LatLongMap(np.array([[[1.0, 2.0, 3.0]]], np.float32), rows_on_poles)
    d = np.concatenate([random_directions(100, seed=1), np.eye(3), -np.eye(3)])
    assert_allclose(image.sample(d), np.broadcast_to([1.0, 2.0, 3.0], (106, 3)), rtol=0, atol=1e-14)


@pytest.mark.parametrize(("height", "width"), SIZES + ODD_SIZES)
def test_no_look_up_leaves_the_range_of_the_texels(height, width):
    image = random_map(height, width)
    values = image.sample(random_directions(2000, seed=2))
    assert values.min() >= image.texels.min() - FLOAT32
    assert values.max() <= image.texels.max() + FLOAT32


@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_the_exact_poles_and_the_exact_seam_are_finite(zero):
    image = random_map(5, 8)
    d = np.array([[zero, zero, 1.0], [zero, zero, -1.0], [-1.0, zero, 0.0], [-1.0, 0.0, zero]])
    assert np.isfinite(image.sample(d)).all()
    assert_allclose(*image.sample(np.array([[-1.0, 0.0, 0.2], [-1.0, -0.0, 0.2]])), rtol=0, atol=1e-14)


@pytest.mark.parametrize(("rows_on_poles", "top", "middle", "bottom"), [(False, -0.5, 3.5, 7.5), (True, 0, 3.5, 7)])
def test_rows_grow_from_the_north(rows_on_poles, top, middle, bottom):
    scale, offset = random_map(8, 3, rows_on_poles=rows_on_poles).row_scale_offset
    assert [scale * theta + offset for theta in (0, np.pi / 2, np.pi)] == pytest.approx([top, middle, bottom])


def test_values_are_float64():
    assert random_map(2, 4).sample(towards(1.0, [0, 1, 2])).dtype == np.float64


SMALLEST = 2.0**-24
"""The smallest half float above 0."""


@pytest.mark.parametrize(
    ("value", "halves"),
    [
        *(
            (value, True)
            for value in (0.0, 1.0, -1.0, 65504.0, -65504.0, 2.0**-14, SMALLEST, -3 * SMALLEST, 1 + 2.0**-10)
        ),
        *((value, False) for value in (65520.0, 65536.0, -70000.0, SMALLEST / 2, 1 + 2.0**-11, 0.1, 1e30, 2049.0)),
        *((value, False) for value in (2.0**-14 + 2.0**-25, 1.5 * SMALLEST, 2.0**-40)),
    ],
)
def test_a_map_knows_whether_half_floats_hold_all_its_texels(value: float, halves: bool) -> None:
    texels = np.ones((40, 3000, 3), np.float32)
    assert LatLongMap(texels).halves
    texels[33, 2999, 2] = value
    assert LatLongMap(texels).halves is halves
    with np.errstate(over="ignore"):
        assert halves is bool(np.float32(np.float16(value)) == np.float32(value))
