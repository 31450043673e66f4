"""The basis as a short Fourier series along theta.

On the great circle through the poles and phi the normalised function is a trigonometric polynomial,
    Y(l, m)(theta, phi) = {cos, sin}(|m| phi) times the sum over k <= l of D(m, l, k) cos(k theta)     for even m,
                                                                        or D(m, l, k) sin(k theta)     for odd m,
because it continues over the poles; k + l is even wherever D is not zero. So a transform along theta is a product with plain
cosines and sines, the same for every m, and only the small table D depends on m and l.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from shviewer.harmonics.basis import Array, Indices, check_bands, evaluate_basis
from shviewer.harmonics.quadrature import column_azimuths

MAX_SEPARABLE_BANDS = 512
"""The most bands with a table D, which has n**3 values: 1 GiB at 512 bands."""

DEGREES = 48
"""About as many degrees of one parity are summed at a time."""


@lru_cache(maxsize=8)
def theta_series(n_bands: int) -> Array:
    """D(m, l, k), shape (n, n, n), zero for l < m: from the basis on the great circle phi = 0, pi.

    The function and its row functions are even or odd both about theta = 0 and about pi/2, so a quarter of the circle is
    enough, its ends counted half.
    """
    check_bands(n_bands, MAX_SEPARABLE_BANDS)
    quarter = (n_bands + 1) // 2
    angle = np.pi / 2 * np.arange(quarter + 1) / quarter
    circle = np.stack([np.sin(angle), np.zeros(quarter + 1), np.cos(angle)], axis=-1)
    weights = np.full(quarter + 1, 2 / quarter)
    weights[[0, -1]] /= 2
    basis = evaluate_basis(circle, n_bands).T
    wave = angle[:, None] * np.arange(n_bands)
    series = np.zeros((n_bands, n_bands, n_bands))
    for m in range(n_bands):
        degree = np.arange(m, n_bands)
        row_functions = np.sin(wave) if m % 2 else np.cos(wave)
        series[m, m:] = (basis[degree * (degree + 1) + m] * weights) @ row_functions
    series[..., 0] /= 2
    parity = np.arange(n_bands)
    series *= (parity[:, None] + parity + 1) % 2
    series.flags.writeable = False
    return series


@lru_cache(maxsize=8)
def series_by_parity(n_bands: int) -> tuple[Array, Array]:
    """The parts of D that are not zero, laid out as (m, k, l): for even k and l, and for odd k and l."""
    series = theta_series(n_bands).transpose(0, 2, 1)
    return np.ascontiguousarray(series[:, 0::2, 0::2]), np.ascontiguousarray(series[:, 1::2, 1::2])


@lru_cache(maxsize=8)
def degrees_and_orders(n_bands: int) -> tuple[Indices, Indices, Indices]:
    """Degree l and |m| of each coefficient, and 1 for that of a sine, else 0; (n**2,) each."""
    degree = np.repeat(np.arange(n_bands), 2 * np.arange(n_bands) + 1)
    order = np.arange(n_bands**2) - degree * (degree + 1)
    return degree, np.abs(order), (order < 0).astype(np.int64)


@lru_cache(maxsize=8)
def azimuth_functions(n_bands: int, n_columns: int) -> Array:
    """cos(m phi) and sin(m phi) at the column centres, shape (2, n_bands, n_columns)."""
    angle = np.arange(n_bands)[:, None] * column_azimuths(n_columns)
    return np.stack([np.cos(angle), np.sin(angle)])


def from_waves(sums: Array) -> Array:
    """Sums with {cos, sin}(m phi) and cos(k theta), for odd m sin(k theta) -> coefficients (n**2, channels).

    sums: (m, {cos, sin}, channel, k), the even k first, then the odd ones.
    """
    n_bands, _, channels, _ = sums.shape
    table = np.empty((n_bands, 2 * channels, n_bands))  # m, ..., l
    rows = sums.reshape(n_bands, -1, n_bands)
    start = 0
    for parity, series in enumerate(series_by_parity(n_bands)):
        half = series.shape[1]
        step = max(1, -(-half // (1 + half // DEGREES)))
        for first in range(0, half, step):  # some degrees l at a time: only m <= l and k <= l belong to them
            last = min(first + step, half)
            highest = min(2 * last - 1 + parity, n_bands)
            product = rows[:highest, :, start : start + last] @ series[:highest, :last, first:last]
            table[:highest, :, 2 * first + parity : 2 * last + parity : 2] = product
        start += half
    degree, order, sine = degrees_and_orders(n_bands)
    return np.asarray(table.reshape(n_bands, 2, channels, n_bands)[order, sine, :, degree])
