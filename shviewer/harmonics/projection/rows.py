"""From radiance on rows to coefficients, c(l, m) = integral of f Y(l, m); scattered.py has the samples that lie anywhere.

A projection from rows of constant theta separates into three steps: sums over the rows with cos(k theta) and sin(k theta),
the only pass over the values (row_transform.py); sums over the columns with cos(m phi) and sin(m phi); and a small product
with the series of the basis (theta_series.py). Texels, too, are integrated exactly: the integrals of cos(k theta) sin(theta)
over a row and of cos(m phi) over a column are closed forms.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, check_bands
from shviewer.harmonics.projection.row_transform import Precision, RowFunctions, row_sums
from shviewer.harmonics.quadrature import ProductRule, Radiance
from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS, azimuth_functions, from_waves

BLOCK_VALUES = 2**21
"""Eight times the number of directions in one call of a light."""

BLOCK_PRODUCTS = 2**12
"""How many values of three channels are multiplied at a time."""


def project_product(radiance: Radiance, rule: ProductRule, n_bands: int) -> tuple[Array, Array]:
    """Sum of weight * radiance * Y over a product rule, separably: (coefficients (n_bands**2, 3), products (3, 3)).

    Products are the integrals of f_i f_j over the channels by the same rule, so that Bessel's inequality holds exactly.
    """
    values = np.empty((len(rule.theta), rule.n_columns, 3))
    block = max(1, BLOCK_VALUES // (8 * rule.n_columns))
    for start in range(0, len(rule.theta), block):
        rows = slice(start, start + block)
        values[rows] = radiance(rule.directions(rows)).reshape(-1, rule.n_columns, 3)
    angle = np.arange(n_bands)[:, None] * rule.theta
    row_weights = rule.row_weights * (2 * np.pi / rule.n_columns)
    functions = RowFunctions(row_weights * np.cos(angle), row_weights * np.sin(angle))
    azimuth = azimuth_functions(n_bands, rule.n_columns)
    return _from_row_sums(*row_sums(values, functions, np.float64), azimuth), channel_products(
        values, row_weights[:, None]
    )


class Rows(Protocol):
    """Values (rows, columns, 3) of which some rows are asked for at a time."""

    @property
    def shape(self) -> tuple[int, ...]: ...

    def __len__(self) -> int: ...

    def __getitem__(self, rows: slice, /) -> NDArray[np.floating]: ...


def channel_products(values: Rows, weights: Array) -> Array:
    """Integrals of f_i f_j over the sphere, (3, 3): values (rows, columns, 3), steradians of each (rows, columns or 1)."""
    products = np.zeros((3, 3))
    block = max(1, BLOCK_PRODUCTS // values.shape[1])
    for start in range(0, len(values), block):
        wide = values[start : start + block].astype(np.float64, copy=False)
        weighted = weights[start : start + block, :, None] * wide
        products += weighted.reshape(-1, 3).T @ wide.reshape(-1, 3)
    return products


def project_image(image: NDArray[np.floating], n_bands: int, precision: Precision = np.float64) -> Array:
    """Coefficients (n_bands**2, 3) of a lat-long image (height, width, 3) whose texels are areas of constant radiance.

    Row v in [0, 1] from the top is theta = pi v, column u is phi = pi (1 - 2u). In float64 exact up to rounding, 1e-14 of the
    largest coefficient, for any size; in float32, about 2e-8 in half the time.
    """
    check_bands(n_bands, MAX_SEPARABLE_BANDS)
    height, width = image.shape[:2]
    return _from_row_sums(
        *row_sums(image, _rows_of_texels(height, n_bands), precision), _columns_of_texels(width, n_bands)
    )


def project_rows(some: NDArray[np.floating], top: int, height: int, n_bands: int) -> Array:
    """`project_image` for an image of `height` rows that is black but for some, (rows, width, 3), from row `top` on."""
    functions = _rows_of_texels(height, n_bands)
    rows = slice(top, top + len(some))
    part = RowFunctions(functions.cosines[:, rows], functions.sines[:, rows])
    sums = row_sums(some, part, np.float64, mirrored=False)
    return _from_row_sums(*sums, _columns_of_texels(some.shape[1], n_bands))


@lru_cache(maxsize=8)
def _rows_of_texels(height: int, n_bands: int) -> RowFunctions:
    """The integrals of cos(kt) sin(t) and sin(kt) sin(t) over each row.

    That of sin(pt) over a row of height h about t0 is h sinc(ph/2) sin(p t0), and alike for cos.
    """
    row_height = np.pi / height
    north = row_height * (np.arange((height + 1) // 2) + 0.5)
    orders = np.arange(-1, n_bands + 1)[:, None]
    strength = row_height * np.sinc(orders / (2 * height))
    sines, cosines = strength * np.sin(orders * north), strength * np.cos(orders * north)
    row_cosines = (sines[2:] - sines[:-2]) / 2  # cos(kt) sin(t) = (sin((k+1)t) - sin((k-1)t)) / 2
    row_sines = (cosines[:-2] - cosines[2:]) / 2
    mirror = (-1.0) ** np.arange(n_bands)[:, None]
    south = slice(height // 2 - 1, None, -1) if height > 1 else slice(0, 0)
    return RowFunctions(
        np.concatenate([row_cosines, mirror * row_cosines[:, south]], axis=1),
        np.concatenate([row_sines, -mirror * row_sines[:, south]], axis=1),
    )


@lru_cache(maxsize=8)
def _columns_of_texels(width: int, n_bands: int) -> Array:
    """The integrals of cos(m phi) and sin(m phi) over each column, (2, n_bands, width)."""
    strength = 2 * np.pi / width * np.sinc(np.arange(n_bands) / width)
    return strength[:, None] * azimuth_functions(n_bands, width)


def _from_row_sums(even: Array, odd: Array, azimuth: Array) -> Array:
    """Coefficients (n_bands**2, 3) from the sums of `row_sums` and the functions over columns, (2, n_bands, n_columns)."""
    columns, _, n_bands = even.shape
    by_order = np.empty((n_bands, 2, 3, n_bands))  # m, {cos, sin}(m phi), channel, k by parity
    for parity, sums in enumerate((even, odd)):
        for part in (0, 1):
            product = _over_columns(azimuth[part, parity::2], sums.reshape(columns, -1), part == parity)
            by_order[parity::2, part] = product.reshape(-1, 3, n_bands)
    return from_waves(by_order)


def _over_columns(azimuth: Array, sums: Array, mirrored: bool) -> Array:
    """Sums over the columns there are: azimuth (orders, n_columns), sums (n_columns or half of them, any).

    Over half a turn, phi and pi - phi fold once more: cos(m phi) for even m and sin(m phi) for odd m are mirrored.
    """
    if azimuth.shape[1] % 4:
        return np.asarray(azimuth[:, : len(sums)] @ sums)
    half = len(sums) // 2
    west, east = sums[:half], sums[: half - 1 : -1]
    return np.asarray(azimuth[:, :half] @ (west + east if mirrored else west - east))
