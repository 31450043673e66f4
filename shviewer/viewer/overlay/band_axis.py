"""The axis of bands that the bars and the convergence plot share: how many bands it shows, and which it numbers."""

from __future__ import annotations

from dataclasses import dataclass

SLOT_COUNTS = (10, 16, 32, 64, 128)
"""Bands shown: the smallest of these that holds the bands in use, so that a band stays where it is while keys are pressed."""


def band_slots(n_bands: int) -> int:
    """How many bands are shown while `n_bands` are in use."""
    return next((count for count in SLOT_COUNTS if count >= n_bands), SLOT_COUNTS[-1])


def band_step(pitch: float, apart: float) -> int:
    """The step between numbered bands: the least for which bands `pitch` pixels apart have numbers `apart` pixels apart."""
    return next(step for step in (1, 2, 4, 8, 16, 32) if pitch * step > apart or step == 32)


@dataclass(frozen=True)
class BandAxis:
    """Linear in the number of bands n: 0 stands at pixel `start`, `slots` at `end`. Band l lies between n = l and l + 1."""

    slots: int
    start: float
    end: float

    @property
    def pitch(self) -> float:
        return (self.end - self.start) / self.slots

    def at(self, n_bands: float) -> float:
        """The pixel of a number of bands."""
        return self.start + n_bands * self.pitch

    def ticks(self, apart: float) -> list[int]:
        """Round band counts that stand at least `apart` pixels from each other."""
        return list(range(0, self.slots + 1, band_step(self.pitch, apart)))
