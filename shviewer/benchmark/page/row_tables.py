"""Rows of any section as a table."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from shviewer.benchmark.experiments import METHODS
from shviewer.benchmark.page.tables import error, milliseconds, table, with_spread
from shviewer.benchmark.row import Row
from shviewer.words import grouped

COLUMNS: dict[str, tuple[str, Callable[[Row], str]]] = {
    "set up": ("set-up ms", lambda row: milliseconds(row.set_up_milliseconds)),
    "left out": ("left out", lambda row: error(row.truncation)),
    "arithmetic": ("arithmetic", lambda row: error(row.arithmetic_error)),
    "note": ("", lambda row: row.note),
}


def rows_table(rows: Sequence[Row], columns: Sequence[str]) -> list[str]:
    """A table of rows: the method, the time, and the given columns."""
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


def lines_not_measured(rows: Iterable[Row]) -> list[str]:
    """Lines on everything that there was no time for: methods, lights and band counts."""
    words = {method.name: method.words for method in METHODS}
    found: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        if not row.measured:
            what = words.get(row.method, row.method) + ("" if row.samples is None else f" {grouped(row.samples)}")
            bands = found.setdefault(what, {}).setdefault(row.light, [])
            bands += [] if row.n_bands is None else [str(row.n_bands)]
    return [": ".join(filter(None, (what, "; ".join(_places(lights))))) for what, lights in found.items()]


def _places(lights: dict[str, list[str]]) -> list[str]:
    """Each light with its band counts, if there are any."""
    parts = ((light, f"{' '.join(bands)} bands" if bands else "") for light, bands in sorted(lights.items()))
    return [", ".join(filter(None, part)) for part in parts if any(part)]
