"""What shviewer.harmonics.areas.boundary promises: areas from their boundaries."""

import numpy as np
import pytest

from shviewer.harmonics.areas.boundary import project_boundary
from shviewer.harmonics.basis import evaluate_basis

EXACT = 2e-14
"""As a share of the longest way round a pole in radians; both sums of waves end at 2e-15."""


def circle(axis, opening, n_points=600):
    """Directions (k, 3) on the circle at an angle from an axis, counterclockwise as seen from outside, and d(phi) of each.

    Equal steps: the rule of a periodic function, which is exact to rounding.
    """
    axis = np.array(axis) / np.linalg.norm(axis)
    across = np.cross(axis, [0.3, 1, 0.2])
    across /= np.linalg.norm(across)
    turn = 2 * np.pi * np.arange(n_points)[:, None] / n_points
    around = np.cos(turn) * across + np.sin(turn) * np.cross(axis, across)
    ahead = np.cos(turn) * np.cross(axis, across) - np.sin(turn) * across
    directions = np.cos(opening) * axis + np.sin(opening) * around
    x, y, _ = directions.T
    steps = (x * ahead[:, 1] - y * ahead[:, 0]) * np.sin(opening) / (x * x + y * y)
    return directions, steps * 2 * np.pi / n_points


def cap(axis, opening, n_bands):
    """The integral of the basis over a cap: Gauss's rule over z about its axis (Funk and Hecke)."""
    node, weight = np.polynomial.legendre.leggauss(80)
    z = np.cos(opening) + (1 - np.cos(opening)) * (1 + node) / 2
    weight = weight * np.pi * (1 - np.cos(opening))
    zonal = evaluate_basis(np.stack([np.sqrt(1 - z * z), 0 * z, z], axis=-1), n_bands)
    l = np.arange(n_bands)
    factors = weight @ zonal[:, l * (l + 1)] * np.sqrt(4 * np.pi / (2 * l + 1))
    return np.repeat(factors, 2 * l + 1) * evaluate_basis(np.array(axis) / np.linalg.norm(axis), n_bands)


@pytest.mark.parametrize("n_bands", [1, 2, 9, 32, 60])
@pytest.mark.parametrize(
    ("axis", "opening"), [((0.1, 0.2, -1), 0.9), ((1, 0.5, 0.1), 0.8), ((-1, 0.3, -1), 0.4), ((0.2, 0, -1), 1.8)]
)
def test_a_cap_is_given_by_its_circle_whether_the_south_pole_is_in_it_or_not(axis, opening, n_bands):
    directions, steps = circle(axis, opening)
    found = project_boundary(directions, steps[None, None, None, :, None], n_bands)[:, 0]
    assert np.abs(found - cap(axis, opening, n_bands)).max() < EXACT * np.abs(steps).sum()


@pytest.mark.parametrize("n_bands", [9, 40])
def test_areas_and_their_mirror_images_have_their_own_values(n_bands):
    directions, steps = circle((0.5, 0.4, -1), 0.5)
    values = np.random.default_rng(0).normal(size=(2, 2, 1, 1, 3))
    expected = np.zeros((n_bands**2, 3))
    for i, j in np.ndindex(2, 2):  # a mirror turns both the boundary and phi round
        expected += cap((0.5 * (1 - 2 * i), 0.4 * (1 - 2 * j), -1), 0.5, n_bands)[:, None] * values[i, j, 0]
    found = project_boundary(directions, values * steps[:, None], n_bands)
    assert np.abs(found - expected).max() < EXACT * np.abs(steps).sum() * np.abs(values).sum()
