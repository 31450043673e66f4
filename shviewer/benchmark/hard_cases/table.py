"""The table of hard cases as text, Markdown and JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

from shviewer.benchmark.hard_cases.outcome import Outcome
from shviewer.benchmark.hard_cases.views import SEED
from shviewer.benchmark.machine import machine_line, versions

HEADINGS = ("", "case", "reference", "error", "bound", "float32", "bound")
PACKAGES = ("numpy", "moderngl")


def as_text(outcomes: Sequence[Outcome]) -> str:
    """Columns for a terminal, then the exceptions and the number of cases passed."""
    rows = [HEADINGS, *(_cells(outcome) for outcome in outcomes)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEADINGS))]
    lines = [
        "  ".join(
            cell.rjust(w) if i > 2 else cell.ljust(w) for i, (cell, w) in enumerate(zip(row, widths, strict=True))
        )
        for row in rows
    ]
    lines = [line.rstrip() for line in lines]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:], "", *_remarks(outcomes)]) + "\n"


def as_markdown(outcomes: Sequence[Outcome]) -> str:
    """A page: the table, remarks, and the machine and versions it was measured with."""
    rows = [_cells(outcome) for outcome in outcomes]
    lines = ["| " + " | ".join(HEADINGS) + " |", "|---|---|---|--:|--:|--:|--:|"]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows]
    made = [f"- {name}: {value}" for name, value in _made_with().items()]
    explanation = "An error in float32 is the fragment shader's, relative to the peak; the others are float64's."
    return "\n".join(["# Hard cases", "", *lines, "", *_remarks(outcomes), "", explanation, "", *made]) + "\n"


def as_json(outcomes: Sequence[Outcome]) -> str:
    """The table for programs; an error that could not be measured is null."""
    cases = [
        {
            "name": outcome.name,
            "reference": outcome.reference,
            "error": _finite(outcome.error),
            "bound": outcome.bound,
            "shader_error": _finite(outcome.shader_error),
            "shader_bound": outcome.shader_bound,
            "passed": outcome.passed,
            "note": outcome.note,
        }
        for outcome in outcomes
    ]
    page: dict[str, Any] = {
        "passed": all(outcome.passed for outcome in outcomes),
        "shader": "; ".join(_drawn_by(outcomes)),
        "made_with": _made_with(),
        "cases": cases,
    }
    return json.dumps(page, indent=1, allow_nan=False) + "\n"


def _cells(outcome: Outcome) -> tuple[str, ...]:
    numbers = (outcome.error, outcome.bound, outcome.shader_error, outcome.shader_bound)
    return ("ok" if outcome.passed else "FAIL", outcome.name, outcome.reference, *map(_number, numbers))


def _number(value: float | None) -> str:
    return "" if value is None else "0" if value == 0 else f"{value:.1e}"


def _remarks(outcomes: Sequence[Outcome]) -> list[str]:
    """Lines below the table: one per exception, one on the shader, one with the count."""
    lines = [f"{outcome.name}: {outcome.note}" for outcome in outcomes if outcome.note]
    missing = any(outcome.drawn_by and outcome.shader_error is None for outcome in outcomes)
    drawn_by = _drawn_by(outcomes)
    if drawn_by:
        lines.append(f"{'No float32 column' if missing else 'Float32 drawn by'}: {'; '.join(drawn_by)}")
    passed = sum(outcome.passed for outcome in outcomes)
    return [*lines, f"{passed} of {len(outcomes)} cases are within their bounds."]


def _drawn_by(outcomes: Sequence[Outcome]) -> list[str]:
    return sorted({outcome.drawn_by for outcome in outcomes if outcome.drawn_by})


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def _made_with() -> dict[str, str]:
    return {**versions(PACKAGES), "machine": machine_line(), "seed": str(SEED)}
