"""The size of the window that was closed last, kept for those who ask for it with --last-size."""

from __future__ import annotations

import json
import os
import sys
from contextlib import suppress
from pathlib import Path

from shviewer.errors import OutputError
from shviewer.outputs import write_atomically
from shviewer.viewer.composing.composition import MAX_SIDE, MIN_SIDE

Size = tuple[int, int]


def last_size() -> Size | None:
    """The size, in points of the design; None if none was kept, or what was kept is none."""
    with suppress(OSError, ValueError, LookupError, TypeError):
        width, height = json.loads(_file().read_text("utf-8"))["size"]
        if all(isinstance(side, int) and MIN_SIDE <= side <= MAX_SIDE for side in (width, height)):
            return width, height
    return None


def keep_size(size: Size) -> None:
    """Keep a size; where nothing can be written, the next window has the usual one."""
    with suppress(OSError, OutputError):
        _file().parent.mkdir(parents=True, exist_ok=True)
        write_atomically(_file(), json.dumps({"size": size}).encode())


def _file() -> Path:
    """The file in the place that the system has for such things."""
    if sys.platform == "win32":
        folder = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        folder = Path.home() / "Library" / "Application Support"
    else:
        folder = Path(os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state")
    return folder / "shviewer" / "window.json"
