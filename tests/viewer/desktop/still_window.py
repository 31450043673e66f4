"""A window for scripts: it waits for every picture, so that what a frame shows is known."""

from __future__ import annotations

from typing import Any

import moderngl

from shviewer.viewer.desktop import frames, window
from shviewer.viewer.desktop.canvas import Canvas
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import State

frames.PATIENCE = None


def window_of(handle: Any, state: State) -> window.Window:
    """A window with the picture of a state, on a handle of GLFW."""
    return window.Window(handle, Canvas(moderngl.create_context(require=330)), prepare(state))
