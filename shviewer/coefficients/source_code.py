"""Coefficients as C and GLSL: the numbers, and in GLSL a function that evaluates exactly their number of bands.

The shader runs the recurrence of harmonics/basis.py in differences, written out without a loop: no trigonometry, no pole, and
every constant of the convention in place. Up to three bands the basis is a handful of polynomials, and they are written so.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from shviewer.coefficients.parts.scales import LEADING
from shviewer.coefficients.reading import TABLE_BEGINS, TABLE_ENDS
from shviewer.harmonics.basis import Array, degree_order, index, normalisation

MAX_GLSL_BANDS = 32
"""The most bands in a shader: as many as the window sums in its own; more belong in a texture."""


class Row(NamedTuple):
    """A row of a table: what it is, such as ("l", 0) and ("m", 0), and its numbers as text."""

    place: tuple[tuple[str, object], ...]
    numbers: list[str]

    @property
    def words(self) -> str:
        """ "l = 0, m = 0", or "c0" where there is one thing to say"""
        return (
            ", ".join(f"{name} = {value}" for name, value in self.place)
            if len(self.place) > 1
            else str(self.place[0][1])
        )


POLYNOMIALS = ("", "y", "z", "x", "x * y", "y * z", "3.0 * z * z - 1.0", "x * z", "x * x - y * y")
UNITY = 1e-15
"""A constant that differs from 1 by less is left out: the coefficient holds it already."""

_RowText = Callable[[int, int], str]
"""(l, m) -> the expression for its coefficient."""


def identifier(name: str) -> str:
    """The identifier sh_NAME, with only what C and GLSL allow in a name: letters, digits, single underscores."""
    return re.sub(r"_+", "_", "sh_" + re.sub(r"[^A-Za-z0-9]", "_", name)).rstrip("_")


def function_name(name: str, quantity: str) -> str:
    """The name of the function in GLSL: sh_NAME_QUANTITY."""
    return re.sub(r"\W", "_", f"{identifier(name)}_{quantity}")


def c_header(name: str, comments: Sequence[str], rows: Sequence[Row]) -> str:
    """A C99 header with one static array of doubles; complex numbers are pairs."""
    symbol = identifier(name)
    size = f"[{len(rows)}][3]" + ("[2]" if len(rows[0].numbers) == 6 else "")
    bands = f"{symbol.upper()}_BANDS = {math.isqrt(len(rows))}, " if len(rows[0].place) > 1 else ""
    lines = [*comments, "", f"#ifndef {symbol.upper()}_H", f"#define {symbol.upper()}_H", ""]
    lines += [f"enum {{ {bands}{symbol.upper()}_ROWS = {len(rows)} }};", ""]
    lines += [f"static const double {symbol}{size} = {{", f"    // {TABLE_BEGINS}"]
    for row in rows:
        numbers = row.numbers
        pairs = [f"{{{', '.join(numbers[i : i + 2])}}}" for i in range(0, 6, 2)] if len(numbers) == 6 else numbers
        lines.append(f"    {{{', '.join(pairs)}}},  // {row.words}")
    return "\n".join([*lines, f"    // {TABLE_ENDS}", "};", "", "#endif", ""])


def glsl_source(
    name: str, function: str, comments: Sequence[str], rows: Sequence[Row], factors: Array, shift: float, pole: str
) -> str:
    """Constants and the function `function(vec3 direction)`, GLSL 3.30 and later, without a #version line.

    factors: the program's basis functions over Y(l, m), by our index; shift: what it adds to their sum;
    pole: which components of a direction are x, y and z of the basis.
    ValueError for more than MAX_GLSL_BANDS bands.
    """
    n_bands, symbol = math.isqrt(len(rows)), identifier(name)
    if n_bands > MAX_GLSL_BANDS:
        raise ValueError(
            f"{n_bands} bands: a shader is written for 1 to {MAX_GLSL_BANDS}; use fewer, or .npz and a texture"
        )
    lines = [*comments, "", *glsl_table(symbol, rows), "", "// direction: unit, in the axes named above"]
    lines += [f"vec3 {function}(vec3 direction) {{"]
    components = zip("xyz", re.findall("..", pole), strict=True)
    named = (f"{name} = {sign.strip('+')}direction.{axis}" for name, (sign, axis) in components)
    lines += [f"    float {', '.join(named)};"]

    at = {row.place: number for number, row in enumerate(rows)}

    def row(l: int, m: int) -> str:
        return f"{symbol}[{at[('l', l), ('m', m)]}]"

    body = _polynomials(row, factors, n_bands) if n_bands <= 3 else _recurrence(row, factors, n_bands)
    if shift:
        body[-1] = f"{body[-1].removesuffix(';')} + {shift!r};"
    return "\n".join([*lines, *body, "}", ""])


def glsl_table(symbol: str, rows: Sequence[Row]) -> list[str]:
    """The lines of a constant array with the numbers."""
    last = len(rows) - 1
    lines = [f"const vec3 {symbol}[{len(rows)}] = vec3[{len(rows)}](", f"    // {TABLE_BEGINS}"]
    for number, row in enumerate(rows):
        lines.append(f"    vec3({', '.join(row.numbers)}){',' * (number < last)}  // {row.words}")
    return [*lines, f"    // {TABLE_ENDS}", ");"]


def _polynomials(row: _RowText, factors: Array, n_bands: int) -> list[str]:
    terms = [row(0, 0) + _times("", float(factors[0] * normalisation(n_bands)[0, 0]))]
    for place in range(1, n_bands**2):
        l, m = degree_order(place)
        constant = float(factors[place] * normalisation(n_bands)[l, abs(m)] * LEADING[place])
        terms.append(row(l, m) + _times(POLYNOMIALS[place], constant))
    return ["    return " + "\n         + ".join(terms) + ";"]


def _times(polynomial: str, constant: float) -> str:
    """The text " * (constant * polynomial)", without factors that are 1."""
    text = f"({polynomial})" if " " in polynomial else polynomial
    if abs(constant - 1) < UNITY:
        return f" * {text}" if text else ""
    return f" * ({constant!r} * {text})" if text else f" * {constant!r}"


def _recurrence(row: _RowText, factors: Array, n_bands: int) -> list[str]:
    """Lines of the recurrence: g is G(l, m), d its difference, south^(l - m) its sign; c and s are Re and Im (x + iy)^m."""
    norms = normalisation(n_bands)
    lines = ["    float t = (x * x + y * y) / (1.0 + abs(z)), south = z < 0.0 ? -1.0 : 1.0;"]
    lines += ["    float c = 1.0, s = 0.0, g, d, p;", "    vec3 sum = vec3(0.0);"]
    for m in range(n_bands):
        if m:
            lines.append("    p = c * x - s * y; s = s * x + c * y; c = p;")
        lines.append(f"    g = 1.0; d = 0.0;  // m = {m}")
        for l in range(m, n_bands):
            if l > m:
                q = (2 * l - 1) / (l + m)
                lines.append(f"    d = {q!r} * (d - t * g) - d; g += d;")
            sign = "south * " if (l - m) % 2 else ""
            terms = [f"{float(norms[l, m] * factors[index(l, m)])!r} * c * {row(l, m)}"]
            if m:
                terms.append(f"{float(norms[l, m] * factors[index(l, -m)])!r} * s * {row(l, -m)}")
            lines.append(f"    sum += {sign}g * ({' + '.join(terms)});")
    return [*lines, "    return sum;"]
