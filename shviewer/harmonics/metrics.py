"""How far a reconstruction is from its light. Every figure is exact or measured in float64, weighted by solid angle.

Shown coefficients s(l, m) need not be the exact ones c(l, m): bands may be muted, or a sampled method estimates them. Since
the basis is orthonormal, the squared L2 error splits without any quadrature (Parseval):
    ||f - sum of s Y||^2 = (||f||^2 - sum of c^2) + sum of (c - s)^2
The first bracket is what the bands left out hold; the last sum is what muting and sampling add.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array, count_bands, degrees, evaluate_basis
from shviewer.harmonics.projection import Synthesis
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Rec. 709 luminance of linear RGB [ITU-R BT.709-6, item 3.2]."""

Triple = tuple[float, float, float]
Objective = Callable[[Array, Array], Array]
"""Directions (k, 3) and the reconstruction there (k, 3) -> (k,)."""

PATCH = np.stack(np.meshgrid(np.arange(-2.0, 3.0), np.arange(-2.0, 3.0), indexing="ij"), axis=-1).reshape(-1, 2)
ROUNDS = 4
"""Halvings of a patch: from the grid's cell to a sixteenth of it."""

ROUNDING = 1e-11
"""How far, relative to ||f||^2, a sum of squared coefficients may exceed it: rounding of up to 128**2 terms."""


def band_power(coefficients: Array) -> Array:
    """Sum over m of c(l, m)^2, which no rotation changes: (n**2, 3) -> (n, 3)."""
    n_bands = count_bands(coefficients)
    first = np.arange(n_bands) ** 2
    return np.asarray(np.add.reduceat(coefficients**2, first, axis=0))


def squared_error(norm_squared: Array, exact: Array, shown: Array) -> tuple[float, float]:
    """(left-out, added) squared L2 error over all channels: the two terms of the module docstring.

    norm_squared: (3,); exact, shown: (n**2, 3). ValueError if `exact` holds more energy than the light: then the two
    come from different quadratures and no error can be read off them.
    """
    missing = norm_squared - (exact**2).sum(axis=0)
    if (missing < -ROUNDING * norm_squared).any():
        raise ValueError(f"coefficients hold {-missing.min():.3g} more energy than the light: mixed quadratures")
    return float(missing.clip(min=0).sum()), float(((exact - shown) ** 2).sum())


def relative(squared: float, norm_squared: Array) -> float:
    """sqrt(squared / ||f||^2) over all channels; for a black light 0 if nothing is shown, else infinity."""
    total = float(norm_squared.sum())
    if total == 0:
        return 0.0 if squared == 0 else float("inf")
    return float(np.sqrt(squared / total))


@dataclass(frozen=True)
class Extremes:
    """Where a reconstruction is worst, over all channels: the extremes of a grid, followed uphill to the function's own."""

    max_error: float
    max_error_direction: Triple
    minimum: float
    minimum_direction: Triple
    negative_area: float
    """Share of the sphere with negative Rec. 709 luminance, 0 to 1."""
    peak: float
    """The largest |radiance| of the original seen on the same grid."""


class ErrorGrid:
    """A light seen on a lat-long grid and at its landmarks, ready to be compared with any reconstruction.

    radiance: directions (k, 3) -> (k, 3); landmarks: (j, 3), directions where a grid would miss something.
    """

    def __init__(self, radiance: Callable[[Array], Array], landmarks: Array, n_rows: int) -> None:
        self.radiance = radiance
        self.theta = np.pi * (np.arange(n_rows) + 0.5) / n_rows
        self.phi = column_azimuths(2 * n_rows)
        directions = directions_from_angles(self.theta[:, None], self.phi)
        grid = radiance(directions.reshape(-1, 3)).reshape(n_rows, 2 * n_rows, 3)
        self.original = np.ascontiguousarray(grid.transpose(0, 2, 1))
        self.landmarks = landmarks
        self.landmark_radiance = radiance(landmarks) if len(landmarks) else np.zeros((0, 3))
        self.peak = float(max(np.abs(self.original).max(), np.abs(self.landmark_radiance).max(initial=0)))
        edges = np.cos(np.pi * np.arange(n_rows + 1) / n_rows)
        self.row_share = (edges[:-1] - edges[1:]) / (2 * 2 * n_rows)
        """Solid angle of one cell of a row over 4 pi; exact."""

    def compare(self, shown: Array) -> Extremes:
        """The extremes of the reconstruction with coefficients `shown`, (n**2, 3)."""
        synthesis = Synthesis(shown)
        values = synthesis.on_rows(self.theta, len(self.phi))
        error, error_direction = self._largest_error(values, synthesis, shown)
        minimum, direction = self._smallest(values, synthesis)
        luminance = sum(weight * values[:, channel] for channel, weight in enumerate(LUMINANCE))
        negative = float(np.count_nonzero(luminance < 0, axis=1) @ self.row_share)
        return Extremes(error, error_direction, minimum, direction, negative, self.peak)

    def _largest_error(self, values: Array, synthesis: Synthesis, shown: Array) -> tuple[float, Triple]:
        def error(directions: Array, reconstruction: Array) -> Array:
            return np.asarray(np.abs(reconstruction - self.radiance(directions)).max(axis=1))

        difference = values - self.original
        row, _, column = np.unravel_index(int(np.abs(difference, out=difference).argmax()), difference.shape)
        best = self._climb(error, int(row), int(column), synthesis)
        if len(self.landmarks):
            there = error(self.landmarks, evaluate_basis(self.landmarks, synthesis.n_bands) @ shown)
            best = max(best, (float(there.max()), _triple(self.landmarks[int(there.argmax())])))
        return best

    def _smallest(self, values: Array, synthesis: Synthesis) -> tuple[float, Triple]:
        row, channel, column = np.unravel_index(int(values.argmin()), values.shape)
        highest, direction = self._climb(
            lambda _, reconstruction: -reconstruction[:, channel], int(row), int(column), synthesis
        )
        return -highest, direction

    def _climb(self, objective: Objective, row: float, column: float, synthesis: Synthesis) -> tuple[float, Triple]:
        """The largest value of `objective` in ever smaller 5 x 5 patches, the first one as wide as the cells around."""
        best, place = -np.inf, np.zeros(3)
        for step in 0.5 ** np.arange(1, ROUNDS + 1):
            rows, columns = row + step * PATCH[:, 0], column + step * PATCH[:, 1]
            theta = np.pi * (rows + 0.5) / len(self.theta)
            phi = np.pi * (1 - (2 * columns + 1) / len(self.phi))
            directions = directions_from_angles(theta, phi)
            values = objective(directions, synthesis.at(theta, phi))
            at = int(values.argmax())
            if values[at] > best:
                best, place, row, column = float(values[at]), directions[at], float(rows[at]), float(columns[at])
        return best, _triple(place)


def band_weights(n_bands: int, muted: frozenset[int]) -> Array:
    """1 for every coefficient of a band that is on, 0 for a muted one, (n_bands**2, 1)."""
    return np.isin(degrees(n_bands), list(muted), invert=True).astype(np.float64)[:, None]


def _triple(direction: Array) -> Triple:
    x, y, z = (float(component) for component in direction)
    return x, y, z
