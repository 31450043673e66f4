"""A light on a grid, and the extremes of any reconstruction of it, with bounds that no direction passes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.band_limited import BandLimited
from shviewer.harmonics.extremes.bands import Bands, band_heights
from shviewer.harmonics.extremes.both_sides import Extreme, largest_magnitude
from shviewer.harmonics.extremes.climbing import DISPLAY_ROUNDS, Objective, climb
from shviewer.harmonics.extremes.raster import Raster
from shviewer.harmonics.extremes.raster_error import Search
from shviewer.harmonics.extremes.zonal_sum import Lobes
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quadrature import (
    column_azimuths,
    directions_from_angles,
    evaluate_rows,
    row_angles,
    share_below_zero,
)
from shviewer.harmonics.synthesis import Synthesis

TOLERANCE = 8e-4
"""A bound ends about this far from what was found, relative to it: what was found is within a thousandth of the extreme."""

RING_POINTS = 32
"""Points a band along the edge of a lobe, where the tables do not say where the largest error is."""

CLOSE_ROWS, MOST_OPEN = 5, 2000
"""A grid of so many rows a band bounds the minimum of lobes sooner than their tables, or one with fewer points open."""

BLOCKS = 6
"""The blocks of the grid from whose highest cells the largest error is climbed to."""

NEGLIGIBLE = 1e-7
"""The share of the largest radiance that is no longer told apart."""

Triple = tuple[float, float, float]

Form: TypeAlias = Lobes | Raster | Bands
"""The parts of a light between which its error can be bounded."""


@dataclass(frozen=True)
class Extremes:
    """Radiance is linear; errors and minima are over all channels; areas and energies are shares, 0 to 1."""

    max_error: float
    max_error_bound: float | None
    """No direction has a larger error; None for a Python function, whose largest error is found but not proved."""
    max_error_direction: Triple
    minimum: float
    minimum_bound: float
    """No direction of the reconstruction is lower."""
    minimum_direction: Triple
    negative_area: float
    """The share of the sphere with negative Rec. 709 luminance."""
    negative_energy: float
    """The integral of min(reconstruction, 0)^2 divided by that of reconstruction^2, over all channels."""
    peak: float
    """The largest |radiance| of the original seen on the same grid."""


class Lows(NamedTuple):
    """Those of the extremes that are of the reconstruction alone, named as in `Extremes`."""

    minimum: float
    minimum_bound: float
    minimum_direction: Triple
    negative_area: float
    negative_energy: float


class _Seen(NamedTuple):
    """A reconstruction on the grid, (rows, 3, columns), and everything that is made of it once."""

    shown: Array
    synthesis: Synthesis
    values: Array
    waves: BandLimited
    of_lobes: tuple[Array, float]
    """`Lobes.factors` of a light of lobes; nothing for others."""


class ErrorGrid:
    """A light seen on a lat-long grid and at its landmarks, ready to be compared with any reconstruction.

    radiance: directions (k, 3) -> (k, 3); landmarks: (j, 3), directions of features that a grid may miss. rows: a faster way to
    the radiance on whole rows, if there is one: theta (rows,) and the number of columns -> (rows, 3, columns). form: the parts
    of the light, if they are known, or a function that makes them, which is called once for the error; not for Lobes.
    """

    def __init__(
        self,
        radiance: Callable[[Array], Array],
        landmarks: Array,
        n_rows: int,
        rows: Callable[[Array, int], Array] | None = None,
        form: Form | Callable[[], Form | None] | None = None,
    ) -> None:
        self.radiance = radiance
        self.theta, self.phi = row_angles(n_rows), column_azimuths(2 * n_rows)
        self.original = (rows or partial(evaluate_rows, radiance))(self.theta, len(self.phi))
        self.landmarks = landmarks
        self.landmark_radiance = radiance(landmarks) if len(landmarks) else np.zeros((0, 3))
        self.peak = float(max(np.abs(self.original).max(), np.abs(self.landmark_radiance).max(initial=0)))
        edges = np.cos(np.pi * np.arange(n_rows + 1) / n_rows)
        self.row_share = (edges[:-1] - edges[1:]) / (2 * 2 * n_rows)
        """The solid angle of one cell of each row divided by 4 pi, (rows,); exact."""
        self._form = form

    @cached_property
    def form(self) -> Form | None:
        return self._form() if callable(self._form) else self._form

    @property
    def _lobes(self) -> Lobes | None:
        return self._form if isinstance(self._form, Lobes) else None

    def compare(self, shown: Array) -> Extremes:
        """The extremes of the reconstruction with coefficients `shown`, (n**2, 3), and of its error."""
        seen = self._see(shown)
        if isinstance(self.form, Lobes):
            error = self._error_of_lobes(seen, self.form, *seen.of_lobes)
        elif isinstance(self.form, Raster):
            error = self._error_of_raster(seen, self.form)
        else:
            error = self._climbed(seen) if self.form is None else self._error_of_bands(seen, self.form)
        lows = self._lows(seen)
        return Extremes(
            max_error=error.value,
            max_error_bound=None if self.form is None else max(error.value, error.bound),
            max_error_direction=triple(error.direction),
            peak=self.peak,
            **lows._asdict(),
        )

    def lows(self, shown: Array) -> Lows:
        """The same of the reconstruction (n_bands**2, 3) alone, which takes no look at the light."""
        return self._lows(self._see(shown))

    def _see(self, shown: Array) -> _Seen:
        synthesis = Synthesis(shown)
        values = synthesis.on_rows(self.theta, len(self.phi))
        of_lobes = self._lobes.factors(shown) if self._lobes else (np.zeros((0, 0)), 0.0)
        return _Seen(shown, synthesis, values, BandLimited(values, band_heights(shown)), of_lobes)

    def _lows(self, seen: _Seen) -> Lows:
        lobes = self._lobes
        lowest = self._lowest_of_lobes(seen, lobes, *seen.of_lobes) if lobes else self._lowest(seen)
        luminance = sum(weight * seen.values[:, channel] for channel, weight in enumerate(LUMINANCE))
        return Lows(
            minimum=lowest.value,
            minimum_bound=min(lowest.value, lowest.bound),
            minimum_direction=triple(lowest.direction),
            negative_area=share_below_zero(luminance, self.theta),
            negative_energy=self._negative_energy(seen.values, seen.shown),
        )

    @property
    def _step(self) -> float:
        return float(np.pi / len(self.theta))

    def _negligible(self, seen: _Seen) -> float:
        """What is no longer told apart in a reconstruction."""
        return NEGLIGIBLE * float(max(seen.waves.high.max(), -seen.waves.low.min()))

    def _best(self, objective: Objective, starts: Array) -> Extreme:
        """The best of directions (k, 3), climbed from."""
        values, places = climb(objective, starts[[int(objective(starts).argmax())]], self._step / 2, DISPLAY_ROUNDS)
        return Extreme(float(values[0]), places[0])

    def _lowest(self, seen: _Seen) -> Extreme:
        def depth(directions: Array) -> Array:
            return np.asarray(-seen.synthesis.in_directions(directions).min(axis=1))

        row, _, column = (int(i) for i in np.unravel_index(int(seen.values.argmin()), seen.values.shape))
        start = directions_from_angles(self.theta[[row]], self.phi[[column]])
        values, places = climb(depth, start, self._step, DISPLAY_ROUNDS)
        found = Extreme(-float(values[0]), places[0], -np.inf)
        tolerance = max(TOLERANCE * abs(found.value), self._negligible(seen))
        bounded = seen.waves.lowest(found.value, tolerance)
        if bounded.lowest < found.value - tolerance / 2:
            deeper = self._best(depth, directions_from_angles(np.array([bounded.theta]), np.array([bounded.phi])))
            found = min(found, Extreme(-deeper.value, deeper.direction, -np.inf), key=lambda place: place.value)
        return found._replace(bound=bounded.bound)

    def _lowest_of_lobes(self, seen: _Seen, lobes: Lobes, zonal: Array, rest: float) -> Extreme:
        negligible, low = self._negligible(seen), float(seen.waves.low.min())
        close = len(self.theta) >= CLOSE_ROWS * len(seen.waves.heights) or (
            seen.waves.open_points(low, TOLERANCE * abs(low)) < MOST_OPEN
        )
        if rest > negligible or (close and not lobes.on_one_axis):  # coefficients of samples are not the light's own
            found = self._lowest(seen)
            if rest > negligible or found.bound >= found.value - 2 * max(TOLERANCE * abs(found.value), negligible):
                return found
        places, bound = lobes.shade(zonal).largest(TOLERANCE, negligible, magnitude=False)
        found = self._best(lambda d: -seen.synthesis.in_directions(d).min(axis=1), places)
        return Extreme(-found.value, found.direction, -bound - rest)

    def _error_of_lobes(self, seen: _Seen, lobes: Lobes, zonal: Array, rest: float) -> Extreme:
        negligible = NEGLIGIBLE * self.peak
        places, bound = lobes.error(zonal).largest(TOLERANCE, negligible, magnitude=True)
        errors = self._error(seen, places)
        best = int(errors.argmax())
        found = Extreme(float(errors[best]), places[best], bound + rest)
        if rest <= negligible and bound <= found.value * (1 + 2 * TOLERANCE) + negligible:
            return found
        around = lobes.rings(RING_POINTS * seen.synthesis.n_bands)
        starts = np.concatenate([places, around])
        starts = starts[np.argsort(-self._error(seen, starts))[:BLOCKS]]
        return found.or_larger(self._climbed(seen, starts))._replace(bound=found.bound)

    def _error_of_raster(self, seen: _Seen, raster: Raster) -> Extreme:
        negligible, rows = NEGLIGIBLE * self.peak, raster.aligned_rows(len(self.theta))
        if rows is not None:
            values = seen.values if rows == len(self.theta) else seen.synthesis.on_rows(row_angles(rows), 2 * rows)
            heights, magnitude = seen.waves.heights, partial(self._error, seen)
            return largest_magnitude(values, raster.on_grid(rows), heights, magnitude, TOLERANCE, negligible)
        error = Search(raster, seen.waves, self.original, seen.synthesis, TOLERANCE, negligible).run()
        direction = directions_from_angles(np.array([error.theta]), np.array([error.phi]))
        found = Extreme(float(self._error(seen, direction)[0]), direction[0], error.bound)
        if error.bound <= found.value * (1 + 2 * TOLERANCE):
            return found
        return found.or_larger(self._climbed(seen))._replace(bound=error.bound)

    def _error_of_bands(self, seen: _Seen, bands: Bands) -> Extreme:
        least = float(np.abs(seen.values - self.original).max())
        return bands.largest_error(seen.shown, len(self.theta), least, TOLERANCE, NEGLIGIBLE * self.peak)

    def _error(self, seen: _Seen, directions: Array) -> Array:
        return np.asarray(np.abs(seen.synthesis.in_directions(directions) - self.radiance(directions)).max(axis=1))

    def _climbed(self, seen: _Seen, others: Array | None = None) -> Extreme:
        """The largest error that is found from the grid, the landmarks and other directions (k, 3), without a bound."""
        difference = seen.values - self.original
        rows, columns = _highest_in_blocks(np.abs(difference, out=difference).max(axis=1))
        starts = directions_from_angles(self.theta[rows], self.phi[columns])
        if others is not None:
            starts = np.concatenate([starts, others])
        errors, places = climb(partial(self._error, seen), starts, self._step, DISPLAY_ROUNDS)
        best = Extreme(float(errors.max()), places[int(errors.argmax())])
        if len(self.landmarks):
            there = np.abs(seen.synthesis.in_directions(self.landmarks) - self.landmark_radiance).max(axis=1)
            highest = int(there.argmax())
            best = best.or_larger(Extreme(float(there[highest]), self.landmarks[highest]))
        return best

    def _negative_energy(self, values: Array, shown: Array) -> float:
        """The share of energy below zero: that part measured on the grid, the whole as the sum of squares (Parseval)."""
        whole = float((shown**2).sum())
        if values.min() >= 0 or whole == 0:  # squares of less than 1e-160 may be 0
            return 0.0
        negative = np.minimum(values, 0).reshape(len(self.theta), -1)
        squares = np.einsum("rx,rx->r", negative, negative) @ self.row_share
        return min(1.0, 4 * np.pi * float(squares) / whole)


def _highest_in_blocks(values: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows and columns of the highest cells of the BLOCKS best 8 x 8 blocks of a grid: several peaks, not one's slope."""
    short = [-side % 8 for side in values.shape]
    values = np.pad(values, ((0, short[0]), (0, short[1])), constant_values=-np.inf)
    rows, columns = values.shape
    blocks = values.reshape(rows // 8, 8, columns // 8, 8).transpose(0, 2, 1, 3).reshape(-1, 64)
    best = np.argsort(blocks.max(axis=1))[-BLOCKS:]
    inside = blocks[best].argmax(axis=1)
    return best // (columns // 8) * 8 + inside // 8, best % (columns // 8) * 8 + inside % 8


def triple(values: Array) -> Triple:
    """Three numbers of an array (3,) as Python's own."""
    first, second, third = values.tolist()
    return first, second, third
