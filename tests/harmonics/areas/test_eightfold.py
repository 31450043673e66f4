"""What shviewer.harmonics.areas.eightfold promises: points and their images under the symmetries of a square."""

import numpy as np
import pytest
from harmonics.independent import random_directions

from shviewer.harmonics.areas.eightfold import eightfold_waves, waves
from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.theta_series import from_waves

EXACT = 2e-14
"""A share of the sum of |value|: the series of a strip end at 2e-15, waves so near a pole that they are left out at 1e-14."""


@pytest.mark.parametrize("n_bands", [1, 2, 3, 5, 33, 100])
def test_eight_points_are_summed_as_if_each_were_given(n_bands):
    directions = random_directions(300, seed=0)
    corners = np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [0, 1, 0], [1, 1, 0], [1e-9, 0, 1], [0.01, 0.02, -1]])
    directions = np.concatenate([directions, corners / np.linalg.norm(corners, axis=1, keepdims=True)])
    random = np.random.default_rng(1)
    values = random.normal(size=(2, 2, 2, 3, len(directions)))  # exchanged, -x, -y
    expected = np.zeros((n_bands**2, 3))
    for exchanged, x, y in np.ndindex(2, 2, 2):
        image = directions[:, [1, 0, 2]] if exchanged else directions
        expected += evaluate_basis(image * [1 - 2 * x, 1 - 2 * y, 1], n_bands).T @ values[exchanged, x, y].T
    folded = np.stack([values[:, 0] + values[:, 1], values[:, 0] - values[:, 1]], axis=1)
    folded = np.stack([folded[:, :, 0] + folded[:, :, 1], folded[:, :, 0] - folded[:, :, 1]], axis=2)
    found = from_waves(eightfold_waves(directions, folded[0], folded[1], n_bands))
    assert np.abs(found - expected).max() < EXACT * np.abs(values).sum() / 3


def test_channels_without_exchanged_points_and_blocks_of_points_change_nothing(monkeypatch):
    directions, random = random_directions(500, seed=2), np.random.default_rng(3)
    own, exchanged = random.normal(size=(2, 2, 5, 500)), random.normal(size=(2, 2, 2, 500))
    whole = eightfold_waves(directions, own, exchanged, 40)
    padded = np.concatenate([exchanged, np.zeros((2, 2, 3, 500))], axis=2)
    assert np.abs(eightfold_waves(directions, own, padded, 40) - whole).max() < EXACT * np.abs(own).sum()
    monkeypatch.setattr("shviewer.harmonics.areas.eightfold.MOST_POINTS", 7)
    in_parts = from_waves(eightfold_waves(directions, own, exchanged, 40))
    assert np.abs(in_parts - from_waves(whole)).max() < EXACT * np.abs(own).sum()


@pytest.mark.parametrize("n", [1, 2, 3, 4, 8, 9, 200])
def test_waves_are_cosines_and_sines(n):
    angle = np.random.default_rng(4).uniform(-np.pi, np.pi, 50)
    phase = np.arange(n)[:, None] * angle
    assert np.abs(np.stack(waves(np.cos(angle), np.sin(angle), n)) - [np.cos(phase), np.sin(phase)]).max() < 4e-16 * n
