"""Rows of any section as a table."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from shviewer.benchmark.measurement import Measurement
from shviewer.benchmark.page.tables import error, milliseconds, table, with_spread

COLUMNS: dict[str, tuple[str, Callable[[Measurement], str]]] = {
    "set up": ("set-up ms", lambda row: milliseconds(row.set_up_milliseconds)),
    "left out": ("left out", lambda row: error(row.truncation)),
    "arithmetic": ("arithmetic", lambda row: error(row.arithmetic_error)),
    "note": ("", lambda row: row.note),
}


def rows_table(rows: Sequence[Measurement], columns: Sequence[str]) -> list[str]:
    """Any rows: what was done, how long it took, and the columns that the section has to show."""
    shown = [COLUMNS[name] for name in columns]
    body = [
        (
            row.light,
            row.method,
            "" if row.n_bands is None else str(row.n_bands),
            with_spread(milliseconds(row.milliseconds), row.milliseconds, row.low_quartile, row.high_quartile),
            *(cell(row) for _, cell in shown),
        )
        for row in rows
    ]
    return table(("light", "what", "bands", "ms", *(heading for heading, _ in shown)), body, left=2)
