"""Integrals of a function that is not smooth: its cells are divided where, and only where, it is not a polynomial.

A cell is compared with all that is known of the function in it: the polynomial through its points must pass through the points
of the look, and its highest terms must be small. What is missed by so much in so large a cell bounds what integrals may be off
by; a step across a cell is missed by SHARE of it, as the root mean square over all positions of the step. Errors of different
cells have no sign in common, unless edges run along the rows: how much they agree is seen where cells are divided.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.quadrature import Radiance, directions_from_angles, gauss_unit
from shviewer.harmonics.sampling.cells import (
    NODES,
    POINTS,
    Cells,
    highest_terms,
    locate,
    project,
    sectors,
    to_nodes,
)
from shviewer.harmonics.sampling.look import N_STRIPS
from shviewer.harmonics.sampling.points import Samples, missed_by_roots

SHARE = 0.04
"""The error of a cell that a straight step crosses, over its area and the highest terms of its polynomial: 0.038."""

TOLERANCE = 1e-4
"""What integrals and relative L2 errors may be off by before cells are divided further."""

MOST_EVALUATIONS = 2_500_000
"""In cells that are divided; what is not resolved with so many is said to be uncertain."""

MAX_DEPTH = 14
"""A cell of that depth is 0.0002 degrees high."""

ACROSS = 0.1
"""Something reaches across a side if the highest terms of the points next to it are this share of those of the cell."""

MOST_TOGETHER = 4.0
"""An edge along the points is missed by no more than this many times what one at random is missed by."""

CAUTION = 2.0
"""Errors are said to be this many of their standard deviations."""


@dataclass(frozen=True, eq=False)
class Resolved:
    """What the cells say of a function."""

    coefficients: Array
    products: Array
    """Integrals of f_i f_j, (3, 3)."""
    magnitude: Array
    """Integrals of |f|, (3,)."""
    errors: Array
    """What may be missed, (7,): in the integrals of f and of f^2, channel by channel, and in the squared L2 distance of the
    coefficients, over all channels."""
    evaluations: int
    peak: float
    """The largest |f| seen."""
    places: Array
    """Directions (k, 3) of the brightest point in roots that were divided, those first where most had been missed."""
    layers: list[tuple[Cells, Array]]
    """All cells that were not divided, and their values times the weights of their points, (n, POINTS, POINTS, 3)."""
    widest_left: float
    """The height in degrees of the largest cell that should have been divided further; 0 if none was left."""


def resolve(
    radiance: Radiance,
    texels: NDArray[np.float32],
    seen: tuple[Array, Array],
    scales: Array,
    left_out: float,
    n_bands: int,
) -> Resolved:
    """Integrate a function of which the look has the texels.

    seen: directions and values (k, 3) of points that other rules have met. scales: (7,), the integrals to which
    `Resolved.errors` refer, as far as they are known. left_out: likewise the relative L2 error of n_bands; the smaller it is,
    the more a fault of its square changes it.
    """
    work = _Work(radiance, texels, seen, TOLERANCE * scales * np.r_[1, 1, 1, 2, 2, 2, 2 * left_out + TOLERANCE])
    cells = Cells.roots()
    while len(cells):
        cells = work.add(cells)
    order = np.argsort(-work.missed_by_roots, kind="stable")
    return Resolved(
        project([work.whole, work.divided], n_bands),
        work.products,
        work.magnitude,
        CAUTION * np.sqrt(work.squares),
        work.evaluations,
        work.peak,
        work.places[order[work.brightest[order] >= 0]],
        work.layers,
        work.widest_left,
    )


class _Work:
    """The sums over all cells that are not divided further, and what the next depth needs of this one."""

    def __init__(
        self, radiance: Radiance, texels: NDArray[np.float32], seen: tuple[Array, Array], tolerance: Array
    ) -> None:
        self.radiance, self.texels, self.tolerance = radiance, texels, tolerance
        n_roots = int(sectors().sum())
        self.whole = np.zeros((n_roots, POINTS, POINTS, 3))
        self.divided = np.zeros((n_roots, NODES, NODES, 3))
        self.products, self.magnitude = np.zeros((3, 3)), np.zeros(3)
        self.layers: list[tuple[Cells, Array]] = []
        self.squares = np.zeros(7)
        self.evaluations, self.peak, self.widest_left = 0, 0.0, 0.0
        self.brightest, self.places = np.full(n_roots, -1.0), np.zeros((n_roots, 3))
        self.missed_by_roots = np.zeros(n_roots)
        self.samples = Samples(*locate(seen[0]), seen[1])
        self.before = np.zeros((0, 6))
        """The integrals of f and f^2 over the cells that were divided last."""
        self.errors = np.zeros((0, 6))
        """Their errors, and the row of each of them."""
        self.row = np.zeros(0, dtype=np.int64)
        self.together = np.sqrt(sectors()[Cells.roots().strip])
        """How much larger the errors of a row of cells are together than if their signs were random, for each cell.

        Nothing is known of roots, and whatever repeats itself around the axis is missed by all in a row alike.
        """

    def add(self, cells: Cells) -> Cells:
        """Add cells of one depth that are good enough, and return the quarters of the others."""
        values = cells.evaluate(self.radiance)
        self.evaluations += values.size // 3
        weights = cells.weights()
        weighted = values * (weights[:, :, None] * gauss_unit(POINTS)[1])[..., None]
        size = np.abs(values).max(axis=(1, 2))
        self.peak = max(self.peak, float(size.max()))
        highest, at_sides = highest_terms(values)
        if cells.depth == 0:
            missed = np.maximum(missed_by_roots(values, self.texels), self.samples.missed(values))
            self.missed_by_roots = missed.max(axis=1)
        else:
            missed = np.maximum(highest, self.samples.missed(values))
            self._note_brightest(cells, values, size)
        integrals = np.concatenate([weighted.sum(axis=(1, 2)), (values * weighted).sum(axis=(1, 2))], axis=1)
        if cells.depth > 0:
            self._compare(integrals)
        squared = np.stack([missed * size * 2, missed**2 * 2])
        errors = np.concatenate([missed, squared[0], squared[1].sum(axis=1, keepdims=True)], axis=1)
        errors *= SHARE * weights.sum(axis=1, keepdims=True)
        likely = errors * self.together[:, None]
        split = self._to_divide(cells, likely, at_sides > ACROSS * missed.max(axis=1, keepdims=True))
        self._keep(cells, values, weighted, likely, ~split)
        if cells.depth == 0:
            self.samples = self.samples.with_look(cells, split, self.texels)
        self.samples = self.samples.divided(split)
        self.row = np.unique(cells.strip[split] * 2**cells.depth + cells.down[split], return_inverse=True)[1]
        self.before, self.errors, self.together = integrals[split], errors[split, :6], self.together[split]
        return cells[split].divided()

    def _keep(self, cells: Cells, values: Array, weighted: Array, errors: Array, kept: NDArray[np.bool_]) -> None:
        values, weighted = values[kept], weighted[kept]
        self.products += weighted.reshape(-1, 3).T @ values.reshape(-1, 3)
        self.magnitude += np.ones(weighted.size // 3) @ np.abs(weighted).reshape(-1, 3)
        self.squares += (errors[kept] ** 2).sum(axis=0)
        self.layers.append((cells[kept], weighted))
        if cells.depth == 0:
            self.whole[kept] = weighted
        else:
            to_nodes(cells[kept], weighted, self.divided)

    def _compare(self, integrals: Array) -> None:
        """See how much more the last division has changed each row of cells than errors of random signs would."""
        count = np.bincount(self.row)
        sums = np.zeros((2, len(count), 6))
        np.add.at(sums[0], self.row, integrals.reshape(-1, 4, 6).sum(axis=1) - self.before)
        np.add.at(sums[1], self.row, self.errors**2)
        change, expected = np.abs(sums[0]), np.sqrt(sums[1])
        together = np.divide(change, expected, out=np.ones_like(change), where=expected > 0).max(axis=1)
        together = np.minimum(together, MOST_TOGETHER * np.sqrt(count))[self.row]
        self.together = np.repeat(np.maximum(np.maximum(together, self.together / 2), 1), 4)

    def _to_divide(self, cells: Cells, errors: Array, across: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which cells to divide, (n,): those of the largest errors, until the others together are within the tolerance.

        With them those beside a side that something reaches across, (n, 4): it may end there between the points.
        """
        limit = self.tolerance / 2  # for each depth
        share = np.divide(errors, limit, out=np.zeros_like(errors), where=limit > 0)
        split = np.zeros(len(cells), dtype=bool)
        for column in share.T:
            order = np.argsort(column)
            split[order[np.cumsum(column[order] ** 2) > 1]] = True
        if cells.depth == MAX_DEPTH:
            split[:] = False
        split |= cells.beside(across & split[:, None])
        room = max(0, MOST_EVALUATIONS - (self.evaluations if cells.depth else 0)) // (4 * POINTS**2)
        if np.count_nonzero(split) > room:
            urgent = np.argsort(np.where(split, share.max(axis=1), -1))[::-1]
            split[urgent[room:]] = False
            self.widest_left = max(self.widest_left, 180 / N_STRIPS / 2**cells.depth)
        return split

    def _note_brightest(self, cells: Cells, values: Array, size: Array) -> None:
        """Note the brightest point of each root."""
        at, _ = gauss_unit(POINTS)
        top = size.max(axis=1)
        order = np.lexsort((-top, cells.root))
        first = order[np.unique(cells.root[order], return_index=True)[1]]
        first = first[top[first] > self.brightest[cells.root[first]]]
        flat = np.abs(values[first]).max(axis=3).reshape(len(first), POINTS**2)
        row, column = np.divmod(flat.argmax(axis=1), POINTS)
        which, some = np.arange(len(first)), cells[first]
        self.brightest[some.root] = top[first]
        self.places[some.root] = directions_from_angles(some.theta(at)[which, row], some.phi(at)[which, column])
