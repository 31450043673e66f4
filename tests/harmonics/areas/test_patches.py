"""What shviewer.harmonics.areas.patches promises: texels of constant value against any smooth kernel, through few points."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from shviewer.harmonics.areas.patches import (
    DIRECT_BANDS,
    project_mirrored,
    quadrant_points,
    quadrant_weights,
    texel_weights,
)
from shviewer.harmonics.basis import evaluate_basis


@pytest.mark.parametrize("n_points", [1, 2, 3, 8, 41])
@pytest.mark.parametrize("n_texels", [1, 2, 7, 300])
def test_texel_weights_integrate_polynomials_exactly(n_points, n_texels):
    edges = np.sort(np.random.default_rng(n_texels).uniform(0.2, 3.0, n_texels + 1))
    points, weights = texel_weights(edges, n_points)
    middle, half = (edges[0] + edges[-1]) / 2, (edges[-1] - edges[0]) / 2
    for degree in range(n_points):
        polynomial = np.polynomial.Legendre.basis(degree)
        primitive = polynomial.integ()
        exact = half * np.diff(primitive((edges - middle) / half))
        assert_allclose(polynomial((points - middle) / half) @ weights, exact, rtol=0, atol=4e-15 * n_points)


@pytest.mark.parametrize("n_texels", [1, 2, 5, 8])
def test_half_of_an_odd_middle_texel_is_in_each_half(n_texels):
    points, weights = quadrant_points(n_texels, 6)
    assert weights.shape == (6, n_texels - n_texels // 2)
    assert (points > 0).all()
    assert (points < 1).all()
    sizes = np.full(n_texels - n_texels // 2, 2 / n_texels)
    sizes[0] /= 1 + n_texels % 2
    assert_allclose(weights.sum(axis=0), sizes, rtol=0, atol=1e-15)


@pytest.mark.parametrize(("height", "width"), [(1, 1), (2, 2), (3, 5), (8, 6), (301, 40)])
def test_quadrants_are_lower_then_right_and_measured_from_the_centre(height, width):
    """Against a sum over texels of the kernel's own integral, by many midpoints."""
    image = np.random.default_rng(0).random((height, width, 3))
    points, weights = quadrant_weights(image, 12)
    fine = 240
    y, x = (2 * (np.arange(n * fine) + 0.5) / (n * fine) - 1 for n in (height, width))
    signed = np.concatenate([-points, points])
    for power_y, power_x in ((0, 0), (1, 0), (0, 1), (3, 2)):
        over_rows = (y**power_y).reshape(height, fine).sum(axis=1) * 2 / len(y)
        over_columns = (x**power_x).reshape(width, fine).sum(axis=1) * 2 / len(x)
        expected = np.einsum("r,c,rcx->x", over_rows, over_columns, image)
        kernel = (signed**power_y)[:, None] * signed**power_x
        result = np.einsum("aibj,abijx->x", kernel.reshape(2, 12, 2, 12), weights)
        assert_allclose(result, expected, rtol=0, atol=2e-5)  # of the midpoints, 1 / (12 fine^2) of a cube's integral


def test_columns_outside_their_span_count_as_nothing():
    image = np.random.default_rng(1).random((5, 6, 3))
    spans = np.array([[0, 6], [2, 4], [3, 3], [0, 1], [5, 6]])
    cut = image.copy()
    for row, (start, stop) in enumerate(spans):
        cut[row, :start] = cut[row, stop:] = 0
    assert_allclose(quadrant_weights(image, 9, spans)[1], quadrant_weights(cut, 9)[1], rtol=0, atol=1e-16)


def test_blocks_of_rows_change_nothing(monkeypatch):
    image = np.random.default_rng(2).random((50, 30, 3)).astype(np.float32)
    whole = quadrant_weights(image, 15)[1]
    monkeypatch.setattr("shviewer.harmonics.areas.patches.BLOCK_VALUES", 8 * 30 * 7)
    assert_allclose(quadrant_weights(image, 15)[1], whole, rtol=0, atol=1e-15)


@pytest.mark.parametrize("mirrors", [(1, 1, 1), (2, 1, 1), (1, 2, 1), (1, 1, 2), (1, 2, 2), (2, 2, 2)])
@pytest.mark.parametrize("n_bands", [1, 2, 7, DIRECT_BANDS, DIRECT_BANDS + 1])
def test_mirrored_points_count_as_if_each_were_given(mirrors, n_bands):
    random = np.random.default_rng(3)
    directions = random.normal(size=(150, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    values = random.normal(size=(*mirrors, 150, 3))
    expected = np.zeros((n_bands**2, 3))
    for index in np.ndindex(mirrors):
        expected += evaluate_basis(directions * (1 - 2 * np.array(index)), n_bands).T @ values[index]
    assert_allclose(project_mirrored(directions, values, n_bands), expected, rtol=0, atol=1e-12)


def test_no_bands_are_an_error():
    with pytest.raises(ValueError, match="0 bands"):
        project_mirrored(np.eye(3), np.zeros((1, 1, 1, 3, 3)), 0)
