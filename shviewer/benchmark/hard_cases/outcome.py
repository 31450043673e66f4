"""What a hard case is, and what came of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shviewer.benchmark.hard_cases.shader import View


@dataclass(frozen=True)
class Case:
    """One row of the table: where float64 and float32 are known to go wrong, and by how much ours may be off."""

    name: str
    reference: str
    """What the right answer is and where it comes from, short."""
    bound: float
    """For what `measure` returns. The docstring of the function behind `measure` says where it comes from."""
    measure: Callable[[], float]
    """The error of the code under test, in float64."""
    views: Callable[[], Sequence[View]] | None = None
    """What the shader draws for this case; None where no shader is concerned."""


@dataclass(frozen=True)
class Outcome:
    """One measured row. Errors are in the unit of their bound; one that could not be measured is infinite."""

    name: str
    reference: str
    error: float
    bound: float
    shader_error: float | None = None
    """The same in the shader's float32, relative to the peak; None where no shader is concerned or none could run."""
    shader_bound: float | None = None
    note: str = ""
    """What went wrong, if something was raised."""
    drawn_by: str = ""
    """The OpenGL that drew, or why there was none; empty where no shader is concerned."""

    @property
    def passed(self) -> bool:
        """Within both bounds. A shader that could not run does not fail a row; the table says so instead."""
        shader = self.shader_error is None or (self.shader_bound is not None and self.shader_error <= self.shader_bound)
        return self.error <= self.bound and shader


def largest(values: ArrayLike) -> float:
    """The largest magnitude; infinity where a value is no number."""
    found = float(np.abs(np.asarray(values, dtype=np.float64)).max(initial=0.0))
    return found if np.isfinite(found) else float("inf")
