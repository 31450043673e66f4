"""Programs compiled beside the window: a picture is drawn first where nobody sees it, and nothing waits for the compiler.

Mesa in software compiles a program when it first draws, for its framebuffer and the kinds of its textures, which takes a tenth
of a second. What it made it keeps on the disk, for any context. So another one draws a picture of the same programs, until
OpenGL has them at once.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import replace
from functools import partial
from time import sleep, thread_time
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.drawn import Surfaces
from shviewer.viewer.gl.carrier import Carrier, Load
from shviewer.viewer.gl.pane_renderer import Kind, kinds_of
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.gl.textures import ArrayTexture, Upload, large
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.picture import Picture
from shviewer.viewer.surface import Surface

QUICK = 0.015
"""Seconds of a draw: less than any program takes that is compiled, and more than one that comes from the disk."""

PAUSES = 0.0, 0.02, 0.05, 0.1, 0.2
"""Seconds before each try: what was compiled is written behind."""

PATIENCE = 0.05
"""The seconds that are waited for programs that may be on the disk."""

TRIANGLES, UNSIGNED_INT = 4, 0x1405


class Warming:
    """The kinds of programs that are compiled, by the thread of a carrier."""

    def __init__(self, carrier: Carrier) -> None:
        self._carrier = carrier
        self._asked: Set[Kind] = set()
        self._ready: Set[Kind] = set()
        self._gains = True
        """Whether OpenGL keeps what it compiled."""
        self._context: moderngl.Context | None = None
        self._longest = 0.0
        """Seconds of the longest draw."""

    def ready(self, picture: Picture, composition: Composition, at_once: bool = False) -> bool:
        """Whether a frame can be drawn and nothing is compiled in it; what is not is compiled then.

        at_once: it is drawn however that is, as nothing else could be.
        """
        wanted = kinds_of(picture, composition)
        if at_once:
            self._ready |= wanted
        elif self._gains and not wanted <= self._asked:
            self._asked |= wanted
            over = self._carrier.ask(partial(self._warm, picture, composition, wanted))
            if not wanted <= self._ready:
                over.wait(PATIENCE)
        return wanted <= self._ready or not self._gains

    def _warm(self, picture: Picture, composition: Composition, wanted: Set[Kind]) -> None:
        """Draw until it is quick."""
        if isinstance(picture.drawn, Surfaces):
            small = Surface(np.ones((3, 4), np.float32), clipped=False)
            picture = replace(picture, drawn=Surfaces((small,) * len(picture.drawn.shown)))
        gains = False
        try:
            for pause in PAUSES:
                sleep(pause)
                if gains := self._draw(picture, composition) < QUICK:
                    break
        finally:
            self._gains, self._ready = gains, self._ready | wanted

    def _draw(self, picture: Picture, composition: Composition) -> float:
        """Draw with programs made anew, for a window and for a picture that is saved; return the seconds of the longest."""
        if self._context is None:
            settings: dict[str, Any] = {"context": self._carrier.side}
            self._context = moderngl.create_context(require=330, **settings)
            self._context.extra = self._render
        self._longest = 0.0
        renderer = Renderer(self._context, self._carrier, _Corner)
        renderer.carrier = None  # it hears of the frames of the window alone
        try:
            renderer.show(picture)
            layer, file = Layer(np.zeros((1, 1, 4), np.uint8)), self._context.texture((1, 1), 4)
            for target in (self._context.screen, self._context.framebuffer([file])):
                renderer.draw(target, composition, (layer,))
        finally:
            renderer.release()
        return self._longest

    def _render(self, array: moderngl.VertexArray) -> None:
        """Draw a triangle and leave Python's lock to others, which moderngl keeps."""
        calls, start = self._carrier.calls, thread_time()
        calls["glUseProgram"](array.program.glo)
        calls["glBindVertexArray"](array.glo)
        if array.index_buffer is None:
            calls["glDrawArrays"](TRIANGLES, 0, 3)
        else:
            calls["glDrawElements"](TRIANGLES, 3, UNSIGNED_INT, None)
        calls["glFinish"]()
        self._longest = max(self._longest, thread_time() - start)


class _Corner(ArrayTexture):
    """A texture of a corner of an array; for a compiler of shaders it is of the same kind as that of all of it."""

    def _load(self, array: NDArray[np.generic], dtype: str) -> Upload | Load:
        height, width = (3 if side & (side - 1) else 2 for side in array.shape[:2])
        corner = np.ascontiguousarray(array[:height, :width])
        if self._carrier is None or not large(array):
            return super()._load(corner, dtype)
        load = Load(self._carrier, corner, dtype)
        self._carrier.fill(load)
        return load
