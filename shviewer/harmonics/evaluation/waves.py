"""The functions of azimuth and z that Y(l, m) is made of, in many directions.

{cos, sin}(m phi), for odd m times sin(theta), and T(k)(z) = cos(k theta), into which theta_series.py expands the Legendre
functions. No value is much larger than 1, so that nothing cancels, and no angle is computed: sin(theta) {cos, sin}(phi) are x
and y, and those of 2 phi are (x^2 - y^2) and 2xy over x^2 + y^2.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from shviewer.harmonics.evaluation.indices import Array, normalise
from shviewer.harmonics.theta_series import theta_series

NOT_UNIT = 1e-14
"""Directions are normalised if x^2 + y^2 + z^2 is further from 1 than this."""

AT_A_POLE = 1e-200
"""Where x^2 + y^2 is less than this it has lost its digits, and the azimuth cannot matter."""


class Waves:
    """The functions in a block of `length` directions, and the memory for them. n_bands: at least 3."""

    def __init__(self, n_bands: int, length: int) -> None:
        self.n_bands = n_bands
        self.points = np.empty((3, length))
        self.squares = np.empty((3, length))
        self.scratch = np.empty((3, length))
        self.azimuth = np.empty((2, n_bands, length))
        """{cos, sin}, m."""
        self.azimuth[0, 0], self.azimuth[1, 0] = 1, 0
        self.chebyshev = np.empty((n_bands, length))
        """T(k)(|z|)."""

    def take(self, directions: Array) -> None:
        """Fill in the functions of directions (k, 3), k <= length; the rest of the block stands for the north pole.

        ValueError for one that is zero or not finite.
        """
        self.points[:, : len(directions)] = directions.T
        self.points[:, len(directions) :] = [[0], [0], [1]]
        if not self._square():
            self.points[...] = normalise(self.points.T).T
            self._square()
        self._fill_azimuth()
        self._fill_chebyshev()

    def south(self) -> Array:
        """1 or -1, the sign of z, (length,), until the next call."""
        return np.asarray(np.copysign(1, self.points[2], out=self.scratch[1]))

    def _square(self) -> bool:
        """Fill the squares, and the first row of scratch with x^2 + y^2; whether all directions are unit."""
        with np.errstate(over="ignore"):
            np.multiply(self.points, self.points, out=self.squares)
        np.add(self.squares[0], self.squares[1], out=self.scratch[0])
        norms = np.add(self.scratch[0], self.squares[2], out=self.scratch[1])
        return bool(norms.min() > 1 - NOT_UNIT and norms.max() < 1 + NOT_UNIT)  # NaN is not

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
        waves = self.chebyshev
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
def wave_table(n_bands: int) -> Array:
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
