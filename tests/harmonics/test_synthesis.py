"""What shviewer.harmonics.synthesis promises about whole maps; rows and scattered directions: projection/test_projection.py."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from shviewer.harmonics.synthesis import Synthesis


@pytest.mark.parametrize("n_bands", [1, 2, 3, 8, 17, 40, 128])
@pytest.mark.parametrize(("rows", "columns"), [(2, 2), (5, 7), (4, 4), (3, 1), (129, 1030), (200, 11)])
def test_a_map_from_pole_to_pole_is_the_sum_on_its_rows_in_float32(n_bands, rows, columns):
    coefficients = np.random.default_rng(n_bands).standard_normal((n_bands**2, 3))
    synthesis = Synthesis(coefficients)
    expected = synthesis.on_rows(np.linspace(0, np.pi, rows), columns).transpose(0, 2, 1)
    found = synthesis.pole_to_pole(rows, columns)
    assert found.dtype == np.float32
    assert found.flags.c_contiguous
    # 2**-24 for each of about sqrt(2 n) random roundings of terms as large as the peak of a random function, 4.5 sigma
    peak = np.sqrt((coefficients**2).sum(axis=0).max() / (4 * np.pi)) * 4.5
    assert_allclose(found, expected, rtol=0, atol=2.0**-24 * np.sqrt(2 * n_bands) * peak)


def spline_at(nodes, row, column):
    """The sum of quadratic B-splines, in float64: beyond a pole comes the same row half way round."""
    height, width = nodes.shape[:2]
    nodes = nodes[..., :3].astype(np.float64)
    value = np.zeros((len(row), 3))
    for i in range(-1, 2):
        for j in range(-1, 2):
            r, c = np.floor(row + 0.5) + i, np.floor(column + 0.5) + j
            weight = spline(row - r) * spline(column - c)
            c = np.where((r < 0) | (r >= height), c + width // 2, c)
            r = np.where(r < 0, -r, np.where(r >= height, 2 * (height - 1) - r, r))
            value += weight[:, None] * nodes[r.astype(int), c.astype(int) % width]
    return value


def spline(t):
    """The quadratic B-spline of the node at 0."""
    t = np.abs(t)
    return np.where(t < 0.5, 0.75 - t**2, np.where(t < 1.5, 0.5 * (1.5 - t) ** 2, 0))


@pytest.mark.parametrize("n_bands", [1, 3, 9, 32])
def test_the_splines_of_a_map_take_the_values_at_its_nodes(n_bands):
    coefficients = np.random.default_rng(n_bands).standard_normal((n_bands**2, 3))
    synthesis = Synthesis(coefficients)
    nodes, exact = synthesis.spline_map(65, 128), synthesis.pole_to_pole(65, 128).astype(np.float64)
    assert nodes.shape == (65, 128, 4)
    assert not nodes[..., 3].any()
    row, column = (index.ravel() for index in np.indices((65, 128)))
    peak = np.abs(exact).max()
    # float32 rounds coefficients that are up to 1/(3/4 + cos(1.55)/4)^2 = 1.8 times as large as the function
    assert_allclose(spline_at(nodes, row, column), exact.reshape(-1, 3), rtol=0, atol=2e-6 * peak)


@pytest.mark.parametrize(("n_bands", "columns"), [(5, 512), (16, 1024), (32, 2048), (128, 2048)])
def test_between_its_nodes_a_spline_map_is_as_good_as_it_says(n_bands, columns):
    rng = np.random.default_rng(n_bands)
    coefficients = rng.standard_normal((n_bands**2, 3))
    synthesis = Synthesis(coefficients)
    rows = columns // 2 + 1
    nodes = synthesis.spline_map(rows, columns)
    row, column = rng.uniform(0, rows - 1, 4000), rng.uniform(0, columns, 4000)
    row[:100] = rng.uniform(0, 2, 100)  # at the poles
    row[100:200] = rows - 1 - row[:100]
    exact = synthesis.at(np.pi * row / (rows - 1), np.pi * (1 - (2 * column + 1) / columns))
    error = np.abs(spline_at(nodes, row, column) - exact).max() / np.abs(exact).max()
    wave = 2 * np.pi * (n_bands - 1) / columns
    assert error < 0.012 * wave**3 + 1e-6  # 0.006 along each axis for the shortest wave, and float32
    assert error > 1e-9  # a map of splines is not the function


def test_a_map_too_coarse_for_its_bands_is_refused():
    with pytest.raises(ValueError, match="9 bands need more nodes than 9 x 40"):
        Synthesis(np.zeros((81, 3))).spline_map(9, 40)
