"""Files read safely: looked at before they are opened, within limits, with versions told apart."""

from __future__ import annotations

import contextlib
import errno
import math
import os
import select
import stat
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, NamedTuple

from shviewer.errors import LightError, within_memory
from shviewer.limits import Limits
from shviewer.words import one_line


@contextlib.contextmanager
def naming(name: str) -> Iterator[None]:
    """Let the errors raised inside begin with `name`, quoted and escaped if it holds a line break or bytes that are no text."""
    shown = name if name.isprintable() else ascii(name)
    try:
        with within_memory():
            yield
    except LightError as error:
        raise LightError(f"{shown}: {error}") from None


DEBUG = "SHVIEWER_DEBUG"
"""The environment variable that lets errors of parsers keep their traceback."""


@contextlib.contextmanager
def decoding(what: str) -> Iterator[None]:
    """Let whatever a parser raises on the content of a file be that file's LightError. what: the format, such as "NPZ"."""
    try:
        yield
    except (LightError, MemoryError):
        raise
    except Exception as error:  # parsers raise what they like: KeyError, OverflowError, zlib.error, TokenError, ...
        if os.environ.get(DEBUG):
            raise
        said = one_line(str(error), 120)
        raise LightError(f"no {what} ({type(error).__name__}: {said}); save it again") from error


def read_bytes(path: Path, limits: Limits, most: float = math.inf, rule: str = "") -> bytes:
    """The whole file, read once: the one way into the program. Looks before it opens, so that no device is disturbed.

    A pipe is read to its end within `limits.pipe_seconds`. most: bytes of a file of this kind, which `rule` tells.
    LightError for whatever cannot be read, or is too large.
    """

    def check(size: int) -> None:
        if size > most:
            raise LightError(f"{size} bytes; {rule}")
        limits.check_file(size)

    try:
        pipes = limits.pipe_seconds > 0 and hasattr(os, "O_NONBLOCK")
        pipe = _size_of(os.stat(path), check, pipes) is None
        with opened(path) as file:
            size = _size_of(os.fstat(file.fileno()), check, pipe)  # a pipe put in the place of a file is not meant
            if size is None:
                return _from_pipe(file.fileno(), limits.pipe_seconds, check)
            data = file.read(size + 1)
    except (OSError, ValueError) as error:
        raise LightError(_reason(error)) from None
    if len(data) != size:
        raise LightError(f"{len(data)} bytes read where it had {size}; it changed meanwhile: try again")
    return data


def opened(path: Path) -> IO[bytes]:
    """The file, open to be read. Without O_NONBLOCK a pipe that has taken its place since it was looked at would block."""
    return open(os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)), "rb")


def _size_of(status: os.stat_result, check: Callable[[int], None], pipes: bool) -> int | None:
    """The size in bytes, checked; None for a pipe, where `pipes` are read. LightError for what is neither, or empty."""
    if stat.S_ISDIR(status.st_mode):
        raise LightError("a directory; name one file in it")
    if stat.S_ISFIFO(status.st_mode) and pipes:
        return None
    if not stat.S_ISREG(status.st_mode):
        raise LightError("a pipe, socket or device; only a regular file is read: save it as one first")
    if status.st_size == 0:
        raise LightError("an empty file (0 bytes); fetch or export it again")
    check(status.st_size)
    return status.st_size


def _from_pipe(descriptor: int, seconds: float, check: Callable[[int], None]) -> bytes:
    """All bytes that come through a pipe that does not block, from the first until no writer is left."""
    until, data = time.monotonic() + seconds, bytearray()
    while (left := until - time.monotonic()) > 0:
        try:
            piece = os.read(descriptor, 2**20)
        except BlockingIOError:  # a writer that writes nothing just now
            select.select([descriptor], [], [], left)
            continue
        if not piece and data:
            return bytes(data)
        if not piece:  # no writer yet
            time.sleep(min(left, 0.02))
        data += piece
        check(len(data))
    raise LightError(
        f"a pipe from which {len(data)} bytes came in {seconds:g} s, and no end: write all of it, or save it as a file first"
    )


def _reason(error: OSError | ValueError) -> str:
    match error:
        case OSError(errno=errno.ENOENT | errno.ENOTDIR):
            return "no such file; check the path"
        case OSError(errno=errno.EACCES | errno.EPERM):
            return "permission to read it is denied; change its mode (chmod +r) or copy it"
        case OSError(errno=errno.ELOOP):
            return "a symbolic link that leads back to itself; name the file itself"
        case OSError():
            return f"cannot be read ({error.strerror}); check the path and the disk"
    return f"not a path ({error}); check its spelling"


class FileVersion(NamedTuple):
    """What tells a file from the same file edited, without reading it."""

    modified_ns: int
    size: int
    inode: int


def version_of(path: Path) -> FileVersion | None:
    """The present version of the file at `path`; None where there is no file."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return None
    return FileVersion(status.st_mtime_ns, status.st_size, status.st_ino)
