"""Child processes that do not outlive this one, even if it is killed: their stdin is a pipe that ends with it."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

LEASH = "SHVIEWER_LEASH"
"""The environment variable that tells a process to watch its stdin."""


@contextmanager
def leash(environment: Mapping[str, str] = os.environ) -> Iterator[tuple[int, dict[str, str]]]:
    """The stdin and the environment of a child that ends, if it calls `follow_parent`, when the block or this process does."""
    theirs, ours = os.pipe()
    try:
        yield theirs, {**environment, LEASH: "1"}
    finally:
        os.close(theirs)
        os.close(ours)


def follow_parent() -> None:
    """In a child on a leash: end this process as soon as the parent has ended, or lets go. Elsewhere: nothing."""
    if os.environ.pop(LEASH, None):
        watch_stdin()


def watch_stdin() -> None:
    """End this process when its stdin, a pipe that is written no more, is closed at the other end."""

    import threading

    def watch() -> None:
        os.read(0, 1)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
