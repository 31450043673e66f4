"""The sections that are tables of rows with a few sentences on them: peers, reconstruction, end to end."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from shviewer.benchmark.measuring import end_to_end, peers
from shviewer.benchmark.measuring import reconstruction_rows as reconstruction
from shviewer.benchmark.page.advice import known, times, where_bands_stop_paying
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.tables import bullet, milliseconds, rows_table
from shviewer.benchmark.rows.row import Row, alike
from shviewer.words import counted

FRAME_STEM = "frame-time"
"""The file stem of the plot of frame times."""

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
