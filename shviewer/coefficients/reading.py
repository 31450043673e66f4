"""Reading coefficient files: those that `shviewer project` wrote, and bare lists of numbers whose convention is named.

Nothing in a file is run: an .npz with pickled objects is refused unread, and sizes are checked before memory is taken.
"""

from __future__ import annotations

import csv
import json
import re
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.array_files import read_arrays
from shviewer.coefficients.convention import OVER_PI, RADIANCE, Convention
from shviewer.coefficients.numbers import MAX_NUMBERS, as_table, plain_numbers
from shviewer.coefficients.programs import CONVENTIONS, parse_convention
from shviewer.coefficients.stamp import SCHEMA_KEY, Stamp, read_stamp
from shviewer.coefficients.suffixes import HOLDS
from shviewer.errors import LightError
from shviewer.files import decoding, naming, read_bytes
from shviewer.harmonics.basis import Array, count_bands
from shviewer.limits import DEFAULT_LIMITS, Limits

MAX_FILE_BYTES = 8 * 2**20
"""The most bytes of a file. 128 bands of three complex channels, with 24 characters a number, take 3 MiB."""

LARGEST = 1e100
"""The largest coefficient: beyond it, conversions and squares could leave float64. Lights that are drawn end at 1e30."""

TABLE_BEGINS, TABLE_ENDS = "coefficients begin", "coefficients end"
"""The words of two comments in a .h or .glsl file; between them stand the numbers, and nothing else."""

CHANNELS = ("red", "green", "blue")


@dataclass(frozen=True, eq=False)
class CoefficientFile:
    """A file that was read. numbers: as it has them, (n**2, 3), float64 or complex128. coefficients: in our convention."""

    numbers: NDArray[np.generic]
    convention: Convention
    coefficients: Array
    stamp: Stamp
    """The file's stamp; empty for a bare list."""

    @property
    def n_bands(self) -> int:
        return count_bands(self.coefficients)

    @property
    def quantity(self) -> str:
        """The quantity of `coefficients`: "radiance" or "irradiance"."""
        held = self.convention.quantity or RADIANCE
        return "irradiance" if held == OVER_PI else held


def read_coefficients(path: Path, named: str = "", limits: Limits = DEFAULT_LIMITS) -> CoefficientFile:
    """Read the coefficients in a file. named: the convention of a file that names none, a text for parse_convention.

    LightError, one line with file, finding and next step, for whatever is wrong with it.
    """
    with naming(str(path)):
        return interpreted(*read_numbers(path, limits), named)


def read_numbers(path: Path, limits: Limits = DEFAULT_LIMITS) -> tuple[NDArray[Any], Stamp]:
    """Read the numbers in a file, in whichever shape, and its stamp, empty for a bare list. LightError if it is bad."""
    limits = Limits(file_bytes=min(MAX_FILE_BYTES, limits.file_bytes))
    _check_size(path)
    return _READERS[HOLDS[path.suffix.lower()]](read_bytes(path, limits))


def _check_size(path: Path) -> None:
    """LightError if the file is too large, before a byte is read. Whether there is a file is checked later."""
    with suppress(OSError, ValueError):
        if (size := path.stat().st_size) > MAX_FILE_BYTES:
            raise LightError(
                f"{size} bytes; 128 bands, the most there can be, take less than {MAX_FILE_BYTES}: keep only those"
            )


def interpreted(numbers: NDArray[Any], stamp: Stamp, named: str) -> CoefficientFile:
    """Interpret numbers in the convention of their stamp, or the one that was named. LightError if that is impossible."""
    if stamp:
        convention = read_stamp(stamp)
        if named and parse_convention(named) != parse_convention(str(stamp["convention"])):
            raise LightError(
                f"says itself that its convention is {stamp['convention']}; leave out --convention {named}"
            )
    elif named:
        try:
            convention = parse_convention(named)
        except ValueError as error:
            raise LightError(str(error)) from error
    else:
        raise LightError(
            f"a bare list of numbers; name its convention: --convention {', '.join(CONVENTIONS)}, such as --convention three "
            "(in Python convention='three'); "
            "if the light is at hand, --compare finds it out: shviewer LIGHT --compare FILE"
        )
    table = as_table(numbers, complex_pairs=convention.complex)
    if stamp and "bands" in stamp and str(stamp["bands"]) != str(count_bands(table)):
        raise LightError(
            f"says {stamp['bands']} bands but has {len(table)} rows; n bands have n^2: project the light again"
        )
    if convention.most_bands is not None and count_bands(table) > convention.most_bands:
        raise LightError(
            f"{count_bands(table)} bands, so its numbers are not those of {convention.name}, which has at most "
            f"{convention.most_bands}: name another convention"
        )
    if np.abs(table).max() > LARGEST:
        raise LightError(f"a coefficient of {np.abs(table).max():.3g}; at most {LARGEST:g} is read: scale the light")
    try:
        return CoefficientFile(table, convention, convention.to_ours(table), stamp)
    except ValueError as error:
        raise LightError(str(error)) from error


def _read_json(data: bytes) -> tuple[NDArray[Any], Stamp]:
    with decoding("JSON"):
        found = json.loads(_text(data), parse_constant=_no_constant, object_pairs_hook=_no_key_twice)
    stamp: Stamp = {}
    if isinstance(found, dict):
        if "coefficients" not in found:
            raise LightError('a JSON object without "coefficients"; it holds rows of red, green and blue there')
        if SCHEMA_KEY in found:
            stamp = {key: value for key, value in found.items() if isinstance(value, str | int | float)}
        found = found["coefficients"]
    try:
        numbers = np.array(found)
    except (ValueError, OverflowError):  # rows of different lengths
        numbers = np.array([])
    rows = found if isinstance(found, list) else []
    if any(type(value) is bool for row in rows for value in (row if isinstance(row, list) else [row])):
        raise LightError("true or false among the coefficients; they are numbers")
    if numbers.ndim not in (1, 2) or not numbers.size or numbers.dtype.kind not in "fiu":
        raise LightError("coefficients must be rows of three numbers each, or one list of numbers")
    return numbers.astype(np.float64), stamp


def _no_key_twice(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice, _ = Counter(key for key, _ in pairs).most_common(1)[0]
        raise LightError(f"the key {twice!r} stands there twice; keep one of them")
    return found


def _no_constant(name: str) -> float:
    raise LightError(f"{name} among the coefficients; they are finite numbers: project the light again")


def _read_csv(data: bytes) -> tuple[NDArray[Any], Stamp]:
    """Read a CSV file. A header names the columns; without one there are three: red, green and blue."""
    text = _text(data)
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise LightError("no rows; a CSV file has n^2 rows of red, green, blue")
    header = [cell.strip().lower() for cell in _cells(lines[:1])[0]]
    if not any(re.fullmatch(r"[A-Za-z][\w-]*", cell) and cell not in ("nan", "inf", "infinity") for cell in header):
        numbers = plain_numbers(text)
        return numbers.reshape(len(lines), -1) if _even(lines, numbers.size) else numbers, _comments(text)
    wanted = [name for name in header if name.removesuffix("-imaginary") in CHANNELS]
    if missing := [name for name in CHANNELS if name not in wanted]:
        raise LightError(f"no column {' and no column '.join(missing)}; the header must name red, green and blue")
    rows = []
    for number, row in enumerate(_cells(lines[1:]), 1):
        if len(row) != len(header):
            raise LightError(f"row {number} has {len(row)} cells, the header {len(header)}: complete it")
        if number > MAX_NUMBERS:
            raise LightError(f"more than {MAX_NUMBERS} rows: at most 128 bands, 16384 rows, are read")
        rows.append(plain_numbers(" ".join(row[header.index(name)] for name in _in_order(wanted))))
        if len(rows[-1]) != len(wanted):
            raise LightError(f"row {number} lacks a number: complete it")
    return np.array(rows), _comments(text)


def _cells(lines: list[str]) -> list[list[str]]:
    with decoding("CSV"):
        return list(csv.reader(lines))


def _in_order(columns: list[str]) -> list[str]:
    return [name for channel in CHANNELS for name in (channel, f"{channel}-imaginary") if name in columns]


def _even(lines: list[str], count: int) -> bool:
    """Whether all lines hold the same number of numbers."""
    return "," in lines[0] and all((line.count(",") + 1) * len(lines) == count for line in lines)


def _read_text(data: bytes) -> tuple[NDArray[Any], Stamp]:
    """Read a .txt, .h or .glsl file: all its numbers, or those between the marks."""
    text = _text(data)
    begins, ends = text.find(TABLE_BEGINS), text.find(TABLE_ENDS)
    table = text if begins < 0 else text[text.find("\n", begins) : text.rfind("\n", 0, ends)] if ends > begins else ""
    numbers = plain_numbers(re.sub(r"\bd?vec3\b", "", table))
    stamp = _comments(text)
    columns = len(str(stamp.get("columns", "")).split())
    return numbers.reshape(-1, columns) if columns and numbers.size % columns == 0 else numbers, stamp


def _comments(text: str) -> Stamp:
    """The stamp in the comments; empty if there is none."""
    found: dict[str, str | int | float | None] = {}
    for line in text.splitlines():
        match = re.match(r"\s*(?:#|//|\*)\s?([a-z][a-z0-9-]*): (.*)$", line)
        if match:
            found.setdefault(match[1], match[2].strip())
    return found if SCHEMA_KEY in found else {}


def _text(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise LightError(f"byte {error.start} is no UTF-8: save it as text") from error


_READERS: dict[str, Callable[[bytes], tuple[NDArray[Any], Stamp]]] = {
    "json": _read_json,
    "csv": _read_csv,
    "text": _read_text,
    "arrays": read_arrays,
}
