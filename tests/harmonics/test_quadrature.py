"""What shviewer.harmonics.quadrature promises: where samples lie, and that their weights are solid angles."""

import numpy as np
import pytest
from harmonics.independent import scipy_basis
from mpmath import mp
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import roots_legendre

from shviewer.harmonics.projection.rows import project_product
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import (
    column_azimuths,
    directions_from_angles,
    fejer,
    fibonacci,
    gauss_legendre,
    gauss_legendre_rows,
    jittered,
    uniform_random,
)
from shviewer.lights.find import find_light
from shviewer.limits import MAX_SAMPLES

SAMPLE_COUNTS = (1000, 3162, 10_000, 31_623, 100_000)


def smooth(directions):
    """A light with derivatives of every order, of a few bands in effect."""
    return np.exp(directions @ np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, -1]]))


def convergence(sampler, seeds):
    """Slope of log error over log samples: root mean square over seeds, coefficients of 5 bands and channels."""
    exact, _ = project_product(smooth, gauss_legendre(2 * 40**2), 5)
    errors = [
        np.sqrt(np.mean([(project_samples(smooth, sampler(count, seed), 5) - exact) ** 2 for seed in range(seeds)]))
        for count in SAMPLE_COUNTS
    ]
    return np.polyfit(np.log(SAMPLE_COUNTS), np.log(errors), 1)[0]


def cell_coordinates(directions, side):
    """The position in units of cells: (k,) from the north pole and (k,) round the axis."""
    x, y, z = directions.T
    return (1 - z) / 2 * side, np.arctan2(y, x) % (2 * np.pi) / (2 * np.pi) * side


@pytest.mark.parametrize("n_samples", [1, 2, 3, 4, 50, 10_000, 10_200])
def test_jittered_weights_add_up_to_the_sphere_and_are_equal(n_samples):
    samples = jittered(n_samples, seed=0)
    side = int(np.sqrt(n_samples))
    assert samples.directions.shape == (side**2, 3)
    assert_array_equal(samples.weights, np.full(side**2, samples.weights[0]))
    assert samples.weights.sum() == pytest.approx(4 * np.pi, rel=1e-14, abs=0)
    assert_allclose(np.linalg.norm(samples.directions, axis=1), np.ones(side**2), rtol=0, atol=1e-15)


@pytest.mark.parametrize("side", [1, 2, 7, 40])
def test_every_equal_area_cell_holds_one_jittered_sample(side):
    down, around = cell_coordinates(jittered(side**2, seed=3).directions, side)
    cells = list(zip(down.astype(int).tolist(), around.astype(int).tolist(), strict=True))
    assert cells == [(i, j) for i in range(side) for j in range(side)]  # the north first


def test_jitter_is_uniform_and_independent_inside_a_cell():
    down, around = (position % 1 for position in cell_coordinates(jittered(10_000, seed=1).directions, 100))
    six_sigma = 6 / np.sqrt(12 * 10_000)
    for jitter in (down, around):
        assert jitter.mean() == pytest.approx(0.5, abs=six_sigma)
        assert jitter.var() == pytest.approx(1 / 12, abs=0.005)
    assert abs(np.corrcoef(down, around)[0, 1]) < 0.06  # six sigma
    assert abs(np.corrcoef(down[1:], down[:-1])[0, 1]) < 0.06


@pytest.mark.parametrize("sampler", [jittered, uniform_random])
def test_a_seed_repeats_its_samples_and_another_does_not(sampler):
    first, again, other = (sampler(400, seed).directions for seed in (5, 5, 6))
    assert_array_equal(first, again)
    assert np.abs(first - other).max() > 0.01


@pytest.mark.parametrize("sampler", [lambda n: uniform_random(n, seed=0), fibonacci])
@pytest.mark.parametrize("n_samples", [1, 2, 3, 10_007])
def test_random_and_spiral_points_are_as_many_as_asked_for_and_weigh_alike(sampler, n_samples):
    samples = sampler(n_samples)
    assert samples.directions.shape == (n_samples, 3)
    assert_array_equal(samples.weights, np.full(n_samples, 4 * np.pi / n_samples))
    assert_allclose(np.linalg.norm(samples.directions, axis=1), np.ones(n_samples), rtol=0, atol=1e-15)


def test_random_points_are_uniform_and_independent():
    directions = uniform_random(40_000, seed=3).directions
    # sigma of a mean is sqrt(1/3)/200, of a second moment less: 5 of them
    assert_allclose(directions.mean(axis=0), np.zeros(3), rtol=0, atol=0.015)
    assert_allclose(directions.T @ directions / 40_000, np.eye(3) / 3, rtol=0, atol=0.01)
    assert abs(np.corrcoef(directions[1:, 2], directions[:-1, 2])[0, 1]) < 0.03  # six sigma


def test_points_of_the_spiral_are_a_golden_angle_apart_in_zones_of_equal_area():
    x, y, z = fibonacci(500).directions.T
    assert_allclose(z, 1 - (2 * np.arange(500) + 1) / 500, rtol=0, atol=1e-15)
    golden = 2 * np.pi / ((1 + np.sqrt(5)) / 2)
    turns = np.diff(np.arctan2(y, x)) / golden % (2 * np.pi / golden)
    assert_allclose(turns, np.ones(499), rtol=0, atol=1e-12)  # the azimuth is rounded at 300 turns


@pytest.mark.parametrize("n_samples", [100, 1000, 10_000])
def test_no_two_points_of_the_spiral_are_close(n_samples):
    directions = fibonacci(n_samples).directions
    chosen = directions[:: n_samples // 100]
    cosines = chosen @ directions.T
    nearest = np.sqrt(2 - 2 * np.sort(cosines, axis=1)[:, -2])
    assert nearest.min() * np.sqrt(n_samples) > 3  # 3.09 next to the poles; of random points 0.03 to 0.6


def test_jittered_samples_of_a_smooth_light_err_as_one_over_their_number():
    assert -1.1 < convergence(jittered, seeds=12) < -0.9  # -1.00 to -0.985 for three sets of seeds


def test_random_samples_err_as_one_over_the_root_of_their_number():
    assert -0.6 < convergence(uniform_random, seeds=12) < -0.4  # -0.52 to -0.49


@pytest.mark.parametrize("n_samples", [1000, 10_000, 100_000])
def test_the_spiral_errs_less_on_greens_light_than_jittered_samples(n_samples):
    light = find_light("green")
    exact = light.coefficients(9)
    spiral = np.abs(project_samples(light.radiance, fibonacci(n_samples), 9) - exact).max()
    jittered_best = min(
        np.abs(project_samples(light.radiance, jittered(n_samples, seed), 9) - exact).max() for seed in range(5)
    )
    assert 5 * spiral < jittered_best  # 24, 130 and 220 times less on average


@pytest.mark.parametrize(
    "rule", [lambda n: jittered(n, seed=0), lambda n: uniform_random(n, seed=0), fibonacci, gauss_legendre, fejer]
)
@pytest.mark.parametrize("n_samples", [0, -5, MAX_SAMPLES + 1])
def test_fewer_than_one_or_more_than_sixteen_million_samples_are_refused(rule, n_samples):
    with pytest.raises(ValueError, match=f"^{n_samples} samples: there must be 1 to 16000000$"):
        rule(n_samples)


@pytest.mark.parametrize("rows", [1, 2, 3, 16, 161, 1000])
def test_gauss_legendre_nodes_are_scipys_and_their_weights_where_scipys_keep_their_digits(rows):
    theta, weights = gauss_legendre_rows(rows)
    nodes, scipys = roots_legendre(rows)
    assert_allclose(np.cos(theta)[::-1], nodes, rtol=0, atol=1e-15)
    assert_allclose(weights, scipys[::-1], rtol=0, atol=1e-15 * rows)  # SciPy's lose digits with the square of the rows
    assert_allclose(weights.sum(), 2, rtol=1e-14, atol=0)
    assert (np.diff(theta) > 0).all()


def test_4096_gauss_legendre_nodes_are_exact_to_rounding_and_their_weights_to_1e13_next_to_the_poles_too():
    """Against Newton's method and Bonnet's recurrence with 40 digits."""
    theta, weights = gauss_legendre_rows(4096)
    with mp.workdps(40):
        for row in (0, 1, 100, 2047):
            found = mp.mpf(theta[row])
            for _ in range(2):
                value, slope = legendre_and_slope(4096, found)
                found -= value / slope
            slope = legendre_and_slope(4096, found)[1]
            assert abs(found - theta[row]) < 4e-16 * found
            assert abs(weights[row] / (2 / slope**2) - 1) < 1e-13


def legendre_and_slope(n, theta):
    """P(n)(cos theta) and its derivative by theta."""
    x = mp.cos(theta)
    before, value = mp.mpf(1), x
    for l in range(2, n + 1):
        before, value = value, ((2 * l - 1) * x * value - (l - 1) * before) / l
    return value, n * (x * value - before) / mp.sin(theta)


@pytest.mark.parametrize("rows", [1, 2, 3, 8, 15, 16, 31])
def test_fejer_of_2n_minus_1_rows_integrates_products_of_two_functions_of_n_bands_exactly(rows):
    points = fejer(2 * rows**2).direction_set()
    n_bands = (rows + 1) // 2
    values = scipy_basis(points.directions, n_bands + 1)
    gram = values.T @ (points.weights[:, None] * values)
    assert_allclose(gram[: n_bands**2, : n_bands**2], np.eye(n_bands**2), rtol=0, atol=1e-13)  # SciPy's rounding
    assert np.abs(gram - np.eye(len(gram))).max() > 1e-4  # and no more bands than stated


@pytest.mark.parametrize("rows", [1, 2, 3, 4, 70, 1001])
def test_fejer_rows_are_the_texel_centres_of_an_image_and_their_weights_positive(rows):
    rule = fejer(2 * rows**2)
    assert_allclose(rule.theta, np.pi * (np.arange(rows) + 0.5) / rows, rtol=0, atol=1e-15)
    assert rule.row_weights.min() > 0
    solid_angles = np.cos(rule.theta - np.pi / rows / 2) - np.cos(rule.theta + np.pi / rows / 2)
    assert_allclose(rule.row_weights, solid_angles, rtol=0.13)  # most at the poles


@pytest.mark.parametrize("sampling", [gauss_legendre, fejer])
@pytest.mark.parametrize(("n_samples", "rows"), [(1, 1), (7, 1), (8, 2), (17, 2), (18, 3), (10_000, 70)])
def test_a_product_rule_takes_the_largest_grid_within_the_samples(sampling, n_samples, rows):
    rule = sampling(n_samples)
    assert (len(rule.theta), rule.n_columns) == (rows, 2 * rows)
    assert rule.row_weights.sum() == pytest.approx(2, rel=1e-14, abs=0)
    assert rule.direction_set().weights.sum() == pytest.approx(4 * np.pi, rel=1e-14, abs=0)
    assert (np.diff(rule.theta) > 0).all()  # north first, as an image


def test_the_rows_of_a_rule_can_be_taken_in_parts():
    rule = gauss_legendre(2 * 9**2)
    whole, parts = rule.direction_set(), [rule.direction_set(slice(k, k + 4)) for k in (0, 4, 8)]
    assert_array_equal(np.concatenate([part.directions for part in parts]), whole.directions)
    assert_array_equal(np.concatenate([part.weights for part in parts]), whole.weights)
    assert_array_equal(np.concatenate([rule.directions(slice(0, 4)), rule.directions(slice(4, 9))]), whole.directions)
    assert_array_equal(whole.directions[:18], directions_from_angles(np.full(18, rule.theta[0]), rule.phi))


def test_columns_start_behind_and_turn_right():
    assert_allclose(column_azimuths(4), np.pi * np.array([0.75, 0.25, -0.25, -0.75]), rtol=0, atol=1e-15)
    for width in (1, 2, 5, 64, 101):
        azimuths = column_azimuths(width)
        assert azimuths[0] == pytest.approx(np.pi - np.pi / width, abs=1e-15)
        assert_allclose(np.diff(azimuths), np.full(width - 1, -2 * np.pi / width), rtol=0, atol=2e-15)


def test_the_centre_of_an_image_looks_along_x_and_its_left_half_holds_y():
    middle = directions_from_angles(np.array(np.pi / 2), column_azimuths(5)[2])
    assert_allclose(middle, [1, 0, 0], rtol=0, atol=1e-15)
    left = directions_from_angles(np.array(np.pi / 2), column_azimuths(4)[:2])
    assert (left[:, 1] > 0.7).all()


def test_angles_become_directions_and_broadcast():
    assert_allclose(directions_from_angles(np.array(0.0), np.array(1.0)), [0, 0, 1], rtol=0, atol=1e-16)
    assert_allclose(directions_from_angles(np.array(np.pi / 2), np.array(np.pi / 2)), [0, 1, 0], rtol=0, atol=1e-15)
    assert_allclose(directions_from_angles(np.array(np.pi), np.array(0.0)), [0, 0, -1], rtol=0, atol=1e-15)
    assert directions_from_angles(np.zeros((4, 1)), np.zeros(7)).shape == (4, 7, 3)
