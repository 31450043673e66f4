"""Programs compiled beside the window: a picture is drawn first where nobody sees it, and nothing waits for the compiler.

Mesa in software compiles a program when it first draws, for its framebuffer and the kinds of its textures, which takes a tenth
of a second. What it made it keeps on the disk, for any context. So another one draws a picture of the same programs, until
OpenGL has them at once.
"""

from __future__ import annotations

from collections.abc import Set
from contextlib import suppress
from dataclasses import replace
from functools import partial
from time import perf_counter, thread_time
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

PAUSES = 0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8
"""Seconds before each try: what was compiled is written behind."""

PATIENCE, MOST = 0.05, 20.0
"""The seconds that a frame waits for programs that may be on the disk, and the last picture for the next one."""

TRIANGLES, UNSIGNED_INT = 4, 0x1405


class Warming:
    """The kinds of programs that are compiled, by the thread of a carrier."""

    def __init__(self, carrier: Carrier) -> None:
        self._carrier = carrier
        self._asked: Set[Kind] = set()
        self._since = 0.0
        """When something was asked for last."""
        self._ready: Set[Kind] = set()
        self._gains = True
        """Whether OpenGL keeps what it compiled."""
        self._context: moderngl.Context
        carrier.ask(self._enter)
        self._first = self._quick = True
        """Whether nothing was compiled yet, and whether nothing had to be."""

    def ready(self, picture: Picture, composition: Composition) -> bool:
        """Whether a frame can be drawn and nothing is compiled in it; what is not is compiled then."""
        wanted = kinds_of(picture, composition)
        if self._gains and not wanted <= self._asked:
            self._asked |= wanted
            self._since = perf_counter()
            self._carrier.ask(partial(self._warm, picture, composition, wanted)).wait(PATIENCE)
        return self.has(picture, composition) or perf_counter() > self._since + MOST

    def has(self, picture: Picture, composition: Composition) -> bool:
        """Whether all programs of a frame are compiled, or none ever is before it is drawn."""
        return kinds_of(picture, composition) <= self._ready or not self._gains

    def _enter(self) -> None:
        settings: dict[str, Any] = {"context": self._carrier.side}
        self._context = moderngl.create_context(require=330, **settings)
        self._context.extra = self._render

    def _warm(self, picture: Picture, composition: Composition, wanted: Set[Kind]) -> None:
        """Draw until it is quick, as in a window, and then as in a picture that is saved."""
        if isinstance(picture.drawn, Surfaces):
            small = Surface(np.ones((3, 4), np.float32), clipped=False)
            picture = replace(picture, drawn=Surfaces((small,) * len(picture.drawn.shown)))
        for saved in (False, True):
            try:
                for pause in PAUSES:
                    if self._carrier.ending.wait(pause):
                        return
                    self._first = pause == 0.0
                    if self._draw(picture, composition, saved):
                        break
                else:
                    self._gains = False
                    return
            finally:
                self._ready |= wanted
                self._carrier.tell()

    def _draw(self, picture: Picture, composition: Composition, saved: bool) -> bool:
        """Draw with programs made anew; return whether none was compiled. The first time all are, later none after one is."""
        self._quick = True
        renderer = Renderer(self._context, self._carrier, _Corner)
        renderer.carrier = None  # it hears of the frames of the window alone
        file = self._context.texture((1, 1), 4)
        target = self._context.framebuffer([file])
        try:
            renderer.show(picture)
            with suppress(_Compiled):
                renderer.draw(
                    target if saved else self._context.screen, composition, (Layer(np.zeros((1, 1, 4), np.uint8)),)
                )
        finally:
            self._context.screen.use()
            for made in (renderer, target, file):
                made.release()
        return self._quick

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
        if thread_time() - start > QUICK:
            self._quick = False
            if not self._first:
                raise _Compiled


class _Compiled(Exception):
    """A program was compiled."""


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
