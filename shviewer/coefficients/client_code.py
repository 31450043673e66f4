"""Coefficients as JavaScript and C#, with the line that hands them to the program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from shviewer.coefficients.reading import TABLE_BEGINS, TABLE_ENDS
from shviewer.coefficients.source_code import Row, identifier


def javascript_module(
    name: str, comments: Sequence[str], rows: Sequence[Row], applied: tuple[str, tuple[str, ...]] | None
) -> str:
    """An ES module with the rows and, if `applied` says what to do with them and what that needs, a function `apply`."""
    lines = [*comments, "", f"export const {identifier(name)} = [", f"    // {TABLE_BEGINS}"]
    lines += [f"    [{', '.join(row.numbers)}],  // {row.words}" for row in rows]
    lines += [f"    // {TABLE_ENDS}", "];", ""]
    if applied:
        line, takes = applied
        lines += [f"export const apply = ({', '.join(takes)}) => {line};", ""]
    return "\n".join(lines)


def csharp_class(
    name: str, comments: Sequence[str], rows: Sequence[Row], vectors: Mapping[str, tuple[float, float, float, float]]
) -> str:
    """A static class with the rows; with Unity's `vectors` also these, and a function that makes the probe."""
    lines = [*comments, "", f"public static class {identifier(name)}", "{"]
    lines += ["    public static readonly double[,] Rows =", "    {", f"        // {TABLE_BEGINS}"]
    lines += [f"        {{ {', '.join(row.numbers)} }},  // {row.words}" for row in rows]
    lines += [f"        // {TABLE_ENDS}", "    };"]
    if vectors:
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
        for vector, values in vectors.items():
            numbers = ", ".join(f"{value!r}f" for value in values)
            lines.append(
                f"    public static readonly UnityEngine.Vector4 {vector} = new UnityEngine.Vector4({numbers});"
            )
    return "\n".join([*lines, "}", ""])
