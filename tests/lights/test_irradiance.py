"""Irradiance is a light like any other, and agrees with a direct integral."""

from __future__ import annotations

import numpy as np
import pytest
from harmonics.independent import random_directions
from numpy.testing import assert_allclose

from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.metrics import errors_by_band_count, smallest_band_count
from shviewer.harmonics.quadrature import gauss_legendre
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.function import FunctionLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import Light

NORMALS = random_directions(30)


def by_quadrature(light: Light, n_samples: int) -> np.ndarray:
    rule = gauss_legendre(n_samples).direction_set()
    radiance = light.radiance(rule.directions)
    return np.stack([(np.maximum(rule.directions @ n, 0) * rule.weights) @ radiance for n in NORMALS])


@pytest.mark.parametrize(("name", "bound"), [("green", 2e-5), ("studio", 2e-5), ("cosine", 2e-5), ("hemisphere", 2e-3)])
def test_irradiance_of_lobes_is_the_integral_over_the_light(name: str, bound: float) -> None:
    light = find_light(name)
    wanted = by_quadrature(light, 500_000)  # its own error is the bound: kinks and edges between 500 rows
    assert_allclose(light.irradiance().radiance(NORMALS), wanted, rtol=0, atol=bound * wanted.max())


def test_a_constant_light_gives_pi_everywhere_and_a_hemisphere_pi_facing_it() -> None:
    assert_allclose(find_light("constant").irradiance().radiance(NORMALS), np.pi, rtol=0, atol=1e-12)
    up = np.array([[0.0, 0, 1], [0, 0, -1], [1, 0, 0]])
    irradiance = find_light("hemisphere").irradiance().radiance(up)[:, 0]
    assert_allclose(irradiance, [np.pi, 0, np.pi / 2], rtol=0, atol=1e-6)  # the table's stated accuracy


def test_a_small_sun_acts_like_a_directional_light() -> None:
    light = find_light("sun-sky")
    sun = light.lobes[1]  # type: ignore[attr-defined]
    flux = 2 * np.pi * (1 - np.cos(np.radians(0.265))) * sun.radiance[0]
    cosine = NORMALS @ sun.axis
    clear = np.abs(cosine) > 0.01  # where the disc does not cut the horizon, its own size matters by 1e-5
    wanted = np.pi * 1e3 + flux * np.maximum(cosine, 0)
    assert_allclose(light.irradiance().radiance(NORMALS)[clear, 0], wanted[clear], rtol=2e-5)


def test_irradiance_of_an_image_and_of_a_function_is_the_integral_over_the_light() -> None:
    image = EnvironmentLight(LatLongMap(np.random.default_rng(1).random((8, 16, 3)).astype(np.float32)))
    cosines = np.cos(np.pi * np.arange(9) / 8)
    within = (np.arange(40) + 0.5) / 40  # 40 x 40 points of equal area in each texel
    z = (cosines[:-1, None] + (cosines[1:] - cosines[:-1])[:, None] * within).ravel()
    phi = np.pi * (1 - 2 * (np.arange(16)[:, None] + within) / 16).ravel()
    rho = np.sqrt(1 - z**2)[:, None]
    points = np.stack([rho * np.cos(phi), rho * np.sin(phi), np.broadcast_to(z[:, None], (320, 640))], axis=-1).reshape(
        -1, 3
    )
    weights = np.repeat(np.repeat(cosines[:-1] - cosines[1:], 40) * (2 * np.pi / 640) / 40, 640)
    radiance = image.map.texels.repeat(40, axis=0).repeat(40, axis=1).reshape(-1, 3)
    wanted = np.stack([(np.maximum(points @ n, 0) * weights) @ radiance for n in NORMALS])
    assert_allclose(image.irradiance().radiance(NORMALS), wanted, rtol=0, atol=2e-4)  # the horizon between the points
    smooth = FunctionLight(lambda d: np.exp(2 * d))
    assert_allclose(smooth.irradiance().radiance(NORMALS), by_quadrature(smooth, 20_000), rtol=0, atol=2e-4)


def test_many_bands_of_its_coefficients_are_its_values() -> None:
    light = find_light("green").irradiance()
    reconstruction = evaluate_basis(NORMALS, 64) @ light.coefficients(64)
    assert_allclose(reconstruction, light.radiance(NORMALS), rtol=0, atol=2e-5)


@pytest.mark.parametrize(
    ("name", "counts"),
    [("green", (2, 3, 3, 5)), ("sun-sky", (3, 3, 5, 15)), ("hemisphere", (2, 2, 2, 2))],
)
def test_shading_needs_far_fewer_bands_than_the_picture(name: str, counts: tuple[int, ...]) -> None:
    light = find_light(name).irradiance()
    coefficients = light.coefficients(64)
    errors = errors_by_band_count(light.products(), coefficients, coefficients)
    assert tuple(smallest_band_count(errors, tolerance) for tolerance in (0.3, 0.1, 0.05, 0.01)) == counts


def test_relative_irradiance_errors_of_green_are_the_published_ones() -> None:
    light = find_light("green").irradiance()
    coefficients = light.coefficients(64)
    errors = errors_by_band_count(light.products(), coefficients, coefficients)
    assert_allclose(errors[[1, 2, 5, 7]], [0.177, 0.034, 3e-3, 1e-3], rtol=0.2)  # numerics.md 5 gives one or two digits


def test_the_floor_of_an_images_irradiance_covers_the_bands_that_were_not_looked_at() -> None:
    texels = np.zeros((64, 128, 3), np.float32)
    texels[20, 30] = 1
    light = EnvironmentLight(LatLongMap(texels)).irradiance()
    beyond = light.coefficients(200)[128**2 :]
    missed = np.sqrt((beyond**2).sum() / np.trace(light.products()))
    assert 0 < missed < light.accuracy() < 1e-2
