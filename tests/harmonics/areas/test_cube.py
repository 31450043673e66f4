"""What shviewer.harmonics.areas.cube promises: points on the faces of a cube, as if each met each function."""

import numpy as np
import pytest

from shviewer.harmonics.areas.cube import project_faces
from shviewer.harmonics.basis import evaluate_basis


@pytest.mark.parametrize("n_bands", [1, 2, 3, 4, 9, 40])
def test_points_of_all_faces_count_as_if_each_were_given(n_bands):
    random = np.random.default_rng(0)
    points, values = random.uniform(0, 1, 6), random.normal(size=(2, 2, 2, 3, 6, 6, 4))
    u, w = points[:, None] + 0 * points, points + 0 * points[:, None]
    one, expected = np.ones_like(u), np.zeros((n_bands**2, 4))
    for axis, place in enumerate(((one, u, w), (u, one, w), (w, u, one))):
        for sides in np.ndindex(2, 2, 2):
            directions = np.stack(place, axis=-1).reshape(-1, 3) * (1 - 2 * np.array(sides))
            expected += evaluate_basis(directions, n_bands).T @ values[(*sides, axis)].reshape(-1, 4)
    found = project_faces(points, values, n_bands)
    assert np.abs(found - expected).max() < 2e-15 * np.abs(values).sum() / 4  # of sums, and of waves by their powers


def test_no_bands_are_an_error():
    with pytest.raises(ValueError, match="0 bands"):
        project_faces(np.array([0.5]), np.zeros((2, 2, 2, 3, 1, 1, 3)), 0)
