"""All hard cases: measured, and shown as a table in text, Markdown and JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from shviewer.benchmark.hard_cases import (
    evaluation,
    figures,
    identities,
    layouts,
    programs,
    projecting,
    radiances,
    ringing,
    rotating,
    sampling,
)
from shviewer.benchmark.hard_cases.outcome import Case, Outcome, largest
from shviewer.benchmark.hard_cases.shader import SEED, bound, error_of, renderer_or_reason
from shviewer.benchmark.measuring.machine import machine_line, versions
from shviewer.benchmark.rows.row import finite

if TYPE_CHECKING:
    from shviewer.viewer.gl.renderer import Renderer

FILES = (evaluation, identities, sampling, projecting, layouts, radiances, rotating, ringing, figures, programs)
CASES: tuple[Case, ...] = tuple(case for file in FILES for case in file.CASES)

KEY = "stability"
"""The key in a report's `extra`."""

HEADINGS = ("", "case", "reference", "error", "bound", "float32", "bound")
PACKAGES = ("numpy", "moderngl")


def run(*, progress: Callable[[str], None] | None = None, shader: bool = True) -> list[Outcome]:
    """Measure every case; `progress` is told each name first. A case that raises an exception becomes a failed row.

    shader: also draw the cases that concern the fragment shader, if there is an OpenGL without display.
    """
    outcomes = []
    with renderer_or_reason(shader) as drawing:
        for case in CASES:
            if progress is not None:
                progress(case.name)
            outcomes.append(measure(case, drawing))
    return outcomes


def measure(case: Case, drawing: Renderer | str) -> Outcome:
    """Measure one case. drawing: a renderer, or why there is none. Overflow, division by zero and NaN count as exceptions."""
    error, notes = float("inf"), []
    try:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            error = largest(case.measure())
    except Exception as problem:
        notes.append(f"{type(problem).__name__}: {problem}")
    shader_error = shader_bound = None
    if case.views is not None and not isinstance(drawing, str):
        shader_error = shader_bound = float("inf")
        try:
            views = list(case.views())
            shader_bound = bound(views)
            shader_error = max(largest(error_of(view, drawing)) for view in views)
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
        "" if case.views is None else drawing if isinstance(drawing, str) else drawing.version,
    )


def as_text(outcomes: Sequence[Outcome]) -> str:
    """Columns for a terminal, then the exceptions and the number of cases passed."""
    rows = [HEADINGS, *(_cells(outcome) for outcome in outcomes)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEADINGS))]
    columns = "  ".join(f"{{:{'>' if number > 2 else '<'}{width}}}" for number, width in enumerate(widths))
    lines = [columns.format(*row).rstrip() for row in rows]
    *packages, (_, machine), (_, seed) = _made_with().items()
    made = f"Made with {', '.join(map(' '.join, packages))} on {machine}; seed {seed}"
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:], "", made, *_remarks(outcomes)]) + "\n"


def as_markdown(outcomes: Sequence[Outcome]) -> str:
    """The table and remarks on it."""
    rows = [_cells(outcome) for outcome in outcomes]
    lines = ["| " + " | ".join(HEADINGS) + " |", "|---|---|---|--:|--:|--:|--:|"]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows]
    explanation = "An error in float32 is the fragment shader's, relative to the peak; the others are float64's."
    return "\n".join([explanation, "", *lines, "", *_remarks(outcomes)]) + "\n"


def as_json(outcomes: Sequence[Outcome]) -> str:
    """The table for programs; an error that could not be measured is null."""
    columns = ("name", "reference", "error", "bound", "shader_error", "shader_bound", "passed", "note", "drawn_by")
    page = {
        "passed": all(outcome.passed for outcome in outcomes),
        "shader": "; ".join(_drawn_by(outcomes)),
        "made_with": _made_with(),
        "cases": [{name: finite(getattr(outcome, name)) for name in columns} for outcome in outcomes],
    }
    return json.dumps(page, indent=1, allow_nan=False) + "\n"


def from_json(page: Mapping[str, Any]) -> list[Outcome]:
    """The outcomes of a table that `as_json` wrote, parsed: an error of null is infinite, unless no shader was concerned."""
    outcomes = []
    for case in page["cases"]:
        errors = ("error", "bound", *(("shader_error",) if case["shader_bound"] is not None else ()))
        known = {name: value for name, value in case.items() if name != "passed"}
        outcomes.append(Outcome(**known | {name: math.inf for name in errors if known[name] is None}))
    return outcomes


def _cells(outcome: Outcome) -> tuple[str, ...]:
    numbers = (outcome.error, outcome.bound, outcome.shader_error, outcome.shader_bound)
    return ("ok" if outcome.passed else "FAIL", outcome.name, outcome.reference, *map(_number, numbers))


def _number(value: float | None) -> str:
    return "" if value is None else "0" if value == 0 else f"{value:.1e}"


def _remarks(outcomes: Sequence[Outcome]) -> list[str]:
    """Lines below the table: one per exception, on the shader, and with the count."""
    lines = [f"{outcome.name}: {outcome.note}" for outcome in outcomes if outcome.note]
    missing = any(outcome.drawn_by and outcome.shader_error is None for outcome in outcomes)
    drawn_by = _drawn_by(outcomes)
    if drawn_by:
        lines.append(f"{'No float32 column' if missing else 'Float32 drawn by'}: {'; '.join(drawn_by)}")
    passed = sum(outcome.passed for outcome in outcomes)
    return [*lines, f"{passed} of {len(outcomes)} cases are within their bounds."]


def _drawn_by(outcomes: Sequence[Outcome]) -> list[str]:
    return sorted({outcome.drawn_by for outcome in outcomes if outcome.drawn_by})


def _made_with() -> dict[str, str]:
    return {**versions(PACKAGES), "machine": machine_line(), "seed": str(SEED)}
