"""What a file says is to be typed works: with the program itself where it is installed, or with what stands for it."""

from __future__ import annotations

import json
import math
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coefficients import peer_evaluators as peers
from coefficients.peer_cases import EXACT, asymmetric, directions_here
from helpers import unavailable

from shviewer.analysis.projected import project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.texts import parse_convention
from shviewer.coefficients.use import IN_CPP, JAVASCRIPT, USES
from shviewer.coefficients.writing import FORMATS
from shviewer.harmonics.basis import evaluate_basis
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light

NODE = shutil.which("node")


def encoded(name: str, kind: str, n_bands: int = 3) -> bytes:
    convention = parse_convention(name)
    quantity = (convention.quantity or "radiance").removesuffix("-over-pi")
    light = CoefficientLight(asymmetric(n_bands), "a probe")
    return project_recipe(Recipe(light, n_bands=n_bands, quantity=quantity)).encode(convention, kind)


def parsed(name: str, n_bands: int = 3) -> dict[str, Any]:
    return dict(json.loads(encoded(name, "json", n_bands)))


def test_every_program_that_takes_numbers_says_what_to_type_in_one_line() -> None:
    gives_only = {name for name in CONVENTIONS if name.startswith(("webxr", "arcore", "arkit"))}
    for name in CONVENTIONS:
        for kind in FORMATS:
            if name == "scipy" and kind in ("glsl", "hlsl"):
                continue
            said = find_stamp(encoded(name, kind), kind).get("use", "")
            assert "\n" not in str(said)
            assert "{" not in re.sub(r"\{[^{}]*[;(][^{}]*\}", "", str(said)), said  # nothing is left to be filled in
            if kind in ("json", "csv", "npz"):
                assert bool(said) == (name not in gives_only), (name, kind)
            if kind == "h":
                assert bool(said) == (name in IN_CPP)


def find_stamp(data: bytes, kind: str) -> dict[str, Any]:
    if kind == "json":
        return dict(json.loads(data))
    if kind == "npz":
        import io

        return dict(json.loads(str(np.load(io.BytesIO(data))["stamp"])))
    return dict(re.findall(r"^(?://|#) ([a-z-]+): (.*)$", data.decode(), re.MULTILINE))


def test_the_line_of_shtools_gives_the_table_that_evaluates_to_the_light() -> None:
    pyshtools = pytest.importorskip("pyshtools")
    file = parsed("shtools", 6)
    table = eval(file["use"].partition("  #")[0], {"pyshtools": pyshtools, "numpy": np, "json": file})
    x, y, z = directions_here(40).T
    found = table.expand(lat=np.degrees(np.arcsin(z)), lon=np.degrees(np.arctan2(y, x)))
    wanted = evaluate_basis(directions_here(40), 6) @ asymmetric(6)
    np.testing.assert_allclose(found, wanted[:, 0], rtol=0, atol=EXACT)


def test_the_lines_of_sphericart_and_scipy_evaluate_to_the_light() -> None:
    sphericart = pytest.importorskip("sphericart")
    from scipy.special import sph_harm_y

    directions = directions_here(20)
    wanted = evaluate_basis(directions, 4) @ asymmetric(4)
    file = parsed("sphericart", 4)
    names = {"sphericart": sphericart, "numpy": np, "json": file, "directions": directions}
    np.testing.assert_allclose(eval(file["use"], names), wanted, rtol=0, atol=EXACT)
    x, y, z = directions.T
    complex_file = parsed("scipy", 4)
    names = {
        "sph_harm_y": sph_harm_y,
        "numpy": np,
        "json": complex_file,
        "theta": np.arccos(z),
        "phi": np.arctan2(y, x),
    }
    found = eval(complex_file["use"].partition("  #")[0], names)
    np.testing.assert_allclose(found, wanted[:, 0], rtol=0, atol=EXACT)


def test_the_lines_for_gaussians_and_ambisonics_give_the_containers() -> None:
    file = parsed("3dgs", 4)
    names: dict[str, Any] = {"numpy": np, "json": file}
    exec(file["use"], names)
    assert (names["f_dc"].shape, names["f_rest"].shape) == ((3,), (45,))
    rows = np.concatenate([names["f_dc"][None], names["f_rest"].reshape(3, 15).T])
    found = peers.gaussian_splatting(rows, directions_here(20))
    np.testing.assert_allclose(found, evaluate_basis(directions_here(20), 4) @ asymmetric(4), rtol=0, atol=EXACT)
    for name in ("ambix", "fuma"):
        file = parsed(name, 4)
        names = {"numpy": np, "json": file}
        exec(file["use"].partition("  #")[0], names)
        np.testing.assert_array_equal(names["channels"], np.array(file["coefficients"])[:, 0])


def test_the_line_of_our_own_reads_the_file(tmp_path: Path) -> None:
    import shviewer

    path = tmp_path / "probe.json"
    path.write_bytes(encoded("shviewer,y-up,no-phase", "json"))
    light = eval(json.loads(path.read_text())["use"], {"shviewer": shviewer, "path_of_this_file": path})
    np.testing.assert_allclose(light.coefficients(3), asymmetric(3), rtol=0, atol=EXACT)


FAKES = """
const got = {};
const record = (name) => (...values) => { got[name] = values; return fake; };
const fake = { build: record("build") };
const Filament = { IndirectLight: { Builder: () => ({ irradianceSh: record("rows") }) } };
const engine = "engine", probe = { sh: { fromArray: record("rows") } }, material = {}, texture = {};
const BABYLON = {
    SphericalPolynomial: { FromHarmonics: (harmonics) => ({ harmonics }) },
    SphericalHarmonics: { FromArray: (rows) => rows },
};
class Cartesian3 { constructor(x, y, z) { this.xyz = [x, y, z]; } }
const Cesium = { Cartesian3 }, model = { imageBasedLighting: {} };
const gltf = { extensions: { EXT_lights_image_based: { lights: [{}] } } };
const seen = () => JSON.stringify([
    got.rows, [...(material.ambientSH ?? [])], texture.sphericalPolynomial?.harmonics,
    model.imageBasedLighting.sphericalHarmonicCoefficients?.map((c) => c.xyz),
    gltf.extensions.EXT_lights_image_based.lights[0].irradianceCoefficients,
]);
"""


@pytest.mark.parametrize("name", [name for name, use in USES.items() if use.language == JAVASCRIPT])
def test_the_line_of_a_client_and_the_function_of_the_module_hand_over_the_rows(name: str, tmp_path: Path) -> None:
    if NODE is None:
        unavailable("node is not installed")
    file = parsed(name)
    (tmp_path / "probe.mjs").write_bytes(encoded(name, "js"))
    takes = ", ".join(USES[name].takes)
    by_line = f"{FAKES}\nconst json = {json.dumps(file)};\n{file['use']};\nconsole.log(seen());"
    by_module = f'import {{ apply }} from "./probe.mjs";\n{FAKES}\napply({takes});\nconsole.log(seen());'
    for number, text in enumerate((by_line, by_module)):
        (tmp_path / f"run{number}.mjs").write_text(text)
        done = subprocess.run(
            [NODE, tmp_path / f"run{number}.mjs"], capture_output=True, text=True, check=True, timeout=60
        )
        (found,) = [value for value in json.loads(done.stdout) if value]
        numbers = np.array([value for value in np.ravel(np.array(found, dtype=object)) if not isinstance(value, list)])
        rows = np.array(file["coefficients"])
        flat = found[-1] if name in ("filament", "three") else found
        np.testing.assert_allclose(np.ravel(np.array(flat, dtype=float)), rows.ravel(), rtol=1e-6)
        assert name != "filament" or numbers[0] == 3


def test_the_class_for_unity_holds_its_rows_and_its_seven_vectors() -> None:
    """ShadeSH9 adds dot(A, (n, 1)), dot(B, (xy, yz, zz, zx)) and C (xx - yy)."""
    text = encoded("unity", "cs").decode()
    found = re.findall(r"Vector4 (unity_SH\w+) = new UnityEngine.Vector4\((.*)\);", text)
    vectors = {name: [float(value.removesuffix("f")) for value in values.split(", ")] for name, values in found}
    said = find_stamp(encoded("unity", "csv"), "csv")["unity-vectors"]
    assert re.findall(r"(\w+) = \(", said) == list(vectors)
    assert "RenderSettings.ambientProbe = sh_a_probe.Probe();" in text
    assert text.count("{") == text.count("}")
    sh = np.array(parsed("unity")["coefficients"])
    x, y, z = 0.48, 0.6, 0.64
    wanted = peers.unity(sh, np.array([[x, y, z]]))[0]
    for index, channel in enumerate("rgb"):
        value = np.dot(vectors[f"unity_SHA{channel}"], [x, y, z, 1])
        value += np.dot(vectors[f"unity_SHB{channel}"], [x * y, y * z, z * z, z * x])
        value += vectors["unity_SHC"][index] * (x * x - y * y)
        assert math.isclose(value, wanted[index], rel_tol=1e-12)


@pytest.mark.parametrize("kind", ["js", "cs"])
@pytest.mark.parametrize("name", ["three", "unity", "shviewer", "scipy"])
def test_modules_and_classes_are_read_back_to_the_last_digit(name: str, kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"probe.{kind}"
    path.write_bytes(encoded(name, kind))
    light = find_light(str(path))
    assert isinstance(light, CoefficientLight)
    assert light.file is not None
    np.testing.assert_allclose(light.coefficients(3), asymmetric(3), rtol=0, atol=EXACT)
    assert light.convention == name


def test_a_header_for_directxmath_compiles_with_its_line(tmp_path: Path) -> None:
    """With stand-ins for the two functions, of which the second is a dot product."""
    compiler = shutil.which("g++") or shutil.which("c++")
    if compiler is None:
        unavailable("there is no C++ compiler on this machine")
    (tmp_path / "probe.h").write_bytes(encoded("directxmath", "h"))
    line = find_stamp(encoded("directxmath", "h"), "h")["use"]
    (tmp_path / "main.cpp").write_text(
        '#include <cstdio>\n#include <cstddef>\n#include "probe.h"\n'
        "void XMSHEvalDirection(float *basis, size_t n, int) { for (size_t i = 0; i < n * n; ++i) basis[i] = i == 2; }\n"
        "float XMSHDot(size_t n, const float *a, const float *b) { float s = 0; for (size_t i = 0; i < n * n; ++i) s += a[i]"
        " * b[i]; return s; }\n"
        f'int main() {{ int direction = 0; float red[36], basis[36]; {line} printf("%.9g", value); }}\n'
    )
    subprocess.run([compiler, "main.cpp", "-o", "main"], cwd=tmp_path, check=True, capture_output=True)
    printed = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout
    assert float(printed) == pytest.approx(parsed("directxmath")["coefficients"][2][0], rel=1e-6)
