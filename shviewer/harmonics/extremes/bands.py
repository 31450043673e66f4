"""A light as a sum of bands: its difference from a reconstruction is a band-limited function, too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.extremes.both_sides import Extreme, largest_magnitude
from shviewer.harmonics.metrics import band_power
from shviewer.harmonics.quadrature import row_angles
from shviewer.harmonics.synthesis import Synthesis

SPARSE_BANDS = 128
"""A difference of more bands, whose heights fall off, is looked at in two rows a band, others in four."""


@dataclass(frozen=True, eq=False)
class Bands:
    """coefficients: (n**2, 3). room: a bound of what the light holds beyond them, in any channel."""

    coefficients: Array
    room: float = 0.0

    def less(self, shown: Array, most: float) -> tuple[Array, float]:
        """Coefficients of reconstruction minus light, less last bands that stay below `most`, and a bound of what is left out.

        A band l of coefficients c(l, m) stays below sqrt((2l+1)/4pi) times the norm of its coefficients (addition theorem).
        """
        kept = max(count_bands(shown), count_bands(self.coefficients))
        difference = np.zeros((kept**2, 3))
        difference[: len(shown)] = shown
        difference[: len(self.coefficients)] -= self.coefficients
        tails = np.append(np.cumsum(band_heights(difference).max(axis=1)[::-1])[::-1], 0.0)
        kept = max(1, int(np.argmax(tails <= most)))
        return difference[: kept**2], self.room + float(tails[kept])

    def largest_error(self, shown: Array, n_rows: int, least: float, share: float, negligible: float) -> Extreme:
        """The largest error of a reconstruction (n**2, 3).

        n_rows: at least so many rows are looked at. least: about the error there is on some grid; bands that hold less than a
        quarter of its `share` are left out. The bound ends above what is found by about `share` of it, or by `negligible`.
        """
        difference, left_out = self.less(shown, share / 4 * least)
        synthesis, heights = Synthesis(difference), band_heights(difference)
        n_rows = max(n_rows, (4 if len(heights) <= SPARSE_BANDS else 2) * len(heights))
        values = synthesis.on_rows(row_angles(n_rows), 2 * n_rows)
        found = largest_magnitude(
            values, None, heights, lambda d: np.abs(synthesis.in_directions(d)).max(axis=1), share, negligible
        )
        return found._replace(bound=found.bound + left_out)


def band_heights(coefficients: Array) -> Array:
    """A bound of each band's values, (n, channels), of coefficients (n**2, channels)."""
    l = np.arange(count_bands(coefficients))
    return np.asarray(np.sqrt((2 * l + 1) / (4 * np.pi))[:, None] * np.sqrt(band_power(coefficients)))
