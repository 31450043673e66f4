"""Lists of coefficients as people have them: what other programs, shaders and spreadsheets write, and what is assumed of it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from shviewer.errors import LightError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.lights.reading import Reading

ROWS = np.round(np.random.default_rng(0).normal(size=(9, 3)), 4)
PLACES = [(l, m) for l in range(3) for m in range(-l, l + 1)]
GREY = np.repeat(ROWS[:, :1], 3, axis=1)


def read(path: Path, text: str, convention: str = "shviewer") -> CoefficientLight:
    path.write_text(text, encoding="utf-8")
    light = find_light(str(path), Reading(convention=convention))
    assert isinstance(light, CoefficientLight)
    return light


def numbers(path: Path, text: str, convention: str = "shviewer") -> np.ndarray:
    light = read(path, text, convention)
    assert light.file is not None
    return light.file.numbers


def refusal(path: Path, text: str, convention: str = "shviewer") -> str:
    with pytest.raises(LightError) as caught:
        read(path, text, convention)
    message = str(caught.value)
    assert message.isprintable()
    return message


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

OF_THREE = "three rows of 9: taken as red, green and blue, one after the other"
IN_TURN = "27 numbers in one list: taken as red, green and blue in turn"
GREY_LIST = "9 numbers in one list: taken as 3 grey bands"
OF_SHTOOLS = "its columns are l, m, C and S, as SHTOOLS writes them, S being that of -m"
COUNTED = "its first number, 9, says how many rows follow"

COLOURED = {
    # three rows of n^2, whatever parts the numbers
    "planes.txt": (lines(ROWS.T), "three lines" + OF_THREE[10:]),
    "planes.csv": (lines(ROWS.T, ","), OF_THREE),
    "semicolons.csv": (lines(ROWS.T, ";"), OF_THREE),
    "tabs.csv": (lines(ROWS.T, "\t"), OF_THREE),
    "spaces.csv": (lines(ROWS.T), OF_THREE),
    "trailing.csv": (lines(ROWS.T, ",", ",\n"), OF_THREE),
    "braces.h": ("{{" + "},\n{".join(", ".join(f"{x:g}f" for x in row) for row in ROWS.T) + "}}", OF_THREE),
    "lists.h": (
        "\n".join(f"float sh{c}[9] = {{{', '.join(f'{x:g}F' for x in ROWS[:, i])}}};" for i, c in enumerate("RGB")),
        OF_THREE,
    ),
    "channels.json": (json.dumps({c: ROWS[:, i].tolist() for i, c in enumerate(("red", "green", "blue"))}), OF_THREE),
    # lists that are merely wrapped
    **{
        f"wrapped-{k}.txt": ("\n".join(lines([ROWS.ravel()[i : i + k]])[:-1] for i in range(0, 27, k)), IN_TURN)
        for k in (1, 4, 5, 6, 7, 27)
    },
    # red, green, blue and something
    "alpha.txt": (lines(np.c_[ROWS, np.ones(9)]), "the fourth of its columns, 1 throughout, is dropped"),
    "std140.glsl": (
        ",\n".join(vector([*row, 0], "vec4") for row in ROWS),
        "the fourth of its columns, 0 throughout, is dropped",
    ),
    "index.txt": (lines(np.c_[np.arange(9), ROWS]), "the first of its columns is the index of the row"),
    "index-from-1.csv": (lines(np.c_[np.arange(1, 10), ROWS], ","), "the first of its columns is the index of the row"),
    "places.txt": (lines(WITH_PLACES[::-1]), "the first two of its columns are l and m"),
    "places.csv": ("l,m,R,G,B\n" + lines(WITH_PLACES[::-1], ","), ""),
    "count.txt": ("9\n" + lines(ROWS), COUNTED),
    "count.glsl": ("9\n" + LIST, COUNTED),
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
    "objects.txt": ("[" + ",\n".join(f"{{r: {r}, g: {g}, b: {b}}}" for r, g, b in ROWS) + "]", ""),
    # the numbers themselves
    "unicode.txt": (lines(ROWS).replace("-", "\u2212").replace(" ", "\u00a0"), ""),
    "decimal-commas.csv": (lines(ROWS, ";").replace(".", ","), ""),
    "decimal-commas.txt": (lines(ROWS, "  ").replace(".", ","), ""),
    "spreadsheet.csv": ("red;green;blue\n" + lines(ROWS, ";").replace(".", ","), ""),
}


@pytest.mark.parametrize("name", COLOURED)
def test_a_list_as_it_is_found_is_read_and_what_was_assumed_is_said(name: str, tmp_path: Path) -> None:
    text, note = COLOURED[name]
    light = read(tmp_path / name, text)
    np.testing.assert_array_equal(light.given, ROWS)
    assert light.notes == ((note,) if note else ())


@pytest.mark.parametrize(
    ("name", "text", "note"),
    [
        ("grey.txt", lines([ROWS[:, 0]]), GREY_LIST),
        ("lines.csv", lines(ROWS[:, :1]), GREY_LIST),
        ("bands.txt", "\n".join(BY_BAND), GREY_LIST),
        ("bands.h", "{" + "},{".join(BY_BAND) + "}", GREY_LIST),
        ("l-m.csv", lines(WITH_PLACES[:, :3], ","), "the first two of its columns are l and m"),
        ("degrees.csv", "degree,order,value\n" + lines(WITH_PLACES[::-1, :3], ","), ""),
        ("index.txt", lines(np.c_[np.arange(9), ROWS[:, 0]]), "the first of its columns is the index of the row"),
        ("shtools.txt", lines(SHTOOLS, ", "), OF_SHTOOLS),
        ("errors.txt", lines(np.c_[np.array(SHTOOLS), np.ones((6, 2))]), OF_SHTOOLS),
        ("shtools.csv", "l,m,C,S\n" + lines(SHTOOLS, ","), OF_SHTOOLS),
    ],
)  # fmt: skip
def test_a_grey_list_is_told_from_a_coloured_one(name: str, text: str, note: str, tmp_path: Path) -> None:
    light = read(tmp_path / name, text)
    np.testing.assert_array_equal(light.given, GREY)
    assert light.notes == ((note,) if note else ())


def test_a_table_of_shtools_is_that_of_shtools(tmp_path: Path) -> None:
    """The file of its own writer, for lmax 1 to 8: some sizes pass for lists of grey."""
    pyshtools = pytest.importorskip("pyshtools")
    from shviewer.coefficients.programs import parse_convention

    for lmax in range(1, 9):
        ours = np.random.default_rng(lmax).normal(size=((lmax + 1) ** 2, 1))
        theirs = parse_convention("shviewer,no-phase,4pi").from_ours(ours)
        cilm = np.zeros((2, lmax + 1, lmax + 1))
        for l in range(lmax + 1):
            for m in range(l + 1):
                cilm[:, l, m] = theirs[l * (l + 1) + m, 0], theirs[l * (l + 1) - m, 0] if m else 0.0
        pyshtools.shio.shwrite(str(tmp_path / "sh.txt"), cilm)
        light = find_light(str(tmp_path / "sh.txt"), Reading(convention="shviewer,no-phase,4pi"))
        np.testing.assert_allclose(light.coefficients(lmax + 1), np.repeat(ours, 3, axis=1), rtol=1e-14)


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.txt", lines(np.c_[ROWS, ROWS[:, 0]]), "9 lines of 4 numbers, which may be red, green, blue and something else"),
        ("a.csv", lines(np.c_[ROWS, ROWS[:, 0]], ","), "rows of 4 numbers; a row holds red, green and blue: keep only those"),
        ("a.json", json.dumps(np.c_[ROWS, ROWS[:, 0]].tolist()), "rows of 4 numbers"),
        ("a.glsl", ", ".join(vector([*row, 0.5], "vec4") for row in ROWS), "rows of 4 numbers"),
        ("a.txt", lines(np.c_[ROWS, ROWS[:, :2]]), "9 lines of 5 numbers"),
        ("a.txt", lines(np.ones((4, 9))), "4 lines of 9 numbers"),
        ("a.txt", lines(np.ones((12, 3))), "12 rows of three: n bands have n^2 rows"),
        ("a.txt", "16 " + "0.5 " * 48, "49 numbers, of which the first, 16, may be how many rows follow; remove it if it is"),
        ("a.txt", "16\n" + "0.5\n" * 48, "49 numbers, of which the first, 16"),
        ("a.txt", "1,5 2,5 3,5 4 5 6,5 7,5 8,5 9,5", "commas that may be decimal ones"),
        ("a.txt", f"float bright = 2.0;\nvec3 sh[9] = {{{LIST}}};", "2 lists of numbers, with the names bright, sh; keep"),
        ("a.txt", named(lambda l, m: f"L{l}{abs(m)} ="), "9 lists of numbers, with the names L00, L11, L10, L11"),
        ("a.glsl", "vec3(1, 2, 3), vec4(1, 2, 3, 4)", "brackets with 3 numbers and with 4; rows are equally long"),
        ("a.glsl", "vec3(0.5 * 2.0, 1, 1)", "'*' in line 1 is no number"),
        ("a.csv", "l,m,r,g,b\n0,0,1,2,3\n1,0,1,2,3\n1,1,1,2,3\n1,1,1,2,3\n", "columns l and m that do not name every"),
        ("a.csv", "red,green,blue\n", "a header and no rows"),
        ("a.csv", "red;green;blue\n1;2;three\n", "'three' in row 1 is no number"),
        ("a.json", json.dumps([{"irradianceCoefficients": ROWS.tolist()}] * 2), "2 lights with coefficients in it; keep one"),
        ("a.json", json.dumps({"type": "LightProbe", "sh": [1] * 27, "intensity": [1]}), "its intensity is no number"),
        ("a.json", json.dumps([{"r": 1, "g": 2}] * 9), "rows of three numbers each"),
        ("a.json", json.dumps({"a": 1}), "is that of three.js or glTF"),
        ("a.json", json.dumps({"shviewer-coefficients": None, "coefficients": [[1, 1, 1]] * 9}), "version reads schema 1"),
    ],
)  # fmt: skip
def test_what_may_mean_two_things_is_refused_with_the_way_out(name: str, text: str, says: str, tmp_path: Path) -> None:
    assert says in refusal(tmp_path / name, text)


CMGEN = "\n".join(
    f"({', '.join(f'{x:18.15f}' for x in row)}); // L{l}{m}, irradiance, pre-scaled base"
    for (l, m), row in zip(PLACES, ROWS, strict=True)
)
PROBE = {"uuid": "1", "type": "LightProbe", "matrix": [1, 0], "color": 16777215, "sh": ROWS.ravel().tolist()}
BABYLON = "shviewer,irradiance,-y+z+x"
IMPLIED = {
    "sh.txt": (CMGEN, "filament", "its comments, irradiance and pre-scaled base, are those of Filament's cmgen"),
    "cesium.txt": (CMGEN.replace("(", "new Cartesian3("), "filament", "cmgen, without --no-mirror: taken as filament"),
    "probe.json": (json.dumps({"metadata": {}, "object": PROBE | {"intensity": 1}}), "three", "a LightProbe of three.js"),
    "harmonics.json": (
        json.dumps({"isSphericalHarmonics3": True, "coefficients": [dict(zip("xyz", row, strict=True)) for row in ROWS]}),
        "three",
        "a SphericalHarmonics3 of three.js",
    ),
    "scene.json": (
        json.dumps({"extensions": {"EXT_lights_image_based": {"lights": [{"irradianceCoefficients": ROWS.tolist()}]}}}),
        BABYLON,
        f"glTF does not say what irradianceCoefficients are: taken as Babylon.js reads them, {BABYLON}",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", IMPLIED)
def test_a_convention_that_the_file_implies_is_taken_and_said_unless_another_is_named(
    name: str, tmp_path: Path
) -> None:
    text, convention, note = IMPLIED[name]
    implied = read(tmp_path / name, text, "")
    np.testing.assert_allclose(implied.given, read(tmp_path / name, text, convention).given, rtol=1e-15)
    assert any(note in said for said in implied.notes)
    np.testing.assert_array_equal(read(tmp_path / name, text).given, ROWS)
    assert not any(note in said for said in read(tmp_path / name, text).notes)


def test_what_is_beside_the_coefficients_of_a_light_is_applied_or_said_not_to_be(tmp_path: Path) -> None:
    probe = read(tmp_path / "a.json", json.dumps({"object": {"children": [PROBE | {"intensity": 2}]}}), "shviewer")
    np.testing.assert_array_equal(probe.given, 2 * ROWS)
    assert probe.notes == ("multiplied by its intensity, 2",)
    light = {"irradianceCoefficients": ROWS.tolist(), "intensity": 2, "rotation": [0, 1, 0, 0]}
    assert "its intensity and rotation are not applied" in read(tmp_path / "b.json", json.dumps(light)).notes


def test_complex_numbers_of_which_each_is_a_pair_are_no_rgb_and_something(tmp_path: Path) -> None:
    from shviewer.coefficients.programs import CONVENTIONS
    from shviewer.coefficients.writing import real_columns

    pairs = real_columns(CONVENTIONS["scipy"].from_ours(ROWS))
    for text in (lines(pairs), lines([pairs.ravel()])):
        np.testing.assert_allclose(read(tmp_path / "a.txt", text, "scipy").given, ROWS, rtol=0, atol=1e-5)  # six digits
