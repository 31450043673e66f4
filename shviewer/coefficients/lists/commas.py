"""Decimal commas: where they are taken as points, and where they may be something else."""

from __future__ import annotations

import re
from collections.abc import Iterable

from shviewer.coefficients.numbers import holds_light
from shviewer.errors import LightError

DECIMAL_COMMAS = "its commas are taken as decimal ones"

_NUMBER = re.compile(r"[+-]?\d+(?:,\d+)?(?:[eE][+-]?\d+)?", re.ASCII)
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}", re.ASCII)


def with_points(text: str) -> str:
    """The text with points for decimal commas: where cells are parted by semicolons or spaces, and are a list only so.

    LightError where commas could part the numbers as well.
    """
    if "," not in text or "." in text:
        return text
    rows = [re.split(r"[;\s(){}\[\]]+", line.strip("; \t\r(){}[]")) for line in text.splitlines()]
    cells = [cell for row in rows for cell in row if cell]
    if max(map(len, rows)) < 2 or not all(map(_NUMBER.fullmatch, cells)) or not holds_light(len(cells)):
        return text
    if holds_light(len(cells) + text.count(",")):
        raise LightError("commas that may be decimal ones or part the numbers; write decimal points")
    has_decimal_commas(cells)
    return text.replace(",", ".")


def with_point(cell: str) -> str:
    """A number with a point for its decimal comma; anything else as it is."""
    return cell.replace(",", ".") if _NUMBER.fullmatch(cell) else cell


def has_decimal_commas(cells: Iterable[str]) -> bool:
    """Whether some of the numbers have commas. LightError if all of these may be whole ones with a comma between thousands."""
    commas = [cell for cell in cells if "," in cell]
    if commas and all(map(_THOUSANDS.fullmatch, commas)):
        whole = commas[0].replace(",", "")
        raise LightError(
            f"{commas[0]}, which may be {with_point(commas[0])} or, with a comma between thousands, {whole};"
            " write decimal points"
        )
    return bool(commas)
