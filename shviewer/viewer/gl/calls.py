"""Functions of OpenGL that leave Python's lock to others, for a thread with a context of its own; moderngl keeps it."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any, Protocol

import moderngl

_INT, _POINTER = ctypes.c_int, ctypes.c_void_p
_CALLS: dict[str, tuple[type[Any], ...]] = {
    "glGenTextures": (_INT, _POINTER),
    "glDeleteTextures": (_INT, _POINTER),
    "glBindTexture": (_INT, _INT),
    "glTexParameteri": (_INT, _INT, _INT),
    "glPixelStorei": (_INT, _INT),
    "glTexStorage2D": (_INT,) * 5,
    "glTexSubImage2D": (*(_INT,) * 8, _POINTER),
    "glTextureView": (_INT,) * 8,
    "glUseProgram": (_INT,),
    "glBindVertexArray": (_INT,),
    "glDrawArrays": (_INT,) * 3,
    "glDrawElements": (_INT, _INT, _INT, _POINTER),
    "glFinish": (),
    "glGetError": (),
}


class Side(Protocol):
    """A second context that shares its textures with the one that draws."""

    def enter(self) -> None:
        """Make it current in the calling thread. GraphicsError if that cannot be."""

    def leave(self) -> None:
        """Make it current nowhere."""

    def load(self, function: str) -> int:
        """Where a function of OpenGL is; moderngl asks for it by this name."""


def calls_of(context: moderngl.Context, side: Side) -> dict[str, Callable[..., int]]:
    """The functions by name; without glTextureView where it is too new."""
    kind = getattr(ctypes, "WINFUNCTYPE", ctypes.CFUNCTYPE)
    views = context.version_code >= 430 or "GL_ARB_texture_view" in context.extensions
    return {
        name: kind(ctypes.c_int if name == "glGetError" else None, *types)(side.load(name))
        for name, types in _CALLS.items()
        if views or name != "glTextureView"
    }
