"""How far the polynomials of cells miss the points that are known: those of the look, and others that rules have met."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.sampling.cells import POINTS, Cells, sectors, shares
from shviewer.harmonics.sampling.look import STRIP_ROWS, strides


def missed_by_roots(values: Array, texels: NDArray[np.float32]) -> Array:
    """How far the polynomials through the values (roots, POINTS, POINTS, 3) miss the look, at most: (roots, 3)."""
    missed, first = np.empty((len(values), 3)), 0
    down = shares(np.arange(STRIP_ROWS + 1) / STRIP_ROWS, POINTS)
    for strip, (stride, count) in enumerate(zip(strides(), sectors(), strict=True)):
        across = shares(_places_across(int(stride)), POINTS)
        here = values[first : first + count]
        there = across @ (down @ here.reshape(count, POINTS, -1)).reshape(count, STRIP_ROWS + 1, POINTS, 3)
        missed[first : first + count] = np.abs(there - _seen(texels, strip, int(stride))).max(axis=(1, 2))
        first += count
    return missed


def _places_across(stride: int) -> Array:
    """Where in a root the columns of the look are, (STRIP_ROWS,), in [0, 1]."""
    return (np.arange(STRIP_ROWS) + 0.5 / stride) / STRIP_ROWS


def _seen(texels: NDArray[np.float32], strip: int, stride: int) -> Array:
    """The points of the look in the roots of a strip, both ends included: (roots, STRIP_ROWS + 1, STRIP_ROWS, 3)."""
    rows = texels[STRIP_ROWS * strip : STRIP_ROWS * (strip + 1) + 1, ::stride]
    return rows.reshape(STRIP_ROWS + 1, -1, STRIP_ROWS, 3).transpose(1, 0, 2, 3).astype(np.float64)


class Samples(NamedTuple):
    """Points of the look: the number of the cell, place along u and theta in it, 0 to 1, (k,) each; values (k, 3)."""

    cell: Indices
    across: Array
    down: Array
    values: Array

    def with_look(self, roots: Cells, split: NDArray[np.bool_], texels: NDArray[np.float32]) -> Samples:
        """These and the points of the look in roots that are divided, split (n,)."""
        found, per_strip = [self], strides()
        for strip in np.unique(roots.strip[split]):
            stride = int(per_strip[strip])
            here = np.flatnonzero((roots.strip == strip) & split)
            values = _seen(texels, int(strip), stride)[roots.sector[here]]
            number, down, across = np.broadcast_arrays(
                here[:, None, None],
                np.arange(STRIP_ROWS + 1)[:, None] / STRIP_ROWS,
                _places_across(stride),
            )
            found.append(Samples(number.ravel(), across.ravel(), down.ravel(), values.reshape(-1, 3)))
        return Samples(*map(np.concatenate, zip(*found, strict=True)))

    def divided(self, split: NDArray[np.bool_]) -> Samples:
        """Those in the quarters of the cells that are divided, split (n,)."""
        kept = split[self.cell]
        number = (np.cumsum(split) - 1)[self.cell[kept]]
        right, lower = self.across[kept] >= 0.5, self.down[kept] >= 0.5
        return Samples(
            4 * number + 2 * lower + right,
            2 * self.across[kept] - right,
            2 * self.down[kept] - lower,
            self.values[kept],
        )

    def missed(self, values: Array) -> Array:
        """How far the polynomials through the values (n, POINTS, POINTS, 3) of cells miss the samples, at most: (n, 3)."""
        found = np.zeros((len(values), 3))
        for start in range(0, len(self.cell), 4096):
            part = slice(start, start + 4096)
            cell = self.cell[part]
            rows = np.einsum("ki,kijc->kjc", shares(self.down[part], POINTS), values[cell])
            there = np.einsum("kj,kjc->kc", shares(self.across[part], POINTS), rows)
            np.maximum.at(found, cell, np.abs(there - self.values[part]))
        return found
