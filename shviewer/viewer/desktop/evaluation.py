"""The choice between summing per pixel and drawing from a map, by the times that a window's frames have taken.

A frame by direct summation takes longer with every band. Where one took more than LIMIT, twice, it is drawn from the map from
then on, and so is every frame with more bands. The sum comes back at a band count with which it should take less than BACK,
and stays if it does. Between the two limits nothing changes, so that no band count flickers. A slow count is tried again after
a while, the later the slower it was: a machine that was busy at the start is not slow for ever.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import NamedTuple

LIMIT, BACK = 16.0, 12.0
"""Milliseconds of a frame: above the first the sum is too slow, below the second it is fast enough again."""

BELIEF = 5.0
"""Seconds for which a frame that took LIMIT counts against the sum; one that took n times as long counts n times longer."""

MEMORY = 4
"""How many frames of a band count are remembered; the fastest counts, since the others were disturbed."""


COMPARABLE = 0.7
"""The least share of the present frame's pixels that a frame must have to say something about its time."""


class Timed(NamedTuple):
    """A frame that was summed per pixel, and how long it took."""

    seconds: float
    """When it was drawn, on any clock."""
    pixels: float
    milliseconds: float

    def at_least(self, pixels: float) -> float:
        """Milliseconds that a frame of `pixels` takes at least, whatever part of the time does not depend on pixels."""
        return self.milliseconds * min(1.0, pixels / max(self.pixels, 1.0))


@dataclass
class Evaluation:
    """The choice for the next frame, from the frames before it."""

    frames: dict[int, deque[Timed]] = field(default_factory=dict)
    """Number of bands -> the frames remembered."""
    by_map: bool = False

    def choose(self, n_bands: int, pixels: float, seconds: float) -> bool:
        """Whether to draw from the map. pixels: how many show the reconstruction or its error; seconds: on any clock."""
        if self.too_slow(n_bands, pixels, seconds):
            self.by_map = True
        elif self.by_map:
            self.by_map = self._estimate(n_bands, pixels, seconds) > BACK
        return self.by_map

    def drawn(self, n_bands: int, pixels: float, milliseconds: float, seconds: float, *, sure: bool = False) -> bool:
        """Remember a direct frame; True if it has to be drawn once more before it may be called slow.

        sure: whether nothing but the sum has taken so long.
        """
        frames = self.frames.setdefault(n_bands, deque(maxlen=MEMORY))
        frames += [Timed(seconds, pixels, milliseconds)] * (2 if sure else 1)
        return milliseconds > LIMIT and len(self._comparable(n_bands, pixels)) < 2

    def too_slow(self, n_bands: int, pixels: float, seconds: float) -> bool:
        """Whether a direct frame is known to take too long."""
        return any(n <= n_bands and self._too_slow(n, pixels, seconds) for n in self.frames)

    def _comparable(self, n_bands: int, pixels: float) -> list[Timed]:
        return [frame for frame in self.frames[n_bands] if frame.pixels >= COMPARABLE * pixels]

    def _cost(self, n_bands: int, pixels: float, seconds: float) -> float:
        """A lower bound of the milliseconds with `n_bands` bands; 0 where nothing is known or still believed."""
        frames = self._comparable(n_bands, pixels)
        cost = min((frame.at_least(pixels) for frame in frames), default=0.0)
        return cost if frames and seconds - frames[-1].seconds < BELIEF * cost / LIMIT else 0.0

    def _too_slow(self, n_bands: int, pixels: float, seconds: float) -> bool:
        return len(self._comparable(n_bands, pixels)) > 1 and self._cost(n_bands, pixels, seconds) > LIMIT

    def _estimate(self, n_bands: int, pixels: float, seconds: float) -> float:
        """Milliseconds with `n_bands` bands, or scaled from the nearest count above as if all time went to the n^2 terms."""
        costs = {n: self._cost(n, pixels, seconds) for n in self.frames if n >= n_bands}
        known = [n for n, cost in costs.items() if cost > 0]
        return costs[min(known)] * (n_bands / min(known)) ** 2 if known else 0.0
