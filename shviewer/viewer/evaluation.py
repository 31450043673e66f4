"""Summed per pixel or drawn from a map: what a window's frames have cost decides, and not a guess about the machine.

A frame by direct summation takes longer with every band. One that took more than LIMIT, twice, is drawn from the map from
then on, and so is every one with more bands. The sum comes back with so few bands that it should take less than BACK, and
stays if it does: between the two nothing changes, so that no band count flickers.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

LIMIT, BACK = 16.0, 12.0
"""Milliseconds a frame."""

MEMORY = 4
"""Frames of a band count that are remembered; the fastest counts, the others were disturbed."""


@dataclass
class Evaluation:
    """How to draw the next frame, by the frames there have been."""

    costs: dict[int, deque[float]] = field(default_factory=dict)
    """Milliseconds per pixel of the direct frames with so many bands."""
    by_map: bool = False

    def choose(self, n_bands: int, pixels: float) -> bool:
        """Whether to draw from the map. pixels: that show the reconstruction or its error."""
        too_slow = [n for n, cost in self.costs.items() if min(cost) * pixels > LIMIT and len(cost) > 1]
        if any(n <= n_bands for n in too_slow):
            self.by_map = True
        elif self.by_map:
            self.by_map = self._estimate(n_bands) * pixels > BACK
        return self.by_map

    def drawn(self, n_bands: int, pixels: float, milliseconds: float) -> bool:
        """Remember a direct frame; True if it has to be drawn once more before it may be called slow."""
        costs = self.costs.setdefault(n_bands, deque(maxlen=MEMORY))
        costs.append(milliseconds / max(pixels, 1.0))
        return milliseconds > LIMIT and len(costs) < 2

    def _estimate(self, n_bands: int) -> float:
        """Milliseconds per pixel: of so many bands, or else from the nearest above as if all of it was the sum's n^2 terms."""
        above = [n for n in self.costs if n >= n_bands]
        if not above:
            return 0.0
        nearest = min(above)
        return min(self.costs[nearest]) * (n_bands / nearest) ** 2
