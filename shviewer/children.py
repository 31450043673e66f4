"""Child processes that do not outlive this one, even if it is killed: they wait for what ends with it, such as a pipe."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
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
    end_after(lambda: os.read(0, 1))


def end_after(wait: Callable[[], object]) -> None:
    """End this process as soon as `wait` returns, whatever it does meanwhile."""
    import threading

    def watch() -> None:
        wait()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
