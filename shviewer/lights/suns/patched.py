"""An image with some texels replaced, of which no copy is made until somebody needs all of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices


@dataclass(frozen=True, eq=False)
class Patched:
    """An image (height, width, 3) that has other values in a few places."""

    image: NDArray[np.float32]
    places: Indices = field(default_factory=lambda: np.zeros(0, np.int64))
    """Those texels, (k,), ascending: row times width plus column."""
    values: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 3), np.float32))
    """What they have, (k, 3)."""

    def replaced(self, rows: Indices, columns: Indices, values: NDArray[np.float32]) -> Patched:
        """The same with `values` (j, 3) at rows and columns (j,), each of them once."""
        places = np.concatenate([rows * self.image.shape[1] + columns, self.places])
        found, first = np.unique(places, return_index=True)  # the new values come first
        return Patched(self.image, found, np.concatenate([values, self.values])[first])

    def at(self, rows: Indices, columns: Indices) -> NDArray[np.float32]:
        """The values (j, 3) at rows and columns (j,)."""
        values = self.image[rows, columns]
        if len(self.places):
            wanted = rows * self.image.shape[1] + columns
            nearest = np.minimum(np.searchsorted(self.places, wanted), len(self.places) - 1)
            here = self.places[nearest] == wanted
            values[here] = self.values[nearest[here]]
        return values

    @cached_property
    def where(self) -> tuple[Indices, Indices]:
        """Rows and columns (k,) of `places`."""
        rows, columns = np.divmod(self.places, self.image.shape[1])
        return rows, columns

    @property
    def taken(self) -> tuple[Array, Indices, Indices]:
        """How much more the image has, (j, 3), exact as a difference of float32 values, at rows and columns (j,)."""
        taken = self.image[self.where].astype(np.float64) - self.values
        some = taken.any(axis=1)
        return taken[some], self.where[0][some], self.where[1][some]

    @property
    def shape(self) -> tuple[int, ...]:
        return self.image.shape

    def __len__(self) -> int:
        return len(self.image)

    def __getitem__(self, rows: slice) -> NDArray[np.float32]:
        """Some rows of it: a copy where they differ from those of the image."""
        top, stop, _ = rows.indices(len(self.image))
        first, last = np.searchsorted(self.where[0], [top, stop])
        block = self.image[rows]
        if first == last:
            return block
        block = block.copy()
        some = slice(first, last)
        block[self.where[0][some] - top, self.where[1][some]] = self.values[some]
        return block
