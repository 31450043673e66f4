"""The errors that the person at the keyboard can put right.

A `ShviewerError` becomes one line on stderr and the exit code of its class; every other exception is a
programming error and keeps its traceback. The codes are part of the interface (assets/guide/command-line.md).
"""

from collections.abc import Iterator
from contextlib import contextmanager

from shviewer.words import one_line


class ShviewerError(Exception):
    """One line that names the value, the rule and the next step."""

    exit_code = 1

    def __init__(self, message: str) -> None:
        super().__init__(one_line(message))


class UsageError(ShviewerError):
    """An argument outside its range; the same code as argparse's own."""

    exit_code = 2


class LightError(ShviewerError):
    """A LIGHT that is unknown, unreadable, damaged or not what its name says."""

    exit_code = 3


@contextmanager
def refused_as(kind: type[ShviewerError], before: str = "") -> Iterator[None]:
    """Let a ValueError of the block be an error of that kind, its words after `before`."""
    try:
        yield
    except ValueError as error:
        raise kind(f"{before}{error}") from error


@contextmanager
def within_memory(what: str = "") -> Iterator[None]:
    """Let running out of memory be a LightError of what was being made."""
    try:
        yield
    except MemoryError:
        raise LightError(
            f"{what}{': ' if what else ''}not enough memory for it; close something or make it smaller"
        ) from None


class OutputError(ShviewerError):
    """A file that could not be written; what stood there before still does."""

    exit_code = 4


class GraphicsError(ShviewerError):
    """No OpenGL, or one that is too old."""

    exit_code = 5


class ShaderError(ShviewerError):
    """A shader that does not compile or link."""

    exit_code = 6
