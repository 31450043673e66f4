"""The end of the program by a signal: what is begun is finished or taken away, and then it ends at once, wherever it was.

The handler does not raise. An exception in the middle of anything would be lost in a destructor or a callback, and shown as
a traceback in an import.
"""

from __future__ import annotations

import atexit
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path

_LAST: list[Callable[[], object]] = []
"""What is still to be done if the program ends now."""


@contextmanager
def at_the_end(action: Callable[[], object]) -> Iterator[None]:
    """Do `action` when the block ends: by its last line, by an exception, or because a signal ends the program.

    It may be done twice. An exception of the block is raised again, whatever `action` raises.
    """
    _LAST.append(action)
    try:
        yield
    except BaseException:
        with suppress(Exception):
            action()
        raise
    else:
        action()
    finally:
        _LAST.remove(action)


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """A folder that is there during the block, and after no end of it."""
    import shutil
    import tempfile

    folder = Path(tempfile.gettempdir()) / f"shviewer-{os.urandom(8).hex()}"
    with at_the_end(partial(shutil.rmtree, folder, ignore_errors=True)):
        folder.mkdir(mode=0o700)
        yield folder


def end_by_signals() -> None:
    """From here on, SIGINT, SIGTERM and SIGHUP end this process with 128 + their number; those that it ignores stay ignored."""
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _end)


def _end(number: int, frame: object) -> None:
    _do_what_is_left()
    os._exit(128 + number)


@atexit.register
def _do_what_is_left() -> None:
    """For the handler, and for an interrupt that came between two lines of `at_the_end`."""
    for action in reversed(_LAST):
        with suppress(Exception):
            action()
