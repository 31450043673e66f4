"""The options of `shviewer report`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from shviewer.benchmark import experiments
from shviewer.errors import UsageError
from shviewer.lights.reading import DEFAULT_READING, Reading

DEFAULT_BUDGET, QUICK_BUDGET = 120.0, 11.0
"""Seconds of measuring. Starting, reading lights, drawing plots and writing come on top: a quick report takes 15 s."""

SECTIONS = ("projection", "reconstruction", "end to end")


@dataclass(frozen=True)
class Options:
    """The options of one report. UsageError for a value out of its range."""

    budget: float = DEFAULT_BUDGET
    """Seconds of measuring."""
    quick: bool = False
    against: Path | None = None
    stability: bool = False
    peers: bool = False
    seed: int = 0
    methods: tuple[str, ...] = ()
    """Names of experiments.METHODS; empty for all. The best way, the reference, is always added."""
    sections: tuple[str, ...] = SECTIONS
    reading: Reading = DEFAULT_READING
    """How images are read; the peers read them as they are."""
    shader: bool = True
    """Whether anything is drawn."""
    command: str = ""
    """The command line; if empty, made from the arguments of the process."""

    def __post_init__(self) -> None:
        if not (math.isfinite(self.budget) and self.budget > 0):
            raise UsageError(f"budget {self.budget:g}: it must be a number of seconds above 0, such as 120")
        if self.seed < 0:
            raise UsageError(f"seed {self.seed}: it must be at least 0")
        for name in self.methods:
            experiments.method(name)
        for name in self.sections:
            if name not in SECTIONS:
                raise UsageError(f"unknown section {name!r}; there is: {', '.join(SECTIONS)}")

    @property
    def seconds(self) -> float:
        return min(self.budget, QUICK_BUDGET) if self.quick else self.budget
