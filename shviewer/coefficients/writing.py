"""Coefficients as files: JSON, CSV, NPZ, and source code of C, GLSL, HLSL, JavaScript and C#.

Every number is exact: text holds the fewest digits that give the same float64 again. Every file states its convention, and what
to type. Equal arguments give equal bytes. stamp.py explains the keys of the stamp.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.shader_code import glsl_source, hlsl_of
from shviewer.coefficients.source_code import c_header, csharp_class, javascript_module
from shviewer.coefficients.stamp import Value
from shviewer.coefficients.stored_code import FORMULAS, check_stored, glsl_decoder, in_axes, stored_rows
from shviewer.coefficients.table import Table, TableRow
from shviewer.coefficients.use import with_use
from shviewer.errors import UsageError
from shviewer.harmonics.basis import count_bands, degree_order
from shviewer.harmonics.quantities.encodings import Stored
from shviewer.words import meant

OF_A_BASIS = ("basis", "phase", "index", "normalisation")
"""Keys of the stamp that say nothing where the numbers are no coefficients."""

FORMATS = ("json", "csv", "npz", "h", "glsl", "hlsl", "js", "cs")


def encode(
    numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, kind: str, name: str
) -> bytes:
    """The bytes of a file that holds `numbers` (n**2, 3), which are in `convention`, and the `stamp`.

    kind: one of FORMATS; name: the name of the array in a header. UsageError for another kind, ValueError for numbers that
    the format cannot hold.
    """
    _check(kind)
    return _ENCODERS[kind](with_use(Table(numbers, stamp, convention, name, _rows(numbers, convention)), kind))


def encode_stored(stored: Stored, stamp: dict[str, Value], convention: Convention, kind: str, name: str) -> bytes:
    """The bytes of a file that holds what engines store of an irradiance, and its formula. Errors as in `encode`."""
    check_stored(stored.encoding, convention)
    _check(kind)
    if not stored.encoding.turns:
        stamp = {key: value for key, value in stamp.items() if key not in OF_A_BASIS}
    numbers = in_axes(stored, convention.axes)
    table = Table(numbers, stamp, convention, name, stored_rows(stored.encoding, numbers), stored)
    added: dict[str, Value] = {
        "encoding": stored.name,
        "numbers": " ".join(stored.encoding.places),
        "formula": FORMULAS[stored.encoding.formula],
    }
    if kind in ("glsl", "hlsl"):
        added["use"] = f"vec3 irradiance = {table.function}(normal);"
    return _ENCODERS[kind](table.with_keys(added))


def _check(kind: str) -> None:
    if kind not in FORMATS:
        raise UsageError(f"format {kind!r}: {meant(kind, FORMATS)}")


def real_columns(numbers: NDArray[np.generic]) -> NDArray[np.float64]:
    """The numbers as columns (n**2, 3), or (n**2, 6) for complex ones: real and imaginary part of each channel."""
    if np.iscomplexobj(numbers):
        pairs = np.stack([numbers.real, numbers.imag], axis=-1)
        return np.asarray(pairs.reshape(len(numbers), -1), dtype=np.float64) + 0.0
    return np.asarray(numbers, dtype=np.float64)


def _json(table: Table) -> str:
    """JSON with one row to a line."""
    head = json.dumps(table.stamp, indent=2, allow_nan=False)[:-2]
    rows = ",\n".join(f"    [{', '.join(row.numbers)}]" for row in table.rows)
    return f'{head},\n  "coefficients": [\n{rows}\n  ]\n}}\n'


def _csv(table: Table) -> str:
    heads = [name for name, _ in table.rows[0].place]
    lines = [*table.comments("#"), ",".join([*heads, *str(table.stamp["columns"]).split()])]
    lines += [",".join([*(str(value) for _, value in row.place), *row.numbers]) for row in table.rows]
    return "\n".join(lines) + "\n"


def _npz(table: Table) -> bytes:
    file = io.BytesIO()
    np.savez(file, coefficients=table.numbers, stamp=np.array(json.dumps(table.stamp, allow_nan=False)))
    return file.getvalue()


def _glsl(table: Table) -> str:
    return glsl_source(table) if table.stored is None else glsl_decoder(table)


def _hlsl(table: Table) -> str:
    if str(table.stamp.get("use", "")).startswith("vec3 "):
        table = table._replace(stamp=table.stamp | {"use": f"float3{str(table.stamp['use']).removeprefix('vec3')}"})
    return hlsl_of(_glsl(table))


def _text(written: Callable[[Table], str]) -> Callable[[Table], bytes]:
    return lambda table: written(table).encode()


_ENCODERS: dict[str, Callable[[Table], bytes]] = {
    "json": _text(_json),
    "csv": _text(_csv),
    "npz": _npz,
    "h": _text(c_header),
    "glsl": _text(_glsl),
    "hlsl": _text(_hlsl),
    "js": _text(javascript_module),
    "cs": _text(csharp_class),
}


def _rows(numbers: NDArray[np.generic], convention: Convention) -> list[TableRow]:
    """Each row of the file with its l and m, from first to last."""
    places = convention.rows(count_bands(numbers)).tolist()
    return [
        TableRow(tuple(zip("lm", degree_order(place), strict=True)), [repr(value) for value in row])
        for place, row in zip(places, real_columns(numbers).tolist(), strict=True)
    ]
