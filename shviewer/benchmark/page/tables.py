"""Numbers and tables in Markdown that can also be read as plain text, in 128 columns."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from shviewer.words import three_digits

ABSENT = "-"
MOST_COLUMNS = 128


def milliseconds(value: float | None) -> str:
    """A time in three digits, without an exponent."""
    return ABSENT if value is None else three_digits(value)


def percent(share: float | None) -> str:
    """A share in percent, at most three digits: 0.0512 as 5.12 %."""
    return ABSENT if share is None else f"{100 * share:.3g} %"


def error(value: float | None) -> str:
    return ABSENT if value is None else "0" if value == 0 else f"{value:.1e}"


def with_spread(text: str, middle: float | None, low: float | None, high: float | None) -> str:
    """The value, with half the distance from low to high in percent of it, if these are known."""
    if not middle or low is None or high is None:
        return text
    return f"{text} ±{50 * (high - low) / middle:.0f}%"


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


def bullet(text: str) -> str:
    """One item of a list, on as many lines as it takes."""
    return textwrap.fill(text, MOST_COLUMNS, initial_indent="- ", subsequent_indent="  ", break_on_hyphens=False)
