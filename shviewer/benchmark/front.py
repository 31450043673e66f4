"""Advice per light, from measured rows: the Pareto front, a sentence per tolerance, and where bands stop paying."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from shviewer.benchmark.experiments import BEST, PAPER, PAPER_SAMPLES, method
from shviewer.benchmark.measured_lights import MOST_BANDS, MeasuredLight
from shviewer.benchmark.page.tables import milliseconds, percent, plain
from shviewer.benchmark.reconstruction_rows import CACHED, DIRECT, MAP_32
from shviewer.benchmark.row import Row
from shviewer.harmonics.metrics import PARSEVAL_FLOOR, pareto_front
from shviewer.words import counted, grouped


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
    good = [row for row in rows if row.measured and _number(row.total_error, math.inf) <= tolerance * (1 + 1e-12)]
    if not good:
        reached = "of which nothing that was measured is within it; give it a larger --budget."
        return f"{goal}{counted(needed, 'band')}, {reached}"
    fewest = min(row.n_bands or 0 for row in good)
    good = [row for row in good if row.n_bands == fewest]
    winner = min(good, key=lambda row: (row.milliseconds, row.total_error))
    winner = next((row for row in good if row.method == BEST and alike(row, winner)), winner)
    answer = f"{goal}{counted(fewest, 'band')}, {name_of(winner, measured)}, {milliseconds(winner.milliseconds)} ms"
    answer += f", which leaves {percent(winner.total_error)}"
    rivals = [row for row in rows if row.n_bands == winner.n_bands and row is not winner]
    best = next((row for row in rivals if row.method == BEST), None)
    others = [f"{measured.light.best_method} takes {_times(best, winner)}"] if best is not None else []
    paper = next((row for row in rivals if row.method == PAPER and row.samples == PAPER_SAMPLES), None)
    if paper is not None and paper.total_error is not None:
        end = "stop at" if paper.total_error > tolerance else "reach"
        takes = _times(paper, winner)
        if best is not None:  # two ways were named, and each stands for another figure
            words = method(winner.method).words
            takes = f"{_times(paper, winner, words)}, {_times(paper, best, measured.light.best_method)},"
        others.append(
            f"the paper's {grouped(PAPER_SAMPLES)} jittered samples take {takes} and {end} {percent(paper.total_error)}"
        )
    return "; ".join([answer, *others]) + "."


def _times(row: Row, other: Row, name: str = "") -> str:
    """How many times as long a row takes as another, in words, with its name; no factor if their quartiles overlap."""
    name = name and f" as {name}"
    if row.milliseconds is None or not other.milliseconds:
        return "an unknown time"
    if alike(row, other):
        return f"as long{name}, within the spread"
    ratio = row.milliseconds / other.milliseconds
    return f"{ratio:.2g} times as long{name}" if ratio < 10 else f"{ratio:.0f} times as long{name}"


def alike(first: Row, second: Row) -> bool:
    """Whether the quartiles of two times overlap. A time without quartiles counts as exact."""
    found = overlap(first.low_quartile, first.high_quartile, second.low_quartile, second.high_quartile)
    return first.milliseconds == second.milliseconds if found is None else found


def overlap(low: float | None, high: float | None, other_low: float | None, other_high: float | None) -> bool | None:
    """Whether two ranges have a number in common; None if an end is not known."""
    if low is None or high is None or other_low is None or other_high is None:
        return None
    return low <= other_high and other_low <= high


def name_of(row: Row, measured: MeasuredLight) -> str:
    """The method in words, with its samples."""
    words = measured.light.best_method if row.method == BEST else method(row.method).words
    return words if row.samples is None else f"{words}, {grouped(row.samples)} samples"


def where_bands_stop_paying(rows: Sequence[Row]) -> str:
    """One sentence on the reconstruction rows of one light; "" if there are none.

    More bands stop paying where the truncation error falls below the arithmetic error; and, in the direct sum, where every
    further step multiplies the time by more, beyond the quartiles, than it divides the error.
    """
    direct, cached, on_cpu = ([row for row in rows if row.method == method] for method in (DIRECT, CACHED, MAP_32))
    judged = cached or on_cpu
    if not judged:
        return ""
    last = judged[-1]
    met = next((row for row in judged if _number(row.truncation) <= _floor(row)), None)
    parts = [
        f"more than {_bands(met)} bring nothing: no more than {_percent(_floor(met))} is left out, which is lost in rounding"
        if met
        else f"more bands bring less error up to the {last.n_bands} measured, where {_percent(last.truncation)} is left out "
        f"and the arithmetic adds {_percent(last.arithmetic_error)}"
    ]
    if direct:
        parts += _direct_sum(direct) if met is None or met.n_bands != 1 else []
        parts += _crossing(direct, cached)
    return f"{last.light}: {'; '.join(parts)}."


def _direct_sum(direct: list[Row]) -> list[str]:
    """The words on how far more bands pay in the direct sum."""
    steps = list(pairwise(direct))
    paying = [_number(a.total_error) > _slowdown(a, b) * _number(b.total_error) for a, b in steps]
    stop = max((number + 1 for number, pays in enumerate(paying) if pays), default=0)
    if stop == len(steps):
        return [f"summed in the shader they pay up to {_bands(direct[-1])}, {direct[-1].milliseconds:.0f} ms a frame"]
    here, after = direct[stop], direct[stop + 1]
    return [
        f"summed in the shader they stop paying at {_bands(here)}: {after.n_bands} take "
        f"{_number(after.milliseconds) / _number(here.milliseconds):.2f} times as long and leave "
        f"{_number(after.total_error) / max(_number(here.total_error), PARSEVAL_FLOOR):.2f} of the error"
    ]


def _slowdown(a: Row, b: Row) -> float:
    """How many times as long as a b takes; 1 if the quartiles overlap."""
    apart = _number(b.low_quartile) > _number(a.high_quartile)
    return _number(b.milliseconds) / _number(a.milliseconds) if apart else 1.0


def _crossing(direct: list[Row], cached: list[Row]) -> list[str]:
    """The words on the band count from which the cached map is faster."""
    by_bands = {row.n_bands: row for row in cached}
    faster = [row for row in direct if _slowdown(by_bands[row.n_bands], row) > 1]
    if not faster:
        return []
    first = by_bands[faster[0].n_bands]
    return [
        f"from {_bands(first)} on a cached map draws faster, {first.milliseconds:.0f} ms "
        f"after {first.set_up_milliseconds:.0f} ms to make it"
    ]


def _bands(row: Row) -> str:
    return counted(row.n_bands or 0, "band")


def _floor(row: Row) -> float:
    """The truncation error below which it cannot be told from rounding."""
    return max(_number(row.arithmetic_error), PARSEVAL_FLOOR)


def _number(value: float | None, otherwise: float = 0.0) -> float:
    return otherwise if value is None else value


def _percent(value: float | None) -> str:
    """A share in percent, two digits, without powers of ten."""
    return f"{plain(100 * _number(value), 2)} %"
