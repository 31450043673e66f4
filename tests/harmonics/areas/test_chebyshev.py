"""What shviewer.harmonics.areas.chebyshev promises."""

import numpy as np
import pytest
from numpy.polynomial import Chebyshev
from numpy.testing import assert_allclose
from scipy.special import jv

from shviewer.harmonics.areas.chebyshev import (
    chebyshev_points,
    chebyshev_shares,
    chebyshev_values,
    integrate_series,
    point_count,
)

POSITIONS = np.concatenate([[-1.0, 0.0, 1.0], np.random.default_rng(0).uniform(-1, 1, 50)])


@pytest.mark.parametrize("n", [1, 2, 3, 8, 40])
def test_polynomials_and_their_antiderivatives_are_numpys(n):
    table = chebyshev_values(POSITIONS, n)
    assert_allclose(table, [Chebyshev.basis(k)(POSITIONS) for k in range(n)], rtol=0, atol=4e-16 * n**2)
    primitives = integrate_series(chebyshev_values(POSITIONS, n + 1))
    for k in range(n):
        expected = Chebyshev.basis(k).integ()
        change = primitives[k] - primitives[k, 1]
        assert_allclose(change, expected(POSITIONS) - expected(0.0), rtol=0, atol=4e-16 * (n + 1) ** 2)


@pytest.mark.parametrize("n", [1, 2, 9])
def test_shares_reproduce_every_polynomial_of_lower_degree(n):
    shares = chebyshev_shares(POSITIONS, n)
    for k in range(n):
        assert_allclose(
            Chebyshev.basis(k)(chebyshev_points(n)) @ shares, Chebyshev.basis(k)(POSITIONS), rtol=0, atol=1e-14
        )


@pytest.mark.parametrize("phase", [1e-3, 0.1, 1.0, 5.0, 33.0, 200.0, 700.0])
def test_as_many_points_as_a_wave_needs(phase):
    """The rest of its series is 2 (J(n) + J(n+1) + ...): below 1e-14, and not by a fourth more points than that takes."""
    n = point_count(phase)

    def rest(first):
        return 2 * np.abs(jv(np.arange(first, first + 100), phase)).sum()

    assert rest(n) < 1e-14
    assert rest(int(0.8 * n) - 4) > 1e-14
