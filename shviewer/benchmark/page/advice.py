"""Advice per light, from measured rows: the Pareto front, a sentence per tolerance, and where bands stop paying."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from shviewer.benchmark.measuring.evaluations import CACHED, DIRECT, MAP_32
from shviewer.benchmark.measuring.experiments import BEST, PAPER, PAPER_SAMPLES, method
from shviewer.benchmark.page.tables import error, milliseconds
from shviewer.benchmark.rows.report import LightRecord
from shviewer.benchmark.rows.row import Row, alike
from shviewer.harmonics.metrics import PARSEVAL_FLOOR, pareto_front
from shviewer.words import all_of, counted, grouped


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


def sentences(record: LightRecord, rows: Sequence[Row]) -> list[str]:
    """One sentence per tolerance: the method that reaches it in the least time, and how the paper's samples do there.

    rows: the projections of this light. Tolerances of which the same can be said share a sentence.
    """
    found: dict[str, list[str]] = {}
    needs = {float(tolerance): count for tolerance, count in record.bands_within.items()}
    for tolerance in sorted(needs, reverse=True):
        needed = needs[tolerance]
        if needed is None:
            less = "" if tolerance == min(needs) else " or less"
            most = len(record.error_by_bands)
            words = f"more than {most} bands, whatever the method, since the exact first {most} leave"
            found[f"{words} {error(record.error_by_bands[-1])}."] = [f"{100 * tolerance:g} %{less}"]
            break
        found.setdefault(_what_reaches(record, tolerance, needed, rows), []).append(f"{100 * tolerance:g} %")
    return [f"for a total error of {all_of(goals)}: {said}" for said, goals in found.items()]


def _what_reaches(record: LightRecord, tolerance: float, needed: int, rows: Sequence[Row]) -> str:
    good = [row for row in rows if row.measured and known(row.total_error, math.inf) <= tolerance * (1 + 1e-12)]
    if not good:
        return f"{counted(needed, 'band')}, but nothing measured is within it; give it a larger --budget."
    fewest = min(row.n_bands or 0 for row in good)
    good = [row for row in good if row.n_bands == fewest]
    winner = min(good, key=lambda row: (row.milliseconds, row.total_error))
    winner = next((row for row in good if row.method == BEST and alike(row, winner)), winner)
    name = words_for(winner, record)
    samples = "" if winner.samples is None else f", {grouped(winner.samples)} samples,"
    parts = [
        f"{counted(fewest, 'band')}, fastest by {name}{samples} in {milliseconds(winner.milliseconds)} ms, which"
        f" leaves {error(winner.total_error)}"
    ]
    rivals = [row for row in rows if row.n_bands == winner.n_bands and row is not winner and row.measured]
    best = next((row for row in rivals if row.method == BEST), None)
    if best is not None:
        parts.append(f"{record.best_way} takes {_times(best, winner, name)} and leaves {error(best.total_error)}")
    paper = next((row for row in rivals if row.method == PAPER and row.samples == PAPER_SAMPLES), None)
    if paper is not None and paper.total_error is not None:
        takes = _times(paper, winner, name)
        takes += "" if best is None else f", {_times(paper, best, record.best_way)},"
        end = "stop at" if paper.total_error > tolerance else "reach"
        parts.append(
            f"the paper's {grouped(PAPER_SAMPLES)} jittered samples take {takes} and {end} {error(paper.total_error)}"
        )
    return "; ".join(parts) + "."


def _times(row: Row, other: Row, name: str) -> str:
    """How many times as long a row takes as another of this name, in words; no factor if their quartiles overlap."""
    if row.milliseconds is None or not other.milliseconds:
        return "an unknown time"
    if alike(row, other):
        return f"as long as {name} within the spread"
    return f"{times(row.milliseconds / other.milliseconds)} as long as {name}"


def times(ratio: float) -> str:
    """A ratio in words, in two digits."""
    return f"{ratio:.2g} times" if ratio < 10 else f"{ratio:.0f} times"


def words_for(row: Row, record: LightRecord) -> str:
    """The method in words."""
    return record.best_way if row.method == BEST else method(row.method).words


def where_bands_stop_paying(rows: Sequence[Row]) -> str:
    """One sentence on the reconstruction rows of one light; "" if there are none.

    More bands stop paying where what is left out falls below the arithmetic error; and, in the direct sum, where every
    further step multiplies the time by more, beyond the quartiles, than it divides the error.
    """
    direct, cached, on_cpu = ([row for row in rows if row.method == method] for method in (DIRECT, CACHED, MAP_32))
    judged = cached or on_cpu
    if not judged:
        return ""
    last = judged[-1]
    met = next((row for row in judged if known(row.left_out) <= _floor(row)), None)
    parts = [
        f"more than {_bands(met)} bring nothing: no more than {error(_floor(met))} is left out, which is lost in rounding"
        if met
        else f"more bands bring less error up to the {last.n_bands} measured, where {error(last.left_out)} is left out "
        f"and the arithmetic adds {error(last.arithmetic_error)}"
    ]
    if direct:
        parts += _direct_sum(direct) if met is None or met.n_bands != 1 else []
        parts += _crossing(direct, cached)
    return f"{last.light}: {'; '.join(parts)}."


def _direct_sum(direct: list[Row]) -> list[str]:
    """The words on how far more bands pay in the direct sum."""
    steps = list(pairwise(direct))
    paying = [known(a.total_error) > _slowdown(a, b) * known(b.total_error) for a, b in steps]
    stop = max((number + 1 for number, pays in enumerate(paying) if pays), default=0)
    if stop == len(steps):
        return [
            f"summed in the shader they pay up to {_bands(direct[-1])}, {milliseconds(direct[-1].milliseconds)} ms a frame"
        ]
    here, after = direct[stop], direct[stop + 1]
    return [
        f"summed in the shader they stop paying at {_bands(here)}: {after.n_bands} take "
        f"{times(known(after.milliseconds) / known(here.milliseconds))} as long as {here.n_bands} and leave "
        f"{known(after.total_error) / max(known(here.total_error), PARSEVAL_FLOOR):.2f} of their error"
    ]


def _slowdown(a: Row, b: Row) -> float:
    """How many times as long as a b takes; 1 if the quartiles overlap."""
    apart = known(b.low_quartile) > known(a.high_quartile)
    return known(b.milliseconds) / known(a.milliseconds) if apart else 1.0


def _crossing(direct: list[Row], cached: list[Row]) -> list[str]:
    """The words on the band count from which the cached map is faster."""
    by_bands = {row.n_bands: row for row in cached}
    faster = [row for row in direct if _slowdown(by_bands[row.n_bands], row) > 1]
    if not faster:
        return []
    summed, first = faster[0], by_bands[faster[0].n_bands]
    return [
        f"from {_bands(first)} on a cached map draws faster than the direct sum, {milliseconds(first.milliseconds)} ms a frame"
        f" against {milliseconds(summed.milliseconds)} ms, after {milliseconds(first.set_up_milliseconds)} ms to make it"
    ]


def _bands(row: Row) -> str:
    return counted(row.n_bands or 0, "band")


def _floor(row: Row) -> float:
    """What is left out below which it cannot be told from rounding."""
    return max(known(row.arithmetic_error), PARSEVAL_FLOOR)


def known(value: float | None, otherwise: float = 0.0) -> float:
    """A number, or another in its place where it is not known."""
    return otherwise if value is None else value
