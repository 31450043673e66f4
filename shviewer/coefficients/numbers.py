"""The numbers of a coefficient file as a table of n**2 rows and three channels, and one line on every guess that this takes.

Brackets come before lines, and lines before nothing. Rows that name their l and m are sorted by them. n**2 rows of three are
red, green and blue; exactly three rows of n**2 are a channel each. n**2 rows of four or more are red, green, blue and something
else: an index and what only fills them up are dropped, anything else is refused. A list without rows holds n**2 grey numbers,
or 3 n**2 of red, green and blue in turn; the two cannot be confused, as 3 n**2 is no square.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.parts.channels import FLAT_BY_CHANNEL, INTERLEAVED
from shviewer.coefficients.stamp import Stamp
from shviewer.errors import LightError
from shviewer.limits import MAX_BANDS

MAX_NUMBERS = 6 * MAX_BANDS**2
"""The most numbers in a file: real and imaginary parts of three channels."""

Numbers = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Listed:
    """The numbers of a file: rows of channels, or a flat list."""

    numbers: Numbers
    stamp: Stamp = field(default_factory=dict)
    """The file's stamp; empty for a bare list."""
    notes: tuple[str, ...] = ()
    """One line on each guess."""
    implied: str = ""
    """The convention that the kind of file implies, a text for parse_convention; "" for none."""
    implied_by: str = ""
    """One line on why."""
    planar: bool = False
    """Whether the file has a row for each channel, so that `numbers` are its transpose."""
    placed: bool = False
    """Whether the file names l and m, so that its rows are in our order, whichever the program has."""


def arranged(numbers: Numbers, *, wrapped: bool = False) -> Listed:
    """The numbers of a bare list, one after the other (k,) or in rows (k, j), as rows of channels or a flat list.

    wrapped: whether the rows are lines, which may be nothing but where a list was broken.
    LightError for n**2 rows of which nobody knows what they hold.
    """
    if numbers.ndim == 1 or (wrapped and len(numbers) == 1) or numbers.shape[1] == 1:
        return _in_one_list(numbers.reshape(-1))
    rows, columns = numbers.shape
    if (found := sorted_by_degree(numbers)) is not None:
        return found
    if rows == 3 and columns > 3 and _is_square(columns):
        kind = "lines" if wrapped else "rows"
        note = f"three {kind} of {columns}: taken as red, green and blue, one after the other"
        return Listed(numbers.T, notes=(note,), planar=True)
    if columns in (2, 4) and _is_square(rows) and rows > 1:
        if _counts_up(numbers[:, 0]):
            return Listed(numbers[:, 1:], notes=("the first of its columns is the index of the row",))
        if columns == 4 and (last := numbers[0, 3]) in (0, 1) and (numbers[:, 3] == last).all():
            return Listed(numbers[:, :3], notes=(f"the fourth of its columns, {last:g} throughout, is dropped",))
    if wrapped and columns != 3:
        if not _is_square(rows) or (columns % 3 == 0 and _is_square(numbers.size // 3)):
            return _in_one_list(numbers.reshape(-1))
        if columns not in (2, 6):  # real and imaginary parts, if the convention is complex
            raise LightError(
                f"{rows} lines of {columns} numbers, which may be red, green, blue and something else; keep red, green and"
                " blue, or put all of one list on one line"
            )
    return Listed(numbers)


def in_sequence(listed: Listed, sequence: str) -> Numbers:
    """The numbers with their channels in a sequence of parts/channels.py, as rows of three.

    LightError if they are no list of three channels that could be in one.
    """
    numbers = listed.numbers
    if sequence == FLAT_BY_CHANNEL and numbers.ndim > 1:
        return numbers
    flat = numbers.T.reshape(-1) if listed.planar else numbers.reshape(-1)
    if listed.placed or np.iscomplexobj(flat) or flat.size % 3 or not _is_square(flat.size // 3):
        if sequence == FLAT_BY_CHANNEL:
            return numbers
        what = "rows that name their l and m" if listed.placed else f"{flat.size} numbers"
        raise LightError(f"{what} are not read {sequence}, which is for 3 n^2 numbers of three channels: leave it out")
    return flat.reshape(3, -1).T if sequence != INTERLEAVED else flat.reshape(-1, 3)


def _in_one_list(numbers: Numbers) -> Listed:
    size = numbers.size
    if size > 1 and _is_square(size):
        bands = isqrt(size)
        other = f", not as {size // 4} rows of four" if bands % 2 == 0 and bands > 2 else ""
        return Listed(numbers, notes=(f"{size} numbers in one list: taken as {bands} grey bands{other}",))
    if size > 3 and size % 3 == 0 and _is_square(size // 3):
        return Listed(numbers, notes=(f"{size} numbers in one list: taken as red, green and blue in turn",))
    return Listed(numbers)


def sorted_by_degree(numbers: Numbers) -> Listed | None:
    """Rows that begin with l and m, in our order without these; None if they do not name every coefficient once.

    SHTOOLS lists l, m >= 0, C and S, of which S is the coefficient of -m, and perhaps the errors of both.
    """
    rows, columns = numbers.shape
    if columns < 3 or rows < 3 or np.iscomplexobj(numbers):
        return None
    l, m = numbers[:, 0], numbers[:, 1]
    if not (np.isin(l, np.arange(MAX_BANDS)) & np.isin(m, np.arange(-MAX_BANDS, MAX_BANDS)) & (np.abs(m) <= l)).all():
        return None
    index = (l * (l + 1) + m).astype(np.int64)
    if _is_square(rows) and rows > 1 and np.array_equal(np.sort(index), np.arange(rows)):
        return Listed(numbers[np.argsort(index), 2:], notes=("the first two of its columns are l and m",), placed=True)
    n_bands = isqrt(2 * rows)
    if (
        columns not in (4, 6)
        or rows != n_bands * (n_bands + 1) // 2
        or l.max() >= n_bands
        or (m < 0).any()
        or len(set(index)) < rows
    ):
        return None
    found = np.zeros(n_bands**2)
    found[(l * (l + 1) - m).astype(np.int64)] = numbers[:, 3]
    found[index] = numbers[:, 2]
    notes = ("its columns are l, m, C and S, as SHTOOLS writes them, S being that of -m",)
    return Listed(found[:, None], notes=notes, placed=True)


def _counts_up(numbers: Numbers) -> bool:
    return any(np.array_equal(numbers, np.arange(first, first + len(numbers))) for first in (0, 1))


def _is_square(number: int) -> bool:
    return isqrt(number) ** 2 == number


def holds_light(count: int) -> bool:
    """Whether so many numbers are a list of grey, or of red, green and blue."""
    return count > 0 and (_is_square(count) or (count % 3 == 0 and _is_square(count // 3)))


def as_table(numbers: NDArray[np.generic], *, complex_pairs: bool = False) -> NDArray[np.generic]:
    """The numbers as a table (n**2, 3), float64. complex_pairs: complex128, from complex numbers or pairs of real ones.

    LightError for a length that fits no n, more than MAX_BANDS bands, or a value that is not finite.
    """
    if numbers.size > MAX_NUMBERS:
        raise LightError(f"{numbers.size} numbers: at most {MAX_BANDS} bands, {MAX_NUMBERS} numbers, are read")
    if np.iscomplexobj(numbers) and not complex_pairs:
        raise LightError("complex numbers; of the conventions only scipy has them: --convention scipy")
    with np.errstate(over="ignore", invalid="ignore"):  # of longer floats: what is not finite is refused below
        table = np.asarray(numbers, dtype=np.complex128 if np.iscomplexobj(numbers) else np.float64)
    if complex_pairs and not np.iscomplexobj(table):
        if table.shape[-1:] and table.shape[-1] % 2:
            raise LightError(
                f"rows of {table.shape[-1]} numbers; complex ones are pairs, real and imaginary part: six to a row"
            )
        table = np.ascontiguousarray(table).view(np.complex128)
    if not np.isfinite(table).all():
        row = int(np.argmin(np.isfinite(table).reshape(len(table), -1).all(axis=1)))
        where = f"{'row' if table.ndim > 1 else 'number'} {row} (from 0)"
        raise LightError(f"{where} is not finite; coefficients are finite numbers: project the light again")
    flat = table.reshape(-1)
    if flat.size and _is_square(flat.size) and (table.ndim == 1 or table.shape[1] == 1):
        flat = np.repeat(flat, 3)
    elif table.ndim == 2 and table.shape[1] != 3:
        raise LightError(f"rows of {table.shape[1]} numbers; a row holds red, green and blue: keep only those")
    rows = flat.size / 3
    n_bands = max(1, round(rows**0.5))
    if n_bands**2 != rows:
        what = f"{rows:g} rows of three" if flat.size % 3 == 0 else f"{flat.size} numbers"
        raise LightError(
            f"{what}: n bands have n^2 rows; near are n = {n_bands} ({n_bands**2} rows) and "
            f"n = {n_bands + (1 if n_bands**2 < rows or n_bands == 1 else -1)}"
        )
    if n_bands > MAX_BANDS:
        raise LightError(f"{n_bands} bands: at most {MAX_BANDS} are read; keep the first {MAX_BANDS**2} rows")
    return np.ascontiguousarray(flat.reshape(-1, 3))
