"""What shviewer.harmonics.projection.scattered promises: the plain sum over scattered samples, in little memory."""

import tracemalloc
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from harmonics.independent import HARD_CASES, random_directions
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.projection import scattered
from shviewer.harmonics.projection.scattered import (
    POWER_BANDS,
    SLICED_BANDS,
    WAVE_BANDS,
    project_samples,
    project_values,
)
from shviewer.harmonics.quadrature import DirectionSet, jittered
from shviewer.lights.find import find_light

GREEN = find_light("green")
GREEN_EXACT = np.array([float(value) for value in HARD_CASES["lights"]["green"]["coefficients_n4"]])

EVERY_WAY = sorted(
    {1, 2, 3, 4, POWER_BANDS, POWER_BANDS + 1, 8, 9, 16, SLICED_BANDS - 1, SLICED_BANDS, 33, 64, WAVE_BANDS}
)
"""Band counts: powers, waves with sliced and whole products, odd and even, powers of two and their neighbours."""

HARD_AXES = ((0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (1, 1, 1), (3, 2, -9))
NEAR = (0, 1e-310, 1e-170, 3e-162, 1e-160, 1e-101, 1e-16, 1e-8, 1e-3, 0.1)


def around(axis, spread, count=40):
    """Unit directions about an axis."""
    directions = np.array(axis) + spread * np.random.default_rng(0).standard_normal((count, 3))
    return directions / np.linalg.norm(directions, axis=1)[:, None]


def random_values(count, seed=0):
    return np.random.default_rng(seed).standard_normal((count, 3))


@pytest.mark.parametrize("n_bands", EVERY_WAY)
def test_samples_anywhere_are_summed_within_the_accuracy_of_the_basis(n_bands):
    directions = random_directions(500, seed=1)
    values = random_values(500) / 500  # their magnitudes add up to about 1
    expected = evaluate_basis(directions, n_bands).T @ values
    assert_allclose(project_values(directions, values, n_bands), expected, rtol=0, atol=1e-14)  # 2e-15 measured at 64


@pytest.mark.parametrize("n_bands", EVERY_WAY)
@pytest.mark.parametrize("axis", HARD_AXES)
def test_samples_that_round_alike_stay_within_the_promise_of_the_basis(n_bands, axis):
    for spread in NEAR:
        directions = around(axis, spread)
        weighted = np.full((40, 3), 1 / 40) * [1, -1, 0.5]
        expected = evaluate_basis(directions, n_bands).T @ weighted
        found = project_values(directions, weighted, n_bands)
        assert_allclose(found, expected, rtol=0, atol=1e-13)  # 6e-14 measured at 128 bands: no error averages out


@pytest.mark.parametrize("n_bands", [2, 7, 16, 64])
def test_at_the_poles_only_zonal_functions_remain(n_bands):
    poles = np.array([[0.0, 0, 1], [0, -0.0, -1], [-0.0, 0, 1]])
    found = project_values(poles, np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]), n_bands)
    l = np.arange(n_bands)
    north = np.sqrt((2 * l + 1) / (4 * np.pi))
    expected = np.zeros((n_bands**2, 3))
    expected[l * (l + 1)] = np.stack([north, north * (-1.0) ** l, north], axis=1)
    assert_allclose(found, expected, rtol=0, atol=1e-13)


@pytest.mark.parametrize("n_bands", [4, 9, 24, WAVE_BANDS + 1])
def test_values_at_hand_and_a_light_give_the_same(n_bands):
    samples = jittered(200, seed=6)
    weighted = GREEN.radiance(samples.directions) * samples.weights[:, None]
    assert_array_equal(
        project_values(samples.directions, weighted, n_bands), project_samples(GREEN.radiance, samples, n_bands)
    )


@pytest.mark.parametrize("n_bands", [4, 9, 24, WAVE_BANDS + 1])
def test_blocks_of_samples_do_not_show_and_the_light_sees_each_once(monkeypatch, n_bands):
    samples = jittered(1000, seed=0)
    whole = project_samples(GREEN.radiance, samples, n_bands)
    monkeypatch.setattr(scattered, "BLOCK", 100)
    monkeypatch.setattr(scattered, "SMALL_PRODUCT", 6 * 81 * 30)
    monkeypatch.setattr(scattered, "BASIS_VALUES", 70 * (WAVE_BANDS + 1) ** 2)
    seen = []
    again = project_samples(lambda d: seen.append(d.copy()) or GREEN.radiance(d), samples, n_bands)
    assert [len(part) for part in seen] == [97] * 9 + [88]
    assert_array_equal(np.concatenate(seen), samples.directions)
    assert_allclose(again, whole, rtol=0, atol=1e-14)


@pytest.mark.parametrize("n_bands", [3, 9, WAVE_BANDS + 1])
def test_no_samples_add_up_to_nothing(n_bands):
    assert_array_equal(project_values(np.empty((0, 3)), np.empty((0, 3)), n_bands), np.zeros((n_bands**2, 3)))


@pytest.mark.parametrize("n_bands", [3, 9, WAVE_BANDS + 1])
@pytest.mark.parametrize("length", [1 + 1e-12, 1e-200, 3.0, 1e200])
def test_directions_of_any_length_mean_the_same(n_bands, length):
    directions, values = random_directions(50, seed=2), random_values(50) / 50
    expected = project_values(directions, values, n_bands)
    assert_allclose(project_values(directions * length, values, n_bands), expected, rtol=0, atol=1e-14)


@pytest.mark.parametrize("n_bands", [3, 9, WAVE_BANDS + 1])
@pytest.mark.parametrize("bad", [[0, 0, 0], [np.nan, 0, 1], [0, np.inf, 0]])
def test_a_direction_that_is_none_is_refused(n_bands, bad):
    with pytest.raises(ValueError, match=r"it must be finite and not zero$"):
        project_values(np.array([[0, 0, 1], bad]), np.ones((2, 3)), n_bands)


def test_more_bands_than_the_basis_has_are_refused():
    with pytest.raises(ValueError, match="1401 bands: there must be 1 to 1400"):
        project_samples(GREEN.radiance, jittered(4, 0), 1401)


def test_a_channel_that_is_not_finite_leaves_the_others_alone():
    directions, values = random_directions(50, seed=3), random_values(50)
    with_nan = values.copy()
    with_nan[7, 1] = np.nan
    for n_bands in (4, 12, 40):
        expected, found = (project_values(directions, v, n_bands) for v in (values, with_nan))
        assert_array_equal(found[:, [0, 2]], expected[:, [0, 2]])
        assert np.isnan(found[:, 1]).all()


@pytest.mark.parametrize(
    ("n_bands", "count", "mebibytes"), [(16, 1_000_000, 20), (64, 50_000, 40), (WAVE_BANDS + 1, 12_000, 40)]
)
def test_the_memory_does_not_grow_with_the_samples(n_bands, count, mebibytes):
    directions = np.zeros((count, 3))
    directions[:, 2] = 1
    samples = DirectionSet(directions, np.ones(count))
    project_samples(np.abs, jittered(4, 0), n_bands)  # its tables stay
    tracemalloc.start()
    project_samples(np.abs, samples, n_bands)
    peak = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    assert peak < mebibytes  # a million rows of a basis of 16 bands are 2 GiB


@pytest.mark.parametrize(("n_samples", "measured"), [(1000, 6.0e-3), (10_000, 6.5e-4), (100_000, 6.4e-5)])
def test_jittered_projection_of_greens_light_converges_as_measured(n_samples, measured):
    estimates = [project_samples(GREEN.radiance, jittered(n_samples, seed), 4)[:, 0] for seed in range(5)]
    squares = [((found - GREEN_EXACT) ** 2).mean() for found in estimates]
    assert measured / 3 < np.sqrt(np.mean(squares)) < 3 * measured  # root mean square of 20 runs


def test_a_light_that_projects_samples_itself_does_not_disturb_the_projection_it_is_part_of():
    """The memory of one projection is kept for the next of the same size, but nobody has it twice."""
    samples, calls = jittered(400, 0), []

    def light(directions):
        calls.append(project_values(directions, np.ones((len(directions), 3)), 4))
        return np.abs(directions)

    plain = project_samples(np.abs, samples, 4)
    assert_array_equal(project_samples(light, samples, 4), plain)
    assert_array_equal(project_samples(np.abs, samples, 4), plain)
    assert len(calls) == 1


def test_threads_project_side_by_side():
    samples = jittered(10_000, 0)
    alone = [project_samples(np.abs, samples, n) for n in (3, 9)]
    with ThreadPoolExecutor(4) as threads:
        for n, found in threads.map(lambda n: (n, project_samples(np.abs, samples, n)), [3, 9] * 20):
            assert_array_equal(found, alone[n == 9])
