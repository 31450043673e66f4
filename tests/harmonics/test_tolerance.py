"""How many bands a scene needs."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from shviewer.harmonics.metrics import (
    channel_figures,
    errors_by_band_count,
    relative,
    smallest_band_count,
    split_half_estimate,
    squared_error,
)
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import gauss_legendre, jittered
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.find import find_light
from shviewer.lights.function import UNCERTAIN, FunctionLight
from shviewer.lights.light import Light


def band_errors(name: str) -> np.ndarray:
    light = find_light(name)
    exact = light.coefficients(128)
    return errors_by_band_count(light.products(), exact, exact)


@pytest.mark.parametrize(
    ("name", "counts"),
    [
        ("green", {0.5: 5, 0.3: 5, 0.2: 6, 0.1: 10, 0.05: 15, 0.02: 27, 0.01: 41}),
        ("hemisphere", {0.5: 2, 0.3: 4, 0.2: 8, 0.1: 32, 0.05: 128, 0.02: None, 0.01: None}),
        ("sun-sky", {0.5: None, 0.05: None}),
        ("constant", {0.5: 1, 1e-6: 1}),
    ],
)
def test_the_smallest_band_counts_are_the_published_ones(name: str, counts: dict[float, int | None]) -> None:
    errors = band_errors(name)
    assert {tolerance: smallest_band_count(errors, tolerance) for tolerance in counts} == counts


def test_an_error_is_that_of_the_formula_at_every_band_count() -> None:
    light, errors = find_light("studio"), band_errors("studio")
    norm = np.diag(light.products())
    for n_bands in (1, 2, 7, 20):
        exact = light.coefficients(n_bands)
        assert_allclose(errors[n_bands - 1], relative(sum(squared_error(norm, exact, exact)), norm), rtol=1e-9)


@pytest.mark.parametrize("tolerance", [0.0, 1.0, -0.1, 5.0, float("nan")])
def test_a_tolerance_out_of_range_is_refused_by_its_value(tolerance: float) -> None:
    with pytest.raises(ValueError, match=f"tolerance {tolerance:g}"):
        smallest_band_count(np.array([0.5]), tolerance)


def test_figures_of_channels_and_luminance_agree_with_quadrature() -> None:
    """One line of numpy per figure, on a rule that is exact enough for Gaussians."""
    light = find_light("studio")
    exact = light.coefficients(4)
    shown = exact * np.linspace(1, 0.5, 16)[:, None]
    rule = gauss_legendre(100_000).direction_set()
    original = light.radiance(rule.directions)
    from shviewer.harmonics.basis import evaluate_basis

    error = evaluate_basis(rule.directions, 4) @ shown - original
    figures = channel_figures(light.products(), exact, shown, peak=6.0)
    luminance = np.array([0.2126, 0.7152, 0.0722])
    for name, mix in (("red", [1, 0, 0]), ("blue", [0, 0, 1]), ("luminance", luminance)):
        wanted = np.sqrt((rule.weights @ (error @ mix) ** 2) / (rule.weights @ (original @ mix) ** 2))
        assert_allclose(figures[name].relative_l2, wanted, rtol=1e-9)
    wanted = np.sqrt((rule.weights @ error**2).sum() / (rule.weights @ original**2).sum())
    assert_allclose(figures["all"].relative_l2, wanted, rtol=1e-9)
    mean = (rule.weights @ error**2).sum() / (4 * np.pi * 3)
    assert_allclose(figures["all"].psnr, 10 * np.log10(36 / mean), rtol=1e-9)
    assert_allclose(
        figures["all"].left_out ** 2 + figures["all"].added ** 2, figures["all"].relative_l2 ** 2, rtol=1e-12
    )


@pytest.mark.parametrize("factor", [1e-30, 1e28])
def test_figures_do_not_depend_on_the_unit_of_radiance_from_1e_30_to_1e30(factor: float) -> None:
    """A light has 1e-30 to 1e30, and studio reaches 6."""

    def figures(light: Light) -> list[float]:
        exact = light.coefficients(4)
        found = channel_figures(light.products(), exact, 0.5 * exact, light.radiance(light.landmarks()).max())
        return [found["luminance"].relative_l2, found["all"].left_out, found["red"].psnr]

    studio = find_light("studio")
    assert isinstance(studio, LobeLight)
    scaled = LobeLight(tuple(Lobe(lobe.profile, lobe.axis, lobe.radiance * factor) for lobe in studio.lobes))
    assert_allclose(figures(scaled), figures(studio), rtol=1e-9)  # a difference of squares of which 5e-6 remain
    function = FunctionLight(lambda d: np.exp(d) * factor)
    assert_allclose(figures_of_function(function), figures_of_function(FunctionLight(np.exp)), rtol=1e-9)


def figures_of_function(light: FunctionLight) -> list[float]:
    exact = light.coefficients(4)
    found = channel_figures(light.products(), exact, 0.5 * exact, 1.0)
    return [found["luminance"].relative_l2, found["all"].left_out]


def test_a_black_light_has_no_error_and_never_nan() -> None:
    nothing = np.zeros((4, 3))
    figures = channel_figures(np.zeros((3, 3)), nothing, nothing, 0.0)["all"]
    assert (figures.relative_l2, figures.psnr) == (0.0, np.inf)
    assert (errors_by_band_count(np.zeros((3, 3)), nothing, nothing) == 0).all()


def test_coefficients_with_more_energy_than_their_light_are_refused() -> None:
    light = find_light("constant")
    exact = light.coefficients(2) * 1.001
    with pytest.raises(ValueError, match="mixed quadratures"):
        errors_by_band_count(light.products(), exact, exact)
    with pytest.raises(ValueError, match="mixed quadratures"):
        channel_figures(light.products(), exact, exact, 1.0)


def halves(n_samples: int, seed: int) -> tuple[np.ndarray, np.ndarray, float, float]:
    light = find_light("green")
    parts = [jittered(n_samples // 2, 2 * seed + half) for half in (0, 1)]
    first, second = (project_samples(light.radiance, part, 20) for part in parts)
    squares = np.concatenate([(light.radiance(part.directions) ** 2).sum(axis=1) for part in parts])
    return first, second, 4 * np.pi * float(squares.mean()), 4 * np.pi * float(squares.std()) / np.sqrt(len(squares))


def test_products_of_halves_are_unbiased_where_squares_are_not() -> None:
    exact = (find_light("green").coefficients(20) ** 2).sum()
    drawn = [halves(1_000, seed)[:2] for seed in range(12)]
    products = np.array([(first * second).sum() for first, second in drawn])
    squares = np.array([((first + second) ** 2 / 4).sum() for first, second in drawn])
    assert abs(products.mean() - exact) < 4 * products.std() / np.sqrt(12)
    assert squares.mean() - exact > 4 * squares.std() / np.sqrt(12)


def test_the_estimate_is_made_of_products_of_the_halves() -> None:
    """Halves that err in opposite ways have the right products; the squares of either are 44 % off."""
    light = find_light("green")
    exact, norm = light.coefficients(20), float(np.trace(light.products()))
    for first, second in ((1.2 * exact, exact / 1.2), (exact / 1.2, 1.2 * exact)):
        assert split_half_estimate(first, second, norm, 0.0, 0.1).likely == 10


def test_samples_that_are_too_few_leave_the_count_open_and_many_decide_it() -> None:
    few = split_half_estimate(*halves(1_000, 0), 0.1)
    assert not few.decided
    many = split_half_estimate(*halves(250_000, 0), 0.5)
    assert many.decided
    assert many.likely == 5


def test_points_follow_from_the_sharpness_of_a_function() -> None:
    smooth = FunctionLight(lambda d: np.exp(d[:, 2]))
    edge = FunctionLight(lambda d: (d @ np.array([0.48, 0.6, 0.64]) > 0.5) * 1.0)
    assert smooth.accuracy() < 1e-6
    assert smooth.notes == ()
    assert edge.notes == ()
    assert smooth.accuracy() < edge.accuracy() < UNCERTAIN
