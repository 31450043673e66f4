"""What shviewer.harmonics.areas.cycling promises: a function whose axes are exchanged cyclically."""

import numpy as np
import pytest
from harmonics.independent import random_directions

from shviewer.harmonics.areas.cycling import cycled
from shviewer.harmonics.basis import evaluate_basis


@pytest.mark.parametrize("n_bands", [1, 2, 3, 9, 40])
def test_the_value_at_x_y_z_is_the_one_that_was_at_y_z_x(n_bands):
    coefficients = np.random.default_rng(0).normal(size=(n_bands**2, 2))
    directions = random_directions(200, seed=1)
    expected = evaluate_basis(directions[:, [1, 2, 0]], n_bands) @ coefficients
    found = evaluate_basis(directions, n_bands) @ cycled(coefficients)
    assert np.abs(found - expected).max() < 1e-15 * n_bands * np.abs(coefficients).sum() ** 0.5 * n_bands


def test_three_times_is_nothing_at_many_bands():
    coefficients = np.random.default_rng(0).normal(size=(200**2,))
    assert np.abs(cycled(cycled(cycled(coefficients))) - coefficients).max() < 1e-13
