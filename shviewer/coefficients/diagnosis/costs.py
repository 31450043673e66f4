"""How much must have gone wrong: 1 for each thing, more for odd ones, and no more for a program's own convention."""

from __future__ import annotations

from functools import cache, lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.orientations import FLIPS, HALF_TURN, TURNS, USUAL_AXES, between, orientations
from shviewer.coefficients.diagnosis.ways import Taken, sequence_of
from shviewer.coefficients.parts.axes import Axes, all_axes
from shviewer.coefficients.parts.channels import CHANNEL_ORDERS, FLAT_BY_CHANNEL
from shviewer.coefficients.parts.quantities import QUANTITIES, is_over_pi, whole
from shviewer.coefficients.programs import CONVENTIONS, OURS, READINGS
from shviewer.harmonics.basis import Array
from shviewer.harmonics.quantities.names import RADIANCE

ONE = 1.0
ALSO_THE_PHASE = 1.02
"""Half a turn, which the phase is, too."""

FLIPPED, ODD_AXES = 0.98, 2.05
"""An image whose rows or columns are taken in reverse, and axes that no program has."""

OVER_PI_TOO = 0.6
"""Irradiance that is divided by pi, beyond irradiance."""

PROGRAM, OPEN_READING, ANOTHER_PROGRAM, BENDING = 0.9, 1.02, 1.1, 0.15
"""A program where none was named, one of the two readings of a program whose phase nobody documents, another program than
the one that was named; and, beyond the mistakes themselves, those in what the program that was named has fixed.
"""

BENT = -1
"""The number of the base that is what was named, with mistakes in what its program has fixed."""

NAMED_FACTOR, ANY_FACTOR = 1.02, 1.4
"""A factor with a name, which may be part of a quantity or a normalisation, and any other."""

CHANNELS = np.array([0.0 if order == "rgb" else ONE if order == "bgr" else 2.0 for order in CHANNEL_ORDERS])

Combination = tuple[str, str]
"""A quantity and a normalisation."""


def combinations(taken: Taken) -> list[Combination]:
    """All that the table of a way may be of."""
    return list(product(QUANTITIES, taken.scales))


@lru_cache(512)
def costs(
    taken: Taken, n_bands: int, named: Convention | None, flat: bool, placed: bool
) -> tuple[Array, NDArray[np.int64]]:
    """The cost of each orientation and combination, (192, k), without channels and factor, and the number of its base.

    The base is the convention of CONVENTIONS, or what was named, BENT, from which least differs; infinite where none can have
    it. n_bands: those of the list. named: the convention it was read in; flat: whether it has no rows; placed: whether these
    name their l and m.
    """
    best = np.full((len(orientations()), len(combinations(taken))), np.inf)
    bases = np.zeros(best.shape, dtype=np.int64)
    for number, base in enumerate(CONVENTIONS.values()):
        if n_bands <= (base.most_bands or n_bands) and taken.complex == base.complex:
            total = _from_base(base, taken, named, flat, placed)
            better = total < best
            best[better], bases[better] = total[better], number
    if named and named != OURS and named.sequence != FLAT_BY_CHANNEL and taken.complex == named.complex:
        total = _from_base(named, taken, named, flat, placed, free=True)
        total = np.where(total > 0, total + BENDING, total)
        better = total < best - 1e-9
        best[better], bases[better] = total[better], BENT
    return best, bases


def _from_base(
    base: Convention, taken: Taken, named: Convention | None, flat: bool, placed: bool, free: bool = False
) -> Array:
    """The same from one base. A program's own phase, sign of m, normalisation, order, shift and quantity are fixed.

    free: they are not.
    """
    ours, given = free or base is OURS, named if named is not None and named.name == base.name else None
    found = np.full((len(orientations()), len(combinations(taken))), np.inf)
    other_order = taken.order != base.order and not placed
    sequence = sequence_of((given or base).sequence, flat)
    fixed = base.sequence == FLAT_BY_CHANNEL and taken.sequence != sequence
    if fixed or (not ours and (other_order or taken.shift != base.shift)):
        return found
    cost = _of_name(base, named) + (taken.sequence != sequence) + other_order + (taken.shift != base.shift)
    of_axes, polynomial = _of_axes(base.basis_axes, base is OURS), "polynomial" in taken.scales
    for first in range(0, len(found), len(of_axes)):
        phase, mirrored, _ = orientations()[first]
        if polynomial and (phase or mirrored):
            continue  # the phase of polynomials is a half turn, and their factors are those of m and not of -m
        other_phase, other_sign = phase != base.phase and not polynomial, mirrored != base.mirrored
        if not ours and (phase != base.phase or other_sign):
            continue
        for column, (quantity, scale) in enumerate(combinations(taken)):
            if ours or (scale == base.scale and base.quantity in (None, quantity)):
                changed = other_phase + other_sign + (scale != base.scale) + _of_quantity(quantity, base, given)
                found[first : first + len(of_axes), column] = cost + changed + of_axes
    return found


def _of_name(base: Convention, named: Convention | None) -> float:
    if named is None:
        is_open = any(base.name in readings for readings in READINGS.values())
        return 0.0 if base is OURS else OPEN_READING if is_open else PROGRAM
    return 0.0 if base.name == named.name else ANOTHER_PROGRAM


def _of_quantity(quantity: str, base: Convention, given: Convention | None) -> float:
    meant = base.quantity or (given.quantity if given else None) or RADIANCE
    other = whole(quantity) != whole(meant)
    return other + (OVER_PI_TOO if other else ONE) * (is_over_pi(quantity) != is_over_pi(meant))


@cache
def _of_axes(meant: Axes, ours: bool) -> Array:
    """The cost of each of all axes where these were meant."""

    def cost(axes: Axes) -> float:
        if axes == meant:
            return 0.0
        turn = between(meant, axes).text
        if turn == HALF_TURN:
            return ALSO_THE_PHASE
        if turn in FLIPS:
            return FLIPPED
        return ONE if turn in TURNS or (ours and axes.text in USUAL_AXES) else ODD_AXES

    return np.array([cost(axes) for axes in all_axes()])
