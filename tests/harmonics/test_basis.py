"""What shviewer.harmonics.basis promises: one convention, and its values near rounding everywhere on the sphere."""

import tracemalloc

import numpy as np
import pytest
from harmonics.independent import HARD_CASES, random_directions, scipy_basis
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.harmonics import basis
from shviewer.harmonics.basis import count_bands, degrees, evaluate_basis, index, normalisation, normalise

ROUNDING = 2.0**-52
POINTS = {tuple(float.fromhex(x) for x in case["xyz_hex"]): case["point"] for case in HARD_CASES["sh_values"]["values"]}


def test_three_bands_are_the_textbook_polynomials():
    d = random_directions(100, seed=1)
    x, y, z = d.T
    k = np.sqrt(15 / (4 * np.pi))
    expected = [
        np.full(100, np.sqrt(1 / (4 * np.pi))),
        -np.sqrt(3 / (4 * np.pi)) * y,
        np.sqrt(3 / (4 * np.pi)) * z,
        -np.sqrt(3 / (4 * np.pi)) * x,
        k * x * y,
        -k * y * z,
        np.sqrt(5 / (16 * np.pi)) * (3 * z * z - 1),
        -k * x * z,
        k / 2 * (x * x - y * y),
    ]
    assert_allclose(evaluate_basis(d, 3), np.stack(expected, axis=-1), rtol=0, atol=8 * ROUNDING)


def test_basis_agrees_with_scipy_to_degree_30():
    d = random_directions(300, seed=2)
    # SciPy starts from angles and cos(theta): numerics.md 2 measures 9e-15 (l = 16) and 6.6e-14 (l = 33) for that
    assert_allclose(evaluate_basis(d, 31), scipy_basis(d, 31), rtol=0, atol=6.6e-14)


@pytest.mark.parametrize(("most", "bound"), [(16, 4e-15), (128, 2e-14), (1024, 1e-13)])
def test_basis_agrees_with_seventy_digits_at_the_hard_points(most, bound):
    # numerics.md 0 measures 7.6e-14 at l = 1024 for this recurrence; 3.2e-10 for the usual one near a pole
    cases = [case for case in HARD_CASES["sh_values"]["values"] if case["l"] <= most]
    assert len(cases) > 40
    points = list(POINTS)
    table = evaluate_basis(points, most + 1)
    found = [
        table[points.index(tuple(map(float.fromhex, case["xyz_hex"]))), index(case["l"], case["m"])] for case in cases
    ]
    assert_allclose(found, [float(case["value"]) for case in cases], rtol=0, atol=bound)


coordinates = st.floats(allow_nan=False, allow_infinity=False)


@settings(max_examples=200, deadline=None, derandomize=True, database=None)
@given(st.tuples(coordinates, coordinates, coordinates).filter(any))
def test_squares_of_a_band_sum_to_its_share_for_any_finite_direction(direction):
    squares = np.add.reduceat(evaluate_basis(direction, 32) ** 2, np.arange(32) ** 2)
    assert_allclose(squares * 4 * np.pi / (2 * np.arange(32) + 1), np.ones(32), rtol=0, atol=3.1e-14)  # numerics.md 2


def test_the_opposite_direction_changes_the_sign_of_odd_degrees_only():
    d = random_directions(50, seed=6)
    assert_array_equal(evaluate_basis(-d, 20), evaluate_basis(d, 20) * (-1.0) ** degrees(20))


@pytest.mark.parametrize("length", [5e-324, 1e-310, 1e-200, 1e-3, 1.0, 7.0, 1e200, 1e308])
def test_a_direction_of_any_length_is_normalised(length):
    vector = np.array([1.0, -1.0, 1.0]) * length
    assert_allclose(normalise(vector), np.array([1, -1, 1]) / np.sqrt(3), rtol=0, atol=ROUNDING)
    assert_allclose(evaluate_basis(vector, 16), evaluate_basis([1, -1, 1], 16), rtol=0, atol=1e-14)


def test_components_of_very_different_size_are_normalised():
    assert_allclose(normalise([[1e308, 1e-308, 0], [0, 5e-324, 1.0]]), [[1, 0, 0], [0, 0, 1]], rtol=0, atol=5e-324)


@pytest.mark.parametrize("bad", [[0.0, 0.0, 0.0], [1.0, np.nan, 0.0], [np.inf, 0.0, 0.0], [0.0, 0.0, -np.inf]])
def test_a_direction_without_direction_is_refused_and_named(bad):
    directions = np.ones((2, 3, 3))
    directions[1, 2] = bad
    with pytest.raises(ValueError, match="must be finite and not zero") as caught:
        evaluate_basis(directions, 3)
    assert f"direction {bad} at (1, 2)" in str(caught.value)


@pytest.mark.parametrize("shape", [(), (2,), (3, 4), (0,)])
def test_directions_need_three_components(shape):
    with pytest.raises(ValueError, match=r"the last axis must hold x, y, z"):
        evaluate_basis(np.ones(shape), 2)


@pytest.mark.parametrize("n_bands", [0, -1, 1401, 10**9])
def test_fewer_than_one_or_more_than_1400_bands_are_refused(n_bands):
    with pytest.raises(ValueError, match=f"{n_bands} bands: there must be 1 to 1400"):
        evaluate_basis([0, 0, 1], n_bands)


def test_too_many_values_are_refused_before_anything_large_is_allocated():
    directions = random_directions(200)
    tracemalloc.start()
    try:
        with pytest.raises(ValueError, match=f"200 directions x 1960000 functions: at most {2**28} values at once"):
            evaluate_basis(directions, 1400)
        assert tracemalloc.get_traced_memory()[1] < 2**20
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("shape", [(3,), (1, 3), (2, 5, 3), (0, 3), (4, 0, 3)])
def test_the_last_axis_becomes_the_coefficients(shape):
    directions = np.random.default_rng(7).standard_normal(shape)
    values = evaluate_basis(directions, 4)
    assert values.shape == (*shape[:-1], 16)
    for where in np.ndindex(shape[:-1]):
        assert_array_equal(values[where], evaluate_basis(directions[where], 4))


def test_blocks_do_not_show_in_the_values():
    directions = random_directions(700, seed=8)  # 64 bands: blocks of 512
    values = evaluate_basis(directions, 64)
    for k in (0, 511, 512, 699):
        assert_allclose(values[k], evaluate_basis(directions[k], 64), rtol=0, atol=1e-14)


def test_index_degrees_and_count_bands_describe_one_order():
    pairs = [(l, m) for l in range(6) for m in range(-l, l + 1)]
    assert [index(l, m) for l, m in pairs] == list(range(36))
    assert degrees(6).tolist() == [l for l, _ in pairs]
    assert [count_bands(np.zeros((n * n, 3))) for n in (1, 2, 6, 128)] == [1, 2, 6, 128]


@pytest.mark.parametrize("count", [0, 2, 8, 15, 24])
def test_a_number_of_coefficients_that_is_no_square_is_refused(count):
    with pytest.raises(ValueError, match=f"{count} coefficients: n bands have n"):
        count_bands(np.zeros((count, 3)))


def test_the_remembered_normalisation_cannot_be_written_to():
    with pytest.raises(ValueError, match="read-only"):
        normalisation(5)[0, 0] = 1
    assert basis.normalisation(5)[0, 0] == np.sqrt(1 / (4 * np.pi))


@pytest.mark.parametrize("n_bands", [1, 2, 3, 4, 5, 6, 7, 8, 9, 32, 33])
def test_many_directions_have_the_values_that_each_has_alone(n_bands):
    """Many are evaluated by matrix products, few by the recurrence: to 1e-14 of the largest, also where blocks are not full."""
    poles = np.array([[0, 0, 1], [0, 0, -1], [1e-9, 0, 1], [1e-9, -1e-9, -1], [0, 1, 0], [-1, 0, 0.0]])
    directions = np.concatenate([poles, random_directions(20_001 if n_bands < 10 else 4_001, seed=2)])
    some = np.concatenate([np.arange(600), np.arange(len(directions) - 300, len(directions))])
    for length in (1.0, 7.0):
        many = evaluate_basis((length * directions)[:, None], n_bands)
        assert many.shape == (len(directions), 1, n_bands**2)
        few = np.concatenate([evaluate_basis(part, n_bands) for part in np.split(length * directions[some], 9)])
        assert np.abs(many[some, 0] - few).max() < 1e-14 * np.abs(few).max()


@pytest.mark.parametrize("n_bands", [2, 3, 9])
@pytest.mark.parametrize("bad", [[0, 0, 0], [np.nan, 0, 1], [0, np.inf, 0]])
def test_a_direction_without_direction_is_named_among_many(n_bands, bad):
    directions = random_directions(3000, seed=3).reshape(2, 1500, 3)
    directions[1, 7] = bad
    with pytest.raises(ValueError, match=r"at \(1, 7\)"):
        evaluate_basis(directions, n_bands)


@pytest.mark.parametrize("length", [1e-200, 1e200])
@pytest.mark.parametrize("n_bands", [2, 3, 9])
def test_many_directions_of_any_length_are_normalised(n_bands, length):
    directions = random_directions(1500, seed=9)
    found = evaluate_basis(directions * length, n_bands)
    assert_allclose(found, evaluate_basis(directions, n_bands), rtol=0, atol=1e-14)
