"""HLSL gives what the GLSL gives: run by a compiler of C++ that is told what HLSL's words mean, and read by one of HLSL."""

from __future__ import annotations

import re
import shutil
import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from harmonics.independent import random_directions
from helpers import unavailable

import shviewer
from shviewer.analysis.projected import Projected, project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.coefficients.texts import parse_convention
from shviewer.harmonics.basis import Array
from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.harmonics.quantities.names import ENCODED_BANDS

DIRECTIONS = random_directions(40)

SHIM = """
#include <cmath>
#include <cstdio>
typedef double real;  // so that rounding hides no fault
struct bool3 { bool x, y, z; };
struct float3 {
    real x, y, z;
    float3(real a, real b, real c) : x(a), y(b), z(c) {}
    real &operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    real operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    float3 operator-() const { return {-x, -y, -z}; }
    float3 &operator+=(const float3 &o) { x += o.x; y += o.y; z += o.z; return *this; }
};
#define EACH(op) static float3 operator op(const float3 &a, const float3 &b) { return {a.x op b.x, a.y op b.y, a.z op b.z}; } \\
    static float3 operator op(const float3 &a, real b) { return {a.x op b, a.y op b, a.z op b}; } \\
    static float3 operator op(real a, const float3 &b) { return {a op b.x, a op b.y, a op b.z}; }
EACH(+) EACH(-) EACH(*) EACH(/)
static bool3 operator==(const float3 &a, const float3 &b) { return {a.x == b.x, a.y == b.y, a.z == b.z}; }
static bool3 operator!=(const float3 &a, const float3 &b) { return {a.x != b.x, a.y != b.y, a.z != b.z}; }
static bool all(bool3 b) { return b.x && b.y && b.z; }
static bool any(bool3 b) { return b.x || b.y || b.z; }
static real dot(const float3 &a, const float3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static real length(const float3 &a) { return std::sqrt(dot(a, a)); }
static float3 normalize(const float3 &a) { return a / length(a); }
static real min(real a, real b) { return a < b ? a : b; }
static real max(real a, real b) { return a > b ? a : b; }
using std::abs; using std::pow;
#define float real
"""
"""What HLSL has beside C++, in as much as is written."""


COEFFICIENTS = {
    "three": (3, "radiance", "three", "+x+z-y"),
    "unity": (3, "irradiance", "unity", "+x+z+y"),
    "recurrence": (9, "radiance", "shviewer,y-up", "y-up"),
    "gaussians": (4, "radiance", "3dgs", "+x+y+z"),
}
"""Bands, quantity, convention, and its axes."""

CASES = (*COEFFICIENTS, *ENCODINGS)


@cache
def case(name: str) -> Projected:
    if name in ENCODINGS:
        return project_recipe(Recipe("venice_sunset", n_bands=ENCODED_BANDS[name], quantity="irradiance"), name)
    n_bands, quantity, *_ = COEFFICIENTS[name]
    return project_recipe(Recipe("venice_sunset", n_bands=n_bands, quantity=quantity))


def source(name: str) -> str:
    convention = "shviewer" if name in ENCODINGS else COEFFICIENTS[name][2]
    return case(name).encode(parse_convention(convention), "hlsl").decode()


def function_in(text: str) -> str:
    found = re.search(r"^(?:float3|vec3) (\w+)\((?:float3|vec3) \w+\) {", text, re.MULTILINE)
    assert found
    return found[1]


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Array]:
    """What every function returns in DIRECTIONS."""
    compiler = shutil.which("g++") or shutil.which("c++") or shutil.which("clang++")
    if compiler is None:
        unavailable("there is no compiler of C++ on this machine")
    folder = tmp_path_factory.mktemp("hlsl")
    texts = {name: source(name) for name in CASES}
    parts = [f"namespace n{number} {{\n{text}\n}}" for number, text in enumerate(texts.values())]
    places = ", ".join(f"{{{', '.join(map(repr, direction))}}}" for direction in DIRECTIONS.tolist())
    calls = "\n".join(
        f"    for (auto &d : at) {{ float3 v = n{number}::{function_in(text)}(float3(d[0], d[1], d[2])); "
        'printf("%.17g %.17g %.17g\\n", v.x, v.y, v.z); }'
        for number, text in enumerate(texts.values())
    )
    (folder / "main.cpp").write_text(
        "\n".join([SHIM, *parts, f"static const double at[][3] = {{{places}}};", "int main() {", calls, "}\n"])
    )
    subprocess.run([compiler, "-std=c++17", "-O0", "main.cpp", "-o", "main"], cwd=folder, check=True)
    out = subprocess.run([folder / "main"], capture_output=True, text=True, check=True).stdout
    values = np.array(out.split(), float).reshape(len(texts), len(DIRECTIONS), 3)
    return dict(zip(texts, values, strict=True))


@pytest.mark.parametrize("name", COEFFICIENTS)
def test_the_function_gives_what_the_coefficients_hold(answers: dict[str, Array], name: str) -> None:
    ours = DIRECTIONS @ parse_convention(f"shviewer,{COEFFICIENTS[name][3]}").axes.matrix
    wanted = shviewer.reconstruct(case(name).coefficients, ours) / (np.pi if name == "unity" else 1)
    np.testing.assert_allclose(answers[name], wanted, atol=1e-12 * np.abs(wanted).max())


@pytest.mark.parametrize("name", ENCODINGS)
def test_what_engines_store_is_decoded(answers: dict[str, Array], name: str) -> None:
    stored = case(name).stored
    assert stored is not None
    wanted = stored.irradiance(DIRECTIONS)
    np.testing.assert_allclose(answers[name], wanted, atol=1e-12 * np.abs(wanted).max())


@pytest.mark.parametrize("name", CASES)
def test_a_compiler_of_hlsl_takes_it(name: str, tmp_path: Path) -> None:
    compiler = shutil.which("glslangValidator")
    if compiler is None:
        pytest.skip("there is no glslangValidator, which reads HLSL, on this machine")
    text = source(name)
    (tmp_path / "light.hlsl").write_text(
        f"{text}\nfloat4 main(float3 d : TEXCOORD0) : SV_Target {{ return float4({function_in(text)}(normalize(d)), 1); }}\n"
    )
    command = [compiler, "-D", "-V", "-S", "frag", "-e", "main", "light.hlsl", "-o", "light.spv"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    assert "warning" not in done.stdout.lower(), done.stdout


def test_the_stamp_says_what_to_type_and_the_file_is_a_light_again(tmp_path: Path) -> None:
    projected = case("unity")
    projected.save(tmp_path / "sky.hlsl", "unity")
    text = (tmp_path / "sky.hlsl").read_text()
    assert f"// use: float3 value = {function_in(text)}(direction);" in text
    assert "vec3 " not in text.partition("// use")[2]
    light = shviewer.find_light(tmp_path / "sky.hlsl")
    again = light.through("irradiance").coefficients(3)
    np.testing.assert_allclose(again, projected.coefficients, atol=1e-13)
    assert "// use: float3 irradiance = " in source("zh3")
