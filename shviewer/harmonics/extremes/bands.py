"""A light as a sum of bands: its difference from a reconstruction is a band-limited function, too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array, count_bands


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


def band_heights(coefficients: Array) -> Array:
    """A bound of each band's values, (n, channels), of coefficients (n**2, channels)."""
    l = np.arange(count_bands(coefficients))
    norms = np.sqrt(np.add.reduceat(coefficients**2, l**2, axis=0))
    return np.asarray(np.sqrt((2 * l + 1) / (4 * np.pi))[:, None] * norms)
