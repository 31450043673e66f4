"""Joined shaders and the way back from a driver's message to the file that people edit."""

from __future__ import annotations

from pathlib import Path

import pytest

from shviewer.errors import ShaderError
from shviewer.resources import resource_folder
from shviewer.viewer.gl import shader_source
from shviewer.viewer.gl.shader_source import ShaderSource, load_shader


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shaders = tmp_path / "shaders"
    shaders.mkdir()
    files = {
        "main.frag": '#version 330 core\n#include "a.glsl"\n  #include "b.glsl"\nvoid main() {}\n',
        "a.glsl": '#include "common.glsl"\nfloat a;\n',
        "b.glsl": '#include "common.glsl"\n#include "a.glsl"\nfloat b;\n// #include "none.glsl"\n',
        "common.glsl": "float common;\nfloat more;\n",
        "loop.glsl": '#include "loop.glsl"\nfloat once;\n',
    }
    for name, text in files.items():
        (shaders / name).write_text(text)
    monkeypatch.setattr(shader_source, "resource_folder", lambda kind: tmp_path / kind)
    return shaders


@pytest.mark.usefixtures("folder")
def test_includes_are_joined_where_they_stand_and_each_file_once() -> None:
    source = load_shader("main.frag")
    assert source.text.splitlines() == [
        "#version 330 core",
        "float common;",
        "float more;",
        "float a;",
        "float b;",
        '// #include "none.glsl"',
        "void main() {}",
    ]
    assert source.text.endswith("}\n")
    assert source.origins == (
        ("main.frag", 1),
        ("common.glsl", 1),
        ("common.glsl", 2),
        ("a.glsl", 2),
        ("b.glsl", 3),
        ("b.glsl", 4),
        ("main.frag", 4),
    )


@pytest.mark.usefixtures("folder")
def test_a_file_that_includes_itself_is_read_once() -> None:
    assert load_shader("loop.glsl").text == "float once;\n"


@pytest.mark.usefixtures("folder")
def test_generated_text_stands_in_for_a_file_and_before_one() -> None:
    source = load_shader("main.frag", {"common.glsl": "#define X 1\n"})
    assert source.text.splitlines()[1:3] == ["#define X 1", "float a;"]
    assert source.origins[1] == ("common.glsl", 1)


@pytest.mark.usefixtures("folder")
def test_a_missing_shader_lists_those_there_are() -> None:
    with pytest.raises(ShaderError) as caught:
        load_shader("mian.frag")
    assert str(caught.value) == "no shaders/mian.frag; there is: a.glsl, b.glsl, common.glsl, loop.glsl, main.frag"


SOURCE = ShaderSource("...", (("main.frag", 1), ("sh.glsl", 10), ("sh.glsl", 11), ("main.frag", 3)))


@pytest.mark.parametrize(
    ("log", "said"),
    [
        ("0:2(29): error: `oops' undeclared", "shaders/sh.glsl:10: error: `oops' undeclared"),  # Mesa
        ("0(3) : error C1503: undefined variable", "shaders/sh.glsl:11: error C1503: undefined variable"),  # NVIDIA
        ("ERROR: 0:4: 'oops' : undeclared", "shaders/main.frag:3: 'oops' : undeclared"),  # AMD, Intel, Apple
        ("WARNING: 0:1: '' : old", "shaders/main.frag:1: '' : old"),
        ("0:99(1): error: beyond the end", "0:99(1): error: beyond the end"),
        ("0:0(0): error: linking", "0:0(0): error: linking"),
        ("compilation failed for a reason", "compilation failed for a reason"),
        (
            "0:2(1): error: one\n\n====\n0:3(1): error: two\n",
            "shaders/sh.glsl:10: error: one; shaders/sh.glsl:11: error: two",
        ),
        ("", "the driver gave no reason"),
        (" \n==\n", "the driver gave no reason"),
    ],
)
def test_a_drivers_message_is_placed_in_the_file_that_people_edit(log: str, said: str) -> None:
    assert SOURCE.explain(log) == said


def test_every_shader_that_is_shipped_is_used() -> None:
    used = (
        "screen.vert",
        "sphere.frag",
        "layer.frag",
        "kept.frag",
        "surface.vert",
        "surface.frag",
        "surface_resolve.frag",
    )
    joined = {file for name in used for file, _ in origins(name)}
    assert joined - {"constants.glsl"} == {path.name for path in resource_folder("shaders").iterdir()}


def origins(name: str) -> tuple[tuple[str, int], ...]:
    return load_shader(name, {"constants.glsl": "// generated\n"}).origins
