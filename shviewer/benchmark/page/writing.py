"""A report as files: report.html and report.md to be read, report.json and report.csv with every row."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from pathlib import Path
from textwrap import fill

from shviewer.benchmark.hard_cases import table as stability
from shviewer.benchmark.page import bands_page, encodings_page, moving_page, rows_pages, use_page
from shviewer.benchmark.page.html import as_html
from shviewer.benchmark.page.section import Page, Section
from shviewer.benchmark.page.tables import bullet
from shviewer.benchmark.rows.report import Report
from shviewer.benchmark.rows.row import COLUMNS, Row
from shviewer.outputs import write_atomically

FILES = ("report.html", "report.md", "report.json", "report.csv")

AGAINST = "against"
"""The key in the report's `extra` of the lines on the changes since an older report."""

INTRODUCTION = """\
How many bands of spherical harmonics a light needs, how long it takes to project it onto them, and how wrong the result is,
measured together on one machine, which the end of the page names. Errors are relative L2 norms in percent, against the light's
closed form or exact texel integrals. A *time* is the median wall time of repeated runs that took turns with those that it is
compared with; "±12%" is half the distance of its quartiles. A dash is something that was not measured."""

PARTIAL = "**This report is partial: the run did not come to its end, and what it had not measured is missing.**"

NOT_COVERED = (
    "Other machines: times hold for the one below. Ratios between rows of one table travel better.",
    "Times of different tables, band counts or numbers of samples: they did not take turns. The best way and the paper's 10 000"
    " samples did.",
    "Graphics hardware, if the renderer below is software.",
    "Errors of the peers: texels are points to them and areas to us, which is not an error of theirs.",
    "How the pictures look: a relative L2 error says nothing about where it is. `shviewer LIGHT`, key D, shows that.",
)


def _against(page: Page) -> list[str]:
    return list(page.report.extra.get(AGAINST, []))


def _hard_cases(page: Page) -> list[str]:
    found = page.report.extra.get(stability.KEY)
    return stability.as_markdown(stability.from_json(found)).splitlines()[2:] if found else []


SECTIONS = (
    Section("Against an older report", "shviewer report --against OLD.json", _against),
    Section("How many bands", "shviewer info LIGHT", bands_page.needed_lines),
    Section("What to use", "shviewer report LIGHT", use_page.lines),
    Section("What a number of bands serves", "shviewer info LIGHT", bands_page.serves_lines),
    Section("Irradiance in few floats", "shviewer report LIGHT", encodings_page.lines),
    Section("Reconstruction", "shviewer report LIGHT", rows_pages.reconstruction_lines),
    Section("End to end", "shviewer report LIGHT", rows_pages.end_to_end_lines),
    Section("Peers", "shviewer report LIGHT --peers", rows_pages.peers_lines),
    Section("Lights that move", "shviewer report LIGHT --moving", moving_page.lines),
    Section("Projection", "shviewer report LIGHT --methods METHOD", rows_pages.projection_lines),
    Section("Hard cases", "shviewer report --stability", _hard_cases),
)
"""The sections in the order of the page: answers first, long tables last."""


def write(folder: Path, page: Page) -> None:
    """Write all files, each whole or not at all. OutputError if one cannot be written."""
    text = as_markdown(page)
    write_atomically(folder / "report.csv", as_csv(page.report.rows).encode())
    write_atomically(folder / "report.json", page.report.as_json().encode())
    write_atomically(folder / "report.md", text.encode())
    write_atomically(folder / "report.html", as_html(text).encode())


def as_csv(rows: Sequence[Row]) -> str:
    """The rows as CSV: a header, a line per row, and empty cells for what was not measured."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(row.as_dict() for row in rows)
    return text.getvalue()


def as_markdown(page: Page) -> str:
    """The page, in lines of at most 128 columns where they can be broken."""
    report = page.report
    lines = ["# Speed against error", ""]
    if not report.complete:
        lines += [PARTIAL, ""]
    if report.warning:
        lines += [fill(f"**{report.warning[0].upper()}{report.warning[1:]}.**", 124), ""]
    lines += [INTRODUCTION, "", *([page.plot_message, ""] if page.plot_message else [])]
    for section in SECTIONS:
        own = section.lines(page)
        if own:
            lines += [f"## {section.title}", "", f"`{section.command}`", "", *own, ""]
    lines += ["## What this report does not cover", "", *(bullet(line) for line in NOT_COVERED)]
    if report.renderer is None:
        lines.append("- Drawing: there was no OpenGL.")
    if report.not_measured:
        lines += ["", "Not measured for want of time; a larger --budget measures more:", ""]
        lines += [bullet(line) for line in report.not_measured]
    return re.sub(r"\n{3,}", "\n\n", "\n".join([*lines, "", *_made_with(report)])) + "\n"


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
