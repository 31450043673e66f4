"""Advice per light: the Pareto front of time and error, and a sentence per tolerance, made from measured rows only."""

from __future__ import annotations

from collections.abc import Sequence

from shviewer.benchmark.experiments import BEST, PAPER, PAPER_SAMPLES, method
from shviewer.benchmark.measured_lights import MOST_BANDS, MeasuredLight
from shviewer.benchmark.page.tables import milliseconds, percent
from shviewer.benchmark.row import Row
from shviewer.harmonics.metrics import PARSEVAL_FLOOR, pareto_front
from shviewer.words import grouped


def front_of(rows: Sequence[Row], accuracy: float = 0.0) -> list[Row]:
    """The front of one light's projections: milliseconds against the total error.

    Errors that rounding or the reference's own accuracy cannot tell apart count as equal, and so do times whose quartiles
    overlap: the more accurate row then stands for both.
    """
    floor = max(PARSEVAL_FLOOR, accuracy)
    known = [
        (row, (row.milliseconds, max(row.total_error, floor)))
        for row in rows
        if row.milliseconds is not None and row.total_error is not None
    ]
    front = [known[i][0] for i in pareto_front([point for _, point in known])]
    return [row for i, row in enumerate(front) if not any(alike(row, better) for better in front[i + 1 :])]


def sentences(measured: MeasuredLight, rows: Sequence[Row]) -> list[str]:
    """One sentence per tolerance: the method that reaches it in the least time, and how the paper's samples do there.

    rows: the projections of this light. Tolerances that no number of bands reaches share a sentence.
    """
    found = []
    for tolerance in sorted(measured.needs, reverse=True):
        needed = measured.needs[tolerance]
        if needed is None:
            less = "" if tolerance == min(measured.needs) else " or less"
            left = percent(float(measured.truncation[-1]))
            found.append(
                f"for {percent(tolerance)} relative L2{less}: this light needs more than {MOST_BANDS} bands, whatever the"
                f" method: {MOST_BANDS} leave {left}."
            )
            break
        found.append(_sentence(measured, tolerance, needed, rows))
    return found


def _sentence(measured: MeasuredLight, tolerance: float, needed: int, rows: Sequence[Row]) -> str:
    goal = f"for {percent(tolerance)} relative L2: "
    good = [
        row
        for row in rows
        if row.milliseconds is not None and row.total_error is not None and row.total_error <= tolerance * (1 + 1e-12)
    ]
    if not good:
        return f"{goal}{bands(needed)}, of which nothing that was measured is within it; give it a larger --budget."
    fewest = min(row.n_bands or 0 for row in good)
    good = [row for row in good if row.n_bands == fewest]
    winner = min(good, key=lambda row: (row.milliseconds, row.total_error))
    winner = next((row for row in good if row.method == BEST and alike(row, winner)), winner)
    answer = f"{goal}{bands(fewest)}, {name_of(winner, measured)}, {milliseconds(winner.milliseconds)} ms"
    answer += f", which leaves {percent(winner.total_error)}"
    rivals = [row for row in rows if row.n_bands == winner.n_bands and row is not winner]
    best = next((row for row in rivals if row.method == BEST), None)
    others = [f"{measured.light.best_method} takes {_times(best, winner)}"] if best is not None else []
    paper = next((row for row in rivals if row.method == PAPER and row.samples == PAPER_SAMPLES), None)
    if paper is not None and paper.total_error is not None:
        end = "stop at" if paper.total_error > tolerance else "reach"
        others.append(
            f"the paper's {grouped(PAPER_SAMPLES)} jittered samples take {_times(paper, winner)} and {end}"
            f" {percent(paper.total_error)}"
        )
    return "; ".join([answer, *others]) + "."


def _times(row: Row, other: Row) -> str:
    """How many times as long a row takes as another, in words; no factor if their quartiles overlap."""
    if row.milliseconds is None or not other.milliseconds:
        return "an unknown time"
    if alike(row, other):
        return "as long, within the spread"
    ratio = row.milliseconds / other.milliseconds
    return f"{ratio:.2g} times as long" if ratio < 10 else f"{ratio:.0f} times as long"


def alike(first: Row, second: Row) -> bool:
    """Whether the quartiles of two times overlap. A time without quartiles counts as exact."""
    ends = (first.low_quartile, first.high_quartile, second.low_quartile, second.high_quartile)
    if any(end is None for end in ends):
        return first.milliseconds == second.milliseconds
    low, high, other_low, other_high = (float(end or 0) for end in ends)
    return low <= other_high and other_low <= high


def name_of(row: Row, measured: MeasuredLight) -> str:
    """The method in words, with its samples."""
    words = method(row.method).words_for(measured.light.best_method)
    return words if row.samples is None else f"{words}, {grouped(row.samples)} samples"


def bands(count: int | None) -> str:
    return f"{count} band{'' if count == 1 else 's'}"
