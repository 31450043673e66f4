"""The basis as a short Fourier series along theta.

On the great circle through the poles and phi the normalised function is a trigonometric polynomial,
    Y(l, m)(theta, phi) = {cos, sin}(|m| phi) times the sum over k <= l of D(m, l, k) cos(k theta)     for even m,
                                                                        or D(m, l, k) sin(k theta)     for odd m,
because it continues over the poles; k + l is even wherever D is not zero. So a transform along theta is a product with plain
cosines and sines, the same for every m, and only the small table D depends on m and l.

D has n**3 values. It is kept for up to TABLE_BANDS; with more, its two factors are taken one after the other: the functions
on a quarter of the great circle, degree by degree, and the waves there. That takes n**2 values at a time and no longer.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from shviewer.harmonics.evaluation.indices import Array, Indices, check_bands
from shviewer.harmonics.evaluation.recurrence import evaluate_by_recurrence, normalisation
from shviewer.harmonics.quadrature import column_azimuths

MAX_SEPARABLE_BANDS = 512
"""The most bands of an image or a sum on rows."""

TABLE_BANDS = 128
"""The most bands with a table D: 16 MiB."""

DEGREES = 48
"""About as many degrees of one parity are summed at a time."""

PASSED_DEGREES = 8
"""Degrees of one parity in one product where there is no table."""


def theta_series(n_bands: int) -> Array:
    """D(m, l, k), shape (n, n, n), zero for l < m: a part of a larger table, as a sweep wants one band more each time."""
    check_bands(n_bands, TABLE_BANDS)
    part = slice(n_bands)
    return _table(min(1 << (n_bands - 1).bit_length(), TABLE_BANDS))[part, part, part]


@lru_cache(maxsize=8)
def _table(n_bands: int) -> Array:
    """The same from the basis on the great circle phi = 0, pi.

    The function and its row functions are even or odd both about theta = 0 and about pi/2, so a quarter of the circle is
    enough, its ends counted half.
    """
    angle, weights = _quarter(n_bands)
    circle = np.stack([np.sin(angle), np.zeros(len(angle)), np.cos(angle)], axis=-1)
    basis = evaluate_by_recurrence(circle, n_bands)
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


def _quarter(n_bands: int) -> tuple[Array, Array]:
    """Angles theta of a quarter circle, both ends among them, and the weights of values there in D, (k,) each."""
    quarter = (n_bands + 1) // 2
    weights = np.full(quarter + 1, 2 / quarter)
    weights[[0, -1]] /= 2
    return np.pi / 2 * np.arange(quarter + 1) / quarter, weights


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
    rows = sums.reshape(n_bands, -1, n_bands)
    table = _by_table(rows) if n_bands <= TABLE_BANDS else _by_passing(rows)
    return np.asarray(table.reshape(-1).take(_places(n_bands, channels)))


@lru_cache(maxsize=8)
def _places(n_bands: int, channels: int) -> Indices:
    """Where the channels of each coefficient stand in a table (m, {cos, sin}, channel, l), (n**2, channels)."""
    degree, order, sine = degrees_and_orders(n_bands)
    return ((2 * order + sine)[:, None] * channels + np.arange(channels)) * n_bands + degree[:, None]


def to_waves(by_order: Array) -> Array:
    """Factors of the functions (m, l), shape (m, l, any) -> of cos(k theta), for odd m sin(k theta): (m, k, any)."""
    n_bands = len(by_order)
    if n_bands <= TABLE_BANDS:
        return np.asarray(theta_series(n_bands).transpose(0, 2, 1) @ by_order)
    angle, weights = _quarter(n_bands)
    along = np.zeros((2, n_bands, by_order.shape[2], len(angle)))  # by the parity of l
    for degrees, values in _degrees(n_bands, angle):
        orders = slice(len(values))
        along[degrees.start % 2, orders] += by_order[orders, degrees].swapaxes(1, 2) @ values
    found = np.empty((n_bands, n_bands, by_order.shape[2]))
    for parity, waves in enumerate(_waves(n_bands, angle, weights)):
        for odd, functions in enumerate(waves):
            found[odd::2, parity::2] = (along[parity, odd::2] @ functions.T).swapaxes(1, 2)
    return found


def _by_table(rows: Array) -> Array:
    """Sums (m, any, k by parity) -> (m, any, l)."""
    n_bands = len(rows)
    table = np.empty_like(rows)
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
    return table


def _by_passing(rows: Array) -> Array:
    """The same without a table."""
    n_bands = len(rows)
    angle, weights = _quarter(n_bands)
    along = np.empty((2, n_bands, len(angle), rows.shape[1]))  # by the parity of k, which is that of l
    halves = rows[..., : (n_bands + 1) // 2], rows[..., (n_bands + 1) // 2 :]
    for parity, waves in enumerate(_waves(n_bands, angle, weights)):
        for odd, functions in enumerate(waves):
            along[parity, odd::2] = (halves[parity][odd::2] @ functions).swapaxes(1, 2)
    table = np.empty_like(rows)
    for degrees, values in _degrees(n_bands, angle):
        orders = slice(len(values))
        table[orders, :, degrees] = (values @ along[degrees.start % 2, orders]).swapaxes(1, 2)
    return table


def _waves(n_bands: int, angle: Array, weights: Array) -> Iterator[tuple[Array, Array]]:
    """cos(k theta) and sin(k theta) for even k, then for odd k, at angles times their weights, k = 0 half: (k, angles)."""
    for parity in (0, 1):
        k = np.arange(parity, n_bands, 2)[:, None]
        strength = np.where(k == 0, 0.5, 1.0) * weights
        yield np.cos(k * angle) * strength, np.sin(k * angle) * strength


def _degrees(n_bands: int, angle: Array) -> Iterator[tuple[slice, Array]]:
    """Each second degree of a block, and its functions Y(l, m) at angles of phi = 0: (m up to the last l, degrees, angles).

    By the recurrence of basis.py. The memory is used again for the next block.
    """
    away, norms = 2 * np.sin(angle / 2) ** 2, normalisation(n_bands)
    rise = np.sin(angle) ** np.arange(n_bands)[:, None]
    ratio, difference = np.ones((n_bands, len(angle))), np.zeros((n_bands, len(angle)))
    scratch = np.empty_like(ratio)
    kept = np.empty((2, n_bands, PASSED_DEGREES, len(angle)))
    for first in range(0, n_bands, 2 * PASSED_DEGREES):
        last = min(first + 2 * PASSED_DEGREES, n_bands)
        for l in range(first, last):
            lower = slice(l)
            step = np.multiply(away, ratio[lower], out=scratch[lower])
            np.subtract(difference[lower], step, out=step)
            step *= ((2 * l - 1) / (l + np.arange(l)))[:, None]
            np.subtract(step, difference[lower], out=difference[lower])
            ratio[lower] += difference[lower]
            values = kept[l % 2, :, (l - first) // 2]
            np.multiply(ratio[: l + 1], norms[l, : l + 1, None], out=values[: l + 1])
            values[: l + 1] *= rise[: l + 1]
            values[l + 1 : last] = 0
        for parity in (0, 1):
            degrees = slice(first + parity, last, 2)
            if count := len(range(*degrees.indices(n_bands))):
                yield degrees, kept[parity, :last, :count]
