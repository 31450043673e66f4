"""A hard case, and the outcome of measuring it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import wraps
from typing import ParamSpec

import numpy as np
from numpy.typing import ArrayLike

from shviewer.benchmark.hard_cases.shader import DrawnSum

P = ParamSpec("P")


@dataclass(frozen=True)
class Case:
    """One row of the table: a case in which float64 and float32 are known to go wrong, and a bound for our error."""

    name: str
    reference: str
    """The right answer and where it comes from, in a few words."""
    bound: float
    """The bound for the result of `measure`. The docstring of the function behind `measure` says where it comes from."""
    measure: Callable[[], float]
    """The error of the code under test, in float64."""
    views: Callable[[], Sequence[DrawnSum]] | None = None
    """The views that the shader draws for this case; None if no shader is concerned."""


@dataclass(frozen=True)
class Outcome:
    """One measured row. Errors are in the unit of their bound; an error that could not be measured is infinite."""

    name: str
    reference: str
    error: float
    bound: float
    shader_error: float | None = None
    """The error in the shader's float32, relative to the peak; None if no shader is concerned or none could run."""
    shader_bound: float | None = None
    note: str = ""
    """The exception, if one was raised."""
    drawn_by: str = ""
    """The OpenGL that drew, or why there was none; empty if no shader is concerned."""

    @property
    def passed(self) -> bool:
        """Whether both errors are within their bounds. A shader that could not run fails no row; the table then says so."""
        shader = self.shader_error is None or (self.shader_bound is not None and self.shader_error <= self.shader_bound)
        return self.error <= self.bound and shader


def largest(values: ArrayLike) -> float:
    """The largest magnitude; infinity if a value is NaN."""
    found = float(np.abs(np.asarray(values, dtype=np.float64)).max(initial=0.0))
    return found if np.isfinite(found) else float("inf")


def worst(errors: Callable[P, Iterable[ArrayLike]]) -> Callable[P, float]:
    """Decorator: the largest magnitude of all errors that the function yields; infinity if one is NaN."""

    @wraps(errors)
    def measured(*arguments: P.args, **options: P.kwargs) -> float:
        return max(map(largest, errors(*arguments, **options)), default=0.0)

    return measured
