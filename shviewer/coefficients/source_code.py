"""Coefficients as tables in C, JavaScript and C#, with the line that hands them to the program."""

from __future__ import annotations

import math

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.stamp import TABLE_BEGINS, TABLE_ENDS, Value
from shviewer.coefficients.table import Table
from shviewer.coefficients.use import JAVASCRIPT, USES, unity_vectors


def c_header(table: Table) -> str:
    """A C99 header with one static array of doubles; complex numbers are pairs."""
    layout = table.convention.layout
    if layout != Convention.layout:  # the program's own, which this array need not have
        program = table.convention.program.partition(",")[0]
        said: dict[str, Value] = {"layout": f"in {program} {layout}; this array is [row][channel]"}
        table = table._replace(stamp=table.stamp | said)
    symbol, rows = table.symbol, table.rows
    size = f"[{len(rows)}][3]" + ("[2]" if len(rows[0].numbers) == 6 else "")
    bands = f"{symbol.upper()}_BANDS = {math.isqrt(len(rows))}, " if len(rows[0].place) > 1 else ""
    lines = [*table.comments(), "", f"#ifndef {symbol.upper()}_H", f"#define {symbol.upper()}_H", ""]
    lines += [f"enum {{ {bands}{symbol.upper()}_ROWS = {len(rows)} }};", ""]
    lines += [f"static const double {symbol}{size} = {{", f"    // {TABLE_BEGINS}"]
    for row in rows:
        numbers = row.numbers
        pairs = [f"{{{', '.join(numbers[i : i + 2])}}}" for i in range(0, 6, 2)] if len(numbers) == 6 else numbers
        lines.append(f"    {{{', '.join(pairs)}}},  // {row.words}")
    return "\n".join([*lines, f"    // {TABLE_ENDS}", "};", "", "#endif", ""])


def javascript_module(table: Table) -> str:
    """An ES module with the rows and, where the program runs in a browser, a function `apply` that hands them to it."""
    lines = [*table.comments(), "", f"export const {table.symbol} = [", f"    // {TABLE_BEGINS}"]
    lines += [f"    [{', '.join(row.numbers)}],  // {row.words}" for row in table.rows]
    lines += [f"    // {TABLE_ENDS}", "];", ""]
    if (use := USES.get(table.convention.name)) and use.language == JAVASCRIPT:
        lines += [f"export const apply = ({', '.join(use.takes)}) => {table.stamp['use']};", ""]
    return "\n".join(lines)


def csharp_class(table: Table) -> str:
    """A static class with the rows; for Unity also the vectors of its shaders, and a function that makes the probe."""
    rows = table.rows
    lines = [*table.comments(), "", f"public static class {table.symbol}", "{"]
    lines += ["    public static readonly double[,] Rows =", "    {", f"        // {TABLE_BEGINS}"]
    lines += [f"        {{ {', '.join(row.numbers)} }},  // {row.words}" for row in rows]
    lines += [f"        // {TABLE_ENDS}", "    };"]
    if table.convention.name == "unity":
        lines += [
            "",
            "    public static UnityEngine.Rendering.SphericalHarmonicsL2 Probe()",
            "    {",
            "        var sh = new UnityEngine.Rendering.SphericalHarmonicsL2();",
            f"        for (int i = 0; i < {len(rows)}; i++)",
            "            for (int c = 0; c < 3; c++)",
            "                sh[c, i] = (float)Rows[i, c];",
            "        return sh;",
            "    }",
            "",
        ]
        for vector, values in unity_vectors(table.numbers).items():
            numbers = ", ".join(f"{value!r}f" for value in values)
            lines.append(
                f"    public static readonly UnityEngine.Vector4 {vector} = new UnityEngine.Vector4({numbers});"
            )
    return "\n".join([*lines, "}", ""])
