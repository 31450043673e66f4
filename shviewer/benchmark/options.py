"""The options of `shviewer report`: what is measured, and the time that each section gets."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from shviewer.benchmark.measuring import experiments
from shviewer.benchmark.measuring.measured_lights import TOLERANCES
from shviewer.benchmark.measuring.reconstruction_rows import BANDS as RECONSTRUCTED
from shviewer.errors import UsageError
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.words import meant


class ReportSize(NamedTuple):
    """How much a report measures."""

    budget: float
    """Seconds of measuring. Starting, reading lights, drawing plots and writing come on top: a quick report takes 15 s."""
    lights: tuple[str, ...]
    bands: tuple[int, ...]
    samples: tuple[int, ...]
    tolerances: tuple[float, ...]
    kinds: int
    """How many lights, each of another kind, are reconstructed."""
    reconstructed: tuple[int, ...]
    """The bands of these."""
    repeats: int
    """The least repeats of what a user waits for."""


FULL = ReportSize(
    budget=120.0,
    lights=("green", "hemisphere", "sun-sky", "film_studio", "venice_sunset"),  # edges, a small source, photographs
    bands=(3, 5, 9, 16, 32),
    samples=(100, 1_000, 10_000, 100_000, 1_000_000),
    tolerances=TOLERANCES,
    kinds=2,
    reconstructed=RECONSTRUCTED,
    repeats=5,
)
QUICK = ReportSize(
    budget=11.0,
    lights=("green", "film_studio"),
    bands=(3, 9),
    samples=(100, 10_000),
    tolerances=(0.05,),
    kinds=1,
    reconstructed=(3, 16),
    repeats=3,
)

STABILITY_SECONDS = 15.0
"""The time of the hard cases, which comes on top of the budget: all of them are always run."""

MOVING_SECONDS = 60.0
"""The most time of the section on lights that move, which comes on top of the budget, too."""

SECTIONS = ("projection", "reconstruction", "end to end")
SHARES = {"projection": 0.55, "reconstruction": 0.2, "end to end": 0.15, "peers": 0.1}

Progress = Callable[[float, float, str], object]
"""A function that is told the share of the time passed, 0 to 1, the most seconds left, and the next step."""


@dataclass(frozen=True)
class Options:
    """The options of one report. UsageError for a value out of its range."""

    budget: float | None = None
    """Seconds of measuring; None for those of the size."""
    quick: bool = False
    against: Path | None = None
    stability: bool = False
    peers: bool = False
    moving: bool = False
    """Whether lights that move are measured."""
    seed: int = 0
    methods: tuple[str, ...] = ()
    """Names of experiments.METHODS; empty for all. The best way, the reference, is always added."""
    sections: tuple[str, ...] = SECTIONS
    reading: Reading = DEFAULT_READING
    """How images are read; the peers read them as they are."""
    shader: bool = True
    """Whether anything is drawn."""
    force: bool = False
    """Whether files in the folder are replaced even if this program did not write them."""
    command: str = ""
    """The command line; if empty, made from the arguments of the process."""

    def __post_init__(self) -> None:
        if self.budget is not None and not (math.isfinite(self.budget) and self.budget > 0):
            raise UsageError(f"budget {self.budget:g}: it must be a number of seconds above 0, such as 120")
        if self.seed < 0:
            raise UsageError(f"seed {self.seed}: it must be at least 0")
        for name in self.methods:
            experiments.method(name)
        for name in self.sections:
            if name not in SECTIONS:
                raise UsageError(f"section {name!r}: {meant(name, SECTIONS)}")

    @property
    def size(self) -> ReportSize:
        return QUICK if self.quick else FULL

    def seconds(self) -> dict[str, float]:
        """The seconds of every section that is wanted; projection gets the shares of those that are not."""
        wanted = (*self.sections, "peers") if self.peers else self.sections
        shares = {name: share for name, share in SHARES.items() if name in wanted}
        if "projection" in shares:
            shares["projection"] += 1 - sum(shares.values())
        budget = self.size.budget if self.budget is None else self.budget
        budget = min(budget, QUICK.budget) if self.quick else budget
        seconds = {name: budget * share / sum(shares.values()) for name, share in shares.items()}
        if self.moving:
            seconds["moving"] = min(MOVING_SECONDS, budget)
        return seconds | ({"hard cases": STABILITY_SECONDS} if self.stability else {})


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
