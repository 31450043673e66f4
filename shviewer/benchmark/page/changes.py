"""The changes since an older report, as the first section of the page."""

from __future__ import annotations

from collections import Counter

from shviewer.benchmark.page.tables import error, milliseconds, table
from shviewer.benchmark.rows.comparing import ERRORS, Change, Comparison
from shviewer.benchmark.rows.row import Row
from shviewer.words import grouped


def lines(found: Comparison, name: str) -> list[str]:
    """The lines of a section of the page; name: that of the older report."""
    verdicts = Counter(verdict for change in found.changes for verdict in (change.time, change.error))
    counts = ", ".join(f"{verdicts[verdict]} {verdict}" for verdict in ("faster", "slower", "better", "worse"))
    lines = [f"{len(found.changes)} rows are in this report and in {name}: {counts}."]
    if found.different:
        lines.append(f"The times are not comparable, since the machine is another: {'; '.join(found.different)}.")
    else:
        lines.append(
            f"A time differs if the quartiles are apart and the medians by more than {found.needed_ratio:.2f} times."
        )
    lines.append("An error differs if it does beyond its spread over the seeds, or beyond rounding.")
    if found.only_before or found.only_after:
        lines.append(f"Only there: {found.only_before} rows; only here: {found.only_after}.")
    rows = [_cells(change) for change in found.changes if change.time or change.error]
    headings = ("light", "method", "bands", "samples", "ms before", "ms now", "error before", "error now", "")
    return [*lines, "", *(table(headings, rows, left=2) if rows else [])]


def _cells(change: Change) -> tuple[str, ...]:
    row = change.after
    return (
        row.light,
        row.method,
        str(row.n_bands or ""),
        "" if row.samples is None else grouped(row.samples),
        milliseconds(change.before.milliseconds),
        milliseconds(row.milliseconds),
        error(_shown_error(change.before)),
        error(_shown_error(row)),
        ", ".join(filter(None, (change.time, change.error))),
    )


def _shown_error(row: Row) -> float | None:
    return next((getattr(row, name) for name in ERRORS if getattr(row, name) is not None), None)
