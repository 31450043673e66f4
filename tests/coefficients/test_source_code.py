"""The C header is compiled by the system's compiler, the GLSL function by the driver."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import moderngl
import numpy as np
import pytest
from coefficients.peer_cases import asymmetric
from helpers import unavailable
from places import ASSETS

import shviewer
from shviewer.analysis.projected import Projected, project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.table import identifier
from shviewer.coefficients.texts import parse_convention
from shviewer.coefficients.writing import real_columns
from shviewer.errors import UsageError
from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.viewer.gl.renderer import Renderer

COMPILER = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)

SCREEN = (
    "#version 330 core\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }"
)


def projected(n_bands: int, name: str = "a 2nd light!", quantity: str = "radiance") -> Projected:
    light = CoefficientLight(asymmetric(n_bands), name)
    return project_recipe(Recipe(light, n_bands=n_bands, quantity=quantity))


@pytest.mark.parametrize("name", ["shviewer", "three", "scipy"])
def test_the_c_header_compiles_without_a_warning_and_holds_every_digit(name: str, tmp_path: Path) -> None:
    if COMPILER is None:
        unavailable("there is no C compiler (cc, gcc or clang) on this machine")
    (tmp_path / "light.h").write_bytes(projected(3).encode(CONVENTIONS[name], "h"))
    numbers = real_columns(CONVENTIONS[name].from_ours(asymmetric(3)))
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "light.h"\n#include "light.h"\n'
        "int main(void) {\n    const double *p = (const double *)sh_a_2nd_light;\n"
        '    for (unsigned i = 0; i < sizeof sh_a_2nd_light / sizeof *p; ++i) printf("%.17g\\n", p[i]);\n'
        "    return SH_A_2ND_LIGHT_BANDS * SH_A_2ND_LIGHT_BANDS == SH_A_2ND_LIGHT_ROWS ? 0 : 1;\n}\n"
    )
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    built = subprocess.run(
        [COMPILER, *flags, "main.c", "-o", "main"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert built.returncode == 0, built.stderr
    printed = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout
    np.testing.assert_array_equal(np.array(printed.split(), dtype=np.float64), numbers.ravel())


def drawn(renderer: Renderer, source: str, function: str, directions: Array) -> Array:
    """The function's values at up to 4096 directions (k, 3), computed by the GPU in float32."""
    context, side = renderer.context, 64
    grid = np.zeros((side * side, 4), np.float32)
    grid[: len(directions), :3] = directions
    texture = context.texture((side, side), 4, grid.tobytes(), dtype="f4")
    target = context.framebuffer([context.texture((side, side), 4, dtype="f4")])
    fragment = (
        f"#version 330 core\nuniform sampler2D directions;\nout vec4 colour;\n{source}\n"
        f"void main() {{ colour = vec4({function}(texelFetch(directions, ivec2(gl_FragCoord.xy), 0).xyz), 1.0); }}"
    )
    program = context.program(vertex_shader=SCREEN, fragment_shader=fragment)
    array = context.vertex_array(program, [])
    try:
        target.use()
        texture.use(0)
        array.render(moderngl.TRIANGLES, 3)
        values = np.frombuffer(target.read(components=4, dtype="f4"), np.float32).reshape(-1, 4)
    finally:
        renderer.rest.use()
        for piece in (array, program, target.color_attachments[0], target, texture):
            piece.release()
    return values[: len(directions), :3].astype(np.float64)


DIRECTIONS = np.concatenate(
    [
        np.random.default_rng(2).normal(size=(1000, 3)),
        np.eye(3),
        -np.eye(3),
        [[1e-4, 0, 1], [0, 1e-4, -1], [1, 1, 0], [1, -1, 1e-7]],
    ]
)
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1, keepdims=True)


@pytest.mark.parametrize("n_bands", [1, 2, 3, 4, 9, 13])
@pytest.mark.parametrize("text", ["shviewer", "ambix,y-up", "e3nn,y-up", "shtools", "shviewer,m-swapped,-y+z+x"])
def test_the_glsl_function_is_the_reconstruction(renderer: Renderer, n_bands: int, text: str) -> None:
    """In float32: within 2e-6 of the largest value, which rounding of up to 256 products leaves (measured: 7e-7)."""
    convention = parse_convention(text)
    source = projected(n_bands, "light").encode(convention, "glsl").decode()
    wanted = evaluate_basis(DIRECTIONS, n_bands) @ asymmetric(n_bands)
    found = drawn(renderer, source, "sh_light_radiance", DIRECTIONS @ convention.axes.matrix.T)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=2e-6 * np.abs(wanted).max())


@pytest.mark.parametrize(
    "name",
    [
        *("filament", "three", "unity", "unreal"),
        *(
            "babylon",
            "playcanvas",
            "3dgs",
            "fuma",
            "directxmath",
            "shviewer,order-m-major",
        ),  # orders of rows and shifts
    ],
)
def test_the_glsl_of_a_program_gives_what_that_program_holds(renderer: Renderer, name: str) -> None:
    convention = parse_convention(name)
    over_pi = convention.quantity == "irradiance-over-pi"
    source = projected(3, "light", "irradiance" if over_pi else "radiance").encode(convention, "glsl").decode()
    held = asymmetric(3) * (np.repeat([1, 2 / 3, 1 / 4], [1, 3, 5])[:, None] if over_pi else 1)
    wanted = evaluate_basis(DIRECTIONS, 3) @ held
    function = f"sh_light_{'irradiance_over_pi' if over_pi else 'radiance'}"
    found = drawn(renderer, source, function, DIRECTIONS @ convention.axes.matrix.T)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=2e-6 * np.abs(wanted).max())


def test_32_bands_compile_and_33_are_refused(renderer: Renderer) -> None:
    source = projected(32, "light").encode(CONVENTIONS["shviewer"], "glsl").decode()
    wanted = evaluate_basis(DIRECTIONS, 32) @ asymmetric(32)
    found = drawn(renderer, source, "sh_light_radiance", DIRECTIONS)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=4e-6 * np.abs(wanted).max())
    with pytest.raises(UsageError, match="33 bands: a shader is written for 1 to 32"):
        projected(33).encode(CONVENTIONS["shviewer"], "glsl")


def test_complex_coefficients_are_no_shader() -> None:
    with pytest.raises(UsageError, match="complex coefficients"):
        projected(3).encode(CONVENTIONS["scipy"], "glsl")


def test_names_become_identifiers_that_c_and_glsl_accept() -> None:
    assert identifier("film:diffuse--2") == "sh_film_diffuse_2"
    assert identifier("float") == "sh_float"
    assert identifier("__") == "sh"


def test_unitys_seven_vectors_are_made_as_the_guide_says() -> None:
    """ShadeSH9 adds dot(A, (n, 1)), dot(B, (xy, yz, zz, zx)) and C (xx - yy): the polynomials of what is written."""
    page = (ASSETS / "guide" / "coefficients.md").read_text(encoding="utf-8")
    found = shviewer.project("venice_sunset", 3)
    sh = np.asarray(found.numbers("unity"), dtype=float).T
    x, y, z = 0.48, 0.6, 0.64
    rows = [re.findall(rf"unity_SH{name} = \((.*)\)", page)[0].replace("3 sh", "3 * sh") for name in "ABC"]
    a, b, c = (eval(f"({row})", {"sh": sh, "c": 1}) for row in rows)
    value = np.dot(a, [x, y, z, 1]) + np.dot(b, [x * y, y * z, z * z, z * x]) + c[1] * (x * x - y * y)
    ours = np.array([[x, z, y]])
    wanted = shviewer.reconstruct(find_light("venice_sunset").irradiance().coefficients(3), ours) / np.pi
    assert value == pytest.approx(wanted[0, 1], rel=1e-12)
