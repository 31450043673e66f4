"""What engines store of an irradiance, as files: the numbers, and formulas that decode them, in words and run by the driver."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from coefficients.test_source_code import SCREEN
from harmonics.independent import random_directions, random_rotation
from helpers import unavailable
from places import kernels

import shviewer
from shviewer.analysis.projected import Projected, project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.cli.main import main
from shviewer.coefficients.stored_code import FORMULAS
from shviewer.coefficients.texts import parse_convention
from shviewer.errors import UsageError
from shviewer.harmonics.basis import Array, count_bands, evaluate_basis
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quantities import decoding
from shviewer.harmonics.quantities.encodings import ENCODINGS, Stored
from shviewer.harmonics.quantities.names import ENCODED_BANDS
from shviewer.viewer.gl.renderer import Renderer

LEFT_HANDED = "+x+z+y"
NORMALS = np.concatenate([random_directions(300), np.eye(3), -np.eye(3)])
CUT_OFF = {"geomerics": 1e-5, "ambient-cube": 5e-4, "ambient-cube-fitted": 5e-4}


def stored(name: str, light: str = "venice_sunset") -> Projected:
    return project_recipe(Recipe(light, n_bands=ENCODED_BANDS[name], quantity="irradiance"), name)


def text(projected: Projected, kind: str, convention: str = "shviewer") -> str:
    return projected.encode(parse_convention(convention), kind).decode()


def drawn(renderer: Renderer, source: str, call: str, directions: Array) -> Array:
    """What a function of GLSL returns in directions, float32."""
    context, count = renderer.context, len(directions)
    program = context.program(
        vertex_shader=SCREEN,
        fragment_shader=f"#version 330 core\n{source}\nuniform sampler2D places; out vec4 colour;\n"
        f"void main() {{ vec3 at = texelFetch(places, ivec2(gl_FragCoord.xy), 0).xyz; colour = vec4({call}(at), 1); }}",
    )
    places = context.texture((count, 1), 3, directions.astype(np.float32).tobytes(), dtype="f4")
    target = context.framebuffer([context.texture((count, 1), 4, dtype="f4")])
    target.use()
    places.use(0)
    context.vertex_array(program, []).render(moderngl.TRIANGLES, vertices=3)
    return np.frombuffer(target.read(components=4, dtype="f4"), np.float32).reshape(count, 4)[:, :3].astype(np.float64)


@pytest.mark.parametrize("axes", ["shviewer", f"shviewer,{LEFT_HANDED}"])
@pytest.mark.parametrize("name", ENCODINGS)
def test_the_function_of_glsl_has_the_irradiance_in_the_axes_of_the_file(
    renderer: Renderer, name: str, axes: str
) -> None:
    projected, there = stored(name), parse_convention(axes).axes.matrix
    source = text(projected, "glsl", axes)
    (call,) = re.findall(r"^// use: vec3 irradiance = (\w+)\(normal\);$", source, re.MULTILINE)
    wanted = evaluate_basis(NORMALS, projected.n_bands) @ projected.coefficients
    found = drawn(renderer, source, call, NORMALS @ there.T)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=(2e-6 + CUT_OFF.get(name, 0)) * np.abs(wanted).max())


def said(formula: str, numbers: dict[str, float], normal: Array, vectors: Array) -> float:
    """The irradiance by a formula as it is written: factors stand beside each other, and a dot is a product of vectors."""
    known: dict[str, Any] = {**numbers, "n": normal, "sqrt": np.sqrt, "abs": abs, "min": min, "norm": np.linalg.norm}
    known |= dict(zip(("red", "green", "blue"), vectors, strict=True)) | {"dot": np.dot, "array": np.array}
    if "c4" in numbers:
        known |= dict(zip("xyz", normal, strict=True))
    parts = [part for part in re.split(r", (?=[\w()]+ = )", formula) if not part.startswith("n = ")]
    while parts:
        name, _, right = parts.pop().partition(" = ")
        whole = right
        right = re.sub(r"\bv\.([rgb])\b", lambda match: {"r": "red", "g": "green", "b": "blue"}[match[1]], right)
        right = re.sub(r"\|(\w)\.(\w)\|", r"abs(dot(\1, \2))", right.removesuffix(" for all channels"))
        right = re.sub(r"\b([a-z])\.([a-z])\b", r"dot(\1, \2)", re.sub(r"\|(\w)\|", r"norm(\1)", right))
        right = re.sub(r"(?<=[\w)]) (?=[\w(])", " * ", re.sub(r"(.*) but at most 1", r"min(\1, 1)", right))
        right = f"array{right}.astype(float)" if name == "v" else right
        right = re.sub(r"\barray\((.*)\)\.", r"array([\1]).", right)
        try:
            known[name] = eval(right.replace("^", "**"), {}, known)
        except NameError:  # of something that is explained further on
            parts.insert(0, f"{name} = {whole}")
    return float(known["E(n)"])


@pytest.mark.parametrize("formula", [name for name in FORMULAS if name != "cube"])
def test_the_formula_in_words_is_that_of_the_program(formula: str) -> None:
    count = {"zh3": 5, "zh3_shared": 5, "l2": 9}.get(formula, 4)
    numbers = np.random.default_rng(1).random((count, 3)) * np.array([[3.0]] + [[1.0]] * (count - 1))
    wanted = decoding.FORMULAS[formula](numbers, NORMALS[:5])
    names = ["c0", "c1", "c2", "c3", "z"] if count == 5 else [f"c{row}" for row in range(count)]
    vectors = decoding.vectors(numbers)
    found = [
        [
            said(FORMULAS[formula], dict(zip(names, numbers[:, channel], strict=True)), normal, vectors)
            for channel in range(3)
        ]
        for normal in NORMALS[:5]
    ]
    np.testing.assert_allclose(found, wanted, rtol=1e-12)
    assert ("for all channels" in FORMULAS[formula]) == ("shared" in formula)
    assert LUMINANCE.sum() == pytest.approx(1)


@pytest.mark.parametrize("name", ["l1", "zh3", "l2-deringed", "ambient-cube"])
def test_every_format_has_the_numbers_their_names_and_the_formula(name: str, tmp_path: Path) -> None:
    projected = stored(name)
    numbers = projected.stored.numbers
    read = json.loads(text(projected, "json"))
    np.testing.assert_array_equal(read["coefficients"], numbers)
    assert (read["encoding"], read["rows"], read["quantity"]) == (name, len(numbers), "irradiance")
    assert read["formula"] == FORMULAS[ENCODINGS[name].formula]
    assert read["numbers"].split() == [*ENCODINGS[name].places]
    assert ("normalisation" in read) == (name != "ambient-cube")
    table = [line.split(",") for line in text(projected, "csv").splitlines() if not line.startswith("#")]
    assert table[0] == ["number", "red", "green", "blue"]
    assert [row[0] for row in table[1:]] == [*ENCODINGS[name].places]
    np.testing.assert_array_equal(np.array([row[1:] for row in table[1:]], float), numbers)
    (tmp_path / "a.npz").write_bytes(projected.encode(parse_convention("shviewer"), "npz"))
    np.testing.assert_array_equal(np.load(tmp_path / "a.npz")["coefficients"], numbers)
    np.testing.assert_array_equal(projected.numbers(), numbers)
    for kind in ("h", "js", "cs", "glsl"):
        source = text(projected, kind)
        assert f"// formula: {read['formula']}" in source
        assert f"// {ENCODINGS[name].places[-1]}\n" in source
        assert repr(float(numbers[-1, 2])) in source


def test_the_header_compiles(tmp_path: Path) -> None:
    compiler = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
    if compiler is None:
        unavailable("there is no C compiler (cc, gcc or clang) on this machine")
    (tmp_path / "light.h").write_text(text(stored("zh3"), "h"))
    (tmp_path / "main.c").write_text(
        '#include "light.h"\nint main(void) { return SH_VENICE_SUNSET_ROWS == 5 && sh_venice_sunset[4][0] > 1 ? 0 : 1; }\n'
    )
    subprocess.run([compiler, "-std=c99", "-Wall", "-Werror", "main.c", "-o", "main"], cwd=tmp_path, check=True)
    subprocess.run([tmp_path / "main"], check=True)


def test_a_window_is_in_the_numbers_of_sums_and_leaves_the_others_none() -> None:
    windowed = Recipe("green", n_bands=3, quantity="irradiance", window="hann", window_width=4)
    found = project_recipe(windowed, "l2")
    own = shviewer.find_light("green").coefficients(3)
    wanted = own * np.repeat([1, (1 + np.sqrt(0.5)) / 2, 0.5], [1, 3, 5])[:, None]
    np.testing.assert_allclose(found.stored.numbers, wanted, rtol=1e-14)
    none = project_recipe(windowed, "zh3")
    assert (none.stored, none.about["through"], count_bands(none.coefficients)) == (None, "zh3", 3)


@pytest.mark.parametrize("name", ["zh3", "l2", "ambient-cube-fitted"])
def test_numbers_of_a_turned_light_are_those_of_the_light_as_it_stands(name: str) -> None:
    """In two turns as in one. A cube is another one, with errors of its own."""
    first, second = random_rotation(1), random_rotation(2)
    still = stored(name, "green")
    turned = still.turned(first).turned(second)
    radiance = shviewer.project("green", 32).turned(second @ first).coefficients
    wanted = ENCODINGS[name].store(radiance)
    np.testing.assert_allclose(turned.stored.numbers, wanted, rtol=0, atol=1e-12)
    seen = evaluate_basis(NORMALS, turned.n_bands) @ turned.coefficients
    by_formula = Stored(name, wanted).irradiance(NORMALS)
    np.testing.assert_allclose(seen, by_formula, rtol=0, atol=CUT_OFF.get(name, 1e-12) * np.abs(seen).max())
    stamped = np.array(str(turned.about["turned"]).split(), float).reshape(3, 3)
    np.testing.assert_allclose(stamped, second @ first, atol=1e-11)
    assert (turned.sums.relative_l2 == still.sums.relative_l2) == ENCODINGS[name].turns
    assert turned.figures.relative_l2 == turned.sums.relative_l2


SAID: dict[str, str] = {
    "--encode zh4": "--encode 'zh4': it must be one of l1, geomerics",
    "--encode zh3 --bands 3": "--encode zh3: it takes the place of bands",
    "--encode zh3 --for glossy:0.4": "encode zh3: engines store it of irradiance",
    "--encode zh3 --convention three": "--encode zh3: its formula takes shviewer's own numbers, not those of three",
    "--encode zh3 --no-phase": "not those of shviewer,no-phase; for other axes give --axes",
    "--encode zh3 --mute 1": "--mute: the formula of zh3 takes no factors of bands",
    "--encode geomerics --window hann": "--window hann: the formula of geomerics takes no factors of bands",
}


@pytest.mark.parametrize("options", SAID)
def test_what_cannot_be_is_one_line(options: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["project", "green", "-o", "-", "--format", "json", *options.split()]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert SAID[options] in line


@pytest.mark.parametrize(
    ("name", "notes"),
    [("l1", ["the irradiance that l1 decodes to goes to -0.111"]), ("geomerics", []), ("ambient-cube", [])],
)
def test_project_says_what_it_wrote_and_what_goes_below_zero(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, notes: list[str]
) -> None:
    out = tmp_path / "green.json"
    assert main(["project", "green", "--encode", name, "-o", str(out), "--rotate-light", "30", "20"]) == 0
    printed = capsys.readouterr()
    floats = ENCODINGS[name].floats
    assert printed.out.startswith(f"wrote {out}: {floats} numbers a channel, {name}, irradiance within ")
    assert [note for note in notes if note not in printed.err] == []
    assert len(printed.err.splitlines()) == len(notes)


def test_a_light_that_is_below_zero_itself_is_not_said_to_be(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shviewer.project("green", 2, quantity="irradiance").save(tmp_path / "two.json")
    assert main(["project", str(tmp_path / "two.json"), "--encode", "zh3", "-o", str(tmp_path / "e.json")]) == 0
    assert "decodes to" not in capsys.readouterr().err


def test_several_lights_have_the_count_of_their_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["project", "green", "hemisphere", "--encode", "zh3", "-o", str(tmp_path)]) == 0
    head, first, *_ = capsys.readouterr().out.splitlines()
    assert head.split() == ["light", "numbers", "irradiance", "minimum", "file"]
    assert first.split()[1] == "5"


def test_python_has_them_too() -> None:
    found = shviewer.project("green", encode="zh3")
    assert (found.quantity, found.numbers().shape) == ("irradiance", (5, 3))
    assert repr(found) == "<green: irradiance in 5 numbers a channel, zh3, relative L2 error 0.152>"
    np.testing.assert_array_equal(found.numbers("shviewer,y-up")[[0, 4]], found.numbers()[[0, 4]])
    calls: list[Callable[[], object]] = [
        lambda: shviewer.project("green", encode="zh5"),
        lambda: shviewer.project("green", 3, encode="zh3"),
        lambda: shviewer.project("green", encode="zh3", tolerance=0.05),
        lambda: shviewer.project("green", encode="zh3", quantity="radiance"),
        lambda: found.numbers("three"),
    ]
    for call in calls:
        with pytest.raises(UsageError):
            call()


def test_factors_of_a_kernel_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    for roughness, wanted in kernels()["A"]["factors"].items():
        assert main(["--list-factors", f"glossy:{roughness}", "--bands", str(len(wanted["f"]))]) == 0
        head, *rows = capsys.readouterr().out.splitlines()
        values = [row.split(",") for row in rows]
        assert (head, [int(l) for l, _ in values]) == ("l,factor", list(range(len(wanted["f"]))))
        np.testing.assert_allclose([float(f) for _, f in values], np.array(wanted["f"], float), rtol=0, atol=1e-13)
    assert main(["--list-factors", "glossy:0.1", "--bands", "512"]) == 0
    assert float(capsys.readouterr().out.split(",")[-1]) == pytest.approx(1.5e-4, rel=0.05)
    for wrong in (["glossy:2"], ["shiny"], ["irradiance", "--bands", "513"]):
        assert main(["--list-factors", *wrong]) == 2
        assert len(capsys.readouterr().err.splitlines()) == 1
