"""What shviewer.harmonics.projection.row_transform promises: folds and blocks do not show, float32 stays within its bound."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.harmonics.projection import row_transform
from shviewer.harmonics.projection.row_transform import FOLD_BANDS, RowFunctions, by_parity, row_sums
from shviewer.harmonics.projection.rows import project_image
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles
from shviewer.harmonics.zonal import Gaussian

SHAPES = [(1, 1), (1, 8), (2, 2), (3, 6), (5, 4), (64, 12), (65, 10), (129, 7), (130, 3), (200, 400)]


def row_functions(n_bands, rows):
    theta = np.pi * (np.arange(rows) + 0.5) / rows
    angle = np.arange(n_bands)[:, None] * theta
    return RowFunctions(np.sin(theta) * np.cos(angle), np.sin(theta) * np.sin(angle))


@pytest.mark.parametrize("n_bands", [1, 2, 7, FOLD_BANDS - 1, FOLD_BANDS, FOLD_BANDS + 9])
@pytest.mark.parametrize(("height", "width"), SHAPES)
def test_the_sums_are_the_plain_products_over_the_rows(height, width, n_bands):
    values = np.random.default_rng(height).standard_normal((height, width, 3))
    functions = row_functions(n_bands, height)
    even, odd = row_sums(values, functions, np.float64)
    if width % 2:
        left, right = values, values
    else:
        west, east = values[:, : width // 2], values[:, width // 2 :]
        left, right = west + east, west - east
    order = by_parity(n_bands)
    assert_allclose(even, np.einsum("kr,rxc->xck", functions.cosines[order], left), rtol=0, atol=1e-15 * 20 * height)
    assert_allclose(odd, np.einsum("kr,rxc->xck", functions.sines[order], right), rtol=0, atol=1e-15 * 20 * height)


@pytest.mark.parametrize("n_bands", [5, FOLD_BANDS])
@pytest.mark.parametrize(
    "blocks", [{"BLOCK_ROWS": 5, "MAX_STEP": 4}, {"FOLD_VALUES": 70}, {"FOLDED_VALUES": 1, "FEWEST_ROWS": 3}]
)
def test_blocks_do_not_show(monkeypatch, n_bands, blocks):
    image = np.random.default_rng(13).random((23, 10, 3))
    whole = project_image(image, n_bands)
    for name, size in blocks.items():
        monkeypatch.setattr(row_transform, name, size)
    assert_allclose(project_image(image, n_bands), whole, rtol=0, atol=1e-14)


def sky(height, width):
    theta = np.pi * (np.arange(height) + 0.5) / height
    return np.broadcast_to((1.2 + np.cos(theta))[:, None, None] * [0.7, 0.8, 1.1], (height, width, 3))


def noise(height, width):
    return np.random.default_rng(5).gamma(0.3, 1.0, (height, width, 3))


def glow(height, width):
    theta = np.pi * (np.arange(height) + 0.5) / height
    directions = directions_from_angles(theta[:, None], column_azimuths(width)).reshape(-1, 3)
    chord = directions - np.array([0.6, 0.0, 0.8])
    lobe = 2e4 * Gaussian(3000.0).value((chord * chord).sum(axis=1)).reshape(height, width, 1)
    return sky(height, width) + lobe * [1.0, 0.9, 0.7]


@pytest.mark.parametrize("picture", [sky, noise, glow, lambda h, w: np.full((h, w, 3), 0.73)])
@pytest.mark.parametrize("n_bands", [3, 9, 16, 64])
@pytest.mark.parametrize(("height", "width"), [(256, 1024), (255, 1030), (128, 1025)])
def test_float32_is_within_2e_8_of_the_largest_coefficient(picture, height, width, n_bands):
    # each product rounds by 2**-24; sums of 64 of them, over 512 columns and more, leave a third of that
    image = picture(height, width).astype(np.float32)
    exact = project_image(image, n_bands)
    fast = project_image(image, n_bands, np.float32)
    assert (picture is not noise) or not np.array_equal(fast, exact)  # it is not float64 after all
    assert np.abs(fast - exact).max() < 2e-8 * np.abs(exact).max()


def test_a_narrow_image_is_summed_in_float64_whatever_is_asked_for():
    image = noise(64, 1022).astype(np.float32)
    assert_array_equal(project_image(image, 9, np.float32), project_image(image, 9))
