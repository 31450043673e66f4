"""Minima and largest errors are the function's own, not a grid's."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from shviewer.harmonics.basis import evaluate_basis, index
from shviewer.harmonics.extremes.climbing import climb, valleys
from shviewer.harmonics.extremes.error_grid import ErrorGrid
from shviewer.harmonics.synthesis import Synthesis
from shviewer.lights.find import find_light


def grey(coefficients: np.ndarray) -> np.ndarray:
    return np.repeat(coefficients[:, None], 3, axis=1)


def lowest(coefficients: np.ndarray) -> tuple[float, np.ndarray]:
    """The deepest valley: its value, and its direction (3,)."""
    values, directions, _ = valleys(coefficients)
    return values.min(), directions[values.argmin()]


def test_the_minimum_of_one_harmonic_is_known() -> None:
    zonal = np.zeros(9)
    zonal[index(2, 0)] = 1
    value, direction = lowest(grey(zonal))  # sqrt(5/16pi) (3 z^2 - 1), lowest on the equator
    assert_allclose(value, -np.sqrt(5 / (16 * np.pi)), rtol=0, atol=1e-9)
    assert abs(direction[2]) < 1e-4


@pytest.mark.parametrize("n_bands", [3, 8, 20])
def test_no_direction_is_lower_than_the_minimum(n_bands: int) -> None:
    rng = np.random.default_rng(n_bands)
    coefficients = rng.normal(size=(n_bands**2, 3))
    value, direction = lowest(coefficients)
    values = evaluate_basis(rng.normal(size=(50_000, 3)), n_bands) @ coefficients
    assert values.min() >= value
    assert_allclose((evaluate_basis(direction, n_bands) @ coefficients).min(), value, rtol=0, atol=1e-12 * n_bands)


def test_valleys_of_equal_channels_are_listed_once() -> None:
    coefficients = np.random.default_rng(0).normal(size=(25, 3))
    coefficients[:, 2] = coefficients[:, 0]
    _, _, channels = valleys(coefficients)
    assert set(channels) == {0, 1}


def test_climbing_reaches_the_top_from_both_poles_and_the_seam() -> None:
    top = np.array([0.02, -0.01, 1.0]) / np.linalg.norm([0.02, -0.01, 1.0])
    starts = np.array([[0.0, 0, 1], [0.1, 0, 0.995], [-0.1, 1e-9, 0.995]])
    starts /= np.linalg.norm(starts, axis=1, keepdims=True)
    values, places = climb(lambda d: d @ top, starts, 0.2, 20)
    assert_allclose(values, 1, rtol=0, atol=1e-9)
    assert_allclose(places, np.tile(top, (3, 1)), rtol=0, atol=1e-4)


@pytest.mark.parametrize(("n_bands", "wanted"), [(16, 0.0652), (32, 0.0314)])
def test_the_largest_error_of_green_is_that_at_the_kinks(n_bands: int, wanted: float) -> None:
    """Against a grid of 1024 rows: the error peaks on the edge of a lobe, on one of many hills."""
    light = find_light("green")
    coefficients = light.coefficients(n_bands)
    found = ErrorGrid(light.radiance, light.landmarks(), 128).compare(coefficients)
    fine = ErrorGrid(light.radiance, light.landmarks(), 1024)
    values = Synthesis(coefficients).on_rows(fine.theta, len(fine.phi))
    assert found.max_error >= 0.97 * np.abs(values - fine.original).max()
    assert_allclose(found.max_error, wanted, rtol=0.02)
