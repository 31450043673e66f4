"""The section of advice: for each light sentences, the plot of time against error, and its Pareto front."""

from __future__ import annotations

from shviewer.benchmark.measuring.experiments import BEST
from shviewer.benchmark.measuring.projection_rows import SECTION
from shviewer.benchmark.page.advice import front_of, sentences, words_for
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.tables import ABSENT, bullet, error, milliseconds, table, told_apart
from shviewer.benchmark.rows.report import LightRecord
from shviewer.benchmark.rows.row import Row
from shviewer.words import grouped

EXPLAINED = """\
The *error* is that of the coefficients, ||c - exact|| / ||exact||; where samples are random it is the median over several
seeds. *Left out* is what the bands above n hold of the light, and the *total* both together: that of the picture, ||light -
reconstruction|| / ||light||. On the front stands what nothing measured beats in both time and total error."""


def time_error_stems(lights: list[str]) -> list[str]:
    """A file stem for each light's plot, all different."""
    stems: list[str] = []
    for light in lights:
        stem = f"time-error-{''.join(c if c.isalnum() or c in '-_' else '-' for c in light)}"
        while stem in stems:
            stem += "-"
        stems.append(stem)
    return stems


def lines(page: Page) -> list[str]:
    """A subsection for each light."""
    found = [EXPLAINED, ""] if page.report.measured(SECTION) else []
    stems = time_error_stems(list(page.report.lights))
    for (name, record), stem in zip(page.report.lights.items(), stems, strict=True):
        rows = [row for row in page.report.measured(SECTION) if row.light == name]
        found += [f"### {name}", "", *([record.description, ""] if record.description else [])]
        found += [*advised(record, rows), *page.picture(stem, f"Total error of {name} against the time to project it")]
        found += [*_front(record, rows), ""] if rows else []
    return found


def advised(record: LightRecord, rows: list[Row]) -> list[str]:
    """What to use, and how far the reference may be trusted."""
    if not rows:
        return ["Not measured.", ""]
    said = [bullet(sentence) for sentence in sentences(record, rows)]
    missed = f", and {record.best_misses}" if record.best_misses else ""
    accuracy = [f"The reference itself may be off by {error(record.accuracy)}{missed}.", ""] if record.accuracy else []
    return [*said, "", *accuracy]


def _front(record: LightRecord, rows: list[Row]) -> list[str]:
    """The front as a table, times and total errors in as many digits as tell them apart."""
    front = front_of(rows, record.accuracy)
    columns = (
        [words_for(row, record) for row in front],
        [ABSENT if row.method == BEST or row.samples is None else grouped(row.samples) for row in front],
        [str(row.n_bands) for row in front],
        told_apart([row.milliseconds for row in front], milliseconds),
        [milliseconds(row.set_up_milliseconds) for row in front],
        [error(row.error) for row in front],
        [error(row.left_out) for row in front],
        told_apart([row.total_error for row in front], error),
    )
    return table(
        ("on the front", "samples", "bands", "ms", "set-up ms", "error", "left out", "total"),
        list(zip(*columns, strict=True)),
    )
