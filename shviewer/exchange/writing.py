"""Coefficients as files: JSON, CSV, NPZ, C and GLSL, every number exact and every file stating its convention.

Text holds the shortest digits that give the same float64 again. Equal arguments give equal bytes. What the keys of the
stamp mean is in lights/coefficients/stamp.py, where it is read.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import UsageError
from shviewer.exchange.projected import Projected
from shviewer.exchange.source_code import c_header, glsl_source
from shviewer.harmonics.basis import count_bands
from shviewer.harmonics.conventions.axes import orders
from shviewer.harmonics.conventions.convention import Convention
from shviewer.lights.coefficients.stamp import Stamp, Value

FORMATS = ("json", "csv", "npz", "h", "glsl")


def encode(projected: Projected, convention: Convention, kind: str) -> bytes:
    """The file's bytes; `kind` is one of FORMATS.

    UsageError if the convention has not so many bands, cannot hold the quantity or not be written so.
    """
    if kind not in FORMATS:
        raise UsageError(f"format {kind!r}: it must be one of {', '.join(FORMATS)}")
    try:
        numbers = convention.from_ours(projected.coefficients, projected.quantity)
        stamp = projected.stamp(convention, count_bands(numbers))
        return _ENCODERS[kind](numbers, stamp, convention, projected.name)
    except ValueError as error:
        raise UsageError(str(error)) from error


def real_columns(numbers: NDArray[np.generic]) -> NDArray[np.float64]:
    """(n**2, 3), or (n**2, 6) of complex ones: real and imaginary part of each channel."""
    if np.iscomplexobj(numbers):
        pairs = np.stack([numbers.real, numbers.imag], axis=-1)
        return np.asarray(pairs.reshape(len(numbers), -1), dtype=np.float64) + 0.0
    return np.asarray(numbers, dtype=np.float64)


def _json(numbers: NDArray[np.generic], stamp: dict[str, Value], convention: Convention, name: str) -> bytes:
    """One row to a line."""
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
    quantity = str(stamp["quantity"]).replace("-", "_")
    return glsl_source(name, quantity, _comment_lines("//", stamp), rows, factors, convention.mirrored).encode()


_Encoder = Callable[[NDArray[np.generic], dict[str, Value], Convention, str], bytes]
_ENCODERS: dict[str, _Encoder] = {"json": _json, "csv": _csv, "npz": _npz, "h": _h, "glsl": _glsl}


def _digits(row: Iterable[float]) -> list[str]:
    return [repr(float(value)) for value in row]


def _comment_lines(mark: str, stamp: Stamp) -> list[str]:
    return [
        f"{mark} {key}: {value!r}" if isinstance(value, float) else f"{mark} {key}: {value}"
        for key, value in stamp.items()
    ]


def _rows(numbers: NDArray[np.generic], convention: Convention) -> Iterable[tuple[int, int, NDArray[np.float64]]]:
    """(l, m, numbers) in the order of the file."""
    n_bands = count_bands(numbers)
    for index, (m, row) in enumerate(zip(orders(n_bands), real_columns(numbers), strict=True)):
        yield int(np.sqrt(index)), int(-m if convention.mirrored else m), row
