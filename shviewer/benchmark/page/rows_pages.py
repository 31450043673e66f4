"""The sections that are tables of rows, with a few sentences on them: projection, peers, reconstruction, end to end."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

from shviewer.benchmark.measuring import end_to_end, peers, projection_rows
from shviewer.benchmark.measuring import reconstruction_rows as reconstruction
from shviewer.benchmark.measuring.experiments import METHODS
from shviewer.benchmark.page.advice import known, times, where_bands_stop_paying
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.tables import (
    ABSENT,
    MOST_COLUMNS,
    bullet,
    error_of,
    milliseconds,
    rows_table,
    table,
    time_of,
    words_of,
)
from shviewer.benchmark.rows.row import Row, alike
from shviewer.words import counted, grouped

FRAME_STEM = "frame-time"
"""The file stem of the plot of frame times."""

PROJECTION = """\
Every row measured: times and errors of the coefficients, ||c - exact|| / ||exact||; "±" is half the range over the seeds.
The smallest comes first, and what the time did not allow is left: another run may measure other rows, but the errors of
those that both have are the same."""

PEERS = """\
The same projections by other libraries, one thread each, in one process of their own, taking turns. All start from the same
image in float32, or from the same samples with their radiance, and end with the coefficients of three channels; conversions
count."""

RECONSTRUCTION = """\
What a band costs where the sum is evaluated, against what it brings. *Left out* is what the bands above n hold of the
light, *arithmetic* how far the evaluation is from the same sum in float64, both relative to the norm of the light. Where
the arithmetic reaches what is left out, more bands are of no use."""

END_TO_END = """\
What a user waits for. *Warm*: in a process that has drawn, but does not know the light; everything a new process takes is over
its floor, `--version`."""


def projection_lines(page: Page) -> list[str]:
    """A table of the methods, then three tables per light."""
    rows = page.report.measured(projection_rows.SECTION)
    methods = [(each.words, each.name, each.explanation) for each in METHODS]
    found = [PROJECTION, "", *table(("method", "METHOD", "what it is"), methods, left=3), ""] if rows else []
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


def _experiments(rows: Sequence[Row]) -> list[tuple[str, int | None]]:
    """The methods and their numbers of samples, sorted as the table of methods, then by samples."""
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


def peers_lines(page: Page) -> list[str]:
    rows = [row for row in page.report.rows if row.section == peers.SECTION]
    missing = page.report.notes(peers.SECTION)
    if not rows and not missing:
        return []
    lines = [PEERS, "", *map(bullet, _against_peers(rows)), "", *rows_table(rows, ("note", "set up"))]
    if missing:
        lines += ["", *(bullet(f"without {line}") for line in missing), "", f"All of them: `{peers.INSTALL}`"]
    return lines


def _against_peers(rows: Sequence[Row]) -> Iterator[str]:
    """For each light, kind of data and number of bands, the fastest peer."""

    def time(row: Row) -> float:
        return known(row.milliseconds, math.inf)

    for light, note in dict.fromkeys((row.light, row.note) for row in rows if row.measured):
        own = [row for row in rows if (row.light, row.note) == (light, note)]
        others = [row for row in own if not row.method.startswith(peers.OURS)]
        for n_bands in sorted({row.n_bands for row in others if row.n_bands}):
            here = [row for row in own if row.n_bands == n_bands]
            ours = min((row for row in here if row not in others), key=time)
            best = min((row for row in here if row in others), key=time)
            yield f"{light}, {note}, {counted(n_bands, 'band')}: the fastest peer, {best.method}, takes {_beside(best, ours)}."


def _beside(best: Row, ours: Row) -> str:
    said = f"{milliseconds(best.milliseconds)} ms"
    ratio = (best.milliseconds or 0.0) / (ours.milliseconds or 1.0)
    beside = "as long within the spread" if alike(best, ours) else f"{times(ratio)} as long"
    return f"{said}, {beside} as {ours.method} ({milliseconds(ours.milliseconds)} ms)"


def reconstruction_lines(page: Page) -> list[str]:
    rows = [row for row in page.report.rows if row.section == reconstruction.SECTION]
    if not rows:
        return []
    said = [
        where_bands_stop_paying([row for row in rows if row.light == light and row.measured])
        for light in dict.fromkeys(row.light for row in rows)
    ]
    picture = page.picture(
        FRAME_STEM, "Milliseconds per frame against bands: the direct sum, a cached map, making the map"
    )
    lines = [RECONSTRUCTION, "", *(bullet(sentence) for sentence in said if sentence), "", *picture]
    return lines + _and_missing(page, reconstruction.SECTION, rows_table(rows, ("left out", "arithmetic", "note")))


def end_to_end_lines(page: Page) -> list[str]:
    rows = [row for row in page.report.rows if row.section == end_to_end.SECTION]
    missing = page.report.notes(end_to_end.SECTION)
    if not rows and not missing:
        return []
    return [END_TO_END, "", *_and_missing(page, end_to_end.SECTION, rows_table(rows, ("note",)))]


def _and_missing(page: Page, section: str, lines: list[str]) -> list[str]:
    """Lines, then those on what the section lacks."""
    missing = page.report.notes(section)
    return [*lines, "", *(bullet(f"Without {line}") for line in missing)] if missing else lines
