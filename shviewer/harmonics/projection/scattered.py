"""Projecting scattered samples: the sum of weight * radiance * Y(l, m) over them, without ever holding the basis.

Every Y(l, m) is one of 2n functions of the azimuth times a combination of n functions of z. So a block of samples needs only
the products of the two: one matrix product, (2n, block) by (block, 3n) for three channels. The dependence on l is a small
table, applied once at the end. There are two pairs of functions:

    few bands   {Re, Im} (x + iy)^m and z^k (scattered_powers.py): the cheapest, but the sums of powers lose a third of a digit
                per band;
    more        {cos, sin}(m phi) and T(k)(z) = cos(k theta) (evaluation/waves.py), which do not cancel.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from shviewer.harmonics.basis import Array, check_bands, evaluate_basis
from shviewer.harmonics.evaluation.waves import Waves, wave_table
from shviewer.harmonics.projection.scattered_powers import POWER_BANDS, PowerSums
from shviewer.harmonics.quadrature import DirectionSet, Radiance
from shviewer.harmonics.theta_series import degrees_and_orders
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
        self.waves = Waves(n_bands, length)
        self.weighted = np.empty((n_bands, 3, length))  # function k of z times each channel
        self.values = np.empty((2, 3, length))  # as they are, and with the sign of z
        self.sums = np.zeros((2 * n_bands, 3 * n_bands))

    def restart(self) -> None:
        self.sums[:] = 0

    def add(self, directions: Array, values: Array, weights: Array | float) -> None:
        """As in _Sums. T(k)(|z|) serves both hemispheres: for odd k the values take the sign of z."""
        np.multiply(values.T, weights, out=self.values[0, :, : len(directions)])
        self.values[0, :, len(directions) :] = 0
        self.waves.take(directions)
        np.multiply(self.values[0], self.waves.south(), out=self.values[1])
        for parity in (0, 1):
            np.multiply(self.waves.chebyshev[parity::2, None], self.values[parity], out=self.weighted[parity::2])
        left = self.waves.azimuth.reshape(2 * self.n_bands, self.slices, -1).transpose(1, 0, 2)
        right = self.weighted.reshape(3 * self.n_bands, self.slices, -1).transpose(1, 2, 0)
        self.sums += np.matmul(left, right).sum(axis=0)

    def coefficients(self) -> Array:
        n = self.n_bands
        sums = self.sums.reshape(2, n, n, 3).transpose(1, 2, 0, 3).reshape(n, n, 6)
        by_order = np.matmul(wave_table(n), sums).reshape(n, n, 2, 3)
        degree, order, sine = degrees_and_orders(n)
        return np.asarray(by_order[order, degree, sine])
