"""What must not be done while an input is read: to write, start, connect or run anything."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

_FORBIDDEN = (
    *("os.remove", "os.rename", "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.chmod", "os.chown", "os.truncate"),
    *("subprocess.Popen", "os.system", "os.exec", "os.fork", "os.posix_spawn", "os.startfile", "os.kill"),
    *("socket.connect", "socket.bind", "socket.getaddrinfo", "pickle.find_class", "ctypes.dlopen", "shutil.copyfile"),
)
_done: list[str] = []
_watching: list[str] = []
"""The folder of the inputs, while one is read."""


def _audit(event: str, arguments: tuple[Any, ...]) -> None:
    if not _watching:
        return
    if event == "open":
        path, _, flags = arguments
        if isinstance(flags, int) and flags & (os.O_WRONLY | os.O_RDWR) and path != os.devnull:
            _done.append(f"opens {path!r} to write")
    elif event in _FORBIDDEN:
        _done.append(f"{event}{arguments!r}"[:200])
    elif event == "exec" and arguments[0].co_filename.startswith((_watching[0], "<string>")):
        _done.append(f"runs code of {arguments[0].co_filename}")


@contextlib.contextmanager
def watched(folder: Path) -> Iterator[list[str]]:
    """What is done that reading must not, in words."""
    _listen()
    _done.clear()
    _watching.append(str(folder))
    try:
        yield _done
    finally:
        _watching.clear()


@contextlib.contextmanager
def unwatched() -> Iterator[None]:
    """The witness itself writes."""
    kept = _watching.copy()
    _watching.clear()
    try:
        yield
    finally:
        _watching.extend(kept)


def remove(folder: Path) -> None:
    """What is left of a witness that is gone, perhaps while another one watches."""
    with unwatched():
        shutil.rmtree(folder, ignore_errors=True)


@cache
def _listen() -> None:
    """Once: a hook cannot be taken away again; this one does nothing unless an input is read."""
    sys.addaudithook(_audit)
