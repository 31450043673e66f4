"""The time of a run: the seconds that each section gets, those that are left, and those that the run still takes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from time import perf_counter

Progress = Callable[[float, float, str], object]
"""A function that is told the share of the time passed, 0 to 1, the most seconds left, and the next step."""

SHARES = {"projection": 0.55, "reconstruction": 0.2, "end to end": 0.15, "peers": 0.1}
STABILITY_SECONDS = 15.0
"""The time of the hard cases, which comes on top of the budget: all of them are always run."""


def allot(wanted: Mapping[str, bool], budget: float) -> dict[str, float]:
    """Seconds for every section that is wanted, `budget` in all; projection gets the shares of sections not wanted."""
    shares = {name: share for name, share in SHARES.items() if wanted.get(name)}
    if "projection" in shares:
        shares["projection"] += 1 - sum(shares.values())
    return {name: budget * share / sum(shares.values()) for name, share in shares.items()}


class Clock:
    """Tells each section how much time it has left, and the user how much the run has.

    seconds: the time of each section. What one leaves over is added to the next, what it overruns is taken from the next.
    """

    def __init__(self, seconds: Mapping[str, float], progress: Progress | None) -> None:
        self.waiting = dict(seconds)
        self.progress = progress
        self.start = self.deadline = self.likely_end = perf_counter()
        self.current = ""

    def begin(self, section: str) -> None:
        """Begin a section; each may begin once, in any order."""
        own = self.waiting.pop(section)
        self.current = section
        self.deadline += own
        self.likely_end = min(self.deadline, perf_counter() + own)
        self.tell("")

    def left(self) -> float:
        """Seconds until the present section has to end; below zero when its time is up."""
        return self.deadline - perf_counter()

    def tell(self, what: str) -> None:
        """Tell the user what the present section does next."""
        if self.progress is None:
            return
        now = perf_counter()
        passed, left = now - self.start, max(0.0, self.likely_end - now) + sum(self.waiting.values())
        words = f"{self.current}: {what}" if what else self.current
        self.progress(passed / max(passed + left, 1e-9), left, words)

    def finish(self) -> None:
        if self.progress is not None:
            self.progress(1.0, 0.0, "done")
