"""Slips of single rows: one has the other sign, holds what belongs into another, or is 0.

They happen where a list is written by hand, in the program's own rows, so that they are sought there: the rows g of the list
are compared with the rows e that it should have in each of the usual conventions, times a constant. A row that is 0 where e is
not tells nothing and is left out. Any other is taken for s e(j), with the sign s and the row j that leave least; the rows that
gain most by that are the slips, as few as leave an error that is about as small as any. Of n rows, k that have the other sign
are one of C(n, k) choices, k that changed places one of C(n, k) k!, k that hold anything one of C(n, k) (2n)^k: so many times
more lists fit by chance, and so much less simple is it. Rows that are wrong for any other reason would hold anything: that
one of them comes within a share e of its norm of one thing is at most as probable as e, whatever its channels.
"""

from __future__ import annotations

from functools import lru_cache
from math import comb, factorial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.diagnosis.chance import chances_of_rows
from shviewer.harmonics.basis import Array, degree_order, index

ONE_OF_TEN = 1.05
"""The cost of a slip for each factor of ten in the number of choices, and of any: more than that of a mistake in all rows."""

FAINT = 1e-3
"""A row that should hold less than this share of the strongest row may be 0."""

LUCK = 0.05
"""How probable it may be that a row which holds anything comes so near to one of those that it may be taken for."""

ANY = 1.5
"""Constants that are tried are 1, the ratio of the norms, and one that has a name, if it is within this factor of that."""


class Slip(NamedTuple):
    """What stands in a row: `sign` times what belongs into the row `holds`; sign 0: nothing."""

    row: int
    holds: int
    sign: int


class Slipped:
    """Candidates with slips: arrays over all that leave little of an error."""

    def __init__(self, given: Array, wanted: Array, constants: tuple[float, ...], most: float) -> None:
        """given, wanted: the rows of candidates, (c, n**2, 3). constants: those that have a name. most: the largest error."""
        self._read(given, wanted, constants)
        told = (~self._empty).sum(axis=1)
        counts = np.arange(self._errors.shape[1])
        possible = (self._errors <= most) & (2 * counts <= told[:, None])
        possible[:, 0] &= self._empty.any(axis=1)
        self._cases, self._counts = np.nonzero(possible)
        cases, counts = self._cases, self._counts
        self.candidates, self.factors = self._candidates[cases], self._factors[cases]
        """The candidate of each, and its constant."""
        self.errors = self._errors[cases, counts]
        """The relative errors, of all rows but those that are 0."""

        rows = np.arange(given.shape[1])
        wrong = np.argsort(self._order[cases], axis=1) < counts[:, None]
        holds = np.where(wrong, self._holds[cases], rows)
        signs = np.where(wrong, self._signs[cases], 1)
        kept = (holds == rows).all(axis=1)
        moved = (np.sort(holds, axis=1) == rows).all(axis=1) & (signs > 0).all(axis=1)
        ways = [1 if plain else 0 if places else 2 * len(rows) for plain, places in zip(kept, moved, strict=True)]
        choices = np.array(
            [_choices(int(n), int(k), way) for n, k, way in zip(told[cases], counts, ways, strict=True)],
            dtype=np.float64,
        )
        self.costs = ONE_OF_TEN * np.maximum(np.log10(choices), 1.0)
        """What the slips alone cost."""
        with np.errstate(divide="ignore", invalid="ignore"):
            near = np.sqrt(self._least[cases] / (given[self.candidates] ** 2).sum(axis=2))
        luck = np.where(wrong, near, 0.0).max(axis=1) * [way or k for k, way in zip(counts.tolist(), ways, strict=True)]
        held = np.take_along_axis(wanted[self.candidates], holds[:, :, None], axis=1) * signs[:, :, None]
        chances = chances_of_rows(given[self.candidates], held, ~self._empty[cases])
        self.chances = np.where(luck <= LUCK, choices * chances, 1.0)
        """The expected number of lists of random directions that fit so well with as many slips; 1 where slips may be luck."""

    def slips(self, place: int) -> tuple[Slip, ...]:
        """The slips of one of them."""
        case, count = self._cases[place], self._counts[place]
        found = [Slip(int(row), int(row), 0) for row in np.flatnonzero(self._empty[case])]
        for row in self._order[case, :count]:
            found.append(Slip(int(row), int(self._holds[case, row]), int(self._signs[case, row])))
        return tuple(sorted(found))

    def _read(self, given: Array, wanted: Array, constants: tuple[float, ...]) -> None:
        """What each row is best taken for, and the errors with the first 0, 1, 2 ... rows taken so, (cases, slips)."""
        power, own = (given**2).sum(axis=2), (wanted**2).sum(axis=2)
        black = np.asarray(~given.any(axis=2))
        empty = np.asarray(black & (own > FAINT**2 * own.max(axis=1, keepdims=True)))
        empty |= _whole_bands(black) & _whole_bands(empty, np.logical_or)
        told = np.where(empty, 0.0, own).sum(axis=1)
        ratio = np.sqrt(power.sum(axis=1) / np.where(told > 0, told, 1.0))
        candidates = np.flatnonzero((told > 0) & (ratio > 0))
        ratio, known = ratio[candidates], np.array(constants)
        nearest = known[np.abs(np.log(ratio[:, None] / known)).argmin(axis=1)]
        named = np.abs(np.log(ratio / nearest)) < np.log(ANY)
        named &= nearest != 1
        factors = np.concatenate([np.ones(len(candidates)), nearest[named], ratio])
        candidates = np.concatenate([candidates, candidates[named], candidates])

        g, e, empty = given[candidates], wanted[candidates] * factors[:, None, None], empty[candidates]
        power, own = (g**2).sum(axis=2), (e**2).sum(axis=2)
        products = g @ e.transpose(0, 2, 1)
        upright = products.diagonal(axis1=1, axis2=2)
        plain = np.where(empty, 0.0, power + own - 2 * upright)
        others = power[:, :, None] + own[:, None, :] - 2 * np.abs(products)
        rows = np.arange(g.shape[1])
        others[:, rows, rows] = np.where(upright < 0, others[:, rows, rows], np.inf)
        holds = others.argmin(axis=2)
        least = np.take_along_axis(others, holds[:, :, None], axis=2)[:, :, 0]
        signs = np.where(np.take_along_axis(products, holds[:, :, None], axis=2)[:, :, 0] < 0, -1, 1)
        gains = np.where(empty, 0.0, np.maximum(plain - least, 0.0))
        order = np.argsort(-gains, axis=1, kind="stable")
        gained = np.take_along_axis(gains, order, axis=1)[:, : g.shape[1] // 2].cumsum(axis=1)
        left = plain.sum(axis=1)[:, None] - np.concatenate([np.zeros((len(g), 1)), gained], axis=1)
        errors = np.sqrt(np.maximum(left, 0.0) / own.sum(axis=1)[:, None])
        self._candidates, self._factors, self._empty = candidates, factors, empty
        self._holds, self._signs, self._order, self._errors = holds, signs, order, errors
        self._least = np.maximum(least, 0.0)


def _whole_bands(rows: NDArray[np.bool_], which: np.ufunc = np.logical_and) -> NDArray[np.bool_]:
    """Rows (k, n**2) of degrees of which all are, or with logical_or any is."""
    n_bands = round(rows.shape[1] ** 0.5)
    found = which.reduceat(rows, np.arange(n_bands) ** 2, axis=1)
    return np.asarray(np.repeat(found, 2 * np.arange(n_bands) + 1, axis=1))


@lru_cache(512)
def _choices(n_rows: int, count: int, ways: int) -> int:
    """How many choices of at most so many rows there are; ways: what each may hold, 0: what another of them should."""
    return sum(comb(n_rows, k) * (ways**k if ways else factorial(k)) for k in range(count + 1))


def in_pairs(slips: tuple[Slip, ...]) -> bool:
    """Whether rows of m and -m have the same slips, so that complex rows are of a real function with them as without."""
    return {Slip(_of_other_m(row), _of_other_m(holds), sign) for row, holds, sign in slips} == set(slips)


def _of_other_m(row: int) -> int:
    l, m = degree_order(row)
    return index(l, -m)


def mended(numbers: Array, slips: tuple[Slip, ...], wanted: Array) -> Array:
    """A list (n**2, 3) with its slips undone. wanted: the rows that it should have, for those that stand nowhere in it."""
    found = numbers.copy()
    for slip in slips:
        found[slip.row] = wanted[slip.row]
    wrong = {slip.row for slip in slips}
    for slip in slips:
        if slip.sign and slip.holds in wrong:
            found[slip.holds] = slip.sign * numbers[slip.row]
    return found
