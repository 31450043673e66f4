"""Compact sources: the rule for them, and taking them out of an image.

A source is compact if it is, in the mean of the three channels,
    narrow      a half-angle of at most WIDEST,
    bright      a peak at least CONTRAST times as bright as what surrounds it,
    alone       nothing half as bright between CAP and RIM: it would be a piece of something longer, or one of a group,
    worth it    at least FLUX of the image's flux and ENERGY of its ||f||^2, as both are when the source's turn comes.
The brightest goes first, up to MOST, until none is left. Everything within one cap of CAP leaves as one source.

excess.py says what radiance a source is, and clipping.py which is clipped: that one is narrow if its plateau is, bright against
what is beyond FAR, and worth it with CLIPPED_ENERGY of ||f||^2.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, normalise
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.suns.caps import TILE, Caps, chord, chord_of
from shviewer.lights.suns.clipping import highest, is_clipped
from shviewer.lights.suns.excess import CAP, Excess
from shviewer.lights.suns.patched import Patched
from shviewer.lights.suns.rule import ENERGY, FEW_TEXELS, MOST, CompactSource, refusal
from shviewer.lights.suns.sun import Sun

CLIPPED_ENERGY = 0.01

TRIES = 32
"""How many bright spots are looked at before flux and energy of the rest are computed anew."""


class CompactSources:
    """An image (height, width, 3) while its compact sources are being taken out; `rest` is what is left."""

    def __init__(self, pixels: NDArray[np.float32], layout: Layout) -> None:
        self.rest = Patched(pixels)
        self._layout = layout
        self._solid_angles = layout.solid_angles().astype(np.float32)
        self._mean: NDArray[np.float32] = pixels @ np.full(3, 1 / 3, dtype=np.float32)
        """The mean of the channels of what is left, (height, width); 0 for a texel that shows nothing."""
        self._mean *= self._solid_angles > 0
        self._caps = Caps(layout, *pixels.shape[:2])
        self._plateau = highest(pixels, self._caps)
        self._axes: list[Array] = []

    def take_all(self) -> tuple[list[CompactSource], str]:
        """Take all sources out; return them and the reason why there are no more."""
        sources: list[CompactSource] = []
        while True:
            found, why = self._take_brightest(MOST - len(sources))
            sources += found
            if not found or len(sources) == MOST:
                return sources, why

    def keep(self, taken: list[int]) -> list[Sun]:
        """Take only some of the sources that were found, by their indices, out of the image as it was; return them."""
        self._mean[self.rest.where] = self.rest.image[self.rest.where] @ np.full(3, 1 / 3, dtype=np.float32)
        self.rest = Patched(self.rest.image)
        suns = []
        for i in taken:
            excess, clipped = self._around(self._axes[i])
            suns.append(excess.disc(self._layout, self.rest.shape, clipped))
            self._remove(excess)
        return suns

    def _take_brightest(self, most: int) -> tuple[list[CompactSource], str]:
        """Take out up to `most` sources; return them and why the first spot that is not compact is none.

        A source has a texel of at least sqrt(ENERGY ||f||^2 / solid angle of the cap), which few texels reach.
        """
        peak = self._mean.max()
        if not peak > 0:
            return [], "nothing in it is above 0"
        flux, tiles = self._flux_and_squares(peak)
        squares = float(tiles.sum())
        least = ENERGY if self._plateau is None else CLIPPED_ENERGY
        dimmest = np.sqrt(least * squares / np.pi) / chord_of(CAP)
        waiting = self._brighter_than(dimmest * peak)
        found: list[CompactSource] = []
        why = ""
        for _ in range(TRIES):
            if not len(waiting) or len(found) == most:
                break
            spot = waiting[0]
            waiting = waiting[chord(waiting, spot) > chord_of(CAP)]
            if why and not self._may_hold(spot, least * squares, tiles):
                continue
            axis = self._middle(spot)
            excess, clipped = self._around(axis)
            mean, weights = excess.mean / peak, excess.texels.solid_angles
            shares = float(weights @ mean) / flux, float(weights @ mean**2) / squares
            wrong = (
                refusal(excess.core[0], np.inf, 1.0, shares[1], CLIPPED_ENERGY)
                if clipped
                else refusal(0.0, excess.contrast, *shares)
            ) or excess.goes_on * "its brightest spot is part of something larger"
            if not wrong:
                disc = excess.disc(self._layout, self.rest.shape, clipped)
                wrong = "" if clipped else refusal(disc.half_angle, excess.contrast, *shares)
                if not wrong:
                    core, texels = excess.core
                    found.append(CompactSource(disc, core, texels <= FEW_TEXELS, shares[1]))
                    self._axes.append(axis)
                    self._remove(excess)
            why = why or wrong
        return found, why or "no texel is bright enough to hold so much in so small a cap"

    def _around(self, axis: Array) -> tuple[Excess, bool]:
        """The excess around an axis, and whether it is clipped."""
        excess = Excess.around(axis, self._caps, self.rest, self._mean)
        return excess, is_clipped(excess, self._plateau, self._caps, self._mean)

    @cached_property
    def _negative(self) -> bool:
        return bool(self.rest.image.min() < 0)

    def _flux_and_squares(self, peak: np.float32) -> tuple[float, Array]:
        """The integral of |mean| / peak, and that of its square over each tile of `Caps`, in the few digits of a share."""
        height, width = self._mean.shape
        flux, squares = 0.0, np.zeros((-(-height // TILE), -(-width // TILE)))
        for row, top in enumerate(range(0, height, TILE)):
            scaled, weights = self._mean[top : top + TILE] / peak, self._solid_angles[top : top + TILE]
            flux += float((np.abs(scaled) * weights).sum(axis=1).sum(dtype=np.float64))
            columns = (scaled * scaled * weights).sum(axis=0, dtype=np.float64)
            squares[row] = np.add.reduceat(columns, np.arange(0, width, TILE))
        return flux, squares.ravel()

    def _may_hold(self, spot: Array, least: float, tiles: Array) -> bool:
        """Whether a source whose brightest texel is at `spot` may hold `least` of the squares, by those of whole tiles.

        It holds no more than all texels within reach, unless some are negative.
        """
        return self._negative or float(tiles[self._caps.touched(spot, 2 * CAP)].sum()) >= least

    def _brighter_than(self, dimmest: float) -> Array:
        """Directions (k, 3) of the texels brighter than `dimmest`, the brightest first."""
        rows, columns = np.divmod(np.flatnonzero(self._mean >= dimmest), self._mean.shape[1])
        bright = self._caps.texels(rows, columns)
        return bright.directions[np.argsort(-self._mean[bright.rows, bright.columns], kind="stable")]

    def _middle(self, peak: Array) -> Array:
        """The unit vector to the middle of all texels at least half as bright as the peak within CAP of it."""
        near = self._caps.cap(peak, CAP)
        mean = self._mean[near.rows, near.columns]
        return normalise((near.solid_angles * (mean >= mean.max() / 2)) @ near.directions)

    def _remove(self, excess: Excess) -> None:
        rows, columns = excess.texels.rows, excess.texels.columns
        self.rest = self.rest.replaced(rows, columns, excess.after)
        self._mean[rows, columns] = excess.after.mean(axis=1)
