"""Rotated coefficients belong to the rotated function."""

from __future__ import annotations

import numpy as np
import pytest
from harmonics.independent import random_rotation
from numpy.testing import assert_allclose
from places import hard_cases
from scipy.spatial.transform import Rotation

from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import jittered
from shviewer.harmonics.rotation import rotate, turn
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.function import FunctionLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import Light

REFERENCE = hard_cases()["rotation"]


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_the_matrix_of_a_band_is_the_60_digit_one(degree: int) -> None:
    matrix = np.array(REFERENCE["R_times_25"]) / 25
    count = (degree + 1) ** 2
    dense = rotate(np.eye(count), matrix)[degree**2 :, degree**2 :]
    wanted = np.array([[float(value) for value in row] for row in REFERENCE["D"][str(degree)]])
    assert_allclose(dense, wanted, rtol=0, atol=5e-15)  # measured 7e-16


@pytest.mark.parametrize(("n_bands", "bound"), [(2, 1e-14), (9, 1e-14), (33, 1e-13), (128, 2e-13)])
def test_the_rotated_function_has_the_rotated_values(n_bands: int, bound: float) -> None:
    rng = np.random.default_rng(n_bands)
    coefficients = rng.normal(size=(n_bands**2, 3))
    matrix = random_rotation(n_bands)
    directions = rng.normal(size=(100, 3))
    before = evaluate_basis(directions, n_bands) @ coefficients
    after = evaluate_basis(directions @ matrix.T, n_bands) @ rotate(coefficients, matrix)
    assert_allclose(after, before, rtol=0, atol=bound * np.abs(before).max())


def rotated_light(light: Light, matrix: np.ndarray) -> FunctionLight:
    return FunctionLight(lambda directions: light.radiance(directions @ matrix))


@pytest.mark.parametrize("kind", ["lobes", "function", "image"])
def test_rotating_then_projecting_is_projecting_then_rotating(kind: str) -> None:
    """The paper's property 2, as it should read."""
    matrix = random_rotation(3)
    if kind == "lobes":
        light = find_light("studio")
        assert isinstance(light, LobeLight)
        turned: Light = LobeLight(tuple(Lobe(lobe.profile, matrix @ lobe.axis, lobe.radiance) for lobe in light.lobes))
        bound = 1e-14
    elif kind == "function":
        light = FunctionLight(lambda d: np.exp(d @ np.array([[1.0, 0.2, 0], [0, 2, 0.5], [0.3, 0, 1]])))
        turned = rotated_light(light, matrix)
        bound = 1e-12  # a hundred thousand roundings of the sums; measured 2e-13
    else:
        # an image cannot be turned without resampling, but by a half turn about x and a quarter about z it can
        texels = np.random.default_rng(4).random((6, 12, 3)).astype(np.float32)
        matrix = Rotation.from_euler("xz", [180, 90], degrees=True).as_matrix()
        light = EnvironmentLight(LatLongMap(texels))
        # about x: theta -> pi - theta and phi -> -phi, which reverses rows and columns; about z: 3 of 12 columns
        turned = EnvironmentLight(LatLongMap(np.roll(texels[::-1, ::-1], -3, axis=1)))
        bound = 1e-14
    wanted = turned.coefficients(8)
    assert_allclose(rotate(light.coefficients(8), matrix), wanted, rtol=0, atol=bound * np.abs(wanted).max())


def test_sampled_projections_rotate_within_their_noise() -> None:
    light, matrix = find_light("green"), random_rotation(5)
    samples = jittered(40_000, 0)
    turned = project_samples(rotated_light(light, matrix).radiance, samples, 4)
    assert_allclose(rotate(light.coefficients(4), matrix), turned, rtol=0, atol=2e-3)  # peers.md: RMS 2e-4 at 40 000


@pytest.mark.parametrize(
    "matrix",
    [np.eye(2), np.eye(3) * 1.001, np.diag([1, 1, -1]), np.full((3, 3), np.nan)],
    ids=["2x2", "scaled", "mirror", "nan"],
)
def test_what_is_no_rotation_is_refused(matrix: np.ndarray) -> None:
    with pytest.raises(ValueError, match="rotation"):
        rotate(np.ones((4, 3)), matrix)


def test_too_many_bands_are_refused() -> None:
    with pytest.raises(ValueError, match="129 bands"):
        rotate(np.zeros((129**2, 1)), np.eye(3))


@pytest.mark.parametrize("angles", [(0, 0, 0), (30, 40, 50), (-170, -80, 10), (20, 90, 70)])
def test_a_turn_is_that_of_scipy(angles: tuple[float, float, float]) -> None:
    azimuth, elevation, roll = angles
    wanted = Rotation.from_euler("ZYX", [azimuth, -elevation, roll], degrees=True).as_matrix()
    assert_allclose(turn(azimuth, elevation, roll), wanted, rtol=0, atol=1e-15)
