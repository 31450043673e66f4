"""The search for the convention in which a list would be the coefficients of a known light.

A list is numbers g; were it right, they would be our coefficients c of the light, times the factors f(l) of what it holds
and of its normalisation. The usual mistakes are few: the phase, m and -m, the axes, a constant, the clamped cosine A(l),
another normalisation, the order of the rows or the channels, the sequence of the numbers. All combinations are tried.

Phase, m and axes are orthogonal and keep the power of each degree; factors multiply a degree. With g' the numbers after one
of the `ways` to take the rows and one of the orientations undone, e = sum of c^2, d = sum of c g' and p = sum of g'^2 per
degree, the best constant is K = sum p / sum f d, and the squared error that is left, relative to K f c, is
1 - (sum f d)^2 / (sum p sum f^2 e). So each g' serves all factors, channels and constants at once. Degrees that the list
cannot tell, A(3) = 0, must be empty in it.

Among errors that are about equal the explanation decides that costs least (costs.py), and chance.py says what it is worth.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.chance import chance
from shviewer.coefficients.diagnosis.costs import ANY_FACTOR, CHANNELS, NAMED_FACTOR, Combination, combinations
from shviewer.coefficients.diagnosis.costs import costs as costs_of
from shviewer.coefficients.diagnosis.orientations import Orientation, orientations, undoing
from shviewer.coefficients.diagnosis.ways import Taken, Way, ways
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.parts.channels import CHANNEL_ORDERS, FLAT_BY_CHANNEL, channel_places
from shviewer.coefficients.parts.quantities import IRRADIANCE, RADIANCE, is_over_pi, whole
from shviewer.coefficients.parts.rows import ACN
from shviewer.coefficients.parts.scales import SCALES
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.filters import irradiance_factors

MOST_BANDS = 6
"""The most bands compared: enough to tell all mistakes apart, and fast to turn."""

ALIKE = 1.5
"""Errors within this factor of the smallest count as equal: what is left then is noise of sampling and digits."""

TINY = 1e-6
"""Relative errors below this count as none: single precision, or six printed digits."""

NO_FACTOR = 0.02
"""A constant that differs from 1 by no more is no mistake: it is said beside the agreement."""

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


@dataclass(frozen=True)
class Explanation:
    """A convention (`base` with what differs), the relative error of the numbers in it, and by how much chance explains it."""

    convention: Convention
    error: float
    chance: float
    """The expected number of explanations at most so costly that fit a list of random directions so well."""


def explain(listed: Listed, exact: Array, named: Convention | None = None) -> Explanation | None:
    """The simplest convention in which the list fits about as well as in any; None if there is nothing to compare.

    exact: the light's radiance in our coefficients, (n**2, 3), with at least the bands of the list. named: the convention in
    which it was read. LightError if the numbers are no table.
    """
    found = list(ways(listed, named.sequence if named else ""))
    n_bands = min(count_bands(exact), count_bands(found[0].table), MOST_BANDS)
    exact = exact[: n_bands**2]
    if not exact.any() or not found[0].table[: n_bands**2].any():
        return None
    tried, flat = [_Tried(way, exact, n_bands) for way in found], listed.numbers.ndim == 1
    costs = [costs_of(one.taken, count_bands(found[0].table), named, flat, listed.placed) for one in tried]
    for one, (cost, _) in zip(tried, costs, strict=True):
        one.misfits[:, np.isinf(cost)] = np.inf
    least = min(float(one.misfits.min()) for one in tried)
    good = max(ALIKE * least, TINY)
    best, most = None, np.inf
    for one, (cost, bases) in zip(tried, costs, strict=True):
        near = one.misfits <= good
        if near.any():
            total = np.where(near, cost + CHANNELS[:, None, None] + one.constant_costs(good), np.inf)
            place = int(total.argmin())
            if total.flat[place] < most - 1e-9:
                best, most = (one, bases, np.unravel_index(place, total.shape)), float(total.flat[place])
    if best is None:
        return None
    one, bases, (channels, orientation, combination) = best
    base = CONVENTIONS[list(CONVENTIONS)[bases[orientation, combination]]]
    factor = one.constant(channels, orientation, combination, good)
    convention = _convention(
        base, one.taken, orientations()[orientation], CHANNEL_ORDERS[channels], one.combinations[combination], factor
    )
    within = sum(int((CHANNELS[:, None, None] + cost <= most + 1e-9).sum()) * (1 + len(CONSTANTS)) for cost, _ in costs)
    return Explanation(
        convention,
        float(one.misfits[channels, orientation, combination]),
        within * chance(*one.by_degree(channels, orientation, combination), exact),
    )


class _Tried:
    """All that is tried with one way to take the rows; arrays over channels, orientations and combinations."""

    def __init__(self, way: Way, exact: Array, n_bands: int) -> None:
        self.taken = way.taken
        self.combinations = combinations(way.taken)
        self.factors = np.array([_factors(*combination, n_bands) for combination in self.combinations])
        starts = np.arange(n_bands) ** 2
        turned = undoing(n_bands) @ way.table[: n_bands**2]  # (192, n**2, 3)
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

    def constant_costs(self, good: float) -> Array:
        off = np.abs(self.constants - 1)
        costs = np.where(off <= NO_FACTOR, 0.0, ANY_FACTOR)
        for value in CONSTANTS.values():
            costs = np.where(np.abs(self.constants / value - 1) <= good, NAMED_FACTOR, costs)
        return np.asarray(costs)

    def constant(self, channels: np.intp, orientation: np.intp, combination: np.intp, good: float) -> float:
        """The factor of the numbers: 1, one of CONSTANTS, or any, to six digits."""
        found = float(self.constants[channels, orientation, combination])
        if abs(found - 1) <= NO_FACTOR:
            return 1.0
        near = [value for value in CONSTANTS.values() if abs(found / value - 1) <= good]
        return float(f"{near[0]:.10g}" if near else f"{found:.7g}")

    def by_degree(
        self, channels: np.intp, orientation: np.intp, combination: np.intp
    ) -> tuple[Array, NDArray[np.bool_]]:
        """The relative error of each degree, each with its best constant, and whether the degree tells anything."""
        model = self.factors[combination] ** 2 * self.exact
        linear = self.factors[combination] * self.with_exact[channels, orientation]
        told = (model > 0) & (self.own[orientation] > 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.where(told & (linear > 0), linear**2 / (model * self.own[orientation]), 0.0)
        return np.sqrt(np.maximum(1 - share, 0.0)), told


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
