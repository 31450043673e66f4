"""The radiance of a compact source: what rises above its surroundings.

A source is the radiance that rises above its surroundings within CAP of its middle, which is the middle of all texels at least
half as bright as its peak. The surroundings are the ring beyond, out to RING; their level is the radiance that LEVEL of the
ring stays below, per channel. Texels above that level are lowered to it. Texels below 0 are raised to 0: beside a sun they are
the ringing of the filter that resized the image, and belong to the sun. No other texel changes, nor any channel that would
gain flux.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.suns.caps import Caps, Texels, chord, chord_of
from shviewer.lights.suns.patched import Patched
from shviewer.lights.suns.sun import Sun

CAP = np.radians(3.0)
RIM = np.radians(4.0)
RING = np.radians(6.0)
LEVEL = 0.9


@dataclass(frozen=True, eq=False)
class Excess:
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

    @classmethod
    def around(cls, axis: Array, caps: Caps, pixels: Patched, mean: NDArray[np.float32]) -> Excess:
        """The excess within CAP of `axis` (3,).

        mean: of the three channels of `pixels`, (height, width), 0 for texels that show nothing.
        """
        near = caps.cap(axis, RING)
        cap, ring = near.within(axis, -1, CAP), near.within(axis, CAP, RING)
        around = pixels.at(ring.rows, ring.columns)
        level = np.array([_quantile(channel, ring.solid_angles, LEVEL) for channel in around.T], dtype=np.float32)
        level = np.maximum(level, 0)
        before = pixels.at(cap.rows, cap.columns)
        after = np.clip(before, 0, level)
        unwilling = cap.solid_angles @ (before.astype(np.float64) - after) <= 0
        after[:, unwilling] = before[:, unwilling]
        rim = mean[ring.rows, ring.columns][chord(ring.directions, axis) <= chord_of(RIM)]
        return cls(axis, cap, before, after, level.astype(np.float64), float(rim.max(initial=-np.inf)))

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

    def disc(self, layout: Layout, shape: tuple[int, ...], clipped: bool) -> Sun:
        """The disc with bands 0 and 1 of the radiance taken, by exact integrals over its texels, in an image of that shape."""
        some = self.taken.any(axis=1)
        rows, columns = self.texels.rows[some], self.texels.columns[some]
        taken = self.taken[some] / np.abs(self.taken).max()
        coefficients = layout.project_texels(taken, rows, columns, 2)
        if coefficients is None:
            alone = np.zeros(shape, dtype=np.float32)
            alone[rows, columns] = taken
            coefficients = layout.project(alone, 2)
        bands = coefficients.mean(axis=1)
        vector = np.array([-bands[3], -bands[1], bands[2]]) / np.sqrt(3)  # in units of band 0
        length = float(np.linalg.norm(vector))
        smallest = float(self.texels.solid_angles[self.mean.argmax()]) / (4 * np.pi)
        half_angle = float(2 * np.arcsin(np.sqrt(min(1.0, max(1 - length / bands[0], smallest)))))
        return Sun(vector / length, half_angle, self.flux / (4 * np.pi * np.sin(half_angle / 2) ** 2), clipped)


def _quantile(values: NDArray[np.float32], weights: Array, share: float) -> float:
    """The smallest value that `share` of the weight does not exceed; infinite without values."""
    if not len(values):
        return np.inf
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(below, share * below[-1])]])
