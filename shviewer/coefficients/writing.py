"""Coefficients as files: JSON, CSV, NPZ, and source code of C, GLSL, HLSL, JavaScript and C#.

Every number is exact: text holds the fewest digits that give the same float64 again. Every file states its convention, and what
to type. Equal arguments give equal bytes. stamp.py explains the keys of the stamp.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.client_code import csharp_class, javascript_module
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.hlsl import hlsl_of
from shviewer.coefficients.source_code import Row, c_header, function_name, glsl_source, identifier
from shviewer.coefficients.stamp import Value
from shviewer.coefficients.stored_code import FORMULAS, check_stored, glsl_decoder, in_axes, stored_rows
from shviewer.coefficients.use import JAVASCRIPT, USES, unity_vectors, with_keys, with_use
from shviewer.errors import UsageError
from shviewer.harmonics.basis import count_bands, degree_order
from shviewer.harmonics.quantities.encodings import Encoding, Stored
from shviewer.words import meant

OF_A_BASIS = ("basis", "phase", "index", "normalisation")
"""Keys of the stamp that say nothing where the numbers are no coefficients."""

FORMATS = ("json", "csv", "npz", "h", "glsl", "hlsl", "js", "cs")


class _Table(NamedTuple):
    """What is written."""

    numbers: NDArray[np.generic]
    """(k, 3), in the convention."""
    stamp: dict[str, Value]
    convention: Convention
    name: str
    """The name of the light."""
    rows: list[Row]
    """The numbers as text, each row with its place."""
    encoding: Encoding | None = None
    """What the numbers are of, if they are no coefficients alone."""

    def comments(self, mark: str = "//") -> list[str]:
        """The stamp in lines that begin with `mark`."""
        shown = {key: repr(value) if isinstance(value, float) else value for key, value in self.stamp.items()}
        return [f"{mark} {key}: {value}" for key, value in shown.items()]


def encode(
    numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, kind: str, name: str
) -> bytes:
    """The bytes of a file that holds `numbers` (n**2, 3), which are in `convention`, and the `stamp`.

    kind: one of FORMATS; name: the name of the array in a header. UsageError for another kind, ValueError for numbers that
    the format cannot hold.
    """
    names = identifier(name), function_name(name, str(stamp["quantity"]))
    said = with_use(stamp, numbers, convention, _known(kind), names)
    return _ENCODERS[kind](_Table(numbers, said, convention, name, _rows(numbers, convention)))


def encode_stored(stored: Stored, stamp: dict[str, Value], convention: Convention, kind: str, name: str) -> bytes:
    """The bytes of a file that holds what engines store of an irradiance, and its formula. Errors as in `encode`."""
    check_stored(stored.encoding, convention)
    numbers, formula = in_axes(stored, convention.axes), FORMULAS[stored.encoding.formula]
    added: dict[str, Value] = {
        "encoding": stored.name,
        "numbers": " ".join(stored.encoding.places),
        "formula": formula,
    }
    if not stored.encoding.turns:
        stamp = {key: value for key, value in stamp.items() if key not in OF_A_BASIS}
    if _known(kind) in ("glsl", "hlsl"):
        added["use"] = f"vec3 irradiance = {function_name(name, stored.name)}(normal);"
    rows = stored_rows(stored.encoding, numbers)
    return _ENCODERS[kind](_Table(numbers, with_keys(stamp, added), convention, name, rows, stored.encoding))


def _known(kind: str) -> str:
    if kind not in FORMATS:
        raise UsageError(f"format {kind!r}: {meant(kind, FORMATS)}")
    return kind


def real_columns(numbers: NDArray[np.generic]) -> NDArray[np.float64]:
    """The numbers as columns (n**2, 3), or (n**2, 6) for complex ones: real and imaginary part of each channel."""
    if np.iscomplexobj(numbers):
        pairs = np.stack([numbers.real, numbers.imag], axis=-1)
        return np.asarray(pairs.reshape(len(numbers), -1), dtype=np.float64) + 0.0
    return np.asarray(numbers, dtype=np.float64)


def _json(table: _Table) -> bytes:
    """JSON with one row to a line."""
    head = json.dumps(table.stamp, indent=2, allow_nan=False)[:-2]
    rows = ",\n".join(f"    [{', '.join(row.numbers)}]" for row in table.rows)
    return f'{head},\n  "coefficients": [\n{rows}\n  ]\n}}\n'.encode()


def _csv(table: _Table) -> bytes:
    heads = [name for name, _ in table.rows[0].place]
    lines = [*table.comments("#"), ",".join([*heads, *str(table.stamp["columns"]).split()])]
    lines += [",".join([*(str(value) for _, value in row.place), *row.numbers]) for row in table.rows]
    return ("\n".join(lines) + "\n").encode()


def _npz(table: _Table) -> bytes:
    file = io.BytesIO()
    np.savez(file, coefficients=table.numbers, stamp=np.array(json.dumps(table.stamp, allow_nan=False)))
    return file.getvalue()


def _h(table: _Table) -> bytes:
    layout = table.convention.layout
    if layout != Convention.layout:  # the program's own, which this array need not have
        program = table.convention.program.partition(",")[0]
        said: dict[str, Value] = {"layout": f"in {program} {layout}; this array is [row][channel]"}
        table = table._replace(stamp=table.stamp | said)
    return c_header(table.name, table.comments(), table.rows).encode()


def _glsl(table: _Table) -> bytes:
    name, comments, rows, convention = table.name, table.comments(), table.rows, table.convention
    if table.encoding is not None:
        function = function_name(name, str(table.stamp["encoding"]))
        return glsl_decoder(name, function, comments, rows, table.encoding.formula).encode()
    function = function_name(name, str(table.stamp["quantity"]))
    factors = convention.basis_factors(count_bands(table.numbers))
    return glsl_source(name, function, comments, rows, factors, convention.shift, convention.pole.text).encode()


def _hlsl(table: _Table) -> bytes:
    if str(table.stamp.get("use", "")).startswith("vec3 "):
        table = table._replace(stamp=table.stamp | {"use": f"float3{str(table.stamp['use']).removeprefix('vec3')}"})
    return hlsl_of(_glsl(table).decode()).encode()


def _js(table: _Table) -> bytes:
    use = USES.get(table.convention.name)
    applied = (str(table.stamp["use"]), use.takes) if use and use.language == JAVASCRIPT else None
    return javascript_module(table.name, table.comments(), table.rows, applied).encode()


def _cs(table: _Table) -> bytes:
    vectors = unity_vectors(table.numbers) if table.convention.name == "unity" else {}
    return csharp_class(table.name, table.comments(), table.rows, vectors).encode()


_ENCODERS: dict[str, Callable[[_Table], bytes]] = {
    "json": _json,
    "csv": _csv,
    "npz": _npz,
    "h": _h,
    "glsl": _glsl,
    "hlsl": _hlsl,
    "js": _js,
    "cs": _cs,
}


def _digits(row: Iterable[float]) -> list[str]:
    return [repr(float(value)) for value in row]


def _rows(numbers: NDArray[np.generic], convention: Convention) -> list[Row]:
    """Each row of the file with its l and m, from first to last."""
    places = convention.rows(count_bands(numbers)).tolist()
    return [
        Row(tuple(zip("lm", degree_order(place), strict=True)), _digits(row))
        for place, row in zip(places, real_columns(numbers), strict=True)
    ]
