"""The panes of a frame, kept while nothing changes but what is written over them, as under a mouse that points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import moderngl

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.gl.programs import SAMPLERS, Program
from shviewer.viewer.gl.renderer import Part, Renderer
from shviewer.viewer.overlay.layers import Layer


class Kept:
    """One framebuffer beside the screen, with panes that are drawn once. release() at the end."""

    def __init__(self, renderer: Renderer) -> None:
        self._renderer = renderer
        self._key: object = None
        self._made: tuple[moderngl.Texture, moderngl.Framebuffer] | None = None

    @cached_property
    def _program(self) -> Program:
        return Program(self._renderer.context, "kept.frag")

    def parts(
        self,
        key: object,
        target: moderngl.Framebuffer,
        composition: Composition,
        layers: Sequence[Layer],
        seconds: float | None,
    ) -> Iterator[Part]:
        """As `Renderer.parts`. key: equal as long as the panes are."""
        texture, kept = self._sized(composition.width, composition.height)
        if key != self._key:
            self._key = None
            yield from self._renderer.parts(kept, composition, None, seconds=seconds)
            self._key = key
        target.use()
        target.viewport = (0, 0, composition.width, composition.height)
        self._renderer.context.disable(moderngl.BLEND)
        texture.use(SAMPLERS["layer"])
        self._program.draw()
        self._renderer.layers.draw(target, composition, layers)

    def release(self) -> None:
        """Free everything this object made."""
        self._forget()
        if program := self.__dict__.pop("_program", None):
            program.release()

    def _sized(self, width: int, height: int) -> tuple[moderngl.Texture, moderngl.Framebuffer]:
        """The framebuffer and what is in it, made anew for another size."""
        if self._made is None or self._made[0].size != (width, height):
            self._forget()
            texture = self._renderer.context.texture((width, height), 4)
            self._made = texture, self._renderer.context.framebuffer([texture])
        return self._made

    def _forget(self) -> None:
        self._key = None
        if self._made is not None:
            self._renderer.rest.use()  # moderngl would bind a released framebuffer again when it makes the next one
            for resource in reversed(self._made):
                resource.release()
            self._made = None
