"""The basis in many directions, by matrix products: with monomials for few bands, with waves for more."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from shviewer.harmonics.evaluation.indices import Array
from shviewer.harmonics.evaluation.monomials import MONOMIAL_BANDS, MonomialProducts
from shviewer.harmonics.evaluation.waves import Waves, wave_table
from shviewer.harmonics.workspace import borrowed

FEWEST_BANDS, MOST_BANDS = 2, 32
"""The numbers of bands for which matrix products are the fastest way; with more they round to 1e-14."""

FEWEST_DIRECTIONS = 200
"""The fewest directions for which they are, and which make up for the tables."""

BLOCK, BLOCK_WAVES = 20_000, 120_000
"""The most directions in a block, and the most values of T(k)(z): large, for few calls, but within the caches."""

KEPT_BANDS = 16
"""The most bands whose memory, up to 12 MiB, is kept for the next call."""


def evaluate_by_products(points: Array, n_bands: int) -> Array:
    """As `evaluate_basis` of basis.py: directions (k, 3) -> (n_bands**2, k), for FEWEST_BANDS to MOST_BANDS."""
    count = len(points)
    most = min(BLOCK, BLOCK_WAVES // n_bands)
    size = -(-count // -(-count // most))
    table = np.empty((n_bands**2, count))
    make: Callable[[int, int], MonomialProducts | WaveProducts] = (
        MonomialProducts if n_bands <= MONOMIAL_BANDS else WaveProducts
    )
    with borrowed(make, n_bands, size, keep=n_bands <= KEPT_BANDS) as products:
        for start in range(0, count, size):
            block = slice(min(start, count - size), min(start + size, count))  # all of one size: the last may overlap
            products.fill(points[block], table[:, block])
    return table


class WaveProducts:
    """The memory to evaluate the basis in a block of `length` directions.

    The functions of z are made for all l of one parity at once: for even and for odd m by a product each, whose rows alternate.
    """

    def __init__(self, n_bands: int, length: int) -> None:
        self.n_bands = n_bands
        self.waves = Waves(n_bands, length)
        self.rows = np.empty((sum(len(_series(n_bands, 0)[i]) for i in (0, 1)), length))

    def fill(self, directions: Array, table: Array) -> None:
        """Write Y(l, m) at index l(l+1) + m of `table`, (n_bands**2, length), for directions (length, 3)."""
        self.waves.take(directions)
        chebyshev, (cosines, sines) = self.waves.chebyshev, self.waves.azimuth
        chebyshev[1::2] *= self.waves.south()
        for parity in (0, 1):
            even, odd = _series(self.n_bands, parity)
            rows = self.rows[: len(even) + len(odd)]
            np.matmul(even, chebyshev[parity::2], out=rows[0::2])
            np.matmul(odd, chebyshev[1 - parity :: 2], out=rows[1::2])
            first = 0
            for l in range(parity, self.n_bands, 2):
                middle = l * (l + 1)
                np.multiply(rows[first : first + l + 1], cosines[: l + 1], out=table[middle : middle + l + 1])
                left = table[l * l : middle][::-1]
                np.multiply(rows[first + 1 : first + l + 1], sines[1 : l + 1], out=left)
                first += l + 2 - parity


@lru_cache(maxsize=64)
def _series(n_bands: int, parity: int) -> tuple[Array, Array]:
    """The rows of `wave_table` for even and for odd m, of all l of one parity, m up to l + 1: T(k) of one parity each."""
    table = wave_table(n_bands)
    even: list[Array] = []
    odd: list[Array] = []
    for l in range(parity, n_bands, 2):
        for m in range(l + 2 - parity):
            row = table[m, l] if m <= l else np.zeros(n_bands)
            (odd if m % 2 else even).append(row[(parity + m) % 2 :: 2])
    return np.array(even), np.array(odd)
