"""Encodings of irradiance, as engines store them, with the formula that decodes them: in words, and as a function of GLSL.

The formulas are those of harmonics/quantities/decoding.py. In another program's axes the numbers are those of the same function
there, so that the formulas are the same in all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.parts.axes import Axes, turn
from shviewer.coefficients.programs import OURS
from shviewer.coefficients.shader_code import glsl_table
from shviewer.coefficients.table import Table, TableRow
from shviewer.coefficients.texts import convention_text
from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quantities.ambient_cube import FACES
from shviewer.harmonics.quantities.decoding import LINEAR, MEAN, ZONAL
from shviewer.harmonics.quantities.encodings import ENCODINGS, Encoding, Stored

_MIXED = " + ".join(f"{part!r} v.{channel}" for part, channel in zip(LUMINANCE.tolist(), "rgb", strict=True))
_V = "v = (-c3, -c1, c2)"
_U = f"{_V}, u = v/|v|"
_SHARED = f"{_V}, u = w/|w| for all channels, w = {_MIXED}"
_LINEAR = f"{MEAN!r} c0 + {LINEAR!r} v.n"
_ZH3 = f"{_LINEAR} + {ZONAL!r} z (3 (u.n)^2 - 1)"
_GUESSED = "z = c0 s (0.08 + 0.6 s), s = |v.u|/c0"
_L2 = (
    f"{_LINEAR} + {ZONAL!r} (2 sqrt(3) (c4 x y - c5 y z - c7 x z) + c6 (3 z^2 - 1) + sqrt(3) c8 (x^2 - y^2)), "
    f"n = (x, y, z), {_V}"
)

FORMULAS = {
    "l1": f"E(n) = {_LINEAR}, {_V}",
    "geomerics": f"E(n) = {MEAN!r} c0 (a + (1 - a) (p + 1) q^p), q = (1 + n.u)/2, p = 1 + 2 r, a = (1 - r)/(1 + r), "
    f"r = |v|/(sqrt(3) c0) but at most 1, {_U}",
    "zh3": f"E(n) = {_ZH3}, {_U}",
    "zh3_shared": f"E(n) = {_ZH3}, {_SHARED}",
    "hallucinated": f"E(n) = {_ZH3}, {_GUESSED}, {_U}",
    "hallucinated_shared": f"E(n) = {_ZH3}, {_GUESSED}, {_SHARED}",
    "l2": f"E(n) = {_L2}",
    "cube": "E(n) = n.x^2 (n.x < 0 ? -x : +x) + n.y^2 (n.y < 0 ? -y : +y) + n.z^2 (n.z < 0 ? -z : +z)",
}
"""Each formula of decoding.FORMULAS in one line: the irradiance, not divided by pi, of each channel, n a unit normal."""

_SUM_OF_L1 = f"{MEAN!r} * {{s}}[0] + {LINEAR!r} * ({{s}}[2] * n.z - {{s}}[3] * n.x - {{s}}[1] * n.y)"
_VECTOR = "vec3(-{s}[3][i], -{s}[1][i], {s}[2][i])"
_WEIGHTED = "vec3(-dot({s}[3], luminance), -dot({s}[1], luminance), dot({s}[2], luminance))"
_LUMINANCE = f"    const vec3 luminance = vec3({', '.join(map(repr, LUMINANCE.tolist()))});"
_GUESS = [
    "        float s = {s}[0][i] > 0.0 ? abs(dot(v, u)) / {s}[0][i] : 0.0;",
    "        float z = {s}[0][i] * s * (0.08 + 0.6 * s);",
]
_READ = ["        float z = {s}[4][i];"]


def _about_axis(axis: str, z: Sequence[str], shared: bool) -> list[str]:
    """l1, and a zonal band 2 about the axis of each channel."""
    return [
        *([_LUMINANCE] if shared else []),
        f"    vec3 sum = {_SUM_OF_L1};",
        "    for (int i = 0; i < 3; ++i) {",
        f"        vec3 v = {_VECTOR}, w = {axis};",
        "        vec3 u = w == vec3(0.0) ? w : normalize(w);",
        *z,
        f"        if (u != vec3(0.0)) sum[i] += {ZONAL!r} * z * (3.0 * dot(u, n) * dot(u, n) - 1.0);",
        "    }",
        "    return sum;",
    ]


GLSL = {
    "l1": [f"    return {_SUM_OF_L1};"],
    "geomerics": [
        "    vec3 sum;",
        "    for (int i = 0; i < 3; ++i) {",
        f"        vec3 v = {_VECTOR};",
        "        float size = length(v);",
        "        float r = {s}[0][i] > 0.0 ? min(size / (1.7320508075688772 * {s}[0][i]), 1.0) : 0.0;",
        "        float p = 1.0 + 2.0 * r, a = (1.0 - r) / (1.0 + r);",
        "        float q = size > 0.0 ? max(0.5 + 0.5 * dot(n, v) / size, 0.0) : 0.5;",
        f"        sum[i] = {MEAN!r} * {{s}}[0][i] * (a + (1.0 - a) * (p + 1.0) * pow(q, p));",
        "    }",
        "    return sum;",
    ],
    "zh3": _about_axis("v", _READ, shared=False),
    "zh3_shared": _about_axis(_WEIGHTED, _READ, shared=True),
    "hallucinated": _about_axis("v", _GUESS, shared=False),
    "hallucinated_shared": _about_axis(_WEIGHTED, _GUESS, shared=True),
    "l2": [
        f"    return {_SUM_OF_L1}",
        f"         + {ZONAL!r} * (3.4641016151377544 * ({{s}}[4] * n.x * n.y - {{s}}[5] * n.y * n.z - {{s}}[7] * n.x * n.z)",
        "         + {s}[6] * (3.0 * n.z * n.z - 1.0) + 1.7320508075688772 * {s}[8] * (n.x * n.x - n.y * n.y));",
    ],
    "cube": [
        "    vec3 square = n * n;",
        "    return square.x * {s}[n.x < 0.0 ? 1 : 0] + square.y * {s}[n.y < 0.0 ? 3 : 2] + square.z * {s}[n.z < 0.0 ? 5 : 4];",
    ],
}
"""The lines of a function of a unit normal n; {s} is the array of numbers."""


def in_axes(stored: Stored, axes: Axes) -> Array:
    """The numbers (floats, 3) of the same irradiance in a program's axes."""
    encoding, numbers = stored.encoding, stored.numbers
    if not encoding.turns:
        there = FACES @ axes.matrix  # the direction here that each face has there
        return np.asarray(numbers[np.argmax(there @ FACES.T, axis=1)])
    count = encoding.coefficients
    return np.concatenate([turn(numbers[:count], axes), numbers[count:]]) + 0.0


def out_of_axes(name: str, numbers: Array, axes: Axes) -> Stored:
    """The same irradiance in our axes, from the numbers of a program's. ValueError for as many as the encoding has not."""
    encoding = ENCODINGS[name]
    if numbers.shape != (encoding.floats, 3):
        raise ValueError(
            f"numbers of shape {numbers.shape}; {name} has {encoding.floats} rows of three: project the light again"
        )
    return Stored(name, in_axes(Stored(name, numbers), axes.inverse))


def check_stored(encoding: Encoding, convention: Convention) -> None:
    """ValueError for a convention that says more than axes: the formulas take our own numbers."""
    if replace(convention, quantity=None) != replace(OURS, axes=convention.axes):
        raise ValueError(
            f"{encoding.words} takes shviewer's own numbers, not those of {convention_text(convention)}: "
            "leave --convention out, and name the axes, such as --axes y-up"
        )


def stored_rows(encoding: Encoding, numbers: NDArray[np.generic]) -> list[TableRow]:
    """The numbers as rows of a table."""
    places = zip(encoding.places, numbers.tolist(), strict=True)
    return [TableRow((("number", place),), [repr(value) for value in row]) for place, row in places]


def glsl_decoder(table: Table) -> str:
    """The numbers, and the function of a normal that decodes them, GLSL 3.30 and later, without a #version line."""
    assert table.stored is not None
    head = [
        "// n: unit normal, in the axes named above; the irradiance there, not divided by pi",
        f"vec3 {table.function}(vec3 n) {{",
    ]
    body = [line.replace("{s}", table.symbol) for line in GLSL[table.stored.encoding.formula]]
    return "\n".join([*glsl_table(table), *head, *body, "}", ""])
