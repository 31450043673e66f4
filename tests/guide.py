"""Write the tables of the guide anew, and what shells and man are told of the options: python tests/guide.py

In a page of assets/guide/ they stand between two comments, <!-- generated: WHAT --> and <!-- end -->. WHAT is one of

    keys                    the table of keys
    usage                   the modes and their arguments
    exit codes
    info keys               what shviewer info --json writes
    found images            which program writes what
    found lists             the same of coefficients
    bands needed            how many bands the lights of assets/report/ need
    programs                what programs show that are run in tests/clients/
    options MODE MODE ...   the options that all of these modes have and no other has; the window's mode is called "view"

assets/report/ gets the page and the plots that the rows of its report.json make today; nothing is measured.
"""

from __future__ import annotations

import argparse
import ast
import inspect
import re
from collections.abc import Iterator
from dataclasses import is_dataclass
from itertools import pairwise, starmap
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import get_args, get_origin, get_type_hints

from clients.measured import rendered
from clients.measured import table as programs
from coefficients.found_lists import table as found_lists
from documents import PAGES
from lights.found_images import table as found_images
from places import ROOT
from shell_files import write_shell_files

from shviewer.analysis.information import Information
from shviewer.benchmark.measuring.bands import BANDS_KEY
from shviewer.benchmark.page import plots
from shviewer.benchmark.page.bands_page import needed_table
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.writing import as_markdown
from shviewer.benchmark.rows.report import read_report
from shviewer.cli.options.modes import EXIT_CODES, PARSERS
from shviewer.viewer.control.keys import key_table

MARKED = re.compile(r"(<!-- generated: ([^\n]+) -->\n).*?(<!-- end -->\n)", re.DOTALL)


REPORT = ROOT / "assets" / "report"

CONVENTION = re.compile(r"^(\| `([\w-]+)` \| (?:kept|none) \|.*\|)[^|\n]*\|$", re.MULTILINE)
"""A row of the table of conventions, whose last cell is how far off the program shows it."""


def written_anew(text: str) -> str:
    """A page with its tables as the program has them today. KeyError for one that nothing makes."""
    text = CONVENTION.sub(lambda found: f"{found[1]} {rendered(found[2])} |", text)
    return MARKED.sub(lambda found: found[1] + generated(found[2]) + found[3], text)


def generated(what: str) -> str:
    """The lines between the comments."""
    if what.startswith("options "):
        rows = options_by_modes()[tuple(what.split()[1:])]
        return "\n".join(["", "| option | meaning |", "|---|---|", *rows, "", ""])
    if what == "found images":
        return found_images()
    if what == "programs":
        return programs()
    if what == "bands needed":
        found = read_report(REPORT / "report.json").extra[BANDS_KEY]
        return "\n".join(["", *needed_table(found), "", ""])
    if what == "found lists":
        return found_lists()
    if what == "info keys":
        return "\n".join(
            ["", "| key | what it is |", "|---|---|", *starmap("| `{}` | {} |".format, said_of(Information)), "", ""]
        )
    texts = {"keys": key_table(), "usage": usage(), "exit codes": exit_codes()}
    return f"\n```text\n{texts[what]}\n```\n\n"


def said_of(holder: type, before: str = "", told: tuple[type, ...] = ()) -> Iterator[tuple[str, str]]:
    """The keys of a dataclass as JSON, those within [] of a list, and what its source says of them; of each class once."""
    body = ast.parse(inspect.getsource(holder)).body[0].body
    texts = {
        first.target.id: str(second.value.value)
        for first, second in pairwise(body)
        if isinstance(first, ast.AnnAssign) and isinstance(second, ast.Expr)
    }
    for name, kind in get_type_hints(holder).items():
        held = [each for each in (kind, *get_args(kind)) if is_dataclass(each)]
        text = texts.get(name) or inspect.cleandoc(held[0].__doc__ or "")
        key = f"{before}{name}{'[]' * (get_origin(kind) is tuple and bool(held))}"
        yield key, " ".join(text.split()).removesuffix(".").replace("None", "null").replace("|", "\\|")
        for each in held:
            if each not in told:
                yield from said_of(each, f"{key}.", told)
        told = (*told, *held)


def usage() -> str:
    return re.sub("^ *(?=shviewer)", "", PARSERS["view"]().usage or "", flags=re.MULTILINE)


def exit_codes() -> str:
    return re.sub("^  ", "", EXIT_CODES.partition("\n")[2], flags=re.MULTILINE)


def options_by_modes() -> dict[tuple[str, ...], list[str]]:
    """For each set of modes the rows of a table: the options that just these modes have in common."""
    modes: dict[str, list[str]] = {}
    for mode, parser in PARSERS.items():
        for action in parser()._actions:
            if action.option_strings:
                modes.setdefault(row(action), []).append(mode)
    by_modes: dict[tuple[str, ...], list[str]] = {}
    for text, names in modes.items():
        by_modes.setdefault(tuple(names), []).append(text)
    return by_modes


def row(action: argparse.Action) -> str:
    """An option with what it takes, and its line of the help."""
    metavar = " ".join(action.metavar) if isinstance(action.metavar, tuple) else action.metavar or ""
    *short, last = action.option_strings
    names = ", ".join(f"`{name}`" for name in [*short, f"{last} {metavar}".strip()])
    return f"| {names} | {(action.help or '').replace('%%', '%').replace('|', chr(92) + '|')} |"


def write_report_anew(folder: Path) -> None:
    """The page and, with matplotlib, the plots of the report in a folder: .md and .svg alone."""
    report = read_report(folder / "report.json")
    with TemporaryDirectory() as made:
        drawn, message = plots.make_plots(report, Path(made))
        for path in drawn:
            if path.suffix == ".svg":
                (folder / path.name).write_bytes(path.read_bytes())
    if not message:
        page = Page(report, [path.name for path in drawn])
        (folder / "report.md").write_text(as_markdown(page), encoding="utf-8")


if __name__ == "__main__":
    for page in PAGES:
        page.write_text(written_anew(page.read_text(encoding="utf-8")), encoding="utf-8")
    write_shell_files()
    write_report_anew(REPORT)
