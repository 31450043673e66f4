"""Summed per pixel or drawn from a map: what a window's frames have cost decides, and not a guess about the machine.

A frame by direct summation takes longer with every band. Where one took more than LIMIT, twice, it is drawn from the map from
then on, and so is every one with more bands. The sum comes back with so few bands that it should take less than BACK, and stays
if it does: between the two nothing changes, so that no band count flickers. What was slow is tried again after a while, the
later the slower it was: a machine that was busy at the start is not slow for ever.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import NamedTuple

LIMIT, BACK = 16.0, 12.0
"""Milliseconds a frame."""

BELIEF = 5.0
"""Seconds for which a frame of LIMIT is held against the sum; one that took n times as long, n times as long."""

MEMORY = 4
"""Frames of a band count that are remembered; the fastest counts, the others were disturbed."""


COMPARABLE = 0.7
"""A frame says something of others with so many times its pixels or fewer: more would blow up what does not grow with them."""


class Frame(NamedTuple):
    """A direct one."""

    seconds: float
    """When."""
    pixels: float
    milliseconds: float

    def at_least(self, pixels: float) -> float:
        """What one of so many pixels takes, whatever part of this one does not depend on them."""
        return self.milliseconds * min(1.0, pixels / max(self.pixels, 1.0))


@dataclass
class Evaluation:
    """How to draw the next frame, by the frames there have been."""

    frames: dict[int, deque[Frame]] = field(default_factory=dict)
    """By the number of bands."""
    by_map: bool = False

    def choose(self, n_bands: int, pixels: float, seconds: float) -> bool:
        """Whether to draw from the map. pixels: that show the reconstruction or its error; seconds: by any clock."""
        if any(n <= n_bands and self._too_slow(n, pixels, seconds) for n in self.frames):
            self.by_map = True
        elif self.by_map:
            self.by_map = self._estimate(n_bands, pixels, seconds) > BACK
        return self.by_map

    def drawn(self, n_bands: int, pixels: float, milliseconds: float, seconds: float) -> bool:
        """Remember a direct frame; True if it has to be drawn once more before it may be called slow."""
        self.frames.setdefault(n_bands, deque(maxlen=MEMORY)).append(Frame(seconds, pixels, milliseconds))
        return milliseconds > LIMIT and len(self._comparable(n_bands, pixels)) < 2

    def _comparable(self, n_bands: int, pixels: float) -> list[Frame]:
        return [frame for frame in self.frames[n_bands] if frame.pixels >= COMPARABLE * pixels]

    def _cost(self, n_bands: int, pixels: float, seconds: float) -> float:
        """Milliseconds with so many bands, at least; 0 where nothing is known, or no more believed."""
        frames = self._comparable(n_bands, pixels)
        cost = min((frame.at_least(pixels) for frame in frames), default=0.0)
        return cost if frames and seconds - frames[-1].seconds < BELIEF * cost / LIMIT else 0.0

    def _too_slow(self, n_bands: int, pixels: float, seconds: float) -> bool:
        return len(self._comparable(n_bands, pixels)) > 1 and self._cost(n_bands, pixels, seconds) > LIMIT

    def _estimate(self, n_bands: int, pixels: float, seconds: float) -> float:
        """Milliseconds with so many bands, or from the nearest count above as if all of it was the sum's n^2 terms."""
        costs = {n: self._cost(n, pixels, seconds) for n in self.frames if n >= n_bands}
        known = [n for n, cost in costs.items() if cost > 0]
        return costs[min(known)] * (n_bands / min(known)) ** 2 if known else 0.0
