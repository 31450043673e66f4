"""Projecting scattered samples: the sum of weight * radiance * Y(l, m) over them, without ever holding the basis.

Every Y(l, m) is one of 2n functions of the azimuth times a combination of n functions of z. So a block of samples needs only
the products of the two: one matrix product, (2n, block) by (block, 3n) for three channels. The dependence on l is a small
table, applied once at the end. There are two pairs of functions:

    few bands   {Re, Im} (x + iy)^m and z^k (scattered_powers.py): the cheapest, but the sums of powers lose a third of a digit
                per band;
    more        {cos, sin}(m phi), for odd m times sin(theta), and T(k)(z) = cos(k theta), into which theta_series.py expands
                the Legendre functions. No value is much larger than 1, so that nothing cancels.

No angle is computed: sin(theta) {cos, sin}(phi) are x and y, and those of 2 phi are (x^2 - y^2) and 2xy over x^2 + y^2.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Protocol

import numpy as np

from shviewer.harmonics.basis import Array, check_bands, evaluate_basis, normalise
from shviewer.harmonics.quadrature import DirectionSet, Radiance
from shviewer.harmonics.scattered_powers import NOT_UNIT, POWER_BANDS, PowerSums
from shviewer.harmonics.theta_series import degrees_and_orders, theta_series
from shviewer.harmonics.workspace import borrowed
from shviewer.progress import tell

Values = Callable[[slice], tuple[Array, Array | float]]
"""A slice of the samples -> their values (k, 3) and weights, (k,) or one for all."""

WAVE_BANDS = 128
"""The most bands with a table, which has n**3 values; with more, the basis is evaluated."""

BLOCK = 10_000
"""The most samples in a block, for which the light is called once; no power of two, for the sake of the cache."""

BASIS_VALUES = 2**21
"""How many values of the basis are held at a time, where it is evaluated."""

SMALL_PRODUCT, SLICED_BANDS = 900_000, 20
"""Multiplications in one product: below a million, OpenBLAS reads operands in place, which pays below 20 bands."""

KEPT_VALUES = 100_000
"""Samples times bands up to which the memory of a projection, up to 7 MiB, is kept for the next: fetching it takes as long."""

AT_A_POLE = 1e-200
"""Where x^2 + y^2 is less than this it has lost its digits, and the azimuth cannot matter."""


def project_samples(radiance: Radiance, samples: DirectionSet, n_bands: int) -> Array:
    """Sum of weight * radiance * Y over the samples, (n_bands**2, 3); the light is called once per block, on an array.

    Over jittered samples this is what the paper calls `SH_project_polar_function`. Within 1e-13 of the plain sum, relative to
    the sum of |weight * radiance|. ValueError for too many bands, and for a direction that is zero or not finite.
    """
    directions, weights = samples.directions, samples.weights
    return _project(directions, lambda rows: (radiance(directions[rows]), weights[rows]), n_bands)


def project_values(directions: Array, weighted: Array, n_bands: int) -> Array:
    """The same for values that are known and already weighted: (k, 3) each -> (n_bands**2, 3)."""
    return _project(directions, lambda rows: (weighted[rows], 1.0), n_bands)


def _project(directions: Array, values: Values, n_bands: int) -> Array:
    check_bands(n_bands)
    count = len(directions)
    block = max(1, -(-count // max(1, -(-count // BLOCK))))  # blocks of one size
    blocks = (slice(start, min(start + block, count)) for start in range(0, count, block))
    make: Callable[[int, int], _Sums] = (
        PowerSums if n_bands <= POWER_BANDS else _WaveSums if n_bands <= WAVE_BANDS else _BasisSums
    )
    with borrowed(make, n_bands, block, keep=block * n_bands <= KEPT_VALUES) as sums:
        sums.restart()
        for rows in blocks:
            tell("projecting", rows.start / count)
            sums.add(directions[rows], *values(rows))
        return sums.coefficients()


class _Sums(Protocol):
    """Sums over samples against all bands, and the memory to add a block of samples."""

    def restart(self) -> None:
        """Forget all samples."""

    def add(self, directions: Array, values: Array, weights: Array | float) -> None:
        """Add samples: directions (k, 3), values (k, 3), weights (k,), not more than a block of them."""

    def coefficients(self) -> Array:
        """Coefficients (n_bands**2, 3) of all samples added."""


class _BasisSums:
    """Sums over samples of value * Y, for more bands than `_WaveSums` has tables for."""

    def __init__(self, n_bands: int, block: int) -> None:
        self.n_bands = n_bands

    def restart(self) -> None:
        self.sums = np.zeros((self.n_bands**2, 3))

    def add(self, directions: Array, values: Array, weights: Array | float) -> None:
        weighted = np.multiply(values.T, weights).T
        step = max(64, BASIS_VALUES // self.n_bands**2)
        for start in range(0, len(directions), step):
            rows = slice(start, start + step)
            self.sums += evaluate_basis(directions[rows], self.n_bands).T @ weighted[rows]

    def coefficients(self) -> Array:
        return self.sums


class _WaveSums:
    """Sums over samples of value * function of the azimuth * function of z, and the memory to add a block of samples."""

    def __init__(self, n_bands: int, block: int) -> None:
        self.n_bands = n_bands
        self.slices = 1 if n_bands >= SLICED_BANDS else 1 + 6 * n_bands**2 * block // SMALL_PRODUCT
        length = -(-block // (8 * self.slices)) * 8 * self.slices
        self.points = np.empty((3, length))
        self.squares = np.empty((3, length))
        self.azimuth = np.empty((2, n_bands, length))  # {cos, sin}, m
        self.azimuth[0, 0], self.azimuth[1, 0] = 1, 0
        self.weighted = np.empty((n_bands, 3, length))  # function k of z times each channel
        self.scratch = np.empty((3, length))
        self.values = np.empty((2, 3, length))  # as they are, and with the sign of z
        self.waves = np.empty((n_bands, length))
        self.sums = np.zeros((2 * n_bands, 3 * n_bands))

    def restart(self) -> None:
        self.sums[:] = 0

    def add(self, directions: Array, values: Array, weights: Array | float) -> None:
        self.points[:, : len(directions)] = directions.T
        np.multiply(values.T, weights, out=self.values[0, :, : len(directions)])
        self.points[:, len(directions) :] = [[0], [0], [1]]
        self.values[0, :, len(directions) :] = 0
        if not self._square():
            self.points[...] = normalise(self.points.T).T
            self._square()
        self._fill_waves()
        left = self.azimuth.reshape(2 * self.n_bands, self.slices, -1).transpose(1, 0, 2)
        right = self.weighted.reshape(3 * self.n_bands, self.slices, -1).transpose(1, 2, 0)
        self.sums += np.matmul(left, right).sum(axis=0)

    def coefficients(self) -> Array:
        n = self.n_bands
        sums = self.sums.reshape(2, n, n, 3).transpose(1, 2, 0, 3).reshape(n, n, 6)
        by_order = np.matmul(_wave_table(n), sums).reshape(n, n, 2, 3)
        degree, order, sine = degrees_and_orders(n)
        return np.asarray(by_order[order, degree, sine])

    def _square(self) -> bool:
        """Fill the squares, and the first row of scratch with x^2 + y^2; whether all directions are unit."""
        with np.errstate(over="ignore"):
            np.multiply(self.points, self.points, out=self.squares)
        np.add(self.squares[0], self.squares[1], out=self.scratch[0])
        norms = np.add(self.scratch[0], self.squares[2], out=self.scratch[1])
        return bool(norms.min() > 1 - NOT_UNIT and norms.max() < 1 + NOT_UNIT)  # NaN is not

    def _fill_waves(self) -> None:
        """Fill with waves. T(k)(|z|) serves both hemispheres: for odd k the values take the sign of z."""
        self._fill_azimuth()
        self._fill_chebyshev()
        sign = np.copysign(1, self.points[2], out=self.scratch[1])
        np.multiply(self.values[0], sign, out=self.values[1])
        for parity in (0, 1):
            np.multiply(self.waves[parity::2, None], self.values[parity], out=self.weighted[parity::2])

    def _fill_azimuth(self) -> None:
        """Fill in e^(im phi), for odd m times sin(theta): e^(i(b+a)) = e^(i(a-b)) + 2i sin(b) e^(ia), for b = 2, 4, 8, ...

        The step is a rotation that has no cancellation where sin(b) is small, as cos(b+a) = 2 cos(b) cos(a) - cos(b-a) has.
        """
        x, y, _ = self.points
        cosines, sines = self.azimuth
        cosines[1], sines[1] = x, y
        squared = self.scratch[0]
        if squared.min() < AT_A_POLE:
            squared = np.where(squared < AT_A_POLE, 1, squared)
        np.divide(np.subtract(self.squares[0], self.squares[1], out=cosines[2]), squared, out=cosines[2])
        np.divide(np.multiply(2 * x, y, out=sines[2]), squared, out=sines[2])
        b = 2
        while b < self.n_bands:
            twice = np.multiply(2, sines[b], out=self.scratch[1])
            count = min(b, self.n_bands - b)
            real = np.multiply(sines[1:count], twice, out=cosines[b + 1 : b + count])
            np.subtract(cosines[b - 1 : b - count : -1], real, out=real)
            imaginary = np.multiply(cosines[1:count], twice, out=sines[b + 1 : b + count])
            imaginary -= sines[b - 1 : b - count : -1]
            if 2 * b < self.n_bands:
                np.multiply(twice, cosines[b], out=sines[2 * b])
                np.subtract(1, np.multiply(twice, sines[b], out=twice), out=cosines[2 * b])
            b *= 2

    def _fill_chebyshev(self) -> None:
        """Fill in T(k) by W(k) = 1 - T(k)(|z|), which keeps its digits next to the poles: for b = 1, 2, 4, ...

        W(b+a) = 2 W(b) + (2 - 2 W(b)) W(a) - W(b-a).
        """
        waves = self.waves
        np.divide(self.scratch[0], np.add(np.abs(self.points[2]), 1, out=waves[1]), out=waves[1])
        waves[0] = 0
        b = 1
        while b < self.n_bands - 1:
            count = min(b, self.n_bands - 1 - b)
            twice = np.multiply(2, waves[b], out=self.scratch[1])
            factor = np.subtract(2, twice, out=self.scratch[2])
            new = np.multiply(waves[1 : count + 1], factor, out=waves[b + 1 : b + count + 1])
            new += twice
            new -= waves[b - 1 :: -1][:count]
            b *= 2
        np.subtract(1, waves, out=waves)


@lru_cache(maxsize=8)
def _wave_table(n_bands: int) -> Array:
    """The coefficient of T(k)(z) in Y(l, m) over {cos, sin}(m phi), and for odd m over sin(theta), too: (m, l, k).

    sin(k theta) / sin(theta) = 2 T(k-1) + 2 T(k-3) + ..., with T(0) once.
    """
    table = theta_series(n_bands).copy()
    odd = table[1::2]
    odd[..., :-1], odd[..., -1] = 2 * odd[..., 1:], 0
    for k in range(n_bands - 3, -1, -1):
        odd[..., k] += odd[..., k + 2]
    odd[..., 0] /= 2
    table.flags.writeable = False
    return table
