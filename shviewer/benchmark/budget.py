"""Who gets how much of a budget, and an honest word on how long it will still take."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from time import perf_counter

Progress = Callable[[float, float, str], object]
"""Told the share that is done, 0 to 1, the seconds that are left, and what comes next."""

SHARES = {"projection": 0.55, "reconstruction": 0.2, "end to end": 0.15, "peers": 0.1}
STABILITY_SECONDS = 15.0
"""Beside the budget: the hard cases are what they are."""

LEAST_KNOWN = 1.0
"""Seconds that have to pass before the machine's pace is believed."""


def allot(wanted: Mapping[str, bool], budget: float) -> dict[str, float]:
    """Seconds of every section that is wanted, `budget` in all; projection gets the shares of those that are not."""
    shares = {name: share for name, share in SHARES.items() if wanted.get(name)}
    if "projection" in shares:
        shares["projection"] += 1 - sum(shares.values())
    return {name: budget * share / sum(shares.values()) for name, share in shares.items()}


class Clock:
    """Turns the sections' own progress into that of the whole."""

    def __init__(self, seconds: Mapping[str, float], progress: Progress | None) -> None:
        self.seconds = dict(seconds)
        self.progress = progress
        self.start = perf_counter()
        self.done = 0.0
        self.current = ""
        self.current_start = self.start

    def elapsed(self) -> float:
        """Seconds since the beginning."""
        return perf_counter() - self.start

    def pace(self) -> float:
        """How many times as long as planned the finished sections took; at least 1."""
        return max(1.0, (self.current_start - self.start) / self.done) if self.done else 1.0

    def begin(self, section: str) -> None:
        """Section by section, in any order; each once."""
        self.done += self.seconds.pop(self.current, 0.0)
        self.current, self.current_start = section, perf_counter()
        self.tell(0.0, "")

    def expect(self, seconds: float) -> None:
        """The present section will take so long."""
        self.seconds[self.current] = seconds

    def tell(self, share: float, what: str) -> None:
        """How much of the present section is done, 0 to 1, and what it does next.

        What is left of it goes on at its own pace, once there is one; the other sections take what they were given.
        """
        if self.progress is None:
            return
        planned, elapsed = self.seconds.get(self.current, 0.0), perf_counter() - self.current_start
        known = share > 0 and elapsed > LEAST_KNOWN
        rest = elapsed * (1 - share) / share if known else planned * (1 - share)
        later = sum(seconds for name, seconds in self.seconds.items() if name != self.current)
        passed = self.elapsed()
        left = rest + later
        words = f"{self.current}: {what}" if what else self.current
        self.progress(passed / max(passed + left, 1e-9), left, words)

    def finish(self) -> None:
        if self.progress is not None:
            self.progress(1.0, 0.0, "done")
