"""Compact sources: the rule for them, and taking them out of an image.

A source is compact if it is, in the mean of the three channels,
    narrow      a half-angle of at most WIDEST,
    bright      a peak at least CONTRAST times as bright as what surrounds it,
    alone       nothing half as bright between CAP and RIM: it would be a piece of something longer, or one of a group,
    worth it    at least FLUX of the image's flux and ENERGY of its ||f||^2, as both are when the source's turn comes.
The brightest goes first, up to MOST, until none is left. Everything within one cap of CAP leaves as one source.

A source is *clipped* if it ends in a plateau: PLATEAU or more texels at the image's highest value in some channel, most of
all such texels, in a glow that has GLOW of the peak beyond the texels that its edge crosses, as no disc has, and that falls by
FALL towards FAR. Of a clipped source the file has kept too little, and its glow is its surroundings. So it is narrow if the
plateau is, bright against what is beyond FAR, and worth it with CLIPPED_ENERGY of ||f||^2.

A source is the radiance that rises above its surroundings within CAP of its middle, which is the middle of all texels at least
half as bright as its peak. The surroundings are the ring beyond, out to RING; their level is the radiance that LEVEL of the
ring stays below, per channel. Texels above that level are lowered to it. Texels below 0 are raised to 0: beside a sun they are
the ringing of the filter that resized the image, and belong to the sun. No other texel changes, nor any channel that would
gain flux.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, normalise
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.suns.caps import TILE, Caps, Texels, chord, chord_of
from shviewer.lights.suns.rule import CONTRAST, ENERGY, FEW_TEXELS, MOST, Found, refusal
from shviewer.lights.suns.sun import Sun

CAP = np.radians(3.0)
RIM = np.radians(4.0)
RING = np.radians(6.0)
LEVEL = 0.9

PLATEAU = 2
GLOW, FALL = 0.01, 2.0
FAR, FARTHEST = np.radians(10.0), np.radians(15.0)
CLIPPED_ENERGY = 0.01

BLOCK_VALUES = 2**18
"""Texels whose flux is summed at a time."""

TRIES = 32
"""How many bright spots are looked at before flux and energy of the rest are computed anew."""


@dataclass(frozen=True, eq=False)
class _Excess:
    """The texels that rise above their surroundings around an axis, before and after they are taken out."""

    axis: Array
    texels: Texels
    before: NDArray[np.float32]
    after: NDArray[np.float32]
    """Values of the texels, (k, 3), now and with the source taken out."""
    level: Array
    """The radiance that LEVEL of the ring beyond stays below, (3,)."""
    rim: float
    """The largest mean of the channels between CAP and RIM."""

    @cached_property
    def taken(self) -> Array:
        """The radiance taken from each texel, (k, 3): exact, as differences of float32 values."""
        return self.before.astype(np.float64) - self.after

    @cached_property
    def mean(self) -> Array:
        """The mean of the three channels of `taken`, (k,)."""
        return np.asarray(self.taken.mean(axis=1))

    @cached_property
    def bright(self) -> Array:
        """The mean of the three channels before, (k,)."""
        return np.asarray(self.before.mean(axis=1, dtype=np.float64))

    @cached_property
    def core(self) -> tuple[float, int]:
        """The half-angle of a disc as large as the texels at least half as bright as the peak, and how many they are."""
        half = self.bright >= self.bright.max() / 2
        solid_angle = float(self.texels.solid_angles[half].sum())
        return float(2 * np.arcsin(np.sqrt(min(1.0, solid_angle / (4 * np.pi))))), int(half.sum())

    @property
    def contrast(self) -> float:
        """The peak divided by the level; infinite in front of black."""
        level = float(self.level.mean())
        return 1 + float(self.mean.max()) / level if level > 0 else np.inf

    @property
    def goes_on(self) -> bool:
        return self.rim >= (float(self.mean.max()) + float(self.level.mean())) / 2

    @property
    def flux(self) -> Array:
        """The flux taken, (3,)."""
        return np.asarray(self.texels.solid_angles @ self.taken)


class CompactSources:
    """An image while its compact sources are being taken out; `pixels` (height, width, 3) are what is left."""

    def __init__(self, pixels: NDArray[np.float32], layout: Layout) -> None:
        self.pixels = self._given = pixels
        self._layout = layout
        self._solid_angles = layout.solid_angles().astype(np.float32)
        self._mean = self._mean_of_channels(slice(None))
        self._caps = Caps(layout, *self.pixels.shape[:2])
        self._plateau = self._highest()
        self._axes: list[Array] = []
        self.changed = np.zeros(len(pixels), dtype=bool)
        """The rows (height,) of which something was taken."""

    def take_all(self) -> tuple[list[Found], str]:
        """Take all sources out; return them and the reason why there are no more."""
        sources: list[Found] = []
        while True:
            found, why = self._take_brightest(MOST - len(sources))
            sources += found
            if not found or len(sources) == MOST:
                return sources, why

    def keep(self, taken: list[int]) -> list[Sun]:
        """Take only some of the sources that were found, by their indices, out of the image as it was; return them."""
        if self.pixels is not self._given:
            self.pixels[self.changed] = self._given[self.changed]
            self._mean[self.changed] = self._mean_of_channels(self.changed)
        self.changed[:] = False
        suns = []
        for i in taken:
            excess = self._excess(self._axes[i])
            suns.append(replace(self._disc(excess), clipped=self._clipped(excess)))
            self._remove(excess)
        return suns

    def _mean_of_channels(self, rows: slice | NDArray[np.bool_]) -> NDArray[np.float32]:
        """(rows, width), 0 for a texel that shows nothing."""
        mean: NDArray[np.float32] = self.pixels[rows] @ np.full(3, 1 / 3, dtype=np.float32)
        mean *= self._solid_angles[rows] > 0
        return mean

    def _highest(self) -> Texels | None:
        """The texels at the highest value of a channel, if there are so few and so many that they can be a clipped sun."""
        height, width = self.pixels.shape[:2]
        flat = self.pixels.reshape(height, -1)
        ceiling = flat.max(axis=0).reshape(-1, 3).max(axis=0)
        wanted = np.tile(np.where(ceiling > 0, ceiling, np.nan), width).astype(np.float32)
        rows, columns = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
        found, block = 0, max(1, BLOCK_VALUES // width)
        for top in range(0, height, block):
            there = flat[top : top + block] == wanted
            if there.any():
                row, column = np.nonzero(there.reshape(len(there), width, 3).any(axis=2))
                rows.append(row + top)
                columns.append(column)
                found += len(row)
            if found > height * width // 8:
                return None
        return self._caps.texels(np.concatenate(rows), np.concatenate(columns)) if found >= PLATEAU else None

    def _take_brightest(self, most: int) -> tuple[list[Found], str]:
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
        found: list[Found] = []
        why = ""
        for _ in range(TRIES):
            if not len(waiting) or len(found) == most:
                break
            spot = waiting[0]
            waiting = waiting[chord(waiting, spot) > chord_of(CAP)]
            if why and not self._may_hold(spot, least * squares, tiles):
                continue
            axis = self._middle(spot)
            excess = self._excess(axis)
            mean, weights = excess.mean / peak, excess.texels.solid_angles
            shares = float(weights @ mean) / flux, float(weights @ mean**2) / squares
            clipped = self._clipped(excess)
            wrong = (
                refusal(excess.core[0], np.inf, 1.0, shares[1], CLIPPED_ENERGY)
                if clipped
                else refusal(0.0, excess.contrast, *shares)
            ) or excess.goes_on * "its brightest spot is part of something larger"
            if not wrong:
                disc = self._disc(excess)
                wrong = "" if clipped else refusal(disc.half_angle, excess.contrast, *shares)
                if not wrong:
                    core, texels = excess.core
                    found.append(Found(replace(disc, clipped=clipped), core, texels <= FEW_TEXELS, shares[1]))
                    self._axes.append(axis)
                    self._remove(excess)
            why = why or wrong
        return found, why or "no texel is bright enough to hold so much in so small a cap"

    def _clipped(self, excess: _Excess) -> bool:
        """Whether a source is clipped in the file, as the module docstring has it."""
        plateau = self._plateau
        if plateau is None:
            return False
        here = plateau.within(excess.axis, -1, CAP)
        if len(here.rows) < PLATEAU or here.solid_angles.sum() < plateau.solid_angles.sum() / 2:
            return False
        peak, (core, texels) = float(excess.bright.max()), excess.core
        around = self._caps.cap(excess.axis, FARTHEST)
        far = around.within(excess.axis, FAR, FARTHEST)
        beyond = float(np.median(self._mean[far.rows, far.columns])) if len(far.rows) else 0.0
        size = 2 * core / np.sqrt(texels)  # of a texel, about
        edge = core + 0.8 * size  # an edge crosses texels whose centres are up to half a diagonal beyond it
        near, farther = (
            self._average(around.within(excess.axis, *ring)) - beyond
            for ring in ((edge, edge + max(core, 2 * size)), (FAR / 2, FAR))
        )
        return peak >= CONTRAST * beyond and near >= max(GLOW * (peak - beyond), FALL * farther)

    @cached_property
    def _negative(self) -> bool:
        return bool(self._given.min() < 0)

    def _average(self, texels: Texels) -> float:
        """The mean radiance of texels and channels; 0 of none."""
        total = float(texels.solid_angles.sum())
        return float(texels.solid_angles @ self._mean[texels.rows, texels.columns]) / total if total else 0.0

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

    def _excess(self, axis: Array) -> _Excess:
        """The texels that rise above their surroundings within CAP of `axis`."""
        near = self._caps.cap(axis, RING)
        cap, ring = near.within(axis, -1, CAP), near.within(axis, CAP, RING)
        around = self.pixels[ring.rows, ring.columns]
        level = np.array([_quantile(channel, ring.solid_angles, LEVEL) for channel in around.T], dtype=np.float32)
        level = np.maximum(level, 0)
        before = self.pixels[cap.rows, cap.columns]
        after = np.clip(before, 0, level)
        unwilling = cap.solid_angles @ (before.astype(np.float64) - after) <= 0
        after[:, unwilling] = before[:, unwilling]
        rim = self._mean[ring.rows, ring.columns][chord(ring.directions, axis) <= chord_of(RIM)]
        return _Excess(axis, cap, before, after, level.astype(np.float64), float(rim.max(initial=-np.inf)))

    def _disc(self, excess: _Excess) -> Sun:
        """The disc with bands 0 and 1 of the radiance taken, by the layout's exact integrals over its texels."""
        rows, columns = excess.texels.rows, excess.texels.columns
        scale = np.abs(excess.taken).max()
        alone = np.zeros(self.pixels.shape, dtype=np.float32)  # memory pages that stay zero take no memory
        alone[rows, columns] = (excess.taken / scale).astype(np.float32)
        if isinstance(self._layout, LatLongLayout):
            some = slice(int(rows.min()), int(rows.max()) + 1)
            bands = self._layout.project_rows(alone[some], some.start, 2).mean(axis=1)
        else:
            bands = self._layout.project(alone, 2).mean(axis=1)
        vector = np.array([-bands[3], -bands[1], bands[2]]) / np.sqrt(3)  # in units of band 0
        length = float(np.linalg.norm(vector))
        smallest = float(excess.texels.solid_angles[excess.mean.argmax()]) / (4 * np.pi)
        half_angle = float(2 * np.arcsin(np.sqrt(min(1.0, max(1 - length / bands[0], smallest)))))
        return Sun(vector / length, half_angle, excess.flux / (4 * np.pi * np.sin(half_angle / 2) ** 2))

    def _remove(self, excess: _Excess) -> None:
        rows, columns = excess.texels.rows, excess.texels.columns
        if self.pixels is self._given:
            self.pixels = self._given.copy()
        self.pixels[rows, columns] = excess.after
        self.changed[rows] = True
        self._mean[rows, columns] = excess.after.mean(axis=1)


def _quantile(values: NDArray[np.float32], weights: Array, share: float) -> float:
    """The smallest value that `share` of the weight does not exceed; infinite without values."""
    if not len(values):
        return np.inf
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(below, share * below[-1])]])
