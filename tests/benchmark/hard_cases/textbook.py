"""Spherical harmonics as textbooks, papers and many programs write them: the thing that the hard cases are hard for.

Factorials, angles by acos and atan2, double factorials, point weights, Euler angles, float32 sums. Right for a few bands
and ordinary directions, which tests/hard_cases/test_hard_cases.py checks too: it must fail for its method, not for a slip.
"""

from __future__ import annotations

import numpy as np

from shviewer.harmonics.quadrature import DirectionSet


def factorial(k: int) -> float:
    """k! in float64: infinite from 171 on."""
    with np.errstate(over="ignore"):
        return float(np.prod(np.arange(1.0, k + 1)))


def double_factorial(k: int) -> float:
    """k!! for odd k in float64: infinite from 301 on."""
    with np.errstate(over="ignore"):
        return float(np.prod(np.arange(k, 0.0, -2)))


def legendre(l: int, m: int, x: np.ndarray) -> np.ndarray:
    """P(l, m)(x) with the phase, by the recurrence in l from (2m-1)!! (1 - x^2)^(m/2)."""
    last, value = np.zeros_like(x), (-1) ** m * double_factorial(2 * m - 1) * (1 - x * x) ** (m / 2)
    for k in range(m + 1, l + 1):
        last, value = value, ((2 * k - 1) * x * value - (k + m - 1) * last) / (k - m)
    return value


def evaluate_basis(directions: np.ndarray, n_bands: int, *, trust_unit: bool = False) -> np.ndarray:
    """Directions (k, 3) -> (k, n_bands**2), through theta and phi."""
    x, y, z = np.asarray(directions, dtype=float).T
    with np.errstate(all="ignore"):
        length = 1.0 if trust_unit else np.sqrt(x * x + y * y + z * z)
        cosine = np.cos(np.arccos(np.clip(z / length, -1, 1)))
        phi = np.arctan2(y, x)
        columns = []
        for l in range(n_bands):
            for m in range(-l, l + 1):
                k = np.sqrt((2 * l + 1) / (4 * np.pi) * factorial(l - abs(m)) / factorial(l + abs(m)))
                value = k * legendre(l, abs(m), cosine)
                if m:
                    value = value * np.sqrt(2) * (np.cos(m * phi) if m > 0 else np.sin(-m * phi))
                columns.append(value)
    return np.stack(columns, axis=-1)


def normalisation(n_bands: int) -> np.ndarray:
    """N(l, m) of the last degree by factorials; the others are left 1."""
    norms, l = np.ones((n_bands, n_bands)), n_bands - 1
    with np.errstate(all="ignore"):
        for m in range(n_bands):
            k = np.sqrt((2 * l + 1) / (4 * np.pi) * factorial(l - m) / factorial(l + m))
            growth = np.float64(factorial(l + m)) / (np.float64(2) ** m * factorial(m) * factorial(l - m))
            norms[l, m] = (-1) ** m * (np.sqrt(2) if m else 1) * k * growth
    return norms


def plain_recurrence(directions: np.ndarray, n_bands: int) -> np.ndarray:
    """The fully normalised recurrence in z = cos(theta) alone: no factorials, but digits are lost next to the poles."""
    x, y, z = np.asarray(directions, dtype=float).T
    table = np.zeros((n_bands**2, len(x)))
    sectoral, power = np.full(len(x), np.sqrt(1 / (4 * np.pi))), np.ones(len(x), dtype=complex)
    for m in range(n_bands):
        if m:
            sectoral, power = -sectoral * np.sqrt((2 * m + 1) / (2 * m)), power * (x + 1j * y)
        last, value = np.zeros(len(x)), sectoral
        for l in range(m, n_bands):
            if l > m:
                a = np.sqrt((4 * l * l - 1) / (l * l - m * m))
                b = np.sqrt(((l - 1) ** 2 - m * m) / (4 * (l - 1) ** 2 - 1))
                last, value = value, a * (z * value - b * last)
            table[l * (l + 1) + m] = value * power.real * (np.sqrt(2) if m else 1)
            if m:
                table[l * (l + 1) - m] = value * power.imag * np.sqrt(2)
    return table.T


def midpoint_rule(n_samples: int):
    """The centres of a theta-phi grid, each weighing its solid angle."""
    from shviewer.harmonics.quadrature import DirectionSet, directions_from_angles

    rows = int(np.sqrt(n_samples / 2))
    edges = np.linspace(0, np.pi, rows + 1)
    theta, phi = (edges[1:] + edges[:-1]) / 2, np.pi * (np.arange(2 * rows) + 0.5) / rows
    area = (np.cos(edges[:-1]) - np.cos(edges[1:])) * np.pi / rows
    return DirectionSet(directions_from_angles(theta[:, None], phi).reshape(-1, 3), np.repeat(area, 2 * rows))


def project_image(image: np.ndarray, n_bands: int) -> np.ndarray:
    """Point weights: each texel is a sample at its centre, weighing sin(theta) dtheta dphi; one sum over rows of texels."""
    height, width = image.shape[:2]
    theta, phi = np.pi * (np.arange(height) + 0.5) / height, np.pi * (1 - (2 * np.arange(width) + 1) / width)
    total = np.zeros((n_bands**2, 3))
    for angle, row in zip(theta, image, strict=True):
        directions = np.stack(
            [np.sin(angle) * np.cos(phi), np.sin(angle) * np.sin(phi), np.full(width, np.cos(angle))], axis=-1
        )
        weighted = evaluate_basis(directions, n_bands) * (np.sin(angle) * np.pi / height * 2 * np.pi / width)
        total += sequential_sum(weighted[:, :, None] * row[:, None, :])
    return total


def sequential_sum(terms: np.ndarray) -> np.ndarray:
    """One after the other along the first axis, in the type of the terms."""
    return np.add.accumulate(terms, axis=0)[-1]


def project_samples_float32(radiance, samples, n_bands: int) -> np.ndarray:
    """Each term rounded to float32 and added to the last sum; all samples in turn, 2**19 at a time."""
    total = np.zeros((n_bands**2, 3), dtype=np.float32)
    for start in range(0, len(samples.weights), 2**19):
        directions = samples.directions[start : start + 2**19]
        basis = evaluate_basis(directions, n_bands) * samples.weights[start : start + 2**19, None]
        values = radiance(directions)
        for channel in range(3):
            terms = np.concatenate([total[None, :, channel], basis * values[:, channel : channel + 1]]).astype(
                np.float32
            )
            total[:, channel] = sequential_sum(terms)
    return total.astype(np.float64)


def disc_zonal(half_angle: float, n_bands: int) -> np.ndarray:
    """2 pi (P(l-1) - P(l+1))/(2l+1) at cos(half_angle)."""
    x = np.cos(half_angle)
    p = [1.0, x]
    for l in range(2, n_bands + 1):
        p.append(((2 * l - 1) * x * p[-1] - (l - 1) * p[-2]) / l)
    return np.array(
        [2 * np.pi * (1 - x)] + [2 * np.pi * (p[l - 1] - p[l + 1]) / (2 * l + 1) for l in range(1, n_bands)]
    )


def rebuilt_from_euler_angles(matrix: np.ndarray) -> np.ndarray:
    """The rotation written as angles about z, y, z by acos and division by sin(beta), and built again from them."""
    beta = np.arccos(np.clip(matrix[2, 2], -1, 1))
    alpha, gamma = np.arctan2(matrix[1, 2], matrix[0, 2]), np.arctan2(matrix[2, 1], -matrix[2, 0])
    return about_z(alpha) @ about_y(beta) @ about_z(gamma)


def about_z(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])


def about_y(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])


def multiply_float32(second: np.ndarray, first: np.ndarray) -> np.ndarray:
    return (np.float32(second) @ np.float32(first)).astype(np.float64)


def irradiance_factors(n_bands: int) -> np.ndarray:
    """Ramamoorthi and Hanrahan's closed form by factorials."""
    factors = np.zeros(n_bands)
    factors[:2] = np.pi, 2 * np.pi / 3
    with np.errstate(all="ignore"):
        for l in range(2, n_bands, 2):
            ratio = np.float64(factorial(l)) / (np.float64(2) ** l * np.float64(factorial(l // 2)) ** 2)
            factors[l] = 2 * np.pi * (-1) ** (l // 2 - 1) / ((l + 2) * (l - 1)) * ratio
    return factors


def relative_figures(light, squares=np.float64) -> list[float]:
    """Relative L2 error of five bands and their energies: squares of that type, divided by their sum."""
    from shviewer.harmonics.quadrature import gauss_legendre

    points = gauss_legendre(20_000).direction_set()
    with np.errstate(all="ignore"):
        norm = (points.weights[:, None] * light.radiance(points.directions).astype(squares) ** 2).sum()
        power = (light.coefficients(5).astype(squares) ** 2).sum(axis=1)
        shares = np.add.reduceat(power, np.arange(5) ** 2) / norm
        return [float(np.sqrt(1 - shares.sum())), *shares]


def samples_at_equal_angles(n_samples: int, seed: int) -> DirectionSet:
    """Uniform in theta and phi, with weights as if they were uniform on the sphere."""
    theta, phi = np.random.default_rng(seed).random((2, n_samples)) * [[np.pi], [2 * np.pi]]
    directions = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    return DirectionSet(directions, np.full(n_samples, 4 * np.pi / n_samples))
