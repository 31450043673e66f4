"""When a light that turns in the window takes its next step: as often as in a file, but not before the last is projected."""

from __future__ import annotations

from collections import deque

from shviewer.viewer.animation.metronome import TURN_SECONDS, Metronome

KEEPS_UP = 0.8
"""The share of the frames that are due, above which nothing is said of how many there are."""

RECENT = 6
"""The number of steps that a pace is taken from."""


class Turning:
    """The beat of the steps, and how many there are a second."""

    def __init__(self) -> None:
        self._metronome = Metronome(TURN_SECONDS)
        self._steps: deque[float] = deque(maxlen=RECENT)

    def beats(self, playing: bool, now: float, *, ready: bool) -> bool:
        """Whether it is time for a step; ready: whether the picture of the last one is there."""
        if not playing:
            self._steps.clear()
        if (playing and not ready) or not self._metronome.beats(playing, now):
            return False
        self._steps.append(now)
        return True

    def wait(self, now: float, longest: float) -> float:
        """As `Metronome.wait`."""
        return self._metronome.wait(now, longest)

    @property
    def pace(self) -> float | None:
        """Steps a second, where it cannot keep up; None as long as it does, or too little is known."""
        if len(self._steps) < RECENT:
            return None
        pace = (len(self._steps) - 1) / (self._steps[-1] - self._steps[0])
        return pace if pace < KEEPS_UP / TURN_SECONDS else None
