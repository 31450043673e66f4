"""The projections of every light as tables: times, errors, and the cost of setting up."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from shviewer.benchmark.measuring.experiments import METHODS
from shviewer.benchmark.measuring.projection_rows import SECTION
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.tables import ABSENT, MOST_COLUMNS, error_of, milliseconds, table, time_of, words_of
from shviewer.benchmark.rows.row import Row
from shviewer.words import counted, grouped

Experiment = tuple[str, int | None]


EXPLAINED = """\
Every row measured: times and errors of the coefficients, ||c - exact|| / ||exact||; "±" is half the range over the seeds.
The smallest comes first, and what the time did not allow is left: another run may measure other rows, but the errors of
those that both have are the same."""


def projection_lines(page: Page) -> list[str]:
    """A table of the methods, then three tables per light."""
    rows = page.report.measured(SECTION)
    methods = [(each.words, each.name, each.explanation) for each in METHODS]
    found = [EXPLAINED, "", *table(("method", "METHOD", "what it is"), methods, left=3), ""] if rows else []
    for name in page.report.lights:
        own = [row for row in rows if row.light == name]
        if own:
            found += [f"### {name}: milliseconds", "", *_matrix(own, time_of), ""]
            found += [f"### {name}: error of the coefficients", "", *_matrix(own, error_of), ""]
            found += [f"### {name}: evaluations, set-up and memory", "", *_set_up(own), ""]
    return found


def _matrix(rows: Sequence[Row], cell: Callable[[Row], str]) -> list[str]:
    """A table with a line per experiment and a column per band count; one that is too wide continues below."""
    by_place = {(row.method, row.samples, row.n_bands): cell(row) for row in rows}
    experiments, bands = _experiments(rows), sorted({row.n_bands for row in rows if row.n_bands is not None})

    def part(bands: Sequence[int]) -> list[str]:
        cells = {each: [by_place.get((*each, n), ABSENT) for n in bands] for each in experiments}
        body = [(words_of(*each), *line) for each, line in cells.items() if set(line) != {ABSENT}]
        return table(("", *(counted(n, "band") for n in bands)), body)

    found: list[str] = []
    while bands:
        count = next((n for n in range(len(bands), 1, -1) if len(part(bands[:n])[0]) <= MOST_COLUMNS), 1)
        found += [*([""] if found else []), *part(bands[:count])]
        bands = bands[count:]
    return found


def _experiments(rows: Sequence[Row]) -> list[Experiment]:
    """The experiments, sorted as the table of methods, then by samples."""
    order = [each.name for each in METHODS]
    return sorted({(row.method, row.samples) for row in rows}, key=lambda item: (order.index(item[0]), item[1] or 0))


def _set_up(rows: Sequence[Row]) -> list[str]:
    """A table of set-up and memory, for the most bands with which each experiment was measured."""
    body = []
    for experiment in _experiments(rows):
        row = max((row for row in rows if (row.method, row.samples) == experiment), key=lambda row: row.n_bands or 0)
        evaluations = ABSENT if row.evaluations is None else grouped(row.evaluations)
        peak = ABSENT if row.peak_mib is None else f"{row.peak_mib:.1f}"
        body.append((words_of(*experiment), str(row.n_bands), evaluations, milliseconds(row.set_up_milliseconds), peak))
    return table(("", "bands", "evaluations", "set-up ms", "peak MiB"), body)
