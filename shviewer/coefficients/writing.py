"""Coefficients as files: JSON, CSV, NPZ, and source code of C, GLSL, JavaScript and C#.

Every number is exact: text holds the fewest digits that give the same float64 again. Every file states its convention, and what
to type. Equal arguments give equal bytes. stamp.py explains the keys of the stamp.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.client_code import csharp_class, javascript_module
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.parts.axes import orders
from shviewer.coefficients.source_code import c_header, function_name, glsl_source, identifier
from shviewer.coefficients.stamp import Stamp, Value
from shviewer.coefficients.use import JAVASCRIPT, USES, unity_vectors, with_use
from shviewer.errors import UsageError
from shviewer.harmonics.basis import count_bands
from shviewer.words import meant

FORMATS = ("json", "csv", "npz", "h", "glsl", "js", "cs")


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
    return _ENCODERS[kind](numbers, with_use(stamp, numbers, convention, kind, names), convention, name)


def real_columns(numbers: NDArray[np.generic]) -> NDArray[np.float64]:
    """The numbers as columns (n**2, 3), or (n**2, 6) for complex ones: real and imaginary part of each channel."""
    if np.iscomplexobj(numbers):
        pairs = np.stack([numbers.real, numbers.imag], axis=-1)
        return np.asarray(pairs.reshape(len(numbers), -1), dtype=np.float64) + 0.0
    return np.asarray(numbers, dtype=np.float64)


def _json(numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, name: str) -> bytes:
    """JSON with one row to a line."""
    head = json.dumps(stamp, indent=2, allow_nan=False)[:-2]
    rows = ",\n".join(f"    [{', '.join(_digits(row))}]" for row in real_columns(numbers))
    return f'{head},\n  "coefficients": [\n{rows}\n  ]\n}}\n'.encode()


def _csv(numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, name: str) -> bytes:
    lines = [*_comment_lines("#", stamp), ",".join(["l", "m", *str(stamp["columns"]).split()])]
    for l, m, row in _rows(numbers, convention):
        lines.append(",".join([str(l), str(m), *_digits(row)]))
    return ("\n".join(lines) + "\n").encode()


def _npz(numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, name: str) -> bytes:
    file = io.BytesIO()
    np.savez(file, coefficients=numbers, stamp=np.array(json.dumps(stamp, allow_nan=False)))
    return file.getvalue()


def _h(numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, name: str) -> bytes:
    rows = [(l, m, _digits(row)) for l, m, row in _rows(numbers, convention)]
    if convention.layout != Convention.layout:  # the program's own, which this array need not have
        program = convention.program.partition(",")[0]
        stamp = stamp | {"layout": f"in {program} {convention.layout}; this array is [row][channel]"}
    return c_header(name, _comment_lines("//", stamp), rows).encode()


def _glsl(numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, name: str) -> bytes:
    factors = convention.basis_factors(count_bands(numbers))
    rows = [(l, m, _digits(row)) for l, m, row in _rows(numbers, convention)]
    function = function_name(name, str(stamp["quantity"]))
    return glsl_source(
        name, function, _comment_lines("//", stamp), rows, factors, convention.shift, convention.pole.text
    ).encode()


def _js(numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, name: str) -> bytes:
    rows = [(l, m, _digits(row)) for l, m, row in _rows(numbers, convention)]
    use = USES.get(convention.name)
    applied = (str(stamp["use"]), use.takes) if use and use.language == JAVASCRIPT else None
    return javascript_module(name, _comment_lines("//", stamp), rows, applied).encode()


def _cs(numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, name: str) -> bytes:
    rows = [(l, m, _digits(row)) for l, m, row in _rows(numbers, convention)]
    vectors = unity_vectors(numbers) if convention.name == "unity" else {}
    return csharp_class(name, _comment_lines("//", stamp), rows, vectors).encode()


_Encoder = Callable[[NDArray[np.generic], dict[str, Value], Convention, str], bytes]
_ENCODERS: dict[str, _Encoder] = {"json": _json, "csv": _csv, "npz": _npz, "h": _h, "glsl": _glsl, "js": _js, "cs": _cs}


def _digits(row: Iterable[float]) -> list[str]:
    return [repr(float(value)) for value in row]


def _comment_lines(mark: str, stamp: Stamp) -> list[str]:
    return [
        f"{mark} {key}: {value!r}" if isinstance(value, float) else f"{mark} {key}: {value}"
        for key, value in stamp.items()
    ]


def _rows(numbers: NDArray[np.generic], convention: Convention) -> Iterable[tuple[int, int, NDArray[np.float64]]]:
    """Each row of the file as (l, m, numbers), from first to last."""
    n_bands = count_bands(numbers)
    for index, row in zip(convention.rows(n_bands), real_columns(numbers), strict=True):
        yield int(np.sqrt(index)), int(orders(n_bands)[index]), row
