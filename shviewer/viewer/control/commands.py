"""Commands: what a key asks for that no new state can answer."""

from __future__ import annotations

from enum import Enum, auto


class Command(Enum):
    """A request that a key makes; the session carries it out."""

    SAVE = auto()
    RELOAD = auto()
    FIT = auto()
    """Use as many bands as the tolerance needs, which depends on the light."""
    FACE_MARK = auto()
    """Look at the next mark, whose place depends on the light."""
    FULL_SCREEN = auto()
    COPY = auto()
    """Copy the command line that makes this picture."""
    COPY_COEFFICIENTS = auto()
    EXPORT = auto()
    """Write the coefficients into a file."""
    UNDO = auto()
    REDO = auto()
    PASTE = auto()
    """Open the files whose paths are on the clipboard."""
    LEAVE = auto()
    """Leave full screen, or else close the window."""
    CLOSE = auto()
