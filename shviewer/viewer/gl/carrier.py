"""A thread with an OpenGL context of its own, which makes, fills and frees large textures: the one that draws never waits.

An OpenGL in software takes the memory of a texture in one piece and fills it with zeros: a third of a second for the largest
maps, and a tenth to give it back. moderngl keeps Python's lock meanwhile, so the calls of this thread go past it.

A texture is freed with its last holder. So the thread keeps a second name for its memory (glTextureView), which it lets go
when the drawing context has drawn without it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from queue import SimpleQueue
from threading import Event, Thread

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.errors import GraphicsError
from shviewer.viewer.gl.calls import Side, calls_of

CARRIED_BYTES = 2**24
"""What goes up at a time: a driver may let nobody draw meanwhile, which takes some milliseconds."""

TEXTURE_2D, LINEAR, MIN_FILTER, MAG_FILTER, UNPACK_ALIGNMENT = 0x0DE1, 0x2601, 0x2801, 0x2800, 0x0CF5
FORMATS = {3: 0x1907, 4: 0x1908}
"""GL_RGB, GL_RGBA by components."""

STORED = {(3, "f2"): 0x881B, (4, "f2"): 0x881A, (3, "f4"): 0x8815, (4, "f4"): 0x8814}
TYPES = {"f2": 0x140B, "f4": 0x1406}


class Load:
    """An array (height, width, 3 or 4) float32 on its way into a texture, and that texture."""

    def __init__(self, carrier: Carrier, array: NDArray[np.generic], dtype: str) -> None:
        self.array = array
        self.dtype = dtype
        self.share = 0.0
        """How much of it is there."""
        self.names = (ctypes.c_uint * 2)()
        """The name of the texture and that of the view that holds its memory; 0 for none."""
        self.error = ""
        self.unwanted = False
        self.over = Event()
        self._carrier = carrier
        self._texture: moderngl.Texture | None = None

    @property
    def texture(self) -> moderngl.Texture:
        """The texture, once it is there, for the context that draws."""
        if self._texture is None:
            height, width, components = self.array.shape
            self._texture = self._carrier.context.external_texture(
                self.names[0], (width, height), components, 0, self.dtype
            )
        return self._texture

    def go_on(self, end: float | None) -> bool:
        """Whether all of it is there; without an `end`, wait for that. GraphicsError if OpenGL has no memory for it."""
        if end is None:
            self.over.wait()
        if self.over.is_set() and self.error:
            raise GraphicsError(self.error)
        return self.over.is_set()

    def release(self) -> None:
        """Give the texture up, also when only a part of it is there."""
        self.unwanted = True
        self._carrier.retire(self)


class Carrier:
    """The thread. Its methods are for the thread that draws; end() before either context goes."""

    def __init__(self, context: moderngl.Context, side: Side, arrived: Callable[[], None] | None = None) -> None:
        """arrived: called from the other thread when a texture is there, or cannot be.

        GraphicsError if the thread cannot have the context.
        """
        self.context = context
        self.side = side
        self.calls = calls_of(context, side)
        """For that thread."""
        self._arrived = arrived
        self._retired: list[Load] = []
        self._works: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._begun = self._done = 0
        self.ending = Event()
        """Set when nothing is asked for any more."""
        refused: SimpleQueue[str] = SimpleQueue()
        self._thread = Thread(target=self._run, args=(refused,), name="textures", daemon=True)
        self._thread.start()
        if reason := refused.get():
            raise GraphicsError(reason)

    @classmethod
    def beside(
        cls, context: moderngl.Context, side: Side | None, arrived: Callable[[], None] | None = None
    ) -> Carrier | None:
        """A carrier, if there is a second context and this OpenGL can take the memory of a texture by itself."""
        able = context.version_code >= 420 or "GL_ARB_texture_storage" in context.extensions
        if side is None or not able:
            return None
        with suppress(GraphicsError):
            return cls(context, side, arrived)
        return None

    def carry(self, array: NDArray[np.generic], dtype: str) -> Load:
        """Begin with the texture of an array, as half floats ("f2") or as it is ("f4")."""
        load = Load(self, array, dtype)
        self._put(partial(self._fill, load))
        return load

    def ask(self, work: Callable[[], None]) -> Event:
        """Have something done by that thread; the event is set when it is over, whatever came of it."""
        over = Event()

        def done() -> None:
            with suppress(Exception):
                if not self.ending.is_set():
                    work()
            over.set()
            self.tell()

        self._put(done)
        return over

    @property
    def busy(self) -> bool:
        """Whether there is anything that the thread has not done yet."""
        return self._begun != self._done

    def retire(self, load: Load) -> None:
        """Free a texture as soon as nothing is drawn with it."""
        if load.over.is_set() and load.names[0]:
            self.calls["glDeleteTextures"](1, ctypes.byref(load.names))
            load.names[0] = 0
        self._retired.append(load)

    def drawn(self) -> None:
        """Hear that a frame was drawn with what is in use now."""
        retired, self._retired = self._retired, []
        for load in retired:
            self._put(partial(self._free, load))

    def end(self) -> None:
        """Free what is retired, and end the thread."""
        self.ending.set()
        self.drawn()
        self._works.put(None)
        self._thread.join()

    def _run(self, refused: SimpleQueue[str]) -> None:
        """Do what is asked for, once it is told that there was no reason to refuse."""
        try:
            self.side.enter()
        except GraphicsError as error:
            refused.put(str(error))
            return
        refused.put("")
        try:
            while (work := self._works.get()) is not None:
                work()
                self._done += 1
        finally:
            self.side.leave()

    def _put(self, work: Callable[[], None]) -> None:
        self._begun += 1
        self._works.put(work)

    def tell(self) -> None:
        """Say that there is something new."""
        if self._arrived is not None:
            self._arrived()

    def _fill(self, load: Load) -> None:
        self.fill(load)
        self.tell()

    def fill(self, load: Load) -> None:
        """Make a texture in that thread."""
        try:
            if not load.unwanted:
                self._make(load)
        except Exception as error:
            load.error = f"a map could not be handed to OpenGL: {error}"
        load.over.set()

    def _make(self, load: Load) -> None:
        calls, (height, width, components) = self.calls, load.array.shape
        while calls["glGetError"]():
            pass
        calls["glGenTextures"](1, ctypes.byref(load.names))
        calls["glBindTexture"](TEXTURE_2D, load.names[0])
        for what in (MIN_FILTER, MAG_FILTER):
            calls["glTexParameteri"](TEXTURE_2D, what, LINEAR)
        stored = STORED[components, load.dtype]
        calls["glTexStorage2D"](TEXTURE_2D, 1, stored, width, height)
        if calls["glGetError"]():
            load.error = f"no memory in OpenGL for a map of {width} x {height} texels: make it smaller"
            return
        if "glTextureView" in calls:
            calls["glGenTextures"](1, ctypes.byref(load.names, ctypes.sizeof(ctypes.c_uint)))
            calls["glTextureView"](load.names[1], TEXTURE_2D, load.names[0], stored, 0, 1, 0, 1)
        calls["glPixelStorei"](UNPACK_ALIGNMENT, 1)
        step = max(1, CARRIED_BYTES // max(load.array[0].nbytes, 1))
        for top in range(0, height, step):
            rows = load.array[top : top + step]
            data = rows.astype(np.float16) if load.dtype == "f2" else np.ascontiguousarray(rows)
            place = 0, top, width, len(rows)
            calls["glTexSubImage2D"](
                TEXTURE_2D, 0, *place, FORMATS[components], TYPES[load.dtype], ctypes.c_void_p(data.ctypes.data)
            )
            load.share = (top + len(rows)) / height
            if load.unwanted:
                break
        calls["glBindTexture"](TEXTURE_2D, 0)
        calls["glFinish"]()

    def _free(self, load: Load) -> None:
        for place in range(2):
            if load.names[place]:
                name = ctypes.c_uint(load.names[place])
                self.calls["glDeleteTextures"](1, ctypes.byref(name))
                load.names[place] = 0
        self.calls["glFinish"]()
