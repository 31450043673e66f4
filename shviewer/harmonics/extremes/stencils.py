"""The polynomial through square stencils of points, as Bernstein coefficients in the cell between the middle four."""

from __future__ import annotations

from functools import lru_cache
from math import comb, factorial, prod

import numpy as np

from shviewer.harmonics.basis import Array


def halved(control: Array) -> Array:
    """Bernstein coefficients (k, s, s) -> those of the four quarters, (4 k, s, s)."""
    size = control.shape[1]
    split = _halves(size)  # (2 s, s)
    by_row = control.reshape(-1, size) @ split.T
    quarters = by_row.reshape(-1, size, 2 * size).swapaxes(1, 2).reshape(-1, size) @ split.T
    quarters = quarters.reshape(-1, 2, size, 2, size)  # column half, column, row half, row
    return np.ascontiguousarray(quarters.transpose(0, 3, 1, 4, 2)).reshape(-1, size, size)


@lru_cache(maxsize=4)
def _halves(size: int) -> Array:
    """From Bernstein coefficients on [0, 1] to those on both halves, (2 size, size) [de Casteljau]."""
    left = np.array([[comb(i, j) / 2**i for j in range(size)] for i in range(size)])
    return np.concatenate([left, left[::-1, ::-1]])


@lru_cache(maxsize=4)
def stencil(size: int) -> tuple[Array, float, Array]:
    """For `size` points about the cell [0, 1], one apart: the matrix from values to Bernstein coefficients; the factor of
    D(size) in the error of two dimensions; the matrix for size x size points, (size^2, size^2), which stands on the right.
    """
    nodes = np.arange(1.0 - size // 2, 1.0 + size - size // 2)
    degree = size - 1
    x = np.linspace(0.0, 1.0, size)
    weights = _lagrange(nodes, x)
    bernstein = np.array([[comb(degree, j) * t**j * (1 - t) ** (degree - j) for j in range(size)] for t in x])
    matrix = np.linalg.solve(bernstein, weights)
    lebesgue = 1.001 * float(np.abs(_lagrange(nodes, np.linspace(0, 1, 101))).sum(axis=1).max())
    product = prod((k + 0.5) ** 2 for k in range(size // 2))
    both = np.asarray(np.kron(matrix, matrix).T, dtype=np.float64, order="C")
    return matrix, (1 + lebesgue) * product / factorial(size), both


def _lagrange(nodes: Array, x: Array) -> Array:
    """The weights (len(x), len(nodes)) of values at the nodes in the polynomial through them, at x."""
    weights = np.ones((len(x), len(nodes)))
    for i, node in enumerate(nodes):
        for other in np.delete(nodes, i):
            weights[:, i] *= (x - other) / (node - other)
    return weights
