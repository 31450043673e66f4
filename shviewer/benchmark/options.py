"""What `shviewer report` can be asked for."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from shviewer.benchmark import experiments
from shviewer.errors import UsageError
from shviewer.lights.reading import DEFAULT_READING, Reading

DEFAULT_BUDGET, QUICK_BUDGET = 120.0, 11.0
"""Seconds of measuring. Starting, reading lights, drawing plots and writing come on top: with the latter 15 s in all."""

SECTIONS = ("projection", "reconstruction", "end to end")


@dataclass(frozen=True)
class Options:
    """What `shviewer report` was asked for. UsageError for a value out of its range."""

    budget: float = DEFAULT_BUDGET
    """Seconds."""
    quick: bool = False
    against: Path | None = None
    stability: bool = False
    peers: bool = False
    seed: int = 0
    methods: tuple[str, ...] = ()
    """Names of experiments.METHODS; none for all. The best way is always among them: it is the reference."""
    sections: tuple[str, ...] = SECTIONS
    reading: Reading = DEFAULT_READING
    """How images are read; the peers read them as they are."""
    shader: bool = True
    """False: nothing is drawn."""
    command: str = ""
    """What was typed; made up from the arguments of the process if empty."""

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
