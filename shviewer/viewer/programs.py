"""From shader files to programs, and setting their uniforms. A GLSL error names the file and line that people edit."""

from __future__ import annotations

import re
from typing import Any

import moderngl

from shviewer.errors import ShaderError
from shviewer.resources import ShaderSource, load_shader
from shviewer.viewer.layout import glsl_constants


def compile_program(context: moderngl.Context, vertex: str, fragment: str) -> moderngl.Program:
    """Of two files in shaders/, with the constants of layout.py. ShaderError if they do not compile or link."""
    generated = {"constants.glsl": glsl_constants()}
    sources = {"vertex": load_shader(vertex, generated), "fragment": load_shader(fragment, generated)}
    try:
        return context.program(vertex_shader=sources["vertex"].text, fragment_shader=sources["fragment"].text)
    except moderngl.Error as error:
        raise ShaderError(_explain(str(error), sources, f"shaders/{vertex} + shaders/{fragment}")) from error


def uniform(program: moderngl.Program, name: str) -> moderngl.Uniform:
    member = program[name]
    assert isinstance(member, moderngl.Uniform)
    return member


def set_uniform(program: moderngl.Program, name: str, value: Any) -> None:
    uniform(program, name).value = value


def _explain(report: str, sources: dict[str, ShaderSource], pair: str) -> str:
    """moderngl's report names the stage in a heading ("fragment_shader"); a link error has none."""
    stage = re.search(r"(vertex|fragment)_shader\s*=*\s*", report)
    if stage is None:
        return f"{pair} do not link: {' '.join(report.split())}"
    return f"shader does not compile: {sources[stage[1]].explain(report[stage.end() :])}"
