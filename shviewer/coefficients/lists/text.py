"""Lists of numbers in text: with or without brackets, names and a header; in C, GLSL, HLSL, WGSL, JavaScript or no language.

Nothing is computed: between the numbers stand separators, brackets, comments, and names of types, arrays and channels. Whatever
else stands there is refused, with its line.
"""

from __future__ import annotations

import csv
import re
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import replace
from itertools import accumulate, chain, groupby

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.numbers import MAX_NUMBERS, Listed, Numbers, arranged, holds_light, sorted_by_degree
from shviewer.errors import LightError
from shviewer.files import decoding
from shviewer.limits import MAX_BANDS

CHANNELS = ("red", "green", "blue")

_COMMENT_OPENS = re.compile(r"//|#|/\*")
_TEMPLATE = re.compile(
    r"(?:array\s?<\s?)?vec[34]\s?<\s?\w{1,9}\s?>(?:\s?,\s?\w{1,9}\s?>)?|array\s?<\s?\w{1,20}\s?,\s?\w{1,9}\s?>"
)
_WORD = re.compile(
    r"[A-Za-z_][\w.]*(?:-\d+)?(?:\s{0,9}\[\s{0,9}\w{0,40}\s{0,9}\]){0,4}|[()\[\]{}=:]|[^\s,;()\[\]{}=:\"']+", re.ASCII
)
_NAME = re.compile(r"[A-Za-z_].*", re.ASCII | re.DOTALL)
_PLACE = re.compile(r".*?[A-Za-z_](\d)([_mMnN-]{0,2})(\d)", re.ASCII)
_INDEX = re.compile(r"(.*?)\[\s*(\d{1,5})\s*\]", re.ASCII)
_DECIMAL_COMMA = re.compile(r"[+-]?\d+(?:,\d+)?(?:[eE][+-]?\d+)?", re.ASCII)

_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}", re.ASCII)

DECIMAL_COMMAS = "its commas are taken as decimal ones"

_AS_ASCII = str.maketrans({"\u2212": "-", "\u00a0": " ", "\u2009": " ", "\u202f": " "})
"""A minus sign and the spaces that type-setters use."""

_COLUMNS = {"r": "red", "g": "green", "b": "blue", "degree": "l", "order": "m", "gray": "grey", "value": "grey"}

_MOST_WORDS = 4 * MAX_NUMBERS
_LONGEST_HEADER = 1000

_DASH = re.compile(r"^[ \t]*- (?=[A-Za-z_])", re.MULTILINE)  # of a YAML list of names
_UNITY = [f"sh[{i:>2}]" for i in range(27)]
"""The names in Unity's YAML of a SphericalHarmonicsL2: all of red, then of green, then of blue."""


def read_list(text: str, *, table: bool = False, sort: bool = True) -> Listed:
    """The list in a text, and one line on each guess. table: its lines are rows, as in CSV.

    sort: by the columns l and m, if a header has them. LightError if it is anything but a list.
    """
    bare = without_comments(text).translate(_AS_ASCII)
    first, _, rest = bare.lstrip().partition("\n")
    if not first:
        raise LightError("no rows; a list has n^2 rows of red, green, blue")
    if header := _header(first, table):
        return _with_header(*header, rest.splitlines(), sort)
    pointed = _with_points(bare)
    found = _rows_of(_Scan(pointed), wrapped=not table)
    if pointed != bare:
        found = replace(found, notes=(DECIMAL_COMMAS, *found.notes))
    if "pre-scaled base" not in text or "irradiance" not in text:
        return found
    why = "its comments, irradiance and pre-scaled base, are those of Filament's cmgen, without --no-mirror: taken as filament"
    return replace(found, implied="filament", implied_by=why)


def plain_numbers(text: str) -> NDArray[np.float64]:
    """All numbers of a text, (k,), whatever their rows. LightError for anything else in it but brackets and comments."""
    return np.array(_Scan(without_comments(text)).values)


def without_comments(text: str) -> str:
    """The text with only the line breaks of its comments, in one pass; one that is never closed is left as it is.

    Comments are those of C, GLSL and Python.
    """
    parts, at, last_end = [], 0, text.rfind("*/")
    while opens := _COMMENT_OPENS.search(text, at):
        start, end = opens.span()
        if opens[0] != "/*":
            end = text.find("\n", start)
            end = len(text) if end < 0 else end
        elif end <= last_end:
            end = text.find("*/", end) + 2
        else:
            parts.append(text[at:end])
            at = end
            continue
        parts += text[at:start], "\n" * text.count("\n", start, end)
        at = end
    return "".join([*parts, text[at:]])


class _Scan:
    """The numbers of a text, and of each its line, the innermost bracket around it, and the last name with = or : before it."""

    def __init__(self, text: str) -> None:
        self.text = _DASH.sub("", _TEMPLATE.sub("", text))
        self.breaks = [match.start() for match in re.finditer("\n", self.text)]
        self.values: list[float] = []
        self.starts: list[int] = []
        self.brackets: list[int] = []
        self.owners: list[int] = []
        self.names: list[str] = []
        self._read()
        self.lines = [bisect_right(self.breaks, start) for start in self.starts]

    def _read(self) -> None:
        opened, inside, outer = 0, 0, list[int]()
        pending: list[re.Match[str]] = []  # names of which it is not known yet what they name
        for count, match in enumerate(_WORD.finditer(self.text)):
            word = match[0]
            if count > _MOST_WORDS or len(self.values) > MAX_NUMBERS:
                raise LightError(
                    f"more than {MAX_NUMBERS} numbers, which {MAX_BANDS} bands of three channels have, real and imaginary,"
                    " or far more words than numbers: keep the coefficients only"
                )
            if word in "([{":
                outer.append(inside)
                inside = opened = opened + 1
                pending.clear()  # the name of a type
            elif word in "=:" and pending:
                self.names.append(pending[-1][0])
                pending.clear()
            elif (value := _number(word)) is not None:
                if len(pending) == 1 and _PLACE.fullmatch(pending[0][0]) and not self._breaks(pending[0], match):
                    self.names.append(pending.pop()[0])
                if pending:
                    self._refuse(pending[0])
                self.values.append(value)
                self.starts.append(match.start())
                self.brackets.append(inside)
                self.owners.append(len(self.names) - 1)
            elif _NAME.fullmatch(word):
                pending.append(match)
            elif word in ")]}" and not pending:
                inside = outer.pop() if outer else 0
            else:
                self._refuse(pending[0] if pending else match)
        if pending:
            self._refuse(pending[0])

    def _breaks(self, before: re.Match[str], after: re.Match[str]) -> bool:
        return "\n" in self.text[before.end() : after.start()]

    def _refuse(self, match: re.Match[str]) -> None:
        line = bisect_right(self.breaks, match.start()) + 1
        raise LightError(
            f"{match[0][:40]!r} in line {line} is no number; a bare list holds numbers, commas, brackets, names and comments"
        )


def _number(word: str) -> float | None:
    """A number, perhaps with the suffix of C, GLSL or HLSL; None for any other word."""
    if not word.isascii() or "_" in word:  # Python would read 1_0 and the digits of all scripts
        return None
    try:
        return float(word[:-1] if word[-1] in "fFhH" and word[:-1] not in ("in", "+in", "-in") else word)
    except ValueError:
        return None


def _with_points(text: str) -> str:
    """The text with points for decimal commas: where cells are parted by semicolons or spaces, and are a list only so."""
    if "," not in text or "." in text:
        return text
    rows = [re.split(r"[;\s(){}\[\]]+", line.strip("; \t\r(){}[]")) for line in text.splitlines()]
    cells = [cell for row in rows for cell in row if cell]
    if max(map(len, rows)) < 2 or not all(map(_DECIMAL_COMMA.fullmatch, cells)):
        return text
    if not holds_light(len(cells)):
        return text
    if holds_light(len(cells) + text.count(",")):
        raise LightError("commas that may be decimal ones or part the numbers; write decimal points")
    _check_commas(cells)
    return text.replace(",", ".")


def _check_commas(cells: Iterable[str]) -> bool:
    """Whether some of the numbers have commas. LightError if all of these may be whole ones with a comma between thousands."""
    commas = [cell for cell in cells if "," in cell]
    if commas and all(map(_THOUSANDS.fullmatch, commas)):
        whole = commas[0].replace(",", "")
        raise LightError(
            f"{commas[0]}, which may be {commas[0].replace(',', '.')} or, with a comma between thousands, {whole};"
            " write decimal points"
        )
    return bool(commas)


# --------------------------------------------------------------------------------------------------------- rows


def _rows_of(scan: _Scan, wrapped: bool) -> Listed:
    """The numbers in rows: by their names, else by brackets, else by lines."""
    named = sorted(set(scan.owners))
    if len(named) > 1:
        return _by_name(scan, named)
    values = np.array(scan.values)
    by_bracket = _runs(scan.brackets)
    first = int(
        bool(values.size) and by_bracket[0][1] == 1 and len(by_bracket) > 2 and values[0] == len(by_bracket) - 1
    )
    groups = [bracket for bracket, _ in by_bracket[first:]]
    if len(groups) > 1 and 0 not in groups and len(set(groups)) == len(groups):
        sizes = [size for _, size in by_bracket[first:]]
        return _counted(arranged(_even(values[first:], sizes, "brackets")), first and values[0])
    sizes, first = [size for _, size in _runs(scan.lines)], 0
    if len(sizes) > 2 and sizes[0] == 1 < sizes[1] and _counts(values[0], sizes[1:]):
        first, sizes = 1, sizes[1:]
    elif values.size > 4 and _counts(values[0], [1] * (values.size - 1)):
        if holds_light(values.size):
            raise LightError(
                f"{values.size} numbers, of which the first, {values[0]:g}, may be how many rows follow; remove it if it is,"
                " or save the list as JSON"
            )
        first, sizes = 1, [values.size - 1]
    rows = values[first:]
    if len(set(sizes)) == 1:
        rows = rows.reshape(len(sizes), -1)
    return _counted(arranged(rows, wrapped=wrapped), first and values[0])


def _runs(labels: list[int]) -> list[tuple[int, int]]:
    """Each label and how often it stands in a row."""
    return [(label, len(list(same))) for label, same in groupby(labels)]


def _counts(first: float, sizes: list[int]) -> bool:
    """Whether a number is how many rows or numbers come after it, which have these sizes."""
    total = sum(sizes)
    return holds_light(total) and first in {len(sizes), total, total / 3}


def _counted(found: Listed, count: float) -> Listed:
    if not count:
        return found
    return replace(found, notes=(f"its first number, {count:g}, says how many rows follow", *found.notes))


def _even(values: Numbers, sizes: list[int], what: str) -> Numbers:
    """The values as rows of one size; flat, if the sizes are those of bands, 1, 3, 5 ... . LightError for any others."""
    if len(set(sizes)) == 1:
        return values.reshape(len(sizes), -1)
    if any(sizes == [channels * (2 * l + 1) for l in range(len(sizes))] for channels in (1, 3)):
        return values
    odd = next(size for size in sizes if size != sizes[0])
    raise LightError(f"{what} with {sizes[0]} numbers and with {odd}; rows are equally long: complete or remove some")


def _by_name(scan: _Scan, named: list[int]) -> Listed:
    """Rows or lists of which each has a name: of a channel, of an l and m, or with an index. LightError for other names."""
    sizes = [size for _, size in _runs(scan.owners)]
    names = [scan.names[owner] if owner >= 0 else "" for owner in named]
    values, empty = np.array(scan.values), [scan.names[i] for i in sorted(set(range(len(scan.names))) - set(named))]
    if names == _UNITY and set(sizes) == {1}:
        return Listed(values.reshape(3, 9).T, implied="unity", implied_by="sh[ 0] to sh[26] of Unity: taken as unity")
    if set(sizes) == {1}:
        for channels in (3, 4):
            if (order := _channel_order(names, channels)) is not None:
                rows = values.reshape(-1, channels)[:, order]
                place = places_of(empty) if len(empty) == len(rows) else None
                return arranged(rows if place is None else rows[np.argsort(place)])
    parts = np.split(values, list(accumulate(sizes))[:-1])
    if len(parts) == 3 and len(set(sizes)) == 1 and (order := _channel_order([_last_letter(n) for n in names], 3)):
        return arranged(np.stack([parts[i] for i in order]))
    place = places_of(names)
    if place is None:
        shown = ", ".join(name.split("[")[0][:20] or "one without a name" for name in names[:4])
        raise LightError(
            f"{len(names)} lists of numbers, with the names {shown}; keep the one that holds the coefficients"
        )
    rows = _even(values, sizes, "names")
    return arranged(rows[np.argsort(place)]) if rows.ndim == 2 else Listed(rows)


def _channel_order(names: list[str], channels: int) -> list[int] | None:
    """Where red, green, blue and then the rest stand among the first names, if these are repeated to the end; else None."""
    words = [name.split(".")[-1].strip("_").lower() for name in names]
    first = words[:channels]
    if len(words) % channels or words != first * (len(words) // channels):
        return None
    for known in (("r", "g", "b", "a"), ("x", "y", "z", "w"), ("red", "green", "blue", "alpha")):
        if set(first) == set(known[:channels]) and len(set(first)) == channels:
            return [first.index(name) for name in known[:channels]]
    return None


def _last_letter(name: str) -> str:
    """ "shR", "sh_red" and "red[9]" as r, or red."""
    word = name.split("[")[0].strip("_")
    return next((colour for colour in CHANNELS if word.lower().endswith(colour)), word[-1:])


def places_of(names: list[str]) -> list[int] | None:
    """The index l(l+1) + m of each name, such as L00, l1_1, L1m1 or sh[0]; None unless all n**2 are named once.

    An underscore alone may be a minus, as in Babylon's l1_1 beside l11, or part l and m, as in L1_1 beside L1_m1.
    """
    everything = list(range(len(names)))
    indices = [found for name in names if (found := _INDEX.fullmatch(name))]
    if len(indices) == len(names) and len({found[1] for found in indices}) == 1:
        place = [int(found[2]) for found in indices]
        return place if sorted(place) == everything else None
    parts = [found.groups() for name in names if (found := _PLACE.fullmatch(name))]
    for minus in ("mMnN-_", "mMnN-"):
        orders = [(int(l), int(m) * (-1 if set(sign) & set(minus) else 1)) for l, sign, m in parts]
        place = [l * (l + 1) + m for l, m in orders if abs(m) <= l]
        if sorted(place) == everything:
            return place
    return None


# ------------------------------------------------------------------------------------------------------- header


def _header(line: str, table: bool) -> tuple[str, list[str]] | None:
    """The separator of the cells and the names of the columns, if the first line holds such; else None."""
    if len(line) > _LONGEST_HEADER:
        return None
    separator = next((mark for mark in ";\t," if mark in line), " ")
    cells = [_COLUMNS.get(word, word) for word in _cells(line.lower(), separator)]
    names = set(cells) - {""}
    if names & {"nan", "inf", "infinity"} or not all(re.fullmatch(r"[a-z][\w-]*", name, re.ASCII) for name in names):
        return None
    return (separator, cells) if table or names & {*CHANNELS, "grey", "l"} else None


def _cells(line: str, separator: str) -> list[str]:
    """The cells of a line, without those that are empty at its end."""
    if separator == " ":
        return line.split()
    with decoding("CSV"):
        cells = [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]
    while cells and not cells[-1]:
        cells.pop()
    return cells


def _with_header(separator: str, names: list[str], lines: list[str], sort: bool) -> Listed:
    wanted = [name for channel in CHANNELS for name in (channel, f"{channel}-imaginary") if name in names]
    harmonics = {"l", "m", "c", "s"} <= set(names)
    if not wanted and (harmonics or "grey" in names):
        wanted = ["c", "s"] if harmonics else ["grey"]
    elif missing := [name for name in CHANNELS if name not in names]:
        raise LightError(f"no column {' and no column '.join(missing)}; the header must name red, green and blue")
    sort = sort and {"l", "m"} <= set(names) and len(lines) > 1
    columns = [names.index(name) for name in [*(["l", "m"] if sort else []), *wanted]]
    rows = []
    for number, line in enumerate(filter(str.strip, lines), 1):
        if number > MAX_BANDS**2:
            raise LightError(f"more than {MAX_BANDS**2} rows, which 128 bands have, the most that are read")
        cells = _cells(line, separator)
        if len(cells) != len(names):
            raise LightError(f"row {number} has {len(cells)} cells, the header {len(names)}: complete it")
        rows.append([cells[column] for column in columns])
    if not rows:
        raise LightError("a header and no rows; a list has n^2 rows of red, green, blue")
    notes = (DECIMAL_COMMAS,) if separator != "," and _check_commas(chain(*rows)) else ()
    table = np.array([[_cell(cell, number, separator) for cell in row] for number, row in enumerate(rows, 1)])
    if not sort:
        return Listed(table, notes=notes)
    found = sorted_by_degree(table)
    if found is None:
        raise LightError("columns l and m that do not name every coefficient of n bands once: complete or correct them")
    return replace(found, notes=(*notes, *(found.notes if harmonics else ())))


def _cell(cell: str, row: int, separator: str) -> float:
    if not cell:
        raise LightError(f"row {row} lacks a number: complete it")
    if separator != "," and _DECIMAL_COMMA.fullmatch(cell):
        cell = cell.replace(",", ".")
    if (value := _number(cell)) is None:
        raise LightError(f"{cell[:40]!r} in row {row} is no number: correct it")
    return value
