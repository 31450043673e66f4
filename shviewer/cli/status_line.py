"""What is at work, on one line of the terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager


def bar(done: float) -> str:
    """done: 0 to 1."""
    filled = round(24 * done)
    return f"[{'#' * filled}{'.' * (24 - filled)}]"


class StatusLine:
    """What is at work, on one line of the terminal."""

    def show(self, text: str) -> None:
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)

    def fraction(self, done: float, seconds_left: float, what: str) -> None:
        """done: 0 to 1."""
        self.show(f"{bar(done)} {seconds_left:4.0f} s left  {what[:60]}")

    def clear(self) -> None:
        self.show("")


@contextmanager
def status_line() -> Iterator[StatusLine | None]:
    """One on stderr where that is a terminal, wiped at the end whatever happens; else none."""
    line = StatusLine() if sys.stderr.isatty() else None
    try:
        yield line
    finally:
        if line:
            line.clear()
