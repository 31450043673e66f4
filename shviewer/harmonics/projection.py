"""From radiance to coefficients, c(l, m) = integral of f Y(l, m), and back.

Scattered samples take one pass of the basis. Anything on rows of constant theta is separable, and along theta, too, the
basis is a short Fourier series: Y(l, m)(theta, phi) = {cos, sin}(|m| phi) times
    sum over k <= l of D(m, l, k) cos(k theta)     for even m, or sin(k theta) for odd m,
because the function continues as a trigonometric polynomial over the poles along the whole great circle. So one matrix product
of row functions {cos, sin}(k theta) with the image is the only pass over it; the rest is small. It also
makes texels exact: the integral of cos(k theta) sin(theta) over a row, and of cos(m phi) over a column, are closed forms.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, check_bands, count_bands, evaluate_basis
from shviewer.harmonics.quadrature import DirectionSet, ProductRule, column_azimuths

Radiance = Callable[[Array], Array]
"""Directions (k, 3) -> linear RGB (k, 3)."""

MAX_SEPARABLE_BANDS = 512
"""The table D takes n**3 values: 1 GiB at 512 bands."""

BLOCK_VALUES = 2**21
"""Basis values, or texel values, held in float64 at a time."""


def project_samples(radiance: Radiance, samples: DirectionSet, n_bands: int) -> Array:
    """Sum of weight * radiance * Y over the samples, (n_bands**2, 3); blocks keep the memory small."""
    check_bands(n_bands)
    coefficients = np.zeros((n_bands**2, 3))
    block = max(64, BLOCK_VALUES // n_bands**2)
    for start in range(0, len(samples.weights), block):
        directions = samples.directions[start : start + block]
        weighted = radiance(directions) * samples.weights[start : start + block, None]
        coefficients += evaluate_basis(directions, n_bands).T @ weighted
    return coefficients


def project_product(radiance: Radiance, rule: ProductRule, n_bands: int) -> tuple[Array, Array]:
    """The same sum over a product rule, separably: (coefficients (n_bands**2, 3), products (3, 3)).

    Products are the integrals of f_i f_j over the channels by the same rule, so that Bessel's inequality holds exactly.
    """
    values = np.empty((len(rule.theta), rule.n_columns, 3))
    block = max(1, BLOCK_VALUES // (8 * rule.n_columns))
    for start in range(0, len(rule.theta), block):
        rows = slice(start, start + block)
        values[rows] = radiance(rule.direction_set(rows).directions).reshape(-1, rule.n_columns, 3)
    angle = np.arange(n_bands)[:, None] * rule.theta
    row_weights = rule.row_weights * (2 * np.pi / rule.n_columns)
    coefficients = _project_rows(values, row_weights * np.cos(angle), row_weights * np.sin(angle), np.ones(n_bands))
    return coefficients, channel_products(values, row_weights)


def channel_products(values: NDArray[np.floating], row_weights: Array) -> Array:
    """Integrals of f_i f_j over the sphere, (3, 3): values (rows, columns, 3), steradians of one value per row (rows,)."""
    products = np.zeros((3, 3))
    for row, weight in zip(values, row_weights, strict=True):
        wide = row.astype(np.float64, copy=False)
        products += weight * (wide.T @ wide)
    return products


def project_image(image: NDArray[np.floating], n_bands: int) -> Array:
    """Coefficients (n_bands**2, 3) of a lat-long image (height, width, 3) whose texels are areas of constant radiance.

    Row v in [0, 1] from the top is theta = pi v, column u is phi = pi (1 - 2u). Exact up to rounding for any size.
    The integral of sin(p t) over a row of height h about t0 is h sinc(p h / 2) sin(p t0), and alike for cos and columns.
    """
    height, width = image.shape[:2]
    row_height = np.pi / height
    centres = row_height * (np.arange(height) + 0.5)
    orders = np.arange(-1, n_bands + 1)[:, None]
    strength = row_height * np.sinc(orders / (2 * height))
    sines, cosines = strength * np.sin(orders * centres), strength * np.cos(orders * centres)
    row_cosines = (sines[2:] - sines[:-2]) / 2  # cos(kt) sin(t) = (sin((k+1)t) - sin((k-1)t)) / 2
    row_sines = (cosines[:-2] - cosines[2:]) / 2
    column_strength = 2 * np.pi / width * np.sinc(np.arange(n_bands) / width)
    return _project_rows(image, row_cosines, row_sines, column_strength)


def _project_rows(values: NDArray[np.floating], row_cosines: Array, row_sines: Array, column_strength: Array) -> Array:
    """values (rows, columns, 3); row functions (n_bands, rows); a factor per order m (n_bands,) -> (n_bands**2, 3)."""
    n_bands = len(row_cosines)
    rows, columns = values.shape[:2]
    flat = values.reshape(rows, columns * 3)
    row_functions = np.concatenate([row_cosines, row_sines])
    sums = np.zeros((2 * n_bands, columns * 3))
    block = max(1, BLOCK_VALUES // flat.shape[1])
    for start in range(0, rows, block):
        sums += row_functions[:, start : start + block] @ flat[start : start + block].astype(np.float64, copy=False)
    by_order = np.empty((n_bands, n_bands, 2, 3))  # m, k, {cos, sin}(m phi), channel
    azimuth = _azimuth_functions(n_bands, columns)
    by_column = sums.reshape(2, n_bands, columns, 3).transpose(0, 2, 1, 3).reshape(2, columns, n_bands * 3)
    for parity in (0, 1):
        product = azimuth[:, parity::2].reshape(-1, columns) @ by_column[parity]
        by_order[parity::2] = product.reshape(2, -1, n_bands, 3).transpose(1, 2, 0, 3)
    by_order *= column_strength[:, None, None, None]
    by_degree = theta_series(n_bands) @ by_order.reshape(n_bands, n_bands, 6)  # m, l, ...
    return _from_orders(by_degree.reshape(n_bands, n_bands, 2, 3))


class Synthesis:
    """The function with the coefficients (n**2, 3), ready to be evaluated. ValueError if their number is no square."""

    def __init__(self, coefficients: Array) -> None:
        self.n_bands = n_bands = count_bands(coefficients)
        by_order = theta_series(n_bands).transpose(0, 2, 1) @ _to_orders(coefficients).reshape(n_bands, n_bands, 6)
        self._series = [
            np.ascontiguousarray(by_order[parity::2].transpose(1, 2, 0)).reshape(n_bands, -1) for parity in (0, 1)
        ]  # for even and for odd m: k, ({cos, sin}, channel, m)

    def on_rows(self, theta: Array, n_columns: int) -> Array:
        """On rows at `theta` (rows,) with the columns of a lat-long image: (rows, 3, n_columns)."""
        flat = self._along_theta(theta).reshape(-1, 2 * self.n_bands)
        azimuth = _azimuth_functions(self.n_bands, n_columns).reshape(2 * self.n_bands, n_columns)
        return np.asarray(flat @ azimuth).reshape(len(theta), 3, n_columns)

    def at(self, theta: Array, phi: Array) -> Array:
        """At scattered angles (k,), radians: (k, 3)."""
        angle = phi[:, None] * np.arange(self.n_bands)
        azimuth = np.concatenate([np.cos(angle), np.sin(angle)], axis=1)
        return np.asarray(np.einsum("kxm,km->kx", self._along_theta(theta).reshape(len(theta), 3, -1), azimuth))

    def _along_theta(self, theta: Array) -> Array:
        """What stands before cos(m phi) and sin(m phi) at each theta (rows,): (rows, 3, {cos, sin}, n_bands)."""
        angle = theta[:, None] * np.arange(self.n_bands)
        along_theta = np.empty((len(theta), 3, 2, self.n_bands))
        for parity, functions in enumerate((np.cos(angle), np.sin(angle))):
            product = (functions @ self._series[parity]).reshape(len(theta), 2, 3, -1)
            along_theta[..., parity::2] = product.transpose(0, 2, 1, 3)
        return along_theta


@lru_cache(maxsize=8)
def theta_series(n_bands: int) -> Array:
    """D(m, l, k) of the module docstring, shape (n, n, n), zero for l < m: the Fourier series of the great circle phi = 0, pi.

    Both the function and its row functions are even or odd about theta = 0 and about pi/2, so a quarter of the circle is
    enough, its ends counted half; terms with k + l odd vanish.
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
def _azimuth_functions(n_bands: int, n_columns: int) -> Array:
    """cos(m phi) and sin(m phi) at the column centres, shape (2, n_bands, n_columns)."""
    angle = np.arange(n_bands)[:, None] * column_azimuths(n_columns)
    return np.stack([np.cos(angle), np.sin(angle)])


def _from_orders(table: Array) -> Array:
    """(m, l, {cos, sin}, 3) -> coefficients at l(l+1) +- m."""
    n_bands = len(table)
    degree, order = np.tril_indices(n_bands)
    centre = degree * (degree + 1)
    coefficients = np.empty((n_bands**2, 3))
    coefficients[centre - order] = table[order, degree, 1]
    coefficients[centre + order] = table[order, degree, 0]
    return coefficients


def _to_orders(coefficients: Array) -> Array:
    """Coefficients at l(l+1) +- m -> (m, l, {cos, sin}, 3)."""
    n_bands = count_bands(coefficients)
    degree, order = np.tril_indices(n_bands)
    centre = degree * (degree + 1)
    table = np.zeros((n_bands, n_bands, 2, 3))
    table[order, degree, 1] = coefficients[centre - order]
    table[order, degree, 0] = coefficients[centre + order]
    table[0, :, 1] = 0
    return table
