"""A report as files: report.md to be read, report.json and report.csv with every row."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from shviewer.benchmark.front import front_of, name_of, sentences
from shviewer.benchmark.measured_lights import MeasuredLight
from shviewer.benchmark.page import projection_tables
from shviewer.benchmark.page.document import Report
from shviewer.benchmark.page.tables import bullet, error, milliseconds, table
from shviewer.benchmark.projection_rows import SECTION as PROJECTION
from shviewer.benchmark.row import COLUMNS, Row
from shviewer.errors import OutputError
from shviewer.outputs import write_atomically

FILES = ("report.md", "report.json", "report.csv")

INTRODUCTION = """\
How long it takes to project a light onto spherical harmonics, and how wrong the result is, measured together on one machine.

A *time* is the median wall time of repeated runs that took turns with the others of the same light, band count and number of
samples; "±12%" is half the distance of its quartiles. An *error* is that of the coefficients, ||c - exact|| / ||exact||,
against the light's closed form or exact texel integrals; where samples are random it is the median over several seeds, and "±"
half of their range.
The *total* error adds what the bands left out hold: it is that of the picture, ||light - reconstruction|| / ||light||.
A dash is something that was not measured. The smallest comes first, and what the time did not allow is left: another run may
measure other rows, but the errors of those that both have are the same."""

NOT_COVERED = (
    "Other machines: times hold for the one below. Ratios between rows of one table travel better.",
    "Times of different tables, band counts or numbers of samples: they did not take turns. The best way and the paper's 10 000"
    " samples did.",
    "Graphics hardware, if the renderer below is software.",
    "Errors of the peers: texels are points to them and areas to us, which is not an error of theirs.",
    "How the pictures look: a relative L2 error says nothing about where it is.",
)


def make_folder(folder: Path) -> None:
    """Make the folder if need be. OutputError if that is impossible."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise OutputError(
            f"{folder}: cannot be made a folder: {problem.strerror or problem}; choose another place"
        ) from problem


@dataclass
class Page:
    """The content of the page beside the rows."""

    lights: Sequence[MeasuredLight]
    hosted: dict[str, str] = field(default_factory=dict)
    """Title -> Markdown of a further section."""
    plots: list[str] = field(default_factory=list)
    """Names of picture files in the report's folder."""
    plot_message: str = ""
    """The reason why there are no plots, and the remedy."""


def write(folder: Path, report: Report, page: Page) -> None:
    """Write all three files, each whole or not at all. OutputError if one cannot be written."""
    write_atomically(folder / "report.csv", as_csv(report.rows).encode())
    write_atomically(folder / "report.json", report.as_json().encode())
    write_atomically(folder / "report.md", as_markdown(report, page).encode())


def as_csv(rows: Sequence[Row]) -> str:
    """The rows as CSV: a header, a line per row, and empty cells for what was not measured."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(row.as_dict() for row in rows)
    return text.getvalue()


def as_markdown(report: Report, page: Page) -> str:
    """The page; the advice on what to use comes first."""
    projections = report.measured(PROJECTION)
    lines = ["# Speed against error", ""]
    if not report.complete:
        lines += [
            "**This report is partial: the run did not come to its end, and what it had not measured is missing.**",
            "",
        ]
    lines += [INTRODUCTION, "", "## What to use", ""]
    for measured in page.lights:
        lines += _what_to_use(measured, [row for row in projections if row.light == measured.name])
    pictures = [name for name in page.plots if name.endswith(".svg")]
    if pictures or page.plot_message:
        lines += ["## Plots", "", *([f"{page.plot_message}\n"] if page.plot_message else [])]
        lines += [f"![{Path(name).stem.replace('-', ' ')}]({name})\n" for name in pictures]
    if projections:
        lines += ["## Projection", "", *projection_tables.lines(page.lights, projections)]
    for title, text in page.hosted.items():
        lines += [f"## {title}", "", text.strip(), ""]
    lines += ["## What this report does not cover", "", *(bullet(line) for line in NOT_COVERED)]
    if report.renderer is None:
        lines.append("- Drawing: there was no OpenGL.")
    if report.left_out:
        lines += ["", "Not measured for want of time; a larger --budget measures more:", ""]
        lines += [bullet(line) for line in report.left_out]
    return "\n".join([*lines, "", *_made_with(report)]) + "\n"


def _what_to_use(measured: MeasuredLight, projections: Sequence[Row]) -> list[str]:
    light = measured.light
    lines = [f"### {measured.name}", "", *([light.description, ""] if light.description else [])]
    if not projections:
        return [*lines, "Not measured.", ""]
    lines += [bullet(sentence) for sentence in sentences(measured, projections)]
    front = [
        (
            name_of(row, measured),
            str(row.n_bands),
            milliseconds(row.milliseconds),
            milliseconds(row.set_up_milliseconds),
            error(row.error),
            error(row.truncation),
            error(row.total_error),
        )
        for row in front_of(projections, light.accuracy())
    ]
    headings = ("on the front", "bands", "ms", "set-up ms", "error", "left out", "total")
    accuracy = light.accuracy()
    if accuracy:
        lines += ["", f"The reference itself may be off by {error(accuracy)}."]
    return [
        *lines,
        "",
        "Nothing that was measured is both faster and more accurate than these:",
        "",
        *table(headings, front),
        "",
    ]


def _made_with(report: Report) -> list[str]:
    machine = [f"- {name.replace('_', ' ')}: {value}" for name, value in report.machine.items()]
    versions = ", ".join(f"{name} {version}" for name, version in report.versions.items())
    return [
        "## Made with",
        "",
        *machine,
        f"- OpenGL renderer: {report.renderer or 'none'}",
        bullet(f"versions: {versions}"),
        f"- seed: {report.seed}",
        "",
        "```",
        report.command,
        "```",
    ]
