"""The seconds of a run: how many each section gets, what is left of them, and how long it will still take."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from time import perf_counter

Progress = Callable[[float, float, str], object]
"""Told the share of the time that has passed, 0 to 1, the seconds that are left at most, and what comes next."""

SHARES = {"projection": 0.55, "reconstruction": 0.2, "end to end": 0.15, "peers": 0.1}
STABILITY_SECONDS = 15.0
"""Beside the budget: the hard cases are what they are."""


def allot(wanted: Mapping[str, bool], budget: float) -> dict[str, float]:
    """Seconds of every section that is wanted, `budget` in all; projection gets the shares of those that are not."""
    shares = {name: share for name, share in SHARES.items() if wanted.get(name)}
    if "projection" in shares:
        shares["projection"] += 1 - sum(shares.values())
    return {name: budget * share / sum(shares.values()) for name, share in shares.items()}


class Clock:
    """Tells each section how much time it has left, and the user how much the run has.

    seconds: of each section. What one of them leaves over, or takes too much, is added to or taken from the next.
    """

    def __init__(self, seconds: Mapping[str, float], progress: Progress | None) -> None:
        self.waiting = dict(seconds)
        self.progress = progress
        self.start = self.deadline = self.likely_end = perf_counter()
        self.current = ""

    def begin(self, section: str) -> None:
        """Section by section, in any order; each once."""
        own = self.waiting.pop(section)
        self.current = section
        self.deadline += own
        self.likely_end = min(self.deadline, perf_counter() + own)
        self.tell("")

    def left(self) -> float:
        """Seconds until the present section has to end; below zero when its time is up."""
        return self.deadline - perf_counter()

    def tell(self, what: str) -> None:
        """What the present section does next."""
        if self.progress is None:
            return
        now = perf_counter()
        passed, left = now - self.start, max(0.0, self.likely_end - now) + sum(self.waiting.values())
        words = f"{self.current}: {what}" if what else self.current
        self.progress(passed / max(passed + left, 1e-9), left, words)

    def finish(self) -> None:
        if self.progress is not None:
            self.progress(1.0, 0.0, "done")
