"""What shviewer.harmonics.areas.boxes promises: sums over any points against many bands, as if each point met each function."""

import numpy as np
import pytest
from harmonics.independent import random_directions

from shviewer.harmonics.areas.boxes import wave_sums
from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.theta_series import from_waves

EXACT = 2e-14
"""A share of the sum of |value|: the series of a box end at 1e-15 in each of two angles, and sums of products round."""


@pytest.mark.parametrize("n_bands", [1, 2, 33, 100])
def test_points_anywhere_are_summed_as_with_the_basis_itself(n_bands):
    directions = random_directions(400, seed=0)
    corners = np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [1, 1, 0], [1e-9, 0, 1]])
    directions = np.concatenate([directions, corners, 1e-5 * directions[:3] + [0, 0, 1], -0.0 * corners + corners])
    values = np.random.default_rng(1).normal(size=(len(directions), 4))
    found = from_waves(wave_sums(directions, values[None, None, None], n_bands))
    expected = evaluate_basis(directions, n_bands).T @ values
    assert np.abs(found - expected).max() < EXACT * np.abs(values).sum(axis=0).max()


def test_many_points_in_one_box_are_summed_in_parts(monkeypatch):
    directions = random_directions(3000, seed=2) * [1e-3, 1e-3, 0] + [1, 2, 3]
    values = np.random.default_rng(3).normal(size=(1, 1, 1, 3000, 3))
    whole = wave_sums(directions, values, 40)
    monkeypatch.setattr("shviewer.harmonics.areas.boxes.STRIP_POINTS", 700)
    monkeypatch.setattr("shviewer.harmonics.areas.boxes.BOX_POINTS", 64)
    assert np.abs(wave_sums(directions, values, 40) - whole).max() < EXACT * np.abs(values).sum()
