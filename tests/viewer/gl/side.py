"""A second context for another thread, beside a headless one: what glfw gives the window."""

from __future__ import annotations

import ctypes
import ctypes.util

from helpers import unavailable

OPENGL_API, CONFIG_ID, NONE = 0x30A2, 0x3028, 0x3038
MAJOR, MINOR, PROFILE, CORE = 0x3098, 0x30FB, 0x30FD, 1


class EglSide:
    """Shares its textures with the context that is current where it is made. end() when no thread is in it."""

    def __init__(self) -> None:
        library = ctypes.util.find_library("EGL")
        if library is None:
            unavailable("a second context without a window needs EGL")
        self.egl = egl = ctypes.CDLL(library)
        for name in ("eglGetCurrentDisplay", "eglGetCurrentContext", "eglCreateContext", "eglGetProcAddress"):
            getattr(egl, name).restype = ctypes.c_void_p
        self.display = ctypes.c_void_p(egl.eglGetCurrentDisplay())
        shared, number = ctypes.c_void_p(egl.eglGetCurrentContext()), ctypes.c_int()
        egl.eglQueryContext(self.display, shared, CONFIG_ID, ctypes.byref(number))
        config, found = ctypes.c_void_p(), ctypes.c_int()
        egl.eglChooseConfig(
            self.display,
            (ctypes.c_int * 3)(CONFIG_ID, number.value, NONE),
            ctypes.byref(config),
            1,
            ctypes.byref(found),
        )
        asked = (ctypes.c_int * 7)(MAJOR, 3, MINOR, 3, PROFILE, CORE, NONE)
        self.context = ctypes.c_void_p(egl.eglCreateContext(self.display, config, shared, asked))
        assert self.context.value, hex(egl.eglGetError())

    def enter(self) -> None:
        self.egl.eglBindAPI(OPENGL_API)
        assert self.egl.eglMakeCurrent(self.display, None, None, self.context)

    def leave(self) -> None:
        self.egl.eglMakeCurrent(self.display, None, None, None)

    def load(self, function: str) -> int:
        return self.egl.eglGetProcAddress(function.encode()) or 0

    def end(self) -> None:
        self.egl.eglDestroyContext(self.display, self.context)
