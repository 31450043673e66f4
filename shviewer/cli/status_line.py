"""A line of progress on the terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from shviewer.ending import at_the_end


def bar(done: float) -> str:
    """A bar of 24 characters, filled to the share `done`, 0 to 1."""
    filled = round(24 * done)
    return f"[{'#' * filled}{'.' * (24 - filled)}]"


class StatusLine:
    """One line on stderr that is overwritten again and again."""

    def show(self, text: str) -> None:
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)

    def fraction(self, done: float, seconds_left: float, what: str) -> None:
        """Show the share `done`, 0 to 1, the time left and the step at work."""
        self.show(f"{bar(done)} {seconds_left:4.0f} s left  {what[:60]}")

    def clear(self) -> None:
        self.show("")


@contextmanager
def status_line() -> Iterator[StatusLine | None]:
    """A status line if stderr is a terminal, wiped at the end whatever happens; else None."""
    if not sys.stderr.isatty():
        yield None
        return
    line = StatusLine()
    with at_the_end(line.clear):
        yield line
