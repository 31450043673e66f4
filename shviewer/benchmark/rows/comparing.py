"""The changes between two reports that exceed the noise measured in both."""

from __future__ import annotations

from dataclasses import dataclass

from shviewer.benchmark.rows.report import Report
from shviewer.benchmark.rows.row import Row, alike, overlap
from shviewer.words import one_line

LEAST_RATIO = 1.25
"""The least ratio of times that counts: between runs, a shared machine drifts by more than one run's quartiles show."""

ERRORS = ("error", "arithmetic_error", "total_error")
"""The errors that a row may have; the first that is known is compared."""

ROUNDING = 1e-6, 1e-12
"""Relative and absolute differences of errors that the sequence of a summation can cause."""


@dataclass(frozen=True)
class Change:
    """One row that is in both reports. Verdicts are "faster", "slower", "better", "worse" or "" for no difference."""

    before: Row
    after: Row
    time: str
    error: str


@dataclass(frozen=True)
class Comparison:
    """The rows of two reports compared."""

    changes: tuple[Change, ...]
    only_before: int
    only_after: int
    different: tuple[str, ...]
    """The differences between the machines, in words; empty if times can be compared."""
    needed_ratio: float
    """The ratio from which two times count as different."""


def compare(before: Report, after: Report) -> Comparison:
    """Compare two reports; measured rows are matched by section, light, method, bands and samples."""
    different = _differences(before, after)
    ratio = _needed_ratio(before, after)
    old = {row.key: row for row in before.rows if row.measured}
    new = {row.key: row for row in after.rows if row.measured}
    changes = tuple(
        Change(old[key], row, "" if different else _time_verdict(old[key], row, ratio), _error_verdict(old[key], row))
        for key, row in new.items()
        if key in old
    )
    return Comparison(changes, len(old.keys() - new.keys()), len(new.keys() - old.keys()), different, ratio)


def _differences(before: Report, after: Report) -> tuple[str, ...]:
    return tuple(
        f"{name.replace('_', ' ')} {one_line(str(before.machine.get(name)), 80)} there, {one_line(str(value), 80)} here"
        for name, value in after.machine.items()
        if name != "system" and before.machine.get(name) != value
    )


def _needed_ratio(before: Report, after: Report) -> float:
    """LEAST_RATIO, or the ratio by which the yardstick changed within and between the two runs, if that is more."""
    ends = [
        report.yardstick_milliseconds[name]
        for report in (before, after)
        if report.yardstick_milliseconds is not None
        for name in ("low_quartile", "high_quartile")
        if report.yardstick_milliseconds.get(name)
    ]
    return max(LEAST_RATIO, max(ends) / min(ends)) if ends else LEAST_RATIO


def _time_verdict(before: Row, after: Row, ratio: float) -> str:
    if not before.milliseconds or not after.milliseconds or alike(before, after):
        return ""
    if after.milliseconds * ratio < before.milliseconds:
        return "faster"
    return "slower" if before.milliseconds * ratio < after.milliseconds else ""


def _error_verdict(before: Row, after: Row) -> str:
    for name in ERRORS:
        old, new = getattr(before, name), getattr(after, name)
        if old is None or new is None:
            continue
        if name == "error" and overlap(before.error_low, before.error_high, after.error_low, after.error_high):
            return ""
        if abs(old - new) <= max(ROUNDING[0] * max(old, new), ROUNDING[1]):
            return ""
        return "better" if new < old else "worse"
    return ""
