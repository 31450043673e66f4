"""Reading coefficient files: those that `shviewer project` wrote, and bare lists of numbers whose convention is named.

Nothing in a file is run: an .npz with pickled objects is refused unread, and sizes are checked before memory is taken.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.array_files import read_arrays
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.lists.scan import plain_numbers
from shviewer.coefficients.lists.structures import read_structure, rows_of_numbers
from shviewer.coefficients.lists.text import read_list
from shviewer.coefficients.numbers import Listed, as_table, in_sequence
from shviewer.coefficients.parts.quantities import whole
from shviewer.coefficients.parts.rows import ACN, row_order
from shviewer.coefficients.stamp import (
    ENCODING_KEY,
    SCHEMA_KEY,
    TABLE_BEGINS,
    TABLE_ENDS,
    Stamp,
    Value,
    read_stamp,
    safe,
)
from shviewer.coefficients.stored_code import check_stored, out_of_axes
from shviewer.coefficients.suffixes import HOLDS
from shviewer.coefficients.texts import parse_convention
from shviewer.errors import LightError, refused_as
from shviewer.files import decoding, naming, read_bytes
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.quantities.encodings import ENCODINGS, Stored
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE
from shviewer.limits import DEFAULT_LIMITS, Limits
from shviewer.words import meant

MAX_FILE_BYTES = 8 * 2**20
"""The most bytes of a file. 128 bands of three complex channels, with 24 characters a number, take 3 MiB."""

LARGEST = 1e100
"""The largest coefficient: beyond it, conversions and squares could leave float64. Lights that are drawn end at 1e30."""


@dataclass(frozen=True, eq=False)
class CoefficientFile:
    """A file that was read. numbers: as it has them, (n**2, 3) or those of an encoding. coefficients: in our convention."""

    numbers: NDArray[np.generic]
    convention: Convention
    coefficients: Array
    stamp: Stamp
    """The file's stamp; empty for a bare list."""
    notes: tuple[str, ...] = ()
    """One line on each thing that was assumed."""
    implied: bool = False
    """Whether the convention is the one that the kind of file implies."""
    listed: Listed | None = None
    """The numbers before they were read in the convention."""
    stored: Stored | None = None
    """What an engine stores of an irradiance, if the numbers are that; the coefficients are then its bands."""

    @property
    def n_bands(self) -> int:
        return count_bands(self.coefficients)

    @property
    def quantity(self) -> str:
        """The quantity of `coefficients`: "radiance" or "irradiance"."""
        return whole(self.convention.quantity or RADIANCE)


def read_coefficients(path: Path, named: str = "", limits: Limits = DEFAULT_LIMITS) -> CoefficientFile:
    """Read the coefficients in a file. named: the convention of a file that names none, a text for parse_convention.

    LightError, one line with file, finding and next step, for whatever is wrong with it.
    """
    with naming(str(path)):
        return interpreted(read_numbers(path, limits), named)


def read_numbers(path: Path, limits: Limits = DEFAULT_LIMITS) -> Listed:
    """Read the numbers in a file, of whichever shape. LightError if it is bad."""
    rule = f"128 bands, the most there can be, take less than {MAX_FILE_BYTES}: keep only those"
    return _READERS[HOLDS[path.suffix.lower()]](read_bytes(path, limits, MAX_FILE_BYTES, rule))


def interpreted(listed: Listed, named: str, *, overrule: bool = False) -> CoefficientFile:
    """Interpret numbers in the convention of their stamp, the one that was named, or the one that their file implies.

    overrule: the stamp, by what was named, with a note. LightError if it is impossible.
    """
    stamp, notes = safe(listed.stamp), listed.notes
    if listed.stamp:
        convention = read_stamp(stamp)
        if named and parse_convention(named) != parse_convention(str(stamp["convention"])):
            if not overrule:
                raise LightError(
                    f"says itself that its convention is {stamp['convention']}; leave out --convention {named}"
                )
            convention = parse_convention(named)
            notes = (*notes, f"says that its convention is {stamp['convention']}; read as {named}")
    elif named or listed.implied:
        with refused_as(LightError):
            convention = parse_convention(named or listed.implied)
        notes = notes if named else (*notes, listed.implied_by)
    else:
        _check_shape(listed.numbers)
        raise LightError(
            "a bare list of numbers; name its convention, such as --convention three (--input-convention of shviewer project, "
            "whose --help names them all; convention='three' in Python); "
            "if the light is at hand, --compare finds it out: shviewer LIGHT --compare FILE"
        )
    if ENCODING_KEY in stamp:
        return _stored(listed, convention, stamp, notes)
    sequence = convention.sequence if not stamp else ""
    numbers = in_sequence(listed, sequence) if sequence else listed.numbers
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
    if listed.placed and convention.order != ACN:
        try:
            table = table[row_order(convention.order, count_bands(table))]
        except ValueError as error:
            raise LightError(f"{error}; leave {convention.order} out, its rows name their l and m") from error
    _check_size(table)
    with refused_as(LightError):
        return CoefficientFile(table, convention, convention.to_ours(table), stamp, notes, not (stamp or named), listed)


def _stored(listed: Listed, convention: Convention, stamp: Stamp, notes: tuple[str, ...]) -> CoefficientFile:
    """Numbers of which a formula makes irradiance, as --encode writes them. LightError if they are not those of their stamp."""
    name, quantity = stamp[ENCODING_KEY], stamp.get("quantity")
    if name not in ENCODINGS:
        raise LightError(f"encoding {name!r}: {meant(str(name), ENCODINGS)}")
    if quantity != IRRADIANCE:
        raise LightError(f"encoding {name} is of irradiance, but quantity says {quantity}: correct one of them")
    encoding = ENCODINGS[name]
    if (places := stamp.get("numbers", "")) != " ".join(encoding.places):
        raise LightError(
            f"numbers says {places!r}; those of {name} are {' '.join(encoding.places)}: correct one of them"
        )
    numbers = np.asarray(listed.numbers, dtype=np.float64)
    if not np.isfinite(numbers).all():
        raise LightError("a number that is not finite; project the light again")
    _check_size(numbers)
    with refused_as(LightError):
        check_stored(encoding, convention)
        stored = out_of_axes(name, numbers, convention.axes)
    return CoefficientFile(
        numbers, convention, encoding.expand(stored.numbers), stamp, notes, listed=listed, stored=stored
    )


def _check_size(numbers: NDArray[np.generic]) -> None:
    if np.abs(numbers).max() > LARGEST:
        raise LightError(f"a coefficient of {np.abs(numbers).max():.3g}; at most {LARGEST:g} is read: scale the light")


def _check_shape(numbers: NDArray[Any]) -> None:
    """LightError for numbers that are no coefficients in any convention."""
    try:
        as_table(numbers, complex_pairs=np.iscomplexobj(numbers))
    except LightError:
        with suppress(LightError):
            as_table(numbers, complex_pairs=True)
            return
        raise


def _read_json(data: bytes) -> Listed:
    with decoding("JSON"):
        found = json.loads(_text(data), parse_constant=_no_constant, object_pairs_hook=_no_key_twice)
    if not isinstance(found, dict) or SCHEMA_KEY not in found:
        return read_structure(found)
    return Listed(rows_of_numbers(found.get("coefficients")), found)


def _no_key_twice(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice, _ = Counter(key for key, _ in pairs).most_common(1)[0]
        raise LightError(f"the key {twice!r} stands there twice; keep one of them")
    return found


def _no_constant(name: str) -> float:
    raise LightError(f"{name} among the coefficients; they are finite numbers: project the light again")


def _read_text(data: bytes, table: bool = False) -> Listed:
    """Read a .csv (table), .txt or a file of source code: its list, or what stands between the marks."""
    text = _text(data)
    stamp, begins, ends = _comments(text), text.find(TABLE_BEGINS), text.find(TABLE_ENDS)
    if not stamp:
        return read_list(text, table=table)
    if begins < 0:
        return Listed(read_list(text, table=table, sort=False).numbers, stamp)
    numbers = plain_numbers(text[text.find("\n", begins) : text.rfind("\n", 0, ends)] if ends > begins else "")
    columns = len(str(stamp.get("columns", "")).split())
    return Listed(numbers.reshape(-1, columns) if columns and numbers.size % columns == 0 else numbers, stamp)


def _comments(text: str) -> Stamp:
    """The stamp in the comments; empty if there is none."""
    found: dict[str, Value] = {}
    for line in text.splitlines() if SCHEMA_KEY in text else ():
        match = re.match(r"\s*(?:#|//|\*)\s?([a-z][a-z0-9-]*): (.*)$", line)
        if match:
            found.setdefault(match[1], match[2].strip())
    return found if SCHEMA_KEY in found else {}


def _text(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise LightError(f"byte {error.start} is no UTF-8: save it as text") from error


_READERS: dict[str, Callable[[bytes], Listed]] = {
    "json": _read_json,
    "csv": partial(_read_text, table=True),
    "text": _read_text,
    "arrays": read_arrays,
}
