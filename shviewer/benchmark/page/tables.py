"""Numbers, rows and tables in Markdown that can also be read as plain text, in 128 columns."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterable, Sequence
from math import floor, log10

import numpy as np

from shviewer.benchmark.measuring.experiments import METHODS
from shviewer.benchmark.rows.row import Row
from shviewer.words import grouped

ABSENT = "-"
MOST_COLUMNS = 128
MOST_DIGITS = 12


def significant(value: float, digits: int = 3) -> str:
    """A number in so many digits, without a power of ten; a whole number keeps all of its own."""
    if value == 0:
        return "0"
    return f"{value:.{max(0, digits - 1 - floor(log10(abs(value)) + 1e-9))}f}"


def milliseconds(value: float | None, digits: int = 3) -> str:
    """A time in three digits, without a power of ten."""
    return ABSENT if value is None else significant(value, digits)


def error(value: float | None, digits: int = 3) -> str:
    """An error in percent, as the picture has it: 8.51 %; next to 100 % in as many digits as tell it from that, and below a
    thousandth of a percent with a power of ten: 2.2e-5 %.
    """
    if value is None or value == 0:
        return ABSENT if value is None else "0 %"
    percent = 100 * value
    if percent < 1e-3:
        mantissa, exponent = f"{percent:.{digits - 2}e}".split("e")
        return f"{mantissa}e{int(exponent)} %"
    text = significant(percent, digits)
    while value < 1 - 1e-12 and float(text) >= 100:
        text = significant(percent, digits := digits + 1)
    return f"{text} %"


def told_apart(values: Sequence[float | None], said: Callable[[float | None, int], str]) -> list[str]:
    """Each value as `said`(value, digits) has it, in three digits or as many as tell it from every other of the values."""

    def alone(value: float | None, digits: int) -> bool:
        return said(value, digits) not in {said(other, digits) for other in values if other != value}

    enough = (next((n for n in range(3, MOST_DIGITS) if alone(value, n)), MOST_DIGITS) for value in values)
    return [said(value, digits) for value, digits in zip(values, enough, strict=True)]


def plain(value: float, digits: int = 4) -> str:
    """A number in at most so many digits, without a power of ten."""
    return np.format_float_positional(value, digits, unique=False, fractional=False, trim="-")


def with_spread(text: str, middle: float | None, low: float | None, high: float | None) -> str:
    """The value, with half the distance from low to high in percent of it, if these are known."""
    if not middle or low is None or high is None:
        return text
    return f"{text} ±{50 * (high - low) / middle:.0f}%"


def time_of(row: Row) -> str:
    return with_spread(milliseconds(row.milliseconds), row.milliseconds, row.low_quartile, row.high_quartile)


def error_of(row: Row) -> str:
    return with_spread(error(row.error), row.error, row.error_low, row.error_high)


def words_of(method: str, samples: int | None) -> str:
    """A method in words, with its number of samples; what is no way to project is called as it is."""
    words = {each.name: each.words for each in METHODS}.get(method, method)
    return words if samples is None else f"{words} {grouped(samples)}"


def table(headings: Sequence[str], rows: Sequence[Sequence[str]], left: int = 1) -> list[str]:
    """Lines of a Markdown table, padded. The first `left` columns and those without a heading are text; the others are
    numbers, aligned on the right.
    """
    cells = [[cell.replace("|", "\\|") for cell in row] for row in (headings, *rows)]
    widths = [max(3, *(len(row[column]) for row in cells)) for column in range(len(headings))]
    is_text = [column < left or not heading for column, heading in enumerate(headings)]

    def line(row: Sequence[str]) -> str:
        parts = zip(row, widths, is_text, strict=True)
        return f"| {' | '.join(cell.ljust(width) if text else cell.rjust(width) for cell, width, text in parts)} |"

    rules = (
        "-" * (width + 2) if text else "-" * (width + 1) + ":" for width, text in zip(widths, is_text, strict=True)
    )
    return [line(cells[0]), f"|{'|'.join(rules)}|", *map(line, cells[1:])]


COLUMNS: dict[str, tuple[str, Callable[[Row], str]]] = {
    "set up": ("set-up ms", lambda row: milliseconds(row.set_up_milliseconds)),
    "left out": ("left out", lambda row: error(row.left_out)),
    "arithmetic": ("arithmetic", lambda row: error(row.arithmetic_error)),
    "note": ("", lambda row: row.note),
}


def rows_table(rows: Sequence[Row], columns: Sequence[str]) -> list[str]:
    """A table of rows of any section: the method, the time, and the given ones of COLUMNS."""
    shown = [COLUMNS[name] for name in columns]
    body = [
        [row.light, row.method, str(row.n_bands or ""), time_of(row), *(cell(row) for _, cell in shown)] for row in rows
    ]
    return table(("light", "what", "bands", "ms", *(heading for heading, _ in shown)), body, left=2)


def lines_not_measured(rows: Iterable[Row]) -> list[str]:
    """Lines on everything that there was no time for: methods, lights and band counts."""
    found: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        if not row.measured:
            bands = found.setdefault(words_of(row.method, row.samples), {}).setdefault(row.light, [])
            bands += [] if row.n_bands is None else [str(row.n_bands)]
    return [": ".join(filter(None, (what, "; ".join(_places(lights))))) for what, lights in found.items()]


def _places(lights: dict[str, list[str]]) -> list[str]:
    """Each light with its band counts, if there are any."""
    parts = ((light, f"{' '.join(bands)} bands" if bands else "") for light, bands in sorted(lights.items()))
    return [", ".join(filter(None, part)) for part in parts if any(part)]


def bullet(text: str) -> str:
    """One item of a list, on as many lines as it takes; a number keeps its percent sign."""
    kept = text.replace(" %", "\0%")
    lines = textwrap.fill(kept, MOST_COLUMNS, initial_indent="- ", subsequent_indent="  ", break_on_hyphens=False)
    return lines.replace("\0%", " %")
