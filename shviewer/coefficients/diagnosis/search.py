"""The search for the convention in which a list would be the coefficients of a known light.

A list is numbers g; were it right, they would be our coefficients c of the light, times the factors f(l) of what it holds
and of its normalisation. The usual mistakes are few: the phase, m and -m, the axes, a constant, the clamped cosine A(l),
another normalisation, the order of the rows or the channels, the sequence of the numbers. All combinations are tried
(tried.py), and with the simple ones whether single rows are wrong (slips.py).

Among errors that are about equal the explanation decides that costs least (costs.py), and chance.py says what it is worth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.chance import CHANCE, chance
from shviewer.coefficients.diagnosis.costs import CHANNELS
from shviewer.coefficients.diagnosis.costs import costs as costs_of
from shviewer.coefficients.diagnosis.slips import ONE_OF_TEN, Slip, Slipped, in_pairs
from shviewer.coefficients.diagnosis.tried import CONSTANTS, Place, Tried, constant_costs, constant_of
from shviewer.coefficients.diagnosis.ways import ways
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.parts.rows import row_order
from shviewer.harmonics.basis import Array, count_bands

MOST_BANDS = 6
"""The most bands compared: enough to tell all mistakes apart, and fast to turn."""

ALIKE = 1.5
"""Errors within this factor of the smallest count as equal: what is left then is noise of sampling and digits."""

TINY = 1e-6
"""Relative errors below this count as none: single precision, or six printed digits."""

EXPLAINED = 0.25
"""A suspected mistake is named if the error without it is at most this, and at most this share of the error with it."""

CLEAN = 0.05
"""The most that slips may leave of an error: they are told where all other rows are right."""

USUAL = 2.1
"""The most that a convention costs with which slips are sought: two mistakes, or a program and one."""


@dataclass(frozen=True)
class Explanation:
    """A convention, the relative error of the numbers in it, and by how much chance explains it."""

    convention: Convention
    meant: Convention
    """What it differs from: a program's own convention, or the one that was named."""
    error: float
    chance: float
    """The expected number of explanations at most so costly that fit a list of random directions so well."""
    cost: float
    slips: tuple[Slip, ...] = ()
    """What is wrong in single rows of the list, which are counted from 0 in its own order."""


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
    tried = [Tried(way, exact, n_bands) for way in found]
    for one in tried:
        one.costs, one.bases = costs_of(
            one.taken, count_bands(found[0].table), named, listed.numbers.ndim == 1, listed.placed
        )
        one.misfits[:, np.isinf(one.costs)] = np.inf
    simplest = _simplest(tried, exact, named)
    if simplest and simplest.error <= TINY and simplest.cost <= ONE_OF_TEN:
        return simplest
    return _with_slips(tried, exact, named, simplest)


def _simplest(tried: list[Tried], exact: Array, named: Convention | None) -> Explanation | None:
    """The simplest of those that fit about as well as any, without slips."""
    least = min(float(one.misfits.min()) for one in tried)
    good = max(ALIKE * least, TINY)
    best, most = None, np.inf
    for one in tried:
        near = one.misfits <= good
        if near.any():
            total = np.where(near, one.costs + CHANNELS[:, None, None] + constant_costs(one.constants, good), np.inf)
            first = int(total.argmin())
            if total.flat[first] < most - 1e-9:
                channels, orientation, combination = map(int, np.unravel_index(first, total.shape))
                best, most = (one, (channels, orientation, combination)), float(total.flat[first])
    if best is None:
        return None
    one, place = best
    within = sum(
        int((CHANNELS[:, None, None] + one.costs <= most + 1e-9).sum()) * (1 + len(CONSTANTS)) for one in tried
    )
    convention, meant = one.convention(place, constant_of(float(one.constants[place]), good), named)
    by_chance = within * chance(*one.by_degree(place), exact)
    return Explanation(convention, meant, float(one.misfits[place]), by_chance, most)


def _with_slips(
    tried: list[Tried], exact: Array, named: Convention | None, simplest: Explanation | None
) -> Explanation | None:
    """The simplest of those that fit about as well as any and are not chance, with or without slips."""
    sure = simplest is not None and simplest.chance <= CHANCE
    exactly = simplest is not None and sure and simplest.error <= TINY  # then only what is simpler is sought
    most = min(USUAL, simplest.cost - ONE_OF_TEN) if simplest and exactly else USUAL
    places: list[tuple[Tried, Place]] = []
    given: list[Array] = []
    wanted: list[Array] = []
    for one in tried:
        if found := one.usual(most):
            places += [(one, place) for place in found]
            for rows, part in zip((given, wanted), one.rows(found, exact), strict=True):
                rows.append(part)
    if not places:
        return simplest
    with np.errstate(all="ignore"):  # of numbers that float64 cannot square: nothing is near then
        slipped = Slipped(np.concatenate(given), np.concatenate(wanted), (1.0, *CONSTANTS.values()), CLEAN)
    chances = slipped.chances * len(places) * (1 + len(CONSTANTS))
    counted = np.flatnonzero(chances <= CHANCE)
    if not counted.size:
        return simplest
    least = min(float(slipped.errors[counted].min()), simplest.error if simplest and sure else np.inf)
    good = max(ALIKE * least, TINY)
    near = counted[slipped.errors[counted] <= good]
    factors = slipped.factors[near]
    costs = slipped.costs[near] + constant_costs(factors, good)
    costs += [_cost(*places[candidate]) for candidate in slipped.candidates[near]]
    if not near.size or (simplest and sure and simplest.error <= good and simplest.cost <= costs.min() + 1e-9):
        return simplest
    best = int(costs.argmin())
    one, place = places[slipped.candidates[near[best]]]
    convention, meant = one.convention(place, constant_of(float(factors[best]), good), named)
    order = np.argsort(row_order(convention.order, count_bands(exact))).tolist()
    slips = tuple(sorted(Slip(order[row], order[holds], sign) for row, holds, sign in slipped.slips(near[best])))
    if one.taken.complex and not in_pairs(slips):
        return simplest
    error, by_chance = float(slipped.errors[near[best]]), float(chances[near[best]])
    return Explanation(convention, meant, error, by_chance, float(costs[best]), slips)


def _cost(one: Tried, place: Place) -> float:
    channels, orientation, combination = place
    return float(CHANNELS[channels] + one.costs[orientation, combination])
