"""Lists of coefficients as programs write them, and what is made of them: cases of tests, and rows of a table in the guide."""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

ROWS = np.round(np.random.default_rng(0).normal(size=(9, 3)), 4)
PLACES = [(l, m) for l in range(3) for m in range(-l, l + 1)]
GREY = np.repeat(ROWS[:, :1], 3, axis=1)


def lines(rows, between=" ", end="\n"):
    return end.join(between.join(f"{value:g}" for value in row) for row in rows) + "\n"


def vector(row, name="vec3"):
    return f"{name}({', '.join(f'{value:g}' for value in row)})"


def named(name):
    """What `name(l, m)` calls each row, as a line."""
    return "\n".join(f"{name(l, m)} {row}" for (l, m), row in zip(PLACES, map(vector, ROWS), strict=True))


def babylon(l, m):
    return f"l{l}{'_' if m < 0 else ''}{abs(m)}"


SHTOOLS = [
    (l, m, ROWS[l * (l + 1) + m, 0], ROWS[l * (l + 1) - m, 0] if m else 0.0) for l in range(3) for m in range(l + 1)
]
BY_BAND = [lines([ROWS[l * l : (l + 1) ** 2, 0]]) for l in range(3)]
WITH_PLACES = np.column_stack([np.array(PLACES), ROWS])
LIST = ", ".join(map(vector, ROWS))
COLOURS = list(enumerate(("red", "green", "blue")))

OF_THREE = "three rows of 9: taken as red, green and blue, one after the other"
IN_TURN = "27 numbers in one list: taken as red, green and blue in turn"
GREY_LIST = "9 numbers in one list: taken as 3 grey bands"
OF_SHTOOLS = "its columns are l, m, C and S, as SHTOOLS writes them, S being that of -m"
COUNTED = "its first number, 9, says how many rows follow"
COMMAS = "its commas are taken as decimal ones"

COLOURED = {
    # three rows of n^2, whatever parts the numbers
    "planes.txt": (lines(ROWS.T), "three lines" + OF_THREE[10:]),
    "planes.csv": (lines(ROWS.T, ","), OF_THREE),
    "semicolons.csv": (lines(ROWS.T, ";"), OF_THREE),
    "tabs.csv": (lines(ROWS.T, "\t"), OF_THREE),
    "spaces.csv": (lines(ROWS.T), OF_THREE),
    "trailing.csv": (lines(ROWS.T, ",", ",\n"), OF_THREE),
    "trailing-header.csv": ("red,green,blue,\n" + lines(ROWS, ",", ",\n"), ""),
    "braces.h": ("{{" + "},\n{".join(", ".join(f"{x:g}f" for x in row) for row in ROWS.T) + "}}", OF_THREE),
    "lists.h": (
        "\n".join(f"float sh{c}[9] = {{{', '.join(f'{x:g}F' for x in ROWS[:, i])}}};" for i, c in enumerate("RGB")),
        OF_THREE,
    ),
    "words.h": (
        "\n".join(f"float sh_{c}[9] = {{{', '.join(f'{x:g}h' for x in ROWS[:, i])}}};" for i, c in COLOURS[::-1]),
        OF_THREE,
    ),
    "channels.json": (json.dumps({c: ROWS[:, i].tolist() for i, c in COLOURS}), OF_THREE),
    # lists that are merely wrapped
    **{
        f"wrapped-{k}.txt": ("\n".join(lines([ROWS.ravel()[i : i + k]])[:-1] for i in range(0, 27, k)), IN_TURN)
        for k in (1, 4, 5, 6, 7, 27)
    },
    # red, green, blue and something
    "alpha.txt": (lines(np.c_[ROWS, np.ones(9)]), "the fourth of its columns, 1 throughout, is dropped"),
    "alpha-objects.txt": (
        ",".join(f"{{alpha: 1, red: {r}, green: {g}, blue: {b}}}" for r, g, b in ROWS),
        "the fourth of its columns, 1 throughout, is dropped",
    ),
    "std140.glsl": (
        ",\n".join(vector([*row, 0], "vec4") for row in ROWS),
        "the fourth of its columns, 0 throughout, is dropped",
    ),
    "index.txt": (lines(np.c_[np.arange(9), ROWS]), "the first of its columns is the index of the row"),
    "index-from-1.csv": (lines(np.c_[np.arange(1, 10), ROWS], ","), "the first of its columns is the index of the row"),
    "index.h": (
        "{" + ",\n".join(f"{i}, {{{lines([row], ',')}}}" for i, row in enumerate(ROWS)) + "}",
        "the first of its columns is the index of the row",
    ),
    "places.txt": (lines(WITH_PLACES[::-1]), "the first two of its columns are l and m"),
    "places.csv": ("l,m,R,G,B\n" + lines(WITH_PLACES[::-1], ","), ""),
    "count.txt": ("9\n" + lines(ROWS), COUNTED),
    "count.glsl": ("9\n" + LIST, COUNTED),
    "count-alpha.txt": (
        "9\n" + lines(np.c_[ROWS, np.ones(9)]),
        f"{COUNTED}; the fourth of its columns, 1 throughout, is dropped",
    ),
    "count-of-all.txt": ("27\n" + lines(ROWS), COUNTED.replace("9", "27")),
    # shaders and other source code
    "array.glsl": (f"vec3[9](\n{LIST});", ""),
    "declared.glsl": (f"const vec3 sh[9] = vec3[]({LIST});", ""),
    "float3.h": ("static const float3 sh[9] = {" + ", ".join(vector(row, "float3") for row in ROWS) + "};", ""),
    "wgsl.txt": ("let sh = array<vec3<f32>, 9>(" + ", ".join(vector(row, "vec3<f32>") for row in ROWS) + ");", ""),
    "capital.h": ("{" + "},{".join(", ".join(f"{x}F" for x in row) for row in ROWS) + "};", ""),
    "assigned.txt": (
        "\n".join(f"sh[ {i} ] = {vector(ROWS[i], 'new THREE.Vector3')};" for i in reversed(range(9))),
        "",
    ),
    "book.glsl": (named(lambda l, m: f"const vec3 L{l}{'m' if m < 0 else ''}{abs(m)} ="), ""),
    "minus.txt": (named(lambda l, m: f"L{l}{m}:"), ""),
    "parted.txt": (named(lambda l, m: f"vec3 c_L{l}_{'m' if m < 0 else ''}{abs(m)} ="), ""),
    "babylon.txt": (
        "\n".join(f"{babylon(l, m)} {lines([row])[:-1]}" for (l, m), row in list(zip(PLACES, ROWS, strict=True))[::-1]),
        "",
    ),
    "babylon.json": (
        json.dumps(
            {"preScaled": False}
            | {
                babylon(l, m): {"_isDirty": True, "_x": x, "_y": y, "_z": z}
                for (l, m), (x, y, z) in list(zip(PLACES, ROWS, strict=True))[::-1]
            }
        ),
        "",
    ),
    "objects.json": (json.dumps([{"b": b, "r": r, "g": g} for r, g, b in ROWS]), ""),
    "bands.glsl": (
        "".join(f"{{{', '.join(f'{x:g}' for x in ROWS[l * l : (l + 1) ** 2].ravel())}}}" for l in range(3)),
        IN_TURN,
    ),
    "members.txt": ("\n".join(f"c{i}.b = {b}; c{i}.r = {r}; c{i}.g = {g};" for i, (r, g, b) in enumerate(ROWS)), ""),
    "named-objects.txt": (
        "\n".join(
            f"L{l}{m}: {{r: {r}, g: {g}, b: {b}}}" for (l, m), (r, g, b) in list(zip(PLACES, ROWS, strict=True))[::-1]
        ),
        "",
    ),
    "objects.txt": ("[" + ",\n".join(f"{{r: {r}, g: {g}, b: {b}}}" for r, g, b in ROWS) + "]", ""),
    # the numbers themselves
    "unicode.txt": (lines(ROWS).replace("-", "\u2212").replace(" ", "\u00a0\u2009\u202f"), ""),
    "decimal-commas.csv": (lines(ROWS, ";").replace(".", ","), COMMAS),
    "decimal-commas.txt": (lines(ROWS, "  ").replace(".", ","), COMMAS),
    "spreadsheet.csv": ("red;green;blue\n" + lines(ROWS, ";").replace(".", ","), COMMAS),
}

GREYS = [
        ("grey.txt", lines([ROWS[:, 0]]), GREY_LIST),
        ("lines.csv", lines(ROWS[:, :1]), GREY_LIST),
        ("bands.txt", "\n".join(BY_BAND), GREY_LIST),
        ("bands.h", "{" + "},{".join(BY_BAND) + "}", GREY_LIST),
        ("l-m.csv", lines(WITH_PLACES[:, :3], ","), "the first two of its columns are l and m"),
        ("degrees.csv", "degree,order,value\n" + lines(WITH_PLACES[::-1, :3], ","), ""),
        ("index.txt", lines(np.c_[np.arange(9), ROWS[:, 0]]), "the first of its columns is the index of the row"),
        ("shtools.txt", lines(SHTOOLS, ", "), OF_SHTOOLS),
        ("errors.txt", lines(np.c_[np.array(SHTOOLS), np.ones((6, 2))]), OF_SHTOOLS),
        ("header.txt", "gray\n" + lines(ROWS[:, :1]), ""),
        ("header-of-shtools.txt", "l m C S\n" + lines(SHTOOLS), OF_SHTOOLS),
        ("shtools.csv", "l,m,C,S\n" + lines(SHTOOLS, ","), OF_SHTOOLS),
]  # fmt: skip

REFUSED = [
        ("a.txt", lines(np.c_[ROWS, ROWS[:, 0]]), "9 lines of 4 numbers, which may be red, green, blue and something else"),
        ("a.csv", lines(np.c_[ROWS, ROWS[:, 0]], ","), "rows of 4 numbers; a row holds red, green and blue: keep only those"),
        ("a.json", json.dumps(np.c_[ROWS, ROWS[:, 0]].tolist()), "rows of 4 numbers"),
        ("a.glsl", ", ".join(vector([*row, 0.5], "vec4") for row in ROWS), "rows of 4 numbers"),
        ("a.txt", lines(np.c_[ROWS, np.arange(1, 10)]), "9 lines of 4 numbers"),
        ("a.csv", lines(np.ones((3, 5)), ","), "rows of 5 numbers"),
        *(("a.txt", lines([*SHTOOLS[:-1], (*place, 1, 2)]), "8 rows of three: n bands") for place in ((3, 0), (2, -1), (0, 0))),
        ("a.csv", lines(np.vstack([WITH_PLACES[:4], [1, 2, 1, 1, 1], WITH_PLACES[5:]]), ","), "rows of 5 numbers"),
        ("a.csv", "0,1\n1,2\n2,3\n", "rows of 2 numbers"),
        ("a.txt", lines(np.c_[ROWS, ROWS[:, :2]]), "9 lines of 5 numbers"),
        ("a.txt", lines(np.ones((4, 9))), "4 lines of 9 numbers"),
        ("a.txt", lines(np.ones((12, 3))), "12 rows of three: n bands have n^2 rows"),
        ("a.txt", "16 " + "0.5 " * 48, "49 numbers, of which the first, 16, may be how many rows follow; remove it if it is"),
        ("a.txt", "16\n" + "0.5\n" * 48, "49 numbers, of which the first, 16"),
        ("a.txt", "1,5 2,5 3,5 4 5 6,5 7,5 8,5 9,5", "commas that may be decimal ones"),
        ("a.txt", "1,234 0 2,500", "1,234, which may be 1.234 or, with a comma between thousands, 1234"),
        ("a.csv", "red;green;blue\n1,234;0;1", "1,234, which may be 1.234 or, with a comma between thousands, 1234"),
        ("a.txt", f"float bright = 2.0;\nvec3 sh[9] = {{{LIST}}};", "2 lists of numbers, with the names bright, sh; keep"),
        ("a.txt", named(lambda l, m: f"L{l}{abs(m)} ="), "9 lists of numbers, with the names L00, L11, L10, L11"),
        ("a.txt", named(lambda l, m: "L12:" if (l, m) == (2, -2) else f"L{l}{m}:"), "9 lists of numbers, with the names L00"),
        ("a.txt", named(lambda l, m: f"sh[{l}] ="), "9 lists of numbers, with the names sh, sh, sh, sh"),
        ("a.txt", named(lambda l, m: f"{'abc'[l]}[{l * (l + 1) + m}] ="), "9 lists of numbers, with the names a, b, b, b"),
        ("a.txt", "L00\n1 2 3", "'L00' in line 1 is no number"),
        ("a.txt", "6\n1 2 3\n4 5 6", "7 numbers: n bands have n^2 rows"),
        ("a.txt", "1 -inf 3", "number 1 (from 0) is not finite"),
        ("a.glsl", "vec3(scale) (1, 2, 3)", "'scale' in line 1 is no number"),
        ("a.csv", "r\tg\tb\n1\t\t3\n", "row 1 lacks a number"),
        ("a.csv", "nan,nan,inf\n", "is not finite"),
        ("a.csv", "x,y,z\n1,2,3\n", "no column red and no column green"),
        ("a.glsl", "vec3(1, 2, 3), vec4(1, 2, 3, 4)", "brackets with 3 numbers and with 4; rows are equally long"),
        ("a.glsl", "vec3(0.5 * 2.0, 1, 1)", "'*' in line 1 is no number"),
        ("a.csv", "l,m,r,g,b\n0,0,1,2,3\n1,0,1,2,3\n1,1,1,2,3\n1,1,1,2,3\n", "columns l and m that do not name every"),
        ("a.csv", "red,green,blue\n", "a header and no rows"),
        ("a.csv", "red;green;blue\n1;2;three\n", "'three' in row 1 is no number"),
        ("a.csv", 'red,green,blue\n"1,5",2,3\n', "'1,5' in row 1 is no number"),
        ("a.json", json.dumps([{"irradianceCoefficients": ROWS.tolist()}] * 2), "2 lights with coefficients in it; keep one"),
        ("a.json", json.dumps({"type": "LightProbe", "sh": [1] * 27, "intensity": [1]}), "its intensity is no number"),
        ("a.json", json.dumps([{"r": 1, "g": 2}] * 9), "rows of three numbers each"),
        ("a.json", json.dumps({"type": "LightProbe", "sh": [1] * 27, "intensity": 10**400}), "its intensity is no number"),
        ("a.json", json.dumps({"type": "Light", "sh": [1] * 27}), 'without "coefficients"'),
        ("a.json", "[[1, 2, true]]", "true or false among the coefficients"),
        ("a.json", json.dumps([dict.fromkeys("rgbRGB", 1)] * 9), "rows of three numbers each"),
        ("a.json", json.dumps([{"r": 1, "R": 2, "g": 3, "b": 4}] * 9), "rows of three numbers each"),
        ("a.json", json.dumps({"a": 1}), "is that of three.js or glTF"),
        ("a.json", json.dumps({"shviewer-coefficients": None, "coefficients": [[1, 1, 1]] * 9}), "version reads schema 1"),
]  # fmt: skip

CMGEN = "\n".join(
    f"({', '.join(f'{x:18.15f}' for x in row)}); // L{l}{m}, irradiance, pre-scaled base"
    for (l, m), row in zip(PLACES, ROWS, strict=True)
)
PROBE = {"uuid": "1", "type": "LightProbe", "matrix": [1, 0], "color": 16777215, "sh": ROWS.ravel().tolist()}
CILM = np.zeros((3, 2, 3, 3))
for (l, m), row in zip(PLACES, ROWS, strict=True):
    CILM[:, int(m < 0), l, abs(m)] = row
BABYLON = "shviewer,irradiance,-y+z+x"
UNITY = "m_AmbientProbe:\n" + "\n".join(f"  - sh[{i:>2}]: {x:g}" for i, x in enumerate(ROWS.T.ravel()))
IMPLIED = {
    "probe.txt": (UNITY, "unity", "sh[ 0] to sh[26] of Unity"),
    "sh.txt": (CMGEN, "filament", "its comments, irradiance and pre-scaled base, are those of Filament's cmgen"),
    "cesium.txt": (CMGEN.replace("(", "new Cartesian3("), "filament", "cmgen, without --no-mirror: taken as filament"),
    "probe.json": (json.dumps({"metadata": {}, "object": PROBE | {"intensity": 1}}), "three", "a LightProbe of three.js"),
    "cilm.json": (json.dumps(CILM.tolist()), "shtools", "an array cilm: taken as SHTOOLS makes it"),
    "harmonics.json": (
        json.dumps({"isSphericalHarmonics3": True, "coefficients": [dict(zip("xyz", row, strict=True)) for row in ROWS]}),
        "three",
        "a SphericalHarmonics3 of three.js",
    ),
    "scene.gltf": (
        json.dumps({"extensions": {"EXT_lights_image_based": {"lights": [{"irradianceCoefficients": ROWS.tolist()}]}}}),
        BABYLON,
        f"glTF does not say what irradianceCoefficients are: taken as Babylon.js reads them, {BABYLON}",
    ),
}  # fmt: skip


class Found(NamedTuple):
    program: str
    writes: str
    becomes: str
    case: str
    """The name of a file above, or what its refusal says."""


FOUND = (
    Found("Filament's cmgen, and copies of it", "`sh.txt` with the comments `irradiance, pre-scaled base`",
          "`filament`, with a note", "sh.txt"),
    Found("three.js, `LightProbe.toJSON`", "`.json` with `sh` and an intensity",
          "`three`, times the intensity, with notes", "probe.json"),
    Found("three.js, `JSON.stringify` of `SphericalHarmonics3`", "`.json` with x, y, z",
          "`three`, with a note", "harmonics.json"),
    Found("Unity, text of an asset", "`sh[ 0]: ...` to `sh[26]: ...`, red first", "`unity`, with a note", "probe.txt"),
    Found("glTF", "`irradianceCoefficients`, whose convention it does not state",
          f"`{BABYLON}`, as Babylon.js reads it, with a note", "scene.gltf"),
    Found("Babylon.js, `JSON.stringify` of `SphericalHarmonics`", "`.json` with `l00`, `l1_1`, ...",
          "rows, sorted by these names", "babylon.json"),
    Found("SHTOOLS, `shwrite`", "`l, m, C, S`", "grey, S being that of -m, with a note", "shtools.txt"),
    Found("SHTOOLS, `SHCoeffs.to_array`", "`cilm`, (2, n, n) or (3, 2, n, n), in `.npy`, `.npz` or `.json`",
          "`shtools`, with a note", "cilm.json"),
    Found("shaders", "`const vec3 L00 = vec3(...)`, `L1m1`, ...", "rows, sorted by these names", "book.glsl"),
    Found("shaders", "`vec3[9]`, `float3 sh[9]`, `array<vec3<f32>, 9>`", "rows", "wgsl.txt"),
    Found("shaders", "`vec4`s, filled up with 0 or 1", "rows, the fill dropped, with a note", "std140.glsl"),
    Found("ARKit, Unity", "all of red, then of green, then of blue, a line or an array each",
          "that, with a note", "lists.h"),
    Found("JavaScript", "`{r: ..., g: ..., b: ...}`", "rows", "objects.txt"),
    Found("spreadsheets", "decimal commas and semicolons", "that", "spreadsheet.csv"),
    Found("word processors", "a typographic minus", "a minus", "unicode.txt"),
    Found("anything", "an index before red, green and blue", "dropped, with a note", "index.txt"),
    Found("anything", "n² lines of four or more of unknown meaning", "refused", "9 lines of 4 numbers"),
    Found("anything", "several lists in one file", "refused, with their names", "2 lists of numbers"),
)  # fmt: skip


def cases() -> set[str]:
    """What `Found.case` may be."""
    return {*COLOURED, *IMPLIED, *(name for name, *_ in GREYS)}


def table() -> str:
    """The rows as the guide has them."""
    rows = [f"| {row.program} | {row.writes} | {row.becomes} |" for row in FOUND]
    return "\n".join(["", "| program | writes | is read as |", "|---|---|---|", *rows, "", ""])
