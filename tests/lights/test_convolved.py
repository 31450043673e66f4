"""Irradiance and glossy reflection are lights like any other, and agree with direct integrals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from harmonics.independent import random_directions
from numpy.testing import assert_allclose
from places import kernels
from scipy.special import eval_legendre

import shviewer
from shviewer.analysis.projected import project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.coefficients.parts.quantities import recovered_radiance
from shviewer.errors import UsageError
from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.metrics import errors_by_band_count, smallest_band_count
from shviewer.harmonics.quadrature import gauss_legendre
from shviewer.harmonics.quantities.glossy import Glossy, glossy_factors
from shviewer.harmonics.quantities.kernels import kernel_of
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.zonal import Constant, Disc, Gaussian
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.coefficient_light import CoefficientLight
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
    sun = light.lobes[1]
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


def seen_glossily(light: Light, roughness: float, n_samples: int) -> np.ndarray:
    """What a surface reflects in NORMALS, by a rule about each of them that crowds where the kernel does."""
    kernel = Glossy(roughness)
    nodes, weights = np.polynomial.legendre.leggauss(n_samples)
    t = np.pi / 4 * (nodes + 1)
    bend, slope = np.pi / 2 * (2 * t / np.pi) ** 3, 3 * (2 * t / np.pi) ** 2  # of the angle to the normal
    phi = 2 * np.pi * np.arange(2 * n_samples) / (2 * n_samples)
    found = []
    for normal in NORMALS:
        side = np.linalg.svd(normal[None])[2][1:]
        ring = np.cos(phi)[:, None] * side[0] + np.sin(phi)[:, None] * side[1]
        points = np.cos(bend)[:, None, None] * normal + np.sin(bend)[:, None, None] * ring
        shares = weights * np.pi / 4 * slope * np.sin(bend) * kernel.value(4 * np.sin(bend / 2) ** 2)
        radiance = light.radiance(points.reshape(-1, 3)).reshape(*points.shape).sum(axis=1)
        found.append(shares @ radiance * kernel.peak * 2 * np.pi / len(phi))
    return np.stack(found)


@pytest.mark.parametrize("roughness", [0.12, 0.5])
def test_what_a_glossy_surface_reflects_of_lobes_is_the_integral_over_the_light(roughness: float) -> None:
    light = LobeLight(
        (
            Lobe(Gaussian(30), np.array([1.0, 2, 3]), np.array([1.0, 2, 3])),
            Lobe(Constant(), np.array([0.0, 0, 1]), np.array([0.2, 0.1, 0.3])),
            Lobe(Gaussian(4), np.array([-1.0, 0, -1]), np.array([0.5, 0.0, -0.3])),
        )
    )
    wanted = seen_glossily(light, roughness, 120)
    assert_allclose(light.through(f"glossy:{roughness}").radiance(NORMALS), wanted, rtol=0, atol=3e-6 * wanted.max())


def test_what_a_glossy_surface_reflects_of_a_small_sun_is_its_kernel() -> None:
    light = LobeLight((Lobe(Disc(1e-3), np.array([0.0, 0, 1]), np.ones(3)),))
    flux = np.pi * 1e-6
    for roughness in (0.3, 0.6):
        kernel = Glossy(roughness)
        angle = np.linspace(0, np.pi, 400)
        normals = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=1)
        wanted = flux * kernel.peak * kernel.value(4 * np.sin(angle / 2) ** 2)
        found = light.through(f"glossy:{roughness}").radiance(normals)[:, 0]
        # the sun's own size, (1e-3 / 2 roughness^2)^2 of the peak and its part of the kink, and the cubic of the table
        assert_allclose(found, wanted, rtol=0, atol=4e-5 * wanted.max())


def test_roughness_1_is_irradiance_over_pi_for_every_kind_of_light() -> None:
    coefficients = np.random.default_rng(2).normal(size=(36, 3))
    image = EnvironmentLight(LatLongMap(np.random.default_rng(1).random((8, 16, 3)).astype(np.float32)))
    for light in (find_light("green"), image, CoefficientLight(coefficients), FunctionLight(lambda d: np.exp(2 * d))):
        rough, irradiance = light.through("glossy:1"), light.irradiance()
        assert_allclose(
            rough.radiance(NORMALS), irradiance.radiance(NORMALS) / np.pi, rtol=0, atol=1e-6
        )  # float32 maps
        assert_allclose(rough.coefficients(9), irradiance.coefficients(9) / np.pi, rtol=0, atol=1e-13)
        assert_allclose(rough.products(), irradiance.products() / np.pi**2, rtol=1e-12)


def test_quantities_are_of_the_radiance_and_not_of_each_other() -> None:
    light = find_light("studio")
    rough = light.through("glossy:0.4")
    assert rough.irradiance().source is light
    assert rough.through("radiance") is light
    assert rough.through("glossy:0.4") is rough
    assert [one.quantity for one in (light, rough, rough.irradiance())] == ["radiance", "glossy:0.4", "irradiance"]
    assert_allclose(rough.irradiance().radiance(NORMALS), light.irradiance().radiance(NORMALS), rtol=1e-15)


def test_the_norm_of_what_is_reflected_is_that_of_its_bands() -> None:
    for name in ("green", "studio", "mud_road_puresky"):
        light = find_light(name).through("glossy:0.3")
        kept = light.coefficients(128)
        assert_allclose(np.trace(light.products()), (kept**2).sum(), rtol=1e-9)


@pytest.mark.parametrize("name", ["mud_road_puresky", "st_fagans_interior", "green"])
@pytest.mark.parametrize("roughness", ["0.3", "0.5", "0.7", "1.0"])
def test_bands_that_a_roughness_needs_are_the_published_ones(name: str, roughness: str) -> None:
    light = find_light(name).through(f"glossy:{roughness}")
    coefficients = light.coefficients(64)
    errors = errors_by_band_count(light.products(), coefficients, coefficients)
    wanted = kernels()["A"]["maps"][name][roughness]["bands_for_relative_l2"]
    assert {share: smallest_band_count(errors, float(share)) for share in wanted} == wanted


@pytest.mark.parametrize(("quantity", "off"), [("irradiance", 1e-7), ("glossy:0.8", 1e-5), ("glossy:0.2", 1e-5)])
def test_the_map_of_lobes_is_what_they_reflect_at_its_points(quantity: str, off: float) -> None:
    """The kink where a small sun sets is no sum of 128 bands: those alone miss 2e-3 of the irradiance there."""
    light = find_light("sun-sky").through(quantity)
    texels = light.map.texels
    rows = np.arange(0, len(texels), 37)
    exact = light.rows(np.pi * rows / (len(texels) - 1), texels.shape[1]).swapaxes(1, 2)
    assert_allclose(texels[rows], exact, rtol=0, atol=off * np.abs(exact).max())


def test_the_map_of_a_narrow_kernel_has_the_bands_that_it_needs() -> None:
    texels = np.full((32, 64, 3), 0.01, np.float32)
    texels[9, 20] = 50
    light = EnvironmentLight(LatLongMap(texels)).through("glossy:0.2")
    assert light.map.texels.shape == (1025, 2048, 3)
    exact = evaluate_basis(NORMALS, 193) @ light.coefficients(193)
    # bilinear between rows 0.0031 apart of a peak as narrow as 0.04: (0.0031 / 0.04)^2 / 8 each way
    assert_allclose(light.map.sample(NORMALS), exact, rtol=0, atol=2e-3 * np.abs(exact).max())
    assert_allclose(light.radiance(NORMALS), exact, rtol=0, atol=1e-12 * np.abs(exact).max())


def test_a_function_is_reflected_by_as_many_bands_as_it_has() -> None:
    light = FunctionLight(lambda d: np.exp(20 * (d[:, 2] - 1)))
    rough = light.through("glossy:0.1")
    assert rough.accuracy() < 1e-6  # nothing of it is beyond them
    assert_allclose(rough.radiance(NORMALS), seen_glossily(light, 0.1, 120), rtol=0, atol=1e-4)


@pytest.mark.parametrize("roughness", [0.12, 0.2])
def test_a_sun_that_a_function_draws_is_reflected_as_sharply_as_one_of_lobes(roughness: float) -> None:
    """In closed form: the factors of the kernel times those of the disc. 128 bands of it missed 17 % of the peak at 0.12."""
    axis, half_angle = np.array([0.36, 0.48, 0.8]), np.radians(0.5)
    light = FunctionLight(lambda d: np.where(d @ axis > np.cos(half_angle), 100.0, 0.0)).through(f"glossy:{roughness}")
    side = np.linalg.svd(axis[None])[2][1]
    angle = np.linspace(0, 0.3, 60)[:, None]
    l, cosines = np.arange(1200), np.cos(angle[:, 0])
    legendre = eval_legendre(l[:, None], cosines)
    factors = 100 * Disc(half_angle).zonal(1200) * glossy_factors(roughness, 1200) * (2 * l + 1) / (4 * np.pi)
    found = Synthesis(light.coefficients(kernel_of(f"glossy:{roughness}").bands))
    wanted = factors @ legendre
    # the disc is resolved to 1e-4 of its energy; f(512) = 2e-4 is what the kernel has beyond
    assert_allclose(
        found.in_directions(np.cos(angle) * axis + np.sin(angle) * side)[:, 0], wanted, rtol=0, atol=1e-3 * wanted.max()
    )
    assert light.accuracy() < 1e-3


def test_a_smooth_function_of_more_than_128_bands_is_reflected_by_those() -> None:
    """(x + iy)^140 is of degree 140 alone, so that a kernel multiplies it by one factor."""
    light = FunctionLight(lambda d: 1 + ((d[:, 0] + 1j * d[:, 1]) ** 140).real).through("glossy:0.15")
    d = np.stack([np.cos(NORMALS[:, 0]), np.sin(NORMALS[:, 0]), 0 * NORMALS[:, 0]], axis=1)
    factor = kernel_of("glossy:0.15").factors(141)[140]
    assert factor > 3e-3
    found = Synthesis(light.coefficients(light.bands)).in_directions(d)[:, 0]
    assert_allclose(found, 1 + factor * np.cos(140 * NORMALS[:, 0]), rtol=0, atol=1e-10)


def test_radiance_comes_back_from_glossy_coefficients_where_they_hold_it() -> None:
    wanted = np.random.default_rng(3).normal(size=(64, 3))
    for quantity in ("glossy:0.4", "irradiance", "glossy:0.9"):
        held = CoefficientLight(wanted).through(quantity).coefficients(8)
        found, lost = recovered_radiance(held, quantity)
        assert lost == ([3, 5, 7] if quantity == "irradiance" else [])
        kept = np.repeat([l not in lost for l in range(8)], 2 * np.arange(8) + 1)
        assert_allclose(found[kept], wanted[kept], rtol=0, atol=1e-7)  # of factors known to 1e-13 down to 1e-6
    assert kernel_of("glossy:0.9").factors(8).min() > -0.03


@pytest.mark.parametrize("kind", ["json", "csv", "npz", "h", "glsl"])
def test_a_file_of_a_glossy_quantity_says_so_and_is_that_quantity_again(tmp_path: Path, kind: str) -> None:
    found = shviewer.project("studio", 7, quantity="glossy:0.40")
    found.save(tmp_path / f"rough.{kind}")
    light = find_light(str(tmp_path / f"rough.{kind}"))
    assert light.about.quantity == "glossy:0.4"
    assert_allclose(light.through("glossy:0.4").coefficients(7), found.coefficients, rtol=1e-12, atol=1e-15)
    assert_allclose(light.coefficients(7), find_light("studio").coefficients(7), rtol=0, atol=1e-10)
    with pytest.raises(UsageError, match=r"glossy:0\.4 cannot be written as irradiance-over-pi: project"):
        shviewer.project("studio", 3, quantity="glossy:0.4").numbers("unity")


def test_of_a_light_that_no_surface_sees_the_irradiance_is_0_and_not_rounding():
    """A(3) = 0: what quadrature leaves of it, 1e-17, has no relative error to speak of."""
    y31 = FunctionLight(lambda d: -0.4570457994644658 * d[:, 0] * (5 * d[:, 2] ** 2 - 1))
    assert not y31.irradiance().coefficients(6).any()
    assert not y31.irradiance().products().any()
    assert project_recipe(Recipe(y31, n_bands=5)).irradiance_relative_l2 == 0
