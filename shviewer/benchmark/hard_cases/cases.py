"""The list of all hard cases, and a function that runs them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shviewer.benchmark.hard_cases import evaluation, identities, projecting, radiances, ringing, rotating
from shviewer.benchmark.hard_cases.outcome import Case, Outcome, largest
from shviewer.benchmark.hard_cases.shader import Shader, bound, shader_or_reason

CASES: tuple[Case, ...] = (
    *evaluation.CASES,
    *identities.CASES,
    *projecting.CASES,
    *radiances.CASES,
    *rotating.CASES,
    *ringing.CASES,
)


def run(*, progress: Callable[[str], None] | None = None, shader: bool = True) -> list[Outcome]:
    """Measure every case; `progress` is told each name first. A case that raises an exception becomes a failed row.

    shader: also draw the cases that concern the fragment shader, if there is an OpenGL without display.
    """
    outcomes = []
    with shader_or_reason(shader) as drawing:
        for case in CASES:
            if progress is not None:
                progress(case.name)
            outcomes.append(measure(case, drawing))
    return outcomes


def measure(case: Case, drawing: Shader | str) -> Outcome:
    """Measure one case. drawing: the shader, or why there is none. Overflow, division by zero and NaN count as exceptions."""
    error, notes = float("inf"), []
    try:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            error = largest(case.measure())
    except Exception as problem:
        notes.append(f"{type(problem).__name__}: {problem}")
    shader_error = shader_bound = None
    if case.views is not None and isinstance(drawing, Shader):
        shader_error = shader_bound = float("inf")
        try:
            views = list(case.views())
            shader_bound = bound(views)
            shader_error = max(largest(drawing.error(view)) for view in views)
        except Exception as problem:
            shader_bound = min(shader_bound, 1.0)
            notes.append(f"shader: {type(problem).__name__}: {problem}")
    return Outcome(
        case.name,
        case.reference,
        error,
        case.bound,
        shader_error,
        shader_bound,
        "; ".join(" ".join(note.split()) for note in notes),
        "" if case.views is None else drawing.version if isinstance(drawing, Shader) else drawing,
    )
