"""References that share no code with shviewer: SciPy's harmonics, Gauss-Legendre rules of our own, mpmath's figures."""

import numpy as np
from places import hard_cases
from scipy.special import roots_legendre, sph_harm_y

HARD_CASES = hard_cases()


def random_directions(count, seed=0):
    """Unit vectors (count, 3), uniform on the sphere."""
    vectors = np.random.default_rng(seed).standard_normal((count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def random_rotation(seed):
    """A proper rotation matrix (3, 3)."""
    q, r = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    q *= np.sign(np.diag(r))
    return q * np.linalg.det(q)


def scipy_basis(directions, n_bands):
    """Real harmonics (k, n_bands**2) from SciPy's complex ones, which keep the Condon-Shortley phase."""
    x, y, z = np.asarray(directions, dtype=float).T
    theta, phi = np.arctan2(np.hypot(x, y), z), np.arctan2(y, x)
    columns = []
    for l in range(n_bands):
        for m in range(-l, l + 1):
            value = sph_harm_y(l, abs(m), theta, phi)
            columns.append(value.real if m == 0 else np.sqrt(2) * (value.imag if m < 0 else value.real))
    return np.stack(columns, axis=-1)


def sphere_rule(rows):
    """Directions (k, 3) and weights (k,) that integrate polynomials of degree 2 rows - 1 exactly."""
    return cap_rule([0, 0, 1], np.pi, rows)


def cap_rule(axis, half_angle, rows):
    """The same for the cap of directions within `half_angle` of the unit vector `axis`."""
    nodes, weights = roots_legendre(rows)
    height = 2 * np.sin(half_angle / 2) ** 2
    cosine = 1 - height * (1 - nodes) / 2
    sine = np.sqrt((1 - cosine) * (1 + cosine))
    phi = 2 * np.pi * (np.arange(2 * rows) + 0.3) / (2 * rows)
    axis = np.asarray(axis, dtype=float)
    side = np.cross(axis, [0.6, -0.48, 0.64] if abs(axis @ [0.6, -0.48, 0.64]) < 0.9 else [0, 0, 1.0])
    side /= np.linalg.norm(side)
    up = np.cross(axis, side)
    ring = np.cos(phi)[:, None] * side + np.sin(phi)[:, None] * up
    directions = cosine[:, None, None] * axis + sine[:, None, None] * ring
    return directions.reshape(-1, 3), np.repeat(weights * height / 2 * (np.pi / rows), 2 * rows)
