"""Coefficient files as lights: what they may look like, and what is said of those that are broken."""

from __future__ import annotations

import io
import json
import pickle
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers import refusal

from shviewer.analysis.recipe import Recipe
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.reading import MAX_FILE_BYTES
from shviewer.coefficients.stamp import stamp_of
from shviewer.errors import LightError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.lights.reading import Reading
from shviewer.limits import Limits

ROWS = np.random.default_rng(0).normal(size=(9, 3))
THREE = Reading(convention="three")


def read(path: Path, data: str | bytes, reading: Reading = THREE) -> CoefficientLight:
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    light = find_light(str(path), reading)
    assert isinstance(light, CoefficientLight)
    return light


def refused(path: Path, data: str | bytes, reading: Reading = THREE) -> str:
    text = refusal(read, path, data, reading)
    assert text.startswith(str(path))
    return text


def npz(**arrays: Any) -> bytes:
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


def npy(array: Any) -> bytes:
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def stamped(**changes: Any) -> str:
    stamp = {**stamp_of(CONVENTIONS["three"], "radiance", 3), **changes, "coefficients": ROWS.tolist()}
    return json.dumps({key: value for key, value in stamp.items() if value is not None})


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("rows.json", json.dumps(ROWS.tolist())),
        ("channels.json", json.dumps(ROWS.T.tolist())),
        ("flat.json", json.dumps(ROWS.ravel().tolist())),
        ("object.json", json.dumps({"coefficients": ROWS.tolist(), "who": "somebody"})),
        ("bare.csv", "\n".join(",".join(map(repr, row)) for row in ROWS.tolist())),
        ("header.csv", "m,blue,red,green\n" + "\n".join(f"{i},{b!r},{r!r},{g!r}" for i, (r, g, b) in enumerate(ROWS.tolist()))),
        ("bom.csv", "\ufeffred,green,blue\r\n" + "\r\n".join(",".join(map(repr, row)) for row in ROWS.tolist())),
        ("list.txt", " ".join(map(repr, ROWS.ravel().tolist()))),
        ("cmgen.txt", "\n".join(f"({r!r}, {g!r}, {b!r}); // L{i} 0.5" for i, (r, g, b) in enumerate(ROWS.tolist()))),
        ("array.txt", "/* {1, 2,\n 3} */ {" + "},\n{".join(", ".join(f"{v!r}f" for v in row) for row in ROWS.tolist()) + "};"),
        ("array.npz", npz(coefficients=ROWS)),
        ("array.npy", npz(coefficients=ROWS)[:0] + (lambda f: (np.save(f, ROWS), f.getvalue())[1])(io.BytesIO())),
    ],
)  # fmt: skip
def test_a_bare_list_may_be_written_in_many_ways(name: str, data: str | bytes, tmp_path: Path) -> None:
    light = read(tmp_path / name, data)
    assert light.file is not None
    np.testing.assert_array_equal(light.file.numbers, ROWS)
    assert light.description == "3 bands, three"


def test_one_number_per_row_is_grey(tmp_path: Path) -> None:
    light = read(tmp_path / "grey.txt", " ".join(map(repr, ROWS[:, 0].tolist())))
    assert light.file is not None
    np.testing.assert_array_equal(light.file.numbers, np.repeat(ROWS[:, :1], 3, axis=1))


def test_a_light_of_coefficients_is_what_its_coefficients_say(tmp_path: Path) -> None:
    light = read(tmp_path / "ours.json", json.dumps(ROWS.tolist()), Reading(convention="shviewer"))
    np.testing.assert_array_equal(light.coefficients(3), ROWS)
    np.testing.assert_array_equal(light.coefficients(5), np.pad(ROWS, ((0, 16), (0, 0))))
    np.testing.assert_array_equal(light.coefficients(2), ROWS[:4])
    np.testing.assert_allclose(light.products(), ROWS.T @ ROWS, rtol=1e-15)
    up = light.radiance(np.array([[0.0, 0.0, 1.0]]))[0]
    zonal = np.sqrt(np.array([1, 3, 5]) / (4 * np.pi))
    np.testing.assert_allclose(up, zonal @ ROWS[[0, 2, 6]], rtol=0, atol=1e-14)
    theta = np.array([0.3, 2.0])
    grid = light.rows(theta, 8)
    phi = np.pi * (1 - (2 * 2 + 1) / 8)
    there = [[np.sin(theta[1]) * np.cos(phi), np.sin(theta[1]) * np.sin(phi), np.cos(theta[1])]]
    np.testing.assert_allclose(grid[1, :, 2], light.radiance(np.array(there))[0], rtol=0, atol=1e-13)
    texels = light.map.texels
    np.testing.assert_allclose(texels[0, 0], up, rtol=0, atol=1e-6)


def test_a_file_of_irradiance_is_the_light_with_that_irradiance(tmp_path: Path) -> None:
    rows = np.random.default_rng(1).normal(size=(36, 3))
    rows[9:16], rows[25:] = 0, 0
    light = read(tmp_path / "e.json", json.dumps(rows.tolist()), Reading(convention="shviewer,irradiance"))
    assert light.quantity == "irradiance"
    assert light.notes == ("holds irradiance; the radiance is recovered from it, which tells nothing of bands 3, 5",)
    np.testing.assert_allclose(light.irradiance().coefficients(6), rows, rtol=0, atol=1e-14)
    direction = np.array([[0.6, 0.0, 0.8]])
    from shviewer.harmonics.basis import evaluate_basis

    np.testing.assert_allclose(
        light.irradiance().radiance(direction), evaluate_basis(direction, 6) @ rows, rtol=0, atol=1e-13
    )


@pytest.mark.parametrize(
    ("name", "data", "says"),
    [
        ("a.json", json.dumps([[1, 2, 3]] * 8), "8 rows of three: n bands have n^2 rows; near are n = 3 (9 rows)"),
        ("a.txt", " ".join(["1"] * 26), "26 numbers: n bands have n^2 rows"),
        ("a.json", json.dumps([[1, 2]] * 9), "rows of 2 numbers"),
        ("a.json", json.dumps([[1, 2, 3]] * 8 + [[1, 2]]), "rows of three numbers each"),
        ("a.json", "[[NaN, 1, 2]]", "NaN among the coefficients"),
        ("a.json", "[[1e999, 1, 2]]", "row 0 (from 0) is not finite"),
        ("a.txt", "1e308 1 1", "a coefficient of 1e+308; at most 1e+100 is read"),
        ("a.txt", "1 2 nan", "number 2 (from 0) is not finite"),
        ("a.csv", "red,green\n1,2\n", "no column blue"),
        ("a.csv", "l,m,red,blue\n0,0,1,2\n", "no column green"),
        ("a.csv", "red,green,blue\n1,2\n", "row 1 has 2 cells, the header 3"),
        ("a.csv", "red,green,blue\n1,,3\n", "row 1 lacks a number"),
        ("a.csv", "1,2\n3,4\n", "rows of 2 numbers"),
        ("a.csv", "# nothing\n", "no rows"),
        ("a.txt", "1 2 three", "'three' in line 1 is no number"),
        (
            "a.txt",
            "1 2\n3; int x = 4;",
            "with the names one without a name, x; keep the one that holds the coefficients",
        ),
        ("a.txt", "1 2\n3; int x;", "'int' in line 2 is no number"),
        ("a.json", "{", "no JSON"),
        ("a.json", "[" * 100_000, "no JSON"),
        ("a.json", '{"rows": []}', 'without "coefficients"'),
        ("a.json", '{"coefficients": "many"}', "rows of three numbers each"),
        ("a.json", "[]", "rows of three numbers each"),
        ("a.json", '["1", "2", "3"]', "rows of three numbers each"),
        ("a.json", "[null]", "rows of three numbers each"),
        ("a.json", b"\xff\xfe1", "no UTF-8"),
        ("a.npz", b"PK\x03\x04 nothing", "no readable NPZ"),
        ("a.npz", npz(other=ROWS), 'no array "coefficients" in it; there is: other'),
        ("a.npz", npz(coefficients=np.array(["a"])), "they are (n^2, 3) numbers"),
        ("a.npz", npz(coefficients=ROWS * (1 + 1j)), "of the conventions only scipy"),
        ("a.npz", npz(coefficients=ROWS, stamp=np.array("{}")), "no JSON object of a coefficient file"),
        ("a.npy", b"\x93NUMPY\x01\x00", "no readable NPZ or NPY"),
        ("a.json", "", "empty file"),
    ],
)
def test_a_broken_file_is_one_line(name: str, data: str | bytes, says: str, tmp_path: Path) -> None:
    assert says in refused(tmp_path / name, data)


def test_pickles_are_never_loaded(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[object, tuple[str]]:
            return Path.touch, (tmp_path / "sprung",)

    objects = np.empty(1, dtype=object)
    objects[0] = Trap()
    for name, data in (
        ("a.npz", npz(coefficients=objects)),
        ("a.npy", pickle.dumps(Trap())),
        ("b.npz", npz(coefficients=ROWS, stamp=objects)),
    ):
        text = refused(tmp_path / name, data)
        assert "pickled" in text or "no readable" in text
    assert not (tmp_path / "sprung").exists()


def test_what_is_too_large_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    assert "128 bands, the most there can be, take less" in refused(tmp_path / "a.txt", b"1 " * MAX_FILE_BYTES)
    assert "the limit is 10" in refused(
        tmp_path / "b.txt", "1 2 3 " * 9, Reading(convention="three", limits=Limits(file_bytes=10))
    )
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("coefficients.npy", b"\0" * 2**27)
    assert "unpacked; the limit" in refused(tmp_path / "c.npz", bomb.getvalue())
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (2**40, 3)})
    assert "claims" in refused(tmp_path / "d.npy", header.getvalue())
    assert "at most 128 bands" in refused(tmp_path / "e.json", json.dumps([0.5] * (129**2 * 6)))
    for channels in (1, 3):
        many = npz(coefficients=np.ones((129**2, channels)))
        assert "129 bands: at most 128 are read" in refused(tmp_path / "f.npz", many)
    assert "4 bands, so its numbers are not those of three" in refused(tmp_path / "f.json", json.dumps([0.5] * 48))


def test_a_file_that_does_not_say_its_convention_needs_one_named(tmp_path: Path) -> None:
    assert "--convention three" in refused(tmp_path / "a.json", json.dumps(ROWS.tolist()), Reading())
    assert "must be one of shviewer" in refused(
        tmp_path / "a.json", json.dumps(ROWS.tolist()), Reading(convention="maya")
    )


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"shviewer-coefficients": 2}, "shviewer-coefficients 2: this version reads schema 1; update shviewer"),
        ({"convention": "maya"}, "must be one of shviewer"),
        ({"convention": None}, "a stamp needs both"),
        ({"quantity": "luminance"}, "a stamp needs both"),
        ({"quantity": "irradiance"}, "convention three holds radiance, but quantity says irradiance"),
        ({"convention": "three,z-up,y-up"}, "contradict each other"),
        (
            {"phase": "Condon-Shortley phase kept"},
            "phase says 'Condon-Shortley phase kept', but convention three means",
        ),
        ({"axes": "z up"}, "axes says 'z up', but convention three means"),
        ({"bands": 4}, "says 4 bands but has 9 rows"),
    ],
)
def test_a_stamp_that_is_wrong_is_not_believed(changes: dict[str, Any], says: str, tmp_path: Path) -> None:
    assert says in refused(tmp_path / "a.json", stamped(**changes), Reading())


POLYNOMIALS = "1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2, their constants in the numbers"
POLYNOMIALS += " | no phase: plain polynomials | l(l+1) + m | "

WORDS = {
    "shviewer": "orthonormal real spherical harmonics | Condon-Shortley phase kept | l(l+1) + m | +x +y +z; z up, right",
    "filament": POLYNOMIALS + "+y +z +x; y up, right",
    "three": "orthonormal real spherical harmonics | no Condon-Shortley phase | l(l+1) + m | +x +z -y; y up, right",
    "unity": POLYNOMIALS + "+x +z +y; y up, left",
    "unreal": "orthonormal real spherical harmonics | Condon-Shortley phase kept | l(l+1) + m | -y -x +z; z up, left",
    "ambix": "SN3D real spherical harmonics; the numbers are integrals with them | no Condon-Shortley phase | l(l+1) + m"
    " | +x +y +z; z up, right",
    "sphericart": "orthonormal real spherical harmonics | no Condon-Shortley phase | l(l+1) + m | +x +y +z; z up, right",
    "scipy": "orthonormal complex spherical harmonics | Condon-Shortley phase kept | l(l+1) + m | +x +y +z; z up, right",
}


@pytest.mark.parametrize("name", WORDS)
def test_the_words_of_schema_1_stay_what_they_are(name: str) -> None:
    """A reader compares them: other words would make yesterday's files contradict themselves."""
    stamp = stamp_of(CONVENTIONS[name], "radiance", 3)
    basis, phase, index, axes = WORDS[name].split(" | ")
    assert (stamp["basis"], stamp["phase"], stamp["index"]) == (basis, phase, index)
    assert stamp["axes"] == f"x y z are our {axes}-handed"


def test_a_stamp_may_say_more_than_is_understood_but_not_something_else_than_the_user(tmp_path: Path) -> None:
    assert read(tmp_path / "a.json", stamped(moon="full"), Reading()).convention == "three"
    assert read(tmp_path / "a.json", stamped(), THREE).convention == "three"
    assert "leave out --convention unreal" in refused(tmp_path / "a.json", stamped(), Reading(convention="unreal"))


def seeds() -> dict[str, bytes]:
    """One small file of every kind that is written here, and a bare list."""
    from shviewer.analysis.projected import project_recipe
    from shviewer.coefficients.writing import FORMATS

    found = project_recipe(Recipe(n_bands=2))
    files = {f"seed.{kind}": found.encode(CONVENTIONS["three"], kind) for kind in FORMATS}
    scipy = {f"complex.{kind}": found.encode(CONVENTIONS["scipy"], kind) for kind in ("json", "csv", "h")}
    return files | scipy | BARE


BARE = {
    "bare.txt": b"(1, 2, 3); // L\n(4, 5, 6);\n7 8 9f\n-1e-3 0 .5",
    "planes.csv": b"1;2;3;4\n5,5;6;7;8\n9;8;7;6\n",
    "names.glsl": b"const vec3 L00 = vec3(1, 2, 3);\nvec3 L1m1 = vec3(1), L10 = vec3(2), L11 = vec3(3);",
    "objects.txt": b"4\n{r: 1, g: 2, b: 3}, {r: 1, g: 2, b: 3}, {r: 1, g: 2, b: 3}, {r: 1, g: 2, b: \xe2\x88\x923}",
    "header.csv": b"l\tm\tr\tg\tb\n0\t0\t1\t2\t3\n1\t1\t4\t5\t6\n1\t-1\t7\t8\t9\n1\t0\t1,5\t2\t3\n",
    "shtools.txt": b"0, 0, 1.5, 0\n1, 0, 2.5e-1, 0\n1, 1, 3, 4\n",
    "rgba.txt": b"1 2 3 1\n4 5 6 1\n7 8 9 1\n1 2 3 1\n",
    "probe.json": b'{"object": {"type": "LightProbe", "intensity": 2, "sh": [' + b"1, " * 26 + b"2]}}",
    "scene.json": b'{"lights": [{"intensity": 2, "irradianceCoefficients": [' + b"[1, 2, 3], " * 8 + b"[4, 5, 6]]}]}",
    "unity.txt": b"probe:\n" + b"".join(b"  sh[%2d]: %d\n" % (i, i) for i in range(27)),
    "babylon.json": b'{"l00": {"_x": 1, "_y": 2, "_z": 3}, "l1_1": [4, 5, 6], "l10": [7, 8, 9], "l11": [1, 2, 3]}',
}


def outcome(path: Path, reading: Reading) -> tuple[CoefficientLight | None, str]:
    """The light, or why there is none."""
    try:
        light = find_light(str(path), reading)
    except LightError as error:
        return None, str(error)
    assert isinstance(light, CoefficientLight)
    return light, ""


def test_no_mutation_of_a_file_is_anything_but_a_light_or_one_line(tmp_path: Path) -> None:
    """Bytes changed, removed, doubled, cut off; 2500 files in all."""
    generator = np.random.default_rng(0)
    lights = 0
    for name, data in seeds().items():
        path = tmp_path / name
        cuts = range(0, len(data), 17)
        for attempt in range(200 + len(cuts)):
            mutated = bytearray(data)
            if attempt < len(cuts):
                mutated = mutated[: cuts[attempt]]
            else:
                for _ in range(generator.integers(1, 4)):
                    at = int(generator.integers(len(mutated)))
                    match int(generator.integers(4)):
                        case 0:
                            mutated[at] = int(generator.integers(256))
                        case 1:
                            del mutated[at : at + int(generator.integers(1, 9))]
                        case 2:
                            mutated[at:at] = mutated[at : at + int(generator.integers(1, 30))]
                        case 3:
                            mutated[at] = int(generator.choice(list(b'0123456789,.-e\n{}[]"')))
                    if not mutated:
                        break
            path.write_bytes(mutated)
            light, said = outcome(path, THREE if name in BARE else Reading())
            assert "\n" not in said
            assert light is None or np.isfinite(light.given).all()
            lights += light is not None
    assert lights > 100  # many mutations only touch a comment or a digit


@pytest.mark.parametrize(
    ("name", "data", "says"),
    [
        ("a.txt", "1 2 3\n4 5 6\n", "2 rows of three: n bands have n^2 rows"),
        ("a.txt", "1 2 3\n" * 3 + "1 nan 2\n", "row 3 (from 0) is not finite"),
        ("a.json", "[1, 2, 3, 4, 5]", "5 numbers: n bands have n^2 rows"),
        (
            "a.npy",
            npy(np.ones((32, 64))),
            "an array of shape (32, 64); coefficients are (n^2, 3), an image is (height, width, 3)",
        ),
        ("a.txt", "1 2 3\n" * 4, "name its convention"),
        ("a.txt", "1 2\n" * 4, "name its convention"),
        ("a.npy", npy(np.ones((9, 3), complex)), "name its convention"),
    ],
)
def test_what_no_convention_could_mend_is_said_before_one_is_asked_for(
    name: str, data: str | bytes, says: str, tmp_path: Path
) -> None:
    assert says in refused(tmp_path / name, data, Reading())
