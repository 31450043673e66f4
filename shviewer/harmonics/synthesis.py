"""From coefficients to radiance: the sum of c(l, m) Y(l, m) on rows, on a whole map, and in scattered directions."""

from __future__ import annotations

from copy import copy

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shviewer.harmonics.basis import Array, count_bands, normalise
from shviewer.harmonics.projection.row_transform import BLOCK_ROWS, by_parity
from shviewer.harmonics.quadrature import angles_from_directions, column_azimuths
from shviewer.harmonics.theta_series import azimuth_functions, degrees_and_orders, to_waves

BLOCK_VALUES = 2**14
"""How many directions times bands are evaluated at a time, so that they stay in the cache."""

STEP = 768
"""The number of values of a row in one product of a map."""

WAVE_BANDS = 24
"""With more bands, rows of twice as many columns are a Fourier transform; with fewer, a product is as fast."""

FEWEST_BANDS = 8
"""The fewest bands of a product; with fewer, it would have less than four rows and be slower."""


def reconstruct(coefficients: ArrayLike, directions: ArrayLike) -> Array:
    """The function with the coefficients (n**2, 3) of basis.py in directions (..., 3) of any length: (..., 3), float64.

    ValueError if n**2 is no square, or for a direction that is zero or not finite.
    """
    unit = normalise(directions)
    synthesis = Synthesis(np.asarray(coefficients, dtype=np.float64))
    return synthesis.in_directions(unit.reshape(-1, 3)).reshape(unit.shape)


class Synthesis:
    """The function with the coefficients (n**2, 3), ready to be evaluated. ValueError if their number is no square."""

    def __init__(self, coefficients: Array) -> None:
        self.coefficients = coefficients
        self.n_bands = n_bands = count_bands(coefficients)
        by_order = to_waves(_to_orders(coefficients).reshape(n_bands, n_bands, 6))
        self._series = [
            np.ascontiguousarray(by_order[parity::2].transpose(1, 2, 0)).reshape(n_bands, -1) for parity in (0, 1)
        ]  # for even and for odd m: k, ({cos, sin}, channel, m)

    def on_rows(self, theta: Array, n_columns: int) -> Array:
        """Evaluate on rows at `theta` (rows,) with the columns of a lat-long image: (rows, 3, n_columns)."""
        return self._along_phi(self._along_theta(theta), n_columns)

    def in_directions(self, directions: Array) -> Array:
        """Evaluate in directions (k, 3) of any length but 0: (k, 3)."""
        return self.at(*angles_from_directions(directions))

    def at(self, theta: Array, phi: Array) -> Array:
        """Evaluate at scattered angles (k,), radians: (k, 3)."""
        values = np.empty((len(theta), 3))
        block = max(64, BLOCK_VALUES // self.n_bands)
        for start in range(0, len(theta), block):
            rows = slice(start, start + block)
            azimuth = np.concatenate(_turns(phi[rows], self.n_bands)).T.copy()
            along_theta = self._along_theta(theta[rows]).reshape(len(azimuth), 3, -1)
            values[rows] = (along_theta @ azimuth[:, :, None])[..., 0]
        return values

    def pole_to_pole(self, n_rows: int, n_columns: int) -> NDArray[np.float32]:
        """A map for the GPU, (n_rows, n_columns, 3) float32, rows from theta = 0 to pi inclusive; off by 2e-7 of its peak.

        Each block of rows is one product with {cos, sin}(k theta); its mirror south of the equator and the other half of its
        columns, where odd k and odd m change sign, cost only sums (row_transform.py has the same folds the other way round).
        """
        return self._map(n_rows, n_columns, 3)

    def _map(self, n_rows: int, n_columns: int, channels: int) -> NDArray[np.float32]:
        """The map (n_rows, n_columns, channels); channels beyond the third are 0."""
        if self.n_bands < FEWEST_BANDS:
            return self._padded()._map(n_rows, n_columns, channels)
        theta = np.linspace(0, np.pi, n_rows)[: (n_rows + 1) // 2]
        angle = theta[:, None] * by_parity(self.n_bands)
        rows = np.cos(angle).astype(np.float32), np.sin(angle).astype(np.float32)
        split, halves = (self.n_bands + 1) // 2, 1 if n_columns % 2 else 2
        columns = self._by_column(n_columns, n_columns // halves, channels)
        image = np.empty((n_rows, halves, columns.shape[2]), np.float32)
        height, step = min(BLOCK_ROWS, len(theta)), min(STEP, columns.shape[2])
        work = np.empty((6, height, step), np.float32)
        for top in range(0, len(theta), height):
            north = slice(top, min(top + height, len(theta)))
            southern = image[n_rows - north.stop : n_rows - north.start][::-1]
            for left in range(0, columns.shape[2], step):
                part = slice(left, left + step)
                block = work[:, : north.stop - north.start, : columns[0, 0, part].size]
                for parity in (0, 1):
                    np.matmul(rows[parity][north, :split], columns[parity, :split, part], out=block[2 * parity])
                    np.matmul(rows[parity][north, split:], columns[parity, split:, part], out=block[2 * parity + 1])
                even, odd = block[4:]
                for target, change in ((image[north], np.add), (southern, np.subtract)):
                    change(block[0], block[1], out=even)  # k even and odd
                    change(block[3], block[2], out=odd)  # sin(k (pi - t)) = -(-1)^k sin(k t)
                    np.add(even, odd, out=target[:, 0, part])
                    if halves == 2:
                        np.subtract(even, odd, out=target[:, 1, part])
        return image.reshape(n_rows, n_columns, channels)

    def spline_map(self, n_rows: int, n_columns: int) -> NDArray[np.float32]:
        """Coefficients of quadratic B-splines whose sum takes the function's values at the nodes of `pole_to_pole`.

        (n_rows, n_columns, 4), the last of each four 0: graphics processors read texels of four fastest.

        A spline is 3/4 at its node and 1/8 at the two beside it, so it multiplies a wave of w radians a node by 3/4 + cos(w)/4.
        The function is a sum of such waves, along theta round both poles, so each wave is divided by its factor: an
        interpolation without a linear system. Between the nodes it is off by about 0.006 w^3 of a wave. ValueError for fewer
        than 2 nodes a wave.
        """
        if n_rows - 1 < self.n_bands or n_columns < 2 * self.n_bands:
            raise ValueError(f"{self.n_bands} bands need more nodes than {n_rows} x {n_columns}")
        if self.n_bands < FEWEST_BANDS:
            return self._padded().spline_map(n_rows, n_columns)
        order = np.arange(self.n_bands)
        along_theta, along_phi = (
            0.75 + np.cos(order * step) / 4 for step in (np.pi / (n_rows - 1), 2 * np.pi / n_columns)
        )
        splines = copy(self)
        splines._series = [
            (series.reshape(self.n_bands, 6, -1) / along_theta[:, None, None] / along_phi[parity::2]).reshape(
                series.shape
            )
            for parity, series in enumerate(self._series)
        ]
        return splines._map(n_rows, n_columns, 4)

    def _padded(self) -> Synthesis:
        """The same function, with bands of zeros up to FEWEST_BANDS."""
        padded = np.zeros((FEWEST_BANDS**2, 3))
        padded[: self.n_bands**2] = self.coefficients
        return Synthesis(padded)

    def _by_column(self, n_columns: int, kept: int, channels: int) -> NDArray[np.float32]:
        """The factors of cos(k theta), for even m, and sin(k theta), for odd m: (2, k by parity, kept columns x channels)."""
        azimuth = azimuth_functions(self.n_bands, n_columns)[..., :kept]
        order = by_parity(self.n_bands)
        values = np.zeros((2, self.n_bands, kept, channels), np.float32)
        for parity, series in enumerate(self._series):
            table = series.reshape(self.n_bands, 2, 3, -1)[order]  # k, {cos, sin}, channel, m
            values[parity, ..., :3] = np.einsum("ksxm,smp->kpx", table, azimuth[:, parity::2], optimize=True)
        return values.reshape(2, self.n_bands, -1)

    def _along_theta(self, theta: Array) -> Array:
        """The factors of cos(m phi) and sin(m phi) at each theta (rows,): (rows, 3, {cos, sin}, n_bands)."""
        along_theta = np.empty((len(theta), 3, 2, self.n_bands))
        for parity, functions in enumerate(_turns(theta, self.n_bands)):
            product = (functions.T @ self._series[parity]).reshape(len(theta), 2, 3, -1)
            along_theta[..., parity::2] = product.transpose(0, 2, 1, 3)
        return along_theta

    def _along_phi(self, along_theta: Array, n_columns: int) -> Array:
        """Values at the columns of a lat-long image, (rows, 3, n_columns), of what `_along_theta` gives."""
        if self.n_bands <= WAVE_BANDS or n_columns < 2 * self.n_bands:
            flat = along_theta.reshape(-1, 2 * self.n_bands)
            azimuth = azimuth_functions(self.n_bands, n_columns).reshape(2 * self.n_bands, n_columns)
            return np.asarray(flat @ azimuth).reshape(len(along_theta), 3, n_columns)
        first = np.arange(self.n_bands) * column_azimuths(n_columns)[0]  # columns go the other way round
        waves = along_theta[:, :, 0] + 1j * along_theta[:, :, 1]
        waves *= np.exp(-1j * first) / np.where(first > 0, 2, 1)
        return np.fft.irfft(waves, n_columns, norm="forward")


def _turns(angles: Array, n_bands: int) -> tuple[Array, Array]:
    """cos(k a) and sin(k a) of angles (j,), for k up to n_bands - 1: (n_bands, j) each.

    By doubling, e^(i (b + a)) = e^(ib) e^(ia): ten times as fast as cosines, and no further off than their k a is.
    """
    waves = np.empty((n_bands, len(angles)), dtype=np.complex128)
    waves[0] = 1
    if n_bands > 1:
        waves[1] = np.cos(angles) + 1j * np.sin(angles)
    b = 1
    while b < n_bands - 1:
        count = min(b, n_bands - 1 - b)
        np.multiply(waves[1 : count + 1], waves[b], out=waves[b + 1 : b + count + 1])
        b *= 2
    return waves.real.copy(), waves.imag.copy()


def _to_orders(coefficients: Array) -> Array:
    """Coefficients, at index l(l+1) +- m, arranged as (m, l, {cos, sin}, 3)."""
    n_bands = count_bands(coefficients)
    degree, order, sine = degrees_and_orders(n_bands)
    table = np.zeros((n_bands, n_bands, 2, 3))
    table[order, degree, sine] = coefficients
    return table
