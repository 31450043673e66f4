"""What shviewer.harmonics.synthesis promises about whole maps; rows and scattered directions are in test_projection.py."""

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
