"""Lights projected as beginners do, by sums written out here, are recognised for what they are."""

from __future__ import annotations

import numpy as np
import pytest
from helpers import to_srgb

from shviewer.analysis.comparing.comparison import verdict
from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, row_angles
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.light import Light


def sky(seed: int, rows: int = 48) -> EnvironmentLight:
    """Soft light of a random low-order sky, up to about 3, and a small lamp of 40."""
    random = np.random.default_rng(seed)
    smooth = evaluate_basis(grid(rows), 4) @ (random.normal(size=(16, 1)) * 0.3 + random.normal(size=(16, 3)) * 0.1)
    pixels = np.maximum(smooth + 0.8, 0.02).reshape(rows, 2 * rows, 3)
    row, column = random.integers(rows // 4, 3 * rows // 4), random.integers(2 * rows - 3)
    pixels[row : row + 2, column : column + 3] = 40
    return EnvironmentLight(pixels.astype(np.float32), name="sky")


def grid(rows: int) -> Array:
    return directions_from_angles(row_angles(rows)[:, None], column_azimuths(2 * rows)).reshape(-1, 3)


def summed(values: Array, n_bands: int, *, weighed: bool) -> Array:
    """The sum over texel centres of radiance and basis, with the weights sin(theta) or without any."""
    rows = values.shape[0]
    weights = np.repeat(np.sin(row_angles(rows)), 2 * rows) if weighed else np.ones(2 * rows**2)
    return np.asarray((evaluate_basis(grid(rows), n_bands) * (4 * np.pi * weights / weights.sum())[:, None]).T) @ (
        values.reshape(-1, 3)
    )


def said(light: Light, coefficients: Array) -> str:
    return verdict(light, CoefficientLight(coefficients, "theirs"))


@pytest.mark.parametrize(("n_bands", "seed"), [(3, 1), (5, 2)])
def test_the_usual_mistakes_with_an_image_are_named(n_bands: int, seed: int) -> None:
    """What is left is how far a sum over centres is from the integrals of texels of 3.75 degrees."""
    light = sky(seed)
    pixels = light.pixels.astype(np.float64)
    for values, weighed, words in (
        (pixels, False, "all texels count alike, without sin(theta)"),
        (np.minimum(pixels, 1), True, "radiance is clamped at 1"),
        (to_srgb(pixels), True, "radiance is encoded for a display"),
        (to_srgb(np.minimum(pixels, 1)), True, "radiance is clamped at 1 and encoded for a display"),
        (pixels / (1 + pixels), True, "radiance is tone-mapped, x/(1 + x)"),
        (to_srgb(pixels / (1 + pixels)), True, "radiance is tone-mapped, x/(1 + x) and encoded for a display"),
        (pixels * (row_angles(48) < np.pi / 2)[:, None, None], True, "radiance is black below the horizon"),
        (np.minimum(pixels, 1), False, "radiance is clamped at 1 and all texels count alike, without sin(theta)"),
    ):
        line = said(light, summed(values, n_bands, weighed=weighed))
        assert line.endswith(f" % if {words}"), line
        assert float(line.partition("but ")[2].split()[0]) < 1, line


def test_a_light_that_is_no_image_is_taken_on_a_grid() -> None:
    light = find_light("studio")
    values = light.radiance(grid(64)).reshape(64, 128, 3)
    line = said(light, summed(values, 4, weighed=False))
    assert "if all texels count alike, without sin(theta)" in line


@pytest.mark.parametrize("seed", [4])
def test_the_convention_is_found_beside_what_happened_to_the_light(seed: int) -> None:
    light = sky(seed)
    coefficients = summed(np.minimum(light.pixels.astype(np.float64), 1), 4, weighed=True)
    line = said(light, 2 * coefficients[:, ::-1])
    assert "with channels in the order B G R" in line
    assert "times 2" in line
    assert "and radiance is clamped at 1" in line


def test_a_large_image_is_reduced_after_its_values_are_clamped() -> None:
    """1024 rows are 512 for the search; what is clamped is the texel and not the mean."""
    pixels = np.repeat(np.repeat(sky(7).pixels[:, :, ::-1], 32, axis=0), 32, axis=1)[:1024, :2048]
    pixels = np.minimum(pixels, 0.9)
    pixels[::4, ::4] *= np.linspace(1, 60, 256, dtype=np.float32)[:, None, None]
    light = EnvironmentLight(pixels)
    clamped = EnvironmentLight(np.minimum(pixels, 1)).coefficients(3)
    assert said(light, clamped).endswith("if radiance is clamped at 1")


def test_of_another_light_nothing_is_said() -> None:
    for seed in range(6, 9):
        assert "which no usual mistake explains" in said(sky(seed), summed(sky(seed + 50).pixels, 4, weighed=True))
