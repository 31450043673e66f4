"""What shviewer.harmonics.areas.boundary promises: areas from their boundaries."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from shviewer.harmonics.areas.boundary import from_boundary
from shviewer.harmonics.basis import evaluate_basis

THETA, PHI = (0.7, 1.3), (0.2, 1.5)


def turned(seed):
    matrix = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return matrix * np.sign(np.linalg.det(matrix))


def direction(theta, phi):
    theta, phi = np.broadcast_arrays(theta, phi)
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("n_bands", [1, 2, 9, 20])
def test_a_patch_between_meridians_and_parallels_is_given_by_its_four_sides(seed, n_bands):
    """However it is turned: against Gauss's rule over the area."""
    rotation = turned(seed)
    node, weight = np.polynomial.legendre.leggauss(50)
    theta, phi = (a + (b - a) * (1 + node) / 2 for a, b in (THETA, PHI))
    over_theta, over_phi = (weight * (b - a) / 2 for a, b in (THETA, PHI))
    basis = evaluate_basis(direction(theta[:, None], phi) @ rotation.T, n_bands)
    expected = np.einsum("t,p,tpi->i", over_theta * np.sin(theta), over_phi, basis)

    sides = np.zeros((3, n_bands**2))
    for sign, at_phi in ((1, PHI[0]), (-1, PHI[1])):  # south along the first meridian, north along the last
        tangent = direction(theta + np.pi / 2, at_phi) @ rotation.T
        basis = evaluate_basis(direction(theta, at_phi) @ rotation.T, n_bands)
        sides += sign * tangent.T @ (over_theta[:, None] * basis)
    for sign, at_theta in ((1, THETA[1]), (-1, THETA[0])):
        tangent = np.sin(at_theta) * np.stack([-np.sin(phi), np.cos(phi), np.zeros_like(phi)], axis=-1) @ rotation.T
        basis = evaluate_basis(direction(at_theta, phi) @ rotation.T, n_bands)
        sides += sign * tangent.T @ (over_phi[:, None] * basis)
    found = from_boundary(sides[..., None])[:, 0]
    assert found[0] == 0
    assert_allclose(found[1:], expected[1:], rtol=0, atol=1e-14)


def test_channels_do_not_mix():
    tangents = np.random.default_rng(0).normal(size=(3, 25, 4))
    together = from_boundary(tangents)
    for channel in range(4):
        assert_allclose(together[:, channel], from_boundary(tangents[..., channel]), rtol=1e-14, atol=0)
