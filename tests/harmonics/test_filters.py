"""Windows, the clamped cosine, and deringing."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from places import hard_cases
from scipy.optimize import minimize

from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.deringing import dering, least_distance
from shviewer.harmonics.filters import irradiance_factors, per_coefficient, window
from shviewer.harmonics.metrics import band_power
from shviewer.lights.find import find_light

REFERENCE = hard_cases()


def test_windows_are_those_of_the_definitions() -> None:
    degree = np.arange(8)
    assert_allclose(window("hann", 8, 8), np.cos(np.pi * degree / 16) ** 2, rtol=0, atol=1e-15)
    x = np.pi * degree[1:] / 5
    assert_allclose(window("lanczos", 8, 5)[1:], np.where(degree[1:] < 5, np.sin(x) / x, 0), rtol=0, atol=1e-15)
    assert_allclose(window("gauss", 8, 4), np.exp(-((np.pi * degree / 4) ** 2) / 2), rtol=0, atol=1e-15)


@pytest.mark.parametrize("name", ["hann", "lanczos", "gauss"])
def test_a_window_leaves_the_mean_and_never_grows(name: str) -> None:
    factors = window(name, 16, 16)
    assert factors[0] == 1
    assert (np.diff(factors) < 0).all()
    assert (factors > 0).all()


@pytest.mark.parametrize("width", [0.0, -1.0, np.nan, np.inf])
def test_an_impossible_width_is_refused_by_its_value(width: float) -> None:
    with pytest.raises(ValueError, match=f"window width {width:g}"):
        window("hann", 4, width)


def test_an_unknown_window_is_refused_with_those_there_are() -> None:
    with pytest.raises(ValueError, match=r"'welch': there is hann, lanczos, gauss"):
        window("welch", 4, 4)


def test_irradiance_factors_are_the_published_ones() -> None:
    wanted = [float(value) for value in REFERENCE["irradiance"]["A_l"]]
    assert_allclose(irradiance_factors(len(wanted)), wanted, rtol=1e-15, atol=1e-16)


def test_three_bands_hold_127_of_128_parts_of_the_clamped_cosine() -> None:
    light = find_light("cosine")
    assert_allclose(band_power(light.coefficients(3)).sum() / np.trace(light.products()), 127 / 128, rtol=1e-14)


@pytest.mark.parametrize("name", ["green", "hemisphere", "cosine", "sun-sky", "studio"])
@pytest.mark.parametrize("n_bands", [2, 3, 5, 8, 16])
def test_a_deringed_light_is_nowhere_negative(name: str, n_bands: int) -> None:
    coefficients = find_light(name).coefficients(n_bands)
    shown = coefficients * per_coefficient(dering(coefficients).factors)
    directions = np.random.default_rng(0).normal(size=(20_000, 3))
    values = evaluate_basis(directions, n_bands) @ shown
    assert values.min() >= -1e-9 * values.max()  # the search for the minimum is not better than that
    assert_allclose(shown[0], coefficients[0], rtol=0, atol=0)


def test_what_is_not_negative_is_left_as_it_is() -> None:
    for name, n_bands in (("constant", 4), ("studio", 16)):
        assert (dering(find_light(name).coefficients(n_bands)).factors == 1).all()


def test_no_smaller_change_will_do() -> None:
    """An independent optimiser, bound by the same rule on a dense set of directions, finds nothing smaller."""
    coefficients = find_light("green").coefficients(5)
    power = band_power(coefficients).sum(axis=1)
    rng = np.random.default_rng(0)
    basis = evaluate_basis(rng.normal(size=(4000, 3)), 5)
    by_band = np.stack(
        [basis[:, l * l : (l + 1) ** 2] @ coefficients[l * l : (l + 1) ** 2, 0] for l in range(5)], axis=1
    )
    found = minimize(
        lambda h: float((power[1:] * (1 - h) ** 2).sum()),
        x0=np.zeros(4),
        jac=lambda h: -2 * power[1:] * (1 - h),
        constraints={
            "type": "ineq",
            "fun": lambda h: by_band[:, 0] + by_band[:, 1:] @ h,
            "jac": lambda h: by_band[:, 1:],
        },
        method="SLSQP",
        options={"ftol": 1e-12, "maxiter": 500},
    )
    assert found.success
    ours = dering(coefficients)
    assert ours.change**2 * power.sum() <= found.fun * 1.01  # the 4000 directions bind a little less than all do
    assert_allclose(ours.factors[1:], found.x, rtol=0, atol=0.02)


def test_it_changes_less_than_a_lanczos_window_that_removes_as_much() -> None:
    coefficients = find_light("green").coefficients(8)
    power = band_power(coefficients).sum(axis=1)
    lanczos = next(
        factors
        for factors in (window("lanczos", 8, width) for width in np.linspace(8, 1, 200))
        if (evaluate_basis(DIRECTIONS, 8) @ (coefficients * per_coefficient(factors))).min() >= 0
    )
    assert dering(coefficients).change < 0.3 * np.sqrt((power * (1 - lanczos) ** 2).sum() / power.sum())


DIRECTIONS = np.random.default_rng(1).normal(size=(5000, 3))


def test_a_negative_mean_cannot_be_deringed() -> None:
    with pytest.raises(ValueError, match=r"mean radiance -1"):
        dering(-np.sqrt(4 * np.pi) * np.eye(4)[:, :1] * np.ones(3))


def test_too_many_bands_cannot_be_deringed() -> None:
    with pytest.raises(ValueError, match="33 bands"):
        dering(np.ones((33**2, 3)))


def test_the_shortest_vector_over_a_line_is_its_foot() -> None:
    u, binding = least_distance(np.array([[3.0, 4.0], [1.0, 0.0]]), np.array([10.0, -5.0]))
    assert_allclose(u, [1.2, 1.6], rtol=0, atol=1e-14)
    assert binding.tolist() == [True, False]
    with pytest.raises(ValueError, match="no vector"):
        least_distance(np.array([[1.0], [-1.0]]), np.array([1.0, 1.0]))
