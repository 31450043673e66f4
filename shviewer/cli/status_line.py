"""A line of progress on the terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from threading import Event, Thread

from shviewer.ending import at_the_end
from shviewer.progress import in_words, listening

QUIET = 0.5
"""Seconds before work is spoken of."""

BETWEEN = 0.1
"""Seconds between two looks at how far it is."""


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


@contextmanager
def speaking() -> Iterator[None]:
    """Say on a terminal what the body does, once that has taken QUIET seconds; what the code of a light prints is kept from
    stdout, which is for results.
    """
    with redirect_stdout(sys.stderr), status_line() as line:
        if line is None:
            yield
            return
        doing, done = [""], Event()

        def hear(what: str, share: float | None) -> None:
            doing[0] = in_words(what, share) or doing[0]

        def speak() -> None:
            wait, said = QUIET, ""
            while not done.wait(wait):
                if doing[0] != said:
                    said = doing[0]
                    line.show(said[:78])
                wait = BETWEEN

        speaker = Thread(target=speak, daemon=True)
        speaker.start()
        try:
            with listening(hear):
                yield
        finally:
            done.set()
            speaker.join()
