"""The beat of a sweep that plays: when it takes its next step. Pure arithmetic, which is told the time and asks no clock."""

from __future__ import annotations

SWEEP_SECONDS = 0.7
"""How long a sweep shows each band count: long enough to read the error."""


TURN_FRAMES = 72
TURN_SECONDS = 0.08
"""How long a turn shows a frame: once round in 5.8 s, at TURN_STEP degrees a frame."""

TURN_STEP = 360 / TURN_FRAMES
"""Degrees from frame to frame of a light that turns in the window, which leaves none out, however long one takes."""


class Metronome:
    """A beat every so many seconds while something plays, the first one a whole period after it began.

    A beat that comes late, because a frame took long, delays all later ones: none is hurried and none left out.
    """

    def __init__(self, seconds: float = SWEEP_SECONDS) -> None:
        self.seconds = seconds
        self.due: float | None = None
        """When the next beat is, on the clock of `now`; None while nothing plays."""

    def beats(self, playing: bool, now: float) -> bool:
        """Whether it is time for a step."""
        if not playing:
            self.due = None
            return False
        beat = self.due is not None and now >= self.due
        if beat or self.due is None:
            self.due = now + self.seconds
        return beat

    def wait(self, now: float, longest: float) -> float:
        """Seconds to sleep until the next beat, but at most `longest`."""
        return longest if self.due is None else min(max(self.due - now, 0.0), longest)
