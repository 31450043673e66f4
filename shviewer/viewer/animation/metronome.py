"""The beat of what plays: when it takes its next step. Pure arithmetic, which is told the time and asks no clock."""

from __future__ import annotations

from collections import deque

SWEEP_SECONDS = 0.7
"""How long a sweep shows each band count: long enough to read the error."""


TURN_FRAMES = 72
TURN_SECONDS = 0.08
"""How long a turn shows a frame: once round in 5.8 s, at TURN_STEP degrees a frame."""

TURN_STEP = 360 / TURN_FRAMES
"""Degrees from frame to frame of a light that turns in the window, which leaves none out, however long one takes."""


KEEPS_UP = 0.8
"""The share of the steps that are due, above which nothing is said of how many there are."""

RECENT = 6
"""The number of steps that a pace is taken from."""


class Metronome:
    """A beat every so many seconds while something plays, the first one a whole period after it began.

    A beat that comes late, because a frame took long, delays all later ones: none is hurried and none left out.
    """

    def __init__(self) -> None:
        self._seconds: float | None = None
        self._due: float | None = None
        """When the next beat is, on the clock of `now`; None while nothing plays."""
        self._beats: deque[float] = deque(maxlen=RECENT)

    def beats(self, seconds: float | None, now: float, *, ready: bool = True) -> bool:
        """Whether it is time for a step of what plays with this period (None: nothing), and one can be taken."""
        if seconds != self._seconds:
            self._seconds, self._due = seconds, None
            self._beats.clear()
        if seconds is None or not ready:
            return False
        beat = self._due is not None and now >= self._due
        if beat:
            self._beats.append(now)
        if beat or self._due is None:
            self._due = now + seconds
        return beat

    def wait(self, now: float, longest: float) -> float:
        """Seconds to sleep until the next beat, but at most `longest`."""
        return longest if self._due is None else min(max(self._due - now, 0.0), longest)

    @property
    def pace(self) -> float | None:
        """Steps a second, where they cannot keep up with the beat; None as long as they do, or too little is known."""
        if len(self._beats) < RECENT or self._seconds is None:
            return None
        pace = (len(self._beats) - 1) / (self._beats[-1] - self._beats[0])
        return pace if pace < KEEPS_UP / self._seconds else None
