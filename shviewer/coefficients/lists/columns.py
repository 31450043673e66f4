"""Lists whose first line names their columns, such as red, green and blue, or l, m and value."""

from __future__ import annotations

import csv
import re
from dataclasses import replace
from itertools import chain

import numpy as np

from shviewer.coefficients.lists.commas import DECIMAL_COMMAS, has_decimal_commas, with_point
from shviewer.coefficients.lists.names import CHANNELS
from shviewer.coefficients.lists.scan import number
from shviewer.coefficients.numbers import Listed, sorted_by_degree
from shviewer.errors import LightError
from shviewer.files import decoding
from shviewer.limits import MAX_BANDS

_COLUMNS = {"r": "red", "g": "green", "b": "blue", "degree": "l", "order": "m", "gray": "grey", "value": "grey"}
_LONGEST_HEADER = 1000


def header_of(line: str, table: bool) -> tuple[str, list[str]] | None:
    """The separator of the cells and the names of the columns, if the first line holds such; else None."""
    if len(line) > _LONGEST_HEADER:
        return None
    separator = next((mark for mark in ";\t," if mark in line), " ")
    cells = [_COLUMNS.get(word, word) for word in _cells(line.lower(), separator)]
    names = set(cells) - {""}
    if names & {"nan", "inf", "infinity"} or not all(re.fullmatch(r"[a-z][\w-]*", name, re.ASCII) for name in names):
        return None
    return (separator, cells) if table or names & {*CHANNELS, "grey", "l"} else None


def read_columns(separator: str, names: list[str], lines: list[str], sort: bool) -> Listed:
    """The list in the lines below a header. sort: by the columns l and m, if it has them. LightError if it is none."""
    wanted = [name for channel in CHANNELS for name in (channel, f"{channel}-imaginary") if name in names]
    harmonics = {"l", "m", "c", "s"} <= set(names)
    if not wanted and (harmonics or "grey" in names):
        wanted = ["c", "s"] if harmonics else ["grey"]
    elif missing := [name for name in CHANNELS if name not in names]:
        raise LightError(f"no column {' and no column '.join(missing)}; the header must name red, green and blue")
    lines = [line for line in lines if line.strip()]
    if not lines:
        raise LightError("a header and no rows; a list has n^2 rows of red, green, blue")
    if len(lines) > MAX_BANDS**2:
        raise LightError(f"more than {MAX_BANDS**2} rows, which {MAX_BANDS} bands have, the most that are read")
    sort = sort and {"l", "m"} <= set(names) and len(lines) > 1
    columns = [names.index(name) for name in [*(["l", "m"] if sort else []), *wanted]]
    rows = []
    for row, line in enumerate(lines, 1):
        cells = _cells(line, separator)
        if len(cells) != len(names):
            raise LightError(f"row {row} has {len(cells)} cells, the header {len(names)}: complete it")
        rows.append([cells[column] for column in columns])
    notes: tuple[str, ...] = ()
    if separator != "," and has_decimal_commas(chain(*rows)):
        notes, rows = (DECIMAL_COMMAS,), [[with_point(cell) for cell in cells] for cells in rows]
    table = np.array([[_value(cell, row) for cell in cells] for row, cells in enumerate(rows, 1)])
    if not sort:
        return Listed(table, notes=notes)
    found = sorted_by_degree(table)
    if found is None:
        raise LightError("columns l and m that do not name every coefficient of n bands once: complete or correct them")
    return replace(found, notes=(*notes, *(found.notes if harmonics else ())))


def _cells(line: str, separator: str) -> list[str]:
    """The cells of a line, without those that are empty at its end."""
    if separator == " ":
        return line.split()
    with decoding("CSV"):
        cells = [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]
    while cells and not cells[-1]:
        cells.pop()
    return cells


def _value(cell: str, row: int) -> float:
    if not cell:
        raise LightError(f"row {row} lacks a number: complete it")
    if (value := number(cell)) is None:
        raise LightError(f"{cell[:40]!r} in row {row} is no number: correct it")
    return value
