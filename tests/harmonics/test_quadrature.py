"""What shviewer.harmonics.quadrature promises: where samples lie, and that their weights are solid angles."""

import numpy as np
import pytest
from harmonics.independent import scipy_basis
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.harmonics.quadrature import (
    MAX_SAMPLES,
    column_azimuths,
    directions_from_angles,
    gauss_legendre,
    jittered,
)


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


def test_jittered_samples_prefer_no_direction():
    directions = jittered(10_000, seed=2).directions
    # a cell is at most 2/100 in z and 2 pi/100 in azimuth wide: sigma < 2e-4 for every moment below, 5 sigma
    assert_allclose(directions.mean(axis=0), np.zeros(3), rtol=0, atol=1e-3)
    assert_allclose(directions.T @ directions / len(directions), np.eye(3) / 3, rtol=0, atol=1e-3)


def test_a_seed_repeats_its_samples_and_another_does_not():
    first, again, other = (jittered(400, seed).directions for seed in (5, 5, 6))
    assert_array_equal(first, again)
    assert np.abs(first - other).max() > 0.01


@pytest.mark.parametrize("rule", [lambda n: jittered(n, seed=0), gauss_legendre])
@pytest.mark.parametrize("n_samples", [0, -5, MAX_SAMPLES + 1])
def test_fewer_than_one_or_more_than_sixteen_million_samples_are_refused(rule, n_samples):
    with pytest.raises(ValueError, match=f"^{n_samples} samples: there must be 1 to 16000000$"):
        rule(n_samples)


@pytest.mark.parametrize("rows", [1, 2, 3, 8, 16, 24])
def test_gauss_legendre_of_r_rows_integrates_products_of_two_functions_of_r_bands_exactly(rows):
    points = gauss_legendre(2 * rows**2).direction_set()
    assert len(points.weights) == 2 * rows**2
    values = scipy_basis(points.directions, rows)
    # SciPy's 3e-14 at 24 bands, twice
    assert_allclose(values.T @ (points.weights[:, None] * values), np.eye(rows**2), rtol=0, atol=1e-13)


@pytest.mark.parametrize(("n_samples", "rows"), [(1, 1), (7, 1), (8, 2), (17, 2), (18, 3), (10_000, 70)])
def test_gauss_legendre_takes_the_largest_grid_within_the_samples(n_samples, rows):
    rule = gauss_legendre(n_samples)
    assert (len(rule.theta), rule.n_columns) == (rows, 2 * rows)
    assert rule.row_weights.sum() == pytest.approx(2, rel=1e-14, abs=0)
    assert rule.direction_set().weights.sum() == pytest.approx(4 * np.pi, rel=1e-14, abs=0)
    assert (np.diff(rule.theta) > 0).all()  # north first, as an image


def test_the_rows_of_a_rule_can_be_taken_in_parts():
    rule = gauss_legendre(2 * 9**2)
    whole, parts = rule.direction_set(), [rule.direction_set(slice(k, k + 4)) for k in (0, 4, 8)]
    assert_array_equal(np.concatenate([part.directions for part in parts]), whole.directions)
    assert_array_equal(np.concatenate([part.weights for part in parts]), whole.weights)
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
