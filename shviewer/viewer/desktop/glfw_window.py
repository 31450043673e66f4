"""Opening a window with the newest OpenGL there is, and naming its keys. GLFW is used here, in frames.py and in window.py."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import glfw

from shviewer.errors import GraphicsError
from shviewer.viewer.gl.renderer import GL_VERSIONS

SMALLEST_WINDOW = (400, 300)
"""The smallest size, in screen coordinates, in which nothing that matters is left out."""

SPECIAL_KEYS = {
    glfw.KEY_UP: "Up",
    glfw.KEY_DOWN: "Down",
    glfw.KEY_LEFT: "Left",
    glfw.KEY_RIGHT: "Right",
    glfw.KEY_PAGE_UP: "PageUp",
    glfw.KEY_PAGE_DOWN: "PageDown",
    glfw.KEY_HOME: "Home",
    glfw.KEY_END: "End",
    glfw.KEY_ENTER: "Enter",
    glfw.KEY_KP_ENTER: "Enter",
    glfw.KEY_ESCAPE: "Esc",
    glfw.KEY_TAB: "Tab",
    glfw.KEY_SPACE: "Space",
    glfw.KEY_F1: "F1",
    glfw.KEY_F5: "F5",
    glfw.KEY_F11: "F11",
    **{getattr(glfw, f"KEY_{digit}"): str(digit) for digit in range(10)},
    **{getattr(glfw, f"KEY_KP_{digit}"): str(digit) for digit in range(10)},
}
"""Keys known by their place on the keyboard; digits, too, because on some layouts they are typed with Shift."""


class NoDisplayError(GraphicsError):
    """No display to open a window on."""


LETTERS = range(glfw.KEY_A, glfw.KEY_Z + 1)


def key_name(code: int, scancode: int, modifiers: int) -> str:
    """The name under which keys.py binds a key that is no symbol; without a name for the key itself, it binds nothing.

    Letters by what they type, so that the keyboard's layout is respected; on a layout without Latin letters, by their place.
    """
    name = SPECIAL_KEYS.get(code) or _letter(code, scancode)
    if not name and code in LETTERS and not any(map(_letter, LETTERS)):
        name = chr(code)
    shift = "Shift+" if modifiers & glfw.MOD_SHIFT else ""
    control = "Ctrl+" if modifiers & (glfw.MOD_CONTROL | glfw.MOD_SUPER) else ""
    return f"{control}{shift}{name}"


def _letter(code: int, scancode: int = 0) -> str:
    """The Latin letter that a key types, as a capital; "" for any other."""
    typed = glfw.get_key_name(code, scancode) or ""
    return typed.upper() if len(typed) == 1 and typed.isascii() and typed.isalpha() else ""


@contextmanager
def open_window(size: tuple[int, int]) -> Iterator[Any]:
    """A window with a current context of the newest version there is, from 4.5 down to 3.3."""
    glfw.ERROR_REPORTING = "ignore"  # asked for below; a warning would be a second line for one mistake
    if not glfw.init():
        raise NoDisplayError(f"no display to open a window on ({_last_error()})")
    try:
        handle = None
        for version in GL_VERSIONS:
            handle = _create_window(size, version)
            if handle:
                break
        else:
            raise GraphicsError(
                f"no OpenGL 3.3 for a window ({_last_error()}): update the graphics driver, or use shviewer screenshot"
            )
        glfw.make_context_current(handle)
        glfw.swap_interval(1)
        yield handle
    finally:
        glfw.terminate()


class SideContext:
    """A context for another thread, which shares its textures with the window's. Made where the window is current."""

    def __init__(self, handle: Any) -> None:
        self._handle = handle

    def enter(self) -> None:
        glfw.make_context_current(self._handle)
        if not glfw.get_current_context():
            raise GraphicsError(f"no second context of OpenGL ({_last_error()})")

    def leave(self) -> None:
        glfw.make_context_current(None)  # type: ignore[arg-type]  # None: no window

    def load(self, function: str) -> int:
        return ctypes.cast(glfw.get_proc_address(function), ctypes.c_void_p).value or 0


def side_context(window: Any) -> SideContext | None:
    """A second context beside the window's, on a window that nobody sees; None where the system gives none.

    It goes with the window.
    """
    _hint(*(glfw.get_window_attrib(window, what) for what in (glfw.CONTEXT_VERSION_MAJOR, glfw.CONTEXT_VERSION_MINOR)))
    glfw.window_hint(glfw.VISIBLE, False)
    handle = glfw.create_window(1, 1, "", None, window)
    return SideContext(handle) if handle else None


def scale_of(window: Any) -> float:
    """Pixels per point of the design, on the monitor that a window is on."""
    scale = float(glfw.get_window_content_scale(window)[1])
    return scale if scale > 0 else 1.0


def _create_window(size: tuple[int, int], version: int) -> Any:
    _hint(version // 100, version % 100 // 10)
    glfw.window_hint(glfw.SCALE_TO_MONITOR, True)
    handle = glfw.create_window(*size, "shviewer", None, None)
    if handle:
        glfw.set_window_size_limits(handle, *SMALLEST_WINDOW, glfw.DONT_CARE, glfw.DONT_CARE)
    return handle


def _hint(major: int, minor: int) -> None:
    """Ask for a version of OpenGL, and for nothing that is not used."""
    glfw.default_window_hints()
    glfw.window_hint(glfw.CONTEXT_VERSION_MAJOR, major)
    glfw.window_hint(glfw.CONTEXT_VERSION_MINOR, minor)
    glfw.window_hint(glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE)
    glfw.window_hint(glfw.OPENGL_FORWARD_COMPAT, True)
    glfw.window_hint(glfw.DEPTH_BITS, 0)
    glfw.window_hint(glfw.STENCIL_BITS, 0)


def _last_error() -> str:
    code, text = glfw.get_error()
    if not text:
        return f"GLFW error {code}" if code else "GLFW gave no reason"
    return (text.decode("utf-8", "replace") if isinstance(text, bytes) else str(text)).strip()
