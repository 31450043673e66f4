"""All that is tried with one way to take the rows of a list, and the conventions that this stands for.

Phase, m and axes are orthogonal and keep the power of each degree; factors multiply a degree. With g' the numbers after one
of the `ways` to take the rows and one of the orientations undone, e = sum of c^2, d = sum of c g' and p = sum of g'^2 per
degree, the best constant is K = sum p / sum f d, and the squared error that is left, relative to K f c, is
1 - (sum f d)^2 / (sum p sum f^2 e). So each g' serves all factors, channels and constants at once. Degrees that the list
cannot tell, A(3) = 0, must be empty in it.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.costs import ANY_FACTOR, BENT, CHANNELS, NAMED_FACTOR, Combination, combinations
from shviewer.coefficients.diagnosis.orientations import Orientation, orientations, undoing
from shviewer.coefficients.diagnosis.ways import Taken, Way
from shviewer.coefficients.parts.channels import CHANNEL_ORDERS, FLAT_BY_CHANNEL, channel_places
from shviewer.coefficients.parts.quantities import is_over_pi, whole
from shviewer.coefficients.parts.rows import ACN
from shviewer.coefficients.parts.scales import SCALES
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.coefficients.texts import in_our_terms, parse_convention
from shviewer.harmonics.basis import Array
from shviewer.harmonics.filters import irradiance_factors
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE

NO_FACTOR = 0.02
"""A constant that differs from 1 by no more, or by no more than half of what is off, is no mistake: noise has one, too."""

CONSTANTS = {
    "multiplied by pi": np.pi,
    "divided by pi": 1 / np.pi,
    "multiplied by sqrt(4 pi)": np.sqrt(4 * np.pi),
    "divided by sqrt(4 pi)": 1 / np.sqrt(4 * np.pi),
    "times 2": 2.0,
    "times 0.5": 0.5,
    "multiplied by 4 pi": 4 * np.pi,
    "divided by 4 pi": 1 / (4 * np.pi),
}
"""Words -> a factor that the numbers often have."""


Place = tuple[int, int, int]
"""The numbers of an order of channels, an orientation and a combination."""


class Tried:
    """All that is tried with one way to take the rows; arrays over channels, orientations and combinations."""

    def __init__(self, way: Way, exact: Array, n_bands: int) -> None:
        self.taken, self.table = way.taken, way.table[: n_bands**2]
        self.costs, self.bases = np.zeros(0), np.zeros(0, dtype=np.int64)
        """The cost of each orientation and combination, and the number of its base, as in `costs`."""
        self.combinations = combinations(way.taken)
        self.factors = np.array([_factors(*combination, n_bands) for combination in self.combinations])
        starts = np.arange(n_bands) ** 2
        turned = undoing(n_bands) @ self.table  # (192, n**2, 3)
        pairs = np.add.reduceat(exact[None, :, :, None] * turned[:, :, None, :], starts, axis=1)
        self.own = np.add.reduceat((turned**2).sum(axis=2), starts, axis=1)  # (192, n)
        self.exact = np.add.reduceat((exact**2).sum(axis=1), starts)
        places = [np.argsort(channel_places(order)) for order in CHANNEL_ORDERS]
        self.with_exact = np.stack([sum(pairs[:, :, i, at[i]] for i in range(3)) for at in places])  # (6, 192, n)
        self.linear = self.with_exact @ self.factors.T
        power, model = self.own.sum(axis=1)[:, None], self.factors**2 @ self.exact
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.where(self.linear > 0, self.linear**2 / (power * model), 0.0)
            self.constants = np.where(self.linear > 0, power / self.linear, 1.0)
        self.misfits = np.sqrt(np.maximum(1 - np.nan_to_num(share), 0.0))
        if way.taken.shift:  # what is shifted has no factor: it would shift, too
            self.misfits[np.abs(self.constants - 1) > NO_FACTOR] = np.inf

    def by_degree(self, place: Place) -> tuple[Array, NDArray[np.bool_]]:
        """The relative error of each degree, each with its best constant, and whether the degree tells anything."""
        channels, orientation, combination = place
        model = self.factors[combination] ** 2 * self.exact
        linear = self.factors[combination] * self.with_exact[channels, orientation]
        told = (model > 0) & (self.own[orientation] > 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.where(told & (linear > 0), linear**2 / (model * self.own[orientation]), 0.0)
        return np.sqrt(np.maximum(1 - share, 0.0)), told

    def usual(self, most: float) -> list[Place]:
        """The places of what costs at most so much."""
        return [(int(i), int(j), int(k)) for i, j, k in np.argwhere(CHANNELS[:, None, None] + self.costs <= most)]

    def rows(self, places: list[Place], exact: Array) -> tuple[Array, Array]:
        """What the list has, and what it should have there but for a constant: two of (k, n**2, 3), before any order."""
        n_bands = self.factors.shape[1]
        channels, turns, combined = np.array(places).T
        own = np.array([np.argsort(channel_places(order)) for order in CHANNEL_ORDERS])[channels]
        scales = np.array([_row_factors(scale, n_bands) for _, scale in self.combinations])[combined][:, :, None]
        degrees = np.repeat(self.factors[combined], 2 * np.arange(n_bands) + 1, axis=1)[:, :, None]
        wanted = undoing(n_bands)[turns].transpose(0, 2, 1) @ exact  # orthogonal
        return self.table[:, own].transpose(1, 0, 2) * scales, wanted * degrees * scales

    def convention(self, place: Place, factor: float, named: Convention | None) -> tuple[Convention, Convention]:
        """The convention that a place stands for, and the one that it differs from."""
        channels, orientation, combination = place
        number = int(self.bases[orientation, combination])
        base = named if number == BENT and named else CONVENTIONS[list(CONVENTIONS)[number]]
        found = _convention(
            base,
            self.taken,
            orientations()[orientation],
            CHANNEL_ORDERS[channels],
            self.combinations[combination],
            factor,
        )
        if number == BENT:
            found = replace(found, order=self.taken.order)
            if _in_our_terms(found) == _in_our_terms(base):
                return base, base
            found = parse_convention(_in_our_terms(found))
        return found, base


def _in_our_terms(convention: Convention) -> str:
    return in_our_terms(replace(convention, quantity=None if convention.quantity == RADIANCE else convention.quantity))


def constant_of(found: float, good: float) -> float:
    """A factor of numbers that are off by `good`: 1, one of CONSTANTS, or any, to seven digits."""
    if abs(found - 1) <= max(NO_FACTOR, good / 2):
        return 1.0
    near = [value for value in CONSTANTS.values() if abs(found / value - 1) <= good]
    return float(f"{near[0]:.10g}" if near else f"{found:.7g}")


def constant_costs(found: Array, good: float) -> Array:
    """What such factors cost, of the same shape."""
    named = np.any([np.abs(found / value - 1) <= good for value in CONSTANTS.values()], axis=0)
    return np.where(np.abs(found - 1) <= max(NO_FACTOR, good / 2), 0.0, np.where(named, NAMED_FACTOR, ANY_FACTOR))


def _row_factors(scale: str, n_bands: int) -> Array:
    """What was taken out of the rows of a table before anything was turned, (n**2,)."""
    return SCALES[scale][0](n_bands) if scale in ("polynomial", "fuma") else np.ones(n_bands**2)


@cache
def _factors(quantity: str, scale: str, n_bands: int) -> Array:
    """What multiplies our coefficients of the radiance, per degree."""
    factors = irradiance_factors(n_bands) if whole(quantity) == IRRADIANCE else np.ones(n_bands)
    if scale in ("polynomial", "fuma"):  # undone before anything was turned
        scale = "orthonormal"
    return np.asarray(
        factors * SCALES[scale][0](n_bands)[np.arange(n_bands) ** 2] / (np.pi if is_over_pi(quantity) else 1.0)
    )


def _convention(
    base: Convention, taken: Taken, orientation: Orientation, channels: str, combination: Combination, factor: float
) -> Convention:
    quantity, scale = combination
    held = quantity if quantity != RADIANCE or base.quantity else None
    phase = base.phase if scale == "polynomial" and base is not OURS else orientation.phase
    return replace(
        base,
        phase=phase,
        mirrored=orientation.mirrored,
        axes=orientation.axes.then(base.pole.inverse),
        scale=scale,
        quantity=held,
        order=taken.order if taken.order != ACN else base.order,
        shift=taken.shift,
        sequence=base.sequence if base.sequence == FLAT_BY_CHANNEL else taken.sequence,
        channels=channels,
        factor=factor,
    )
