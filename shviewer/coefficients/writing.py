"""Coefficients as files: JSON, CSV, NPZ, and source code of C, GLSL, JavaScript and C#.

Every number is exact: text holds the fewest digits that give the same float64 again. Every file states its convention, and what
to type. Equal arguments give equal bytes. stamp.py explains the keys of the stamp.
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.client_code import csharp_class, javascript_module
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.source_code import Row, c_header, function_name, glsl_source, identifier
from shviewer.coefficients.stamp import Value
from shviewer.coefficients.use import JAVASCRIPT, USES, unity_vectors, with_use
from shviewer.errors import UsageError
from shviewer.harmonics.basis import count_bands, degree_order
from shviewer.words import meant

FORMATS = ("json", "csv", "npz", "h", "glsl", "js", "cs")


class _Table(NamedTuple):
    """What is written: numbers (n**2, 3) in a convention, the stamp, and the name of the light."""

    numbers: NDArray[np.generic]
    stamp: dict[str, Value]
    convention: Convention
    name: str

    def rows(self) -> Iterator[Row]:
        """Each row as l, m and its numbers as text, from first to last."""
        n_bands = count_bands(self.numbers)
        for place, row in zip(self.convention.rows(n_bands).tolist(), real_columns(self.numbers), strict=True):
            yield (*degree_order(place), _digits(row))

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
    if kind not in FORMATS:
        raise UsageError(f"format {kind!r}: {meant(kind, FORMATS)}")
    names = identifier(name), function_name(name, str(stamp["quantity"]))
    return _ENCODERS[kind](_Table(numbers, with_use(stamp, numbers, convention, kind, names), convention, name))


def real_columns(numbers: NDArray[np.generic]) -> NDArray[np.float64]:
    """The numbers as columns (n**2, 3), or (n**2, 6) for complex ones: real and imaginary part of each channel."""
    if np.iscomplexobj(numbers):
        pairs = np.stack([numbers.real, numbers.imag], axis=-1)
        return np.asarray(pairs.reshape(len(numbers), -1), dtype=np.float64) + 0.0
    return np.asarray(numbers, dtype=np.float64)


def _json(table: _Table) -> bytes:
    """JSON with one row to a line."""
    head = json.dumps(table.stamp, indent=2, allow_nan=False)[:-2]
    rows = ",\n".join(f"    [{', '.join(_digits(row))}]" for row in real_columns(table.numbers))
    return f'{head},\n  "coefficients": [\n{rows}\n  ]\n}}\n'.encode()


def _csv(table: _Table) -> bytes:
    lines = [*table.comments("#"), ",".join(["l", "m", *str(table.stamp["columns"]).split()])]
    lines += [",".join([str(l), str(m), *numbers]) for l, m, numbers in table.rows()]
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
    return c_header(table.name, table.comments(), list(table.rows())).encode()


def _glsl(table: _Table) -> bytes:
    factors = table.convention.basis_factors(count_bands(table.numbers))
    function = function_name(table.name, str(table.stamp["quantity"]))
    shift, pole = table.convention.shift, table.convention.pole.text
    return glsl_source(table.name, function, table.comments(), list(table.rows()), factors, shift, pole).encode()


def _js(table: _Table) -> bytes:
    use = USES.get(table.convention.name)
    applied = (str(table.stamp["use"]), use.takes) if use and use.language == JAVASCRIPT else None
    return javascript_module(table.name, table.comments(), list(table.rows()), applied).encode()


def _cs(table: _Table) -> bytes:
    vectors = unity_vectors(table.numbers) if table.convention.name == "unity" else {}
    return csharp_class(table.name, table.comments(), list(table.rows()), vectors).encode()


_ENCODERS = {"json": _json, "csv": _csv, "npz": _npz, "h": _h, "glsl": _glsl, "js": _js, "cs": _cs}


def _digits(row: Iterable[float]) -> list[str]:
    return [repr(float(value)) for value in row]
