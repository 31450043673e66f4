"""The formulas of stored irradiance are the sums of bands that its encoding stands for, whatever the numbers are."""

import numpy as np
import pytest
from harmonics.independent import random_directions
from harmonics.quantities.hard_numbers import CASES, HARD
from numpy.testing import assert_allclose

from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.quantities.decoding import FORMULAS
from shviewer.harmonics.quantities.encodings import ENCODINGS, Stored

NORMALS = np.concatenate([random_directions(300), np.eye(3), -np.eye(3)])

CUT_OFF = {"geomerics": 1e-5, "ambient-cube": 5e-4, "ambient-cube-fitted": 5e-4}
"""What 32 bands leave of those that have more, over the peak."""


@pytest.mark.parametrize(("name", "light"), CASES)
def test_a_formula_is_the_sum_of_the_bands_it_stands_for(name: str, light: str) -> None:
    encoding = ENCODINGS[name]
    numbers = encoding.store(HARD[light])
    assert numbers.shape == (encoding.floats, 3)
    found = Stored(name, numbers).irradiance(NORMALS)
    summed = evaluate_basis(NORMALS, encoding.bands) @ encoding.expand(numbers)
    peak = np.abs(summed).max(axis=0)
    assert_allclose(found, summed, rtol=0, atol=CUT_OFF.get(name, 1e-14) * peak.max())
    assert (np.abs(found - summed).max(axis=0) <= 2 * CUT_OFF.get(name, 1e-5) * peak).all()


@pytest.mark.parametrize("formula", FORMULAS)
def test_channels_do_not_touch_each_other_but_by_their_axis(formula: str) -> None:
    count = 6 if formula == "cube" else 9
    numbers = np.random.default_rng(0).random((count, 3))
    for channel in range(3):
        own = np.repeat(numbers[:, [channel]], 3, axis=1)
        alone, together = FORMULAS[formula](own, NORMALS)[:, channel], FORMULAS[formula](numbers, NORMALS)[:, channel]
        assert np.allclose(alone, together, rtol=0, atol=1e-13) == (not formula.endswith("shared"))
