"""A light as a sum of bands: its difference from a reconstruction is a band-limited function, too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.extremes.climbing import DISPLAY_ROUNDS, climb
from shviewer.harmonics.extremes.waves import Waves
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, row_angles
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

    def largest_error(
        self, shown: Array, n_rows: int, least: float, share: float, negligible: float
    ) -> tuple[float, Array, float]:
        """The largest error of a reconstruction (n**2, 3) that is found, its direction (3,), and a bound.

        n_rows: at least so many rows are looked at. least: about the error there is on some grid; bands that hold less than a
        quarter of its `share` are left out. The bound ends above what is found by about `share` of it, or by `negligible`.
        """
        difference, left_out = self.less(shown, share / 4 * least)
        synthesis, heights = Synthesis(difference), band_heights(difference)
        n_rows = max(n_rows, (4 if len(heights) <= SPARSE_BANDS else 2) * len(heights))
        theta, phi = row_angles(n_rows), column_azimuths(2 * n_rows)
        values = synthesis.on_rows(theta, len(phi))
        ends = [int(values.argmin()), int(values.argmax())]
        row, _, column = np.unravel_index(max(ends, key=lambda at: abs(values.flat[at])), values.shape)

        def climbed(theta: float, phi: float) -> tuple[float, Array]:
            start = directions_from_angles(np.array([theta]), np.array([phi]))
            found, places = climb(
                lambda d: np.abs(synthesis.in_directions(d)).max(axis=1), start, np.pi / n_rows / 2, DISPLAY_ROUNDS
            )
            return float(found[0]), places[0]

        found, place = climbed(theta[row], phi[column])
        tolerance = max(share * found, negligible)
        sides = [Waves(signed, heights).lowest(-found, tolerance) for signed in (values, -values)]
        deepest = min(sides, key=lambda side: side.lowest)
        if -deepest.lowest > found + tolerance / 2:
            found, place = max((found, place), climbed(deepest.theta, deepest.phi), key=lambda pair: pair[0])
        return found, place, left_out - min(side.bound for side in sides)


def band_heights(coefficients: Array) -> Array:
    """A bound of each band's values, (n, channels), of coefficients (n**2, channels)."""
    l = np.arange(count_bands(coefficients))
    norms = np.sqrt(np.add.reduceat(coefficients**2, l**2, axis=0))
    return np.asarray(np.sqrt((2 * l + 1) / (4 * np.pi))[:, None] * norms)
