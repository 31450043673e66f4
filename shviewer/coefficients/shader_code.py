"""Coefficients in a shader: GLSL or HLSL with a function that evaluates exactly their number of bands.

The shader runs the recurrence of harmonics/basis.py in differences, written out without a loop: no trigonometry, no pole, and
every constant of the convention in place. Up to three bands the basis is a handful of polynomials, and they are written so.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from shviewer.coefficients.parts.scales import LEADING
from shviewer.coefficients.stamp import TABLE_BEGINS, TABLE_ENDS
from shviewer.coefficients.table import Table
from shviewer.harmonics.basis import Array, degree_order, index, normalisation

MAX_GLSL_BANDS = 32
"""The most bands in a shader: as many as the window sums in its own; more belong in a texture."""

POLYNOMIALS = ("", "y", "z", "x", "x * y", "y * z", "3.0 * z * z - 1.0", "x * z", "x * x - y * y")
UNITY = 1e-15
"""A constant that differs from 1 by less is left out: the coefficient holds it already."""

_RowText = Callable[[int, int], str]
"""(l, m) -> the expression for its coefficient."""

_HLSL = (
    (r"const vec3 (\w+)\[(\d+)\] = vec3\[\d+\]\(", r"static const vec3 \1[\2] = {"),
    (r"^\);$", "};"),
    (r"\bvec3 sum;", "vec3 sum = vec3(0.0);"),
    (r"\b(\w) == vec3\(0\.0\)", r"all(\1 == vec3(0.0))"),
    (r"\b(\w) != vec3\(0\.0\)", r"any(\1 != vec3(0.0))"),
    (r"\bvec3\(0\.0\)", "vec3(0.0, 0.0, 0.0)"),
    (r"\bvec3\b", "float3"),
)
"""What is replaced by what, in this order, to make HLSL of our GLSL. The languages differ in the names of vectors and in how
arrays begin and end; in HLSL one number makes no vector, and comparing vectors gives a vector."""


def glsl_source(table: Table) -> str:
    """Coefficients and their function of a direction, GLSL 3.30 and later, without a #version line.

    ValueError for more than MAX_GLSL_BANDS bands, or a convention of complex functions.
    """
    n_bands, convention = math.isqrt(len(table.rows)), table.convention
    factors = convention.basis_factors(n_bands)
    if n_bands > MAX_GLSL_BANDS:
        raise ValueError(
            f"{n_bands} bands: a shader is written for 1 to {MAX_GLSL_BANDS}; use fewer, or .npz and a texture"
        )
    lines = [*glsl_table(table), "// direction: unit, in the axes named above"]
    lines += [f"vec3 {table.function}(vec3 direction) {{"]
    components = zip("xyz", re.findall("..", convention.pole.text), strict=True)
    named = (f"{name} = {sign.strip('+')}direction.{axis}" for name, (sign, axis) in components)
    lines += [f"    float {', '.join(named)};"]

    at = {row.place: number for number, row in enumerate(table.rows)}

    def row(l: int, m: int) -> str:
        return f"{table.symbol}[{at[('l', l), ('m', m)]}]"

    body = _polynomials(row, factors, n_bands) if n_bands <= 3 else _recurrence(row, factors, n_bands)
    if convention.shift:
        body[-1] = f"{body[-1].removesuffix(';')} + {convention.shift!r};"
    return "\n".join([*lines, *body, "}", ""])


def glsl_table(table: Table) -> list[str]:
    """The stamp and a constant array with the numbers, in lines."""
    count = len(table.rows)
    lines = [*table.comments(), "", f"const vec3 {table.symbol}[{count}] = vec3[{count}](", f"    // {TABLE_BEGINS}"]
    for number, row in enumerate(table.rows, 1):
        lines.append(f"    vec3({', '.join(row.numbers)}){',' * (number < count)}  // {row.words}")
    return [*lines, f"    // {TABLE_ENDS}", ");", ""]


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


def hlsl_of(glsl: str) -> str:
    """What `glsl_source` or `glsl_decoder` wrote in HLSL of shader model 4 and later, for Direct3D, Unity and Unreal."""
    lines = glsl.splitlines(keepends=True)
    count = next(number for number, line in enumerate(lines) if not line.startswith("//"))
    comments, body = "".join(lines[:count]), "".join(lines[count:])
    for glsl_words, hlsl_words in _HLSL:
        body = re.sub(glsl_words, hlsl_words, body, flags=re.MULTILINE)
    return comments + body
