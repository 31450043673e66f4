"""GLSL programs: compiled once for each choice of what they show, with errors that name the line people edit."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import moderngl

from shviewer.errors import ShaderError
from shviewer.viewer.gl.shader_source import ShaderSource, load_shader
from shviewer.viewer.gl.shared import glsl_constants

BLOCKS = {"ShBlock": 0, "LobeBlock": 1}
"""Uniform blocks and where their buffers are bound."""

SAMPLERS = {"original_map": 0, "reconstruction_map": 1, "colour_map": 2, "layer": 3, "signed_tones": 4}
"""Textures and the units they are bound to."""


class Program:
    """A vertex and a fragment shader; by default the vertices cover the viewport. ShaderError if they do not compile."""

    def __init__(
        self,
        context: moderngl.Context,
        fragment: str,
        chosen: Mapping[str, str | int] = MappingProxyType({}),
        vertex: str = "screen.vert",
    ) -> None:
        self.program = _compile(context, vertex, fragment, chosen)
        self._triangle = context.vertex_array(self.program, []) if vertex == "screen.vert" else None
        self._uniforms: dict[str, Any] = {}
        for name in self.program:
            member = self.program[name]
            if isinstance(member, moderngl.UniformBlock):
                member.binding = BLOCKS[name]
            elif isinstance(member, moderngl.Uniform):
                self._uniforms[name] = member
                if name in SAMPLERS:
                    member.value = SAMPLERS[name]

    def set(self, **values: Any) -> None:
        """Set uniforms by name; a uniform that this choice of the program does not use is left out."""
        for name, value in values.items():
            if name in self._uniforms:
                self._uniforms[name].value = value

    def draw(self) -> None:
        """Draw all pixels of the viewport."""
        assert self._triangle is not None
        render(self._triangle, 3)

    def release(self) -> None:
        if self._triangle is not None:
            self._triangle.release()
        self.program.release()


def render(array: moderngl.VertexArray, vertices: int, first: int = 0) -> None:
    """Draw triangles; a context may have a way of its own, which is its `extra`."""
    if array.ctx.extra is None:
        array.render(moderngl.TRIANGLES, vertices, first=first)
    else:
        array.ctx.extra(array)


def _compile(
    context: moderngl.Context, vertex: str, fragment: str, chosen: Mapping[str, str | int]
) -> moderngl.Program:
    generated = {"constants.glsl": glsl_constants(chosen)}
    sources = {"vertex": load_shader(vertex, generated), "fragment": load_shader(fragment, generated)}
    try:
        return context.program(vertex_shader=sources["vertex"].text, fragment_shader=sources["fragment"].text)
    except moderngl.Error as error:
        raise ShaderError(_explain(str(error), sources, f"shaders/{vertex} + shaders/{fragment}")) from error


def _explain(report: str, sources: dict[str, ShaderSource], pair: str) -> str:
    """The error in one line. moderngl's report names the stage in a heading ("fragment_shader"); a link error has none."""
    stage = re.search(r"(vertex|fragment)_shader\s*=*\s*", report)
    if stage is None:
        return f"{pair} do not link: {' '.join(report.split())}"
    return f"shader does not compile: {sources[stage[1]].explain(report[stage.end() :])}"
