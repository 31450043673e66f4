"""Files read and written safely: looked at before they are opened, written whole or not at all, with versions told apart."""

from __future__ import annotations

import contextlib
import errno
import math
import os
import re
import select
import stat
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import IO, NamedTuple

from shviewer.ending import at_the_end
from shviewer.errors import LightError, OutputError, within_memory
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
    try:
        pipe = _size_of(os.stat(path), limits, most, rule) is None
        with _opened(path) as file:
            here = limits if pipe else replace(limits, pipe_seconds=0)  # a pipe put in the place of a file is not meant
            size = _size_of(os.fstat(file.fileno()), here, most, rule)
            if size is None:
                return _from_pipe(file.fileno(), limits, most, rule)
            data = file.read(size + 1)
    except (OSError, ValueError) as error:
        raise LightError(_reason(error)) from None
    if len(data) != size:
        raise LightError(f"{len(data)} bytes read where it had {size}; it changed meanwhile: try again")
    return data


def _opened(path: Path) -> IO[bytes]:
    """The file, open to be read. Without O_NONBLOCK a pipe that has taken its place since it was looked at would block."""
    return open(os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)), "rb")


def _from_pipe(descriptor: int, limits: Limits, most: float, rule: str) -> bytes:
    """All bytes that come through a pipe that does not block, from the first until no writer is left."""
    until, data = time.monotonic() + limits.pipe_seconds, bytearray()
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
        _check_bytes(len(data), limits, most, rule)
    raise LightError(
        f"a pipe from which {len(data)} bytes came in {limits.pipe_seconds:g} s, and no end: write all of it, or save it as"
        " a file first"
    )


def _size_of(status: os.stat_result, limits: Limits, most: float, rule: str) -> int | None:
    """Return the size in bytes; None for a pipe. LightError unless it is one of them, not empty, and within the limits."""
    if stat.S_ISDIR(status.st_mode):
        raise LightError("a directory; name one file in it")
    if stat.S_ISFIFO(status.st_mode) and limits.pipe_seconds and hasattr(os, "O_NONBLOCK"):
        return None
    if not stat.S_ISREG(status.st_mode):
        raise LightError("a pipe, socket or device; only a regular file is read: save it as one first")
    if status.st_size == 0:
        raise LightError("an empty file (0 bytes); fetch or export it again")
    _check_bytes(status.st_size, limits, most, rule)
    return status.st_size


def _check_bytes(size: int, limits: Limits, most: float, rule: str) -> None:
    if size > most:
        raise LightError(f"{size} bytes; {rule}")
    limits.check_file(size)


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


def write_atomically(path: Path, data: bytes, *, exclusive: bool = False) -> None:
    """Write a file beside and move it into place: `path` is never half written. exclusive: FileExistsError if it exists.

    A link is followed, and what it leads to keeps its mode and owner. Pipes and devices are written through. OutputError if
    that is impossible, or the file there is read-only.
    """
    try:
        target, there = _target(path)
        if there is not None and exclusive:
            raise FileExistsError(path)
        if there is not None and not stat.S_ISREG(there.st_mode):
            with open(os.open(path, os.O_WRONLY), "wb") as through:
                through.write(data)
            return
        beside = target.parent / f".shv-{os.urandom(8).hex()}.tmp"
        with at_the_end(partial(beside.unlink, missing_ok=True)):
            _write_new(beside, data, there)
            if exclusive:
                _place_exclusively(beside, target)
            else:
                os.replace(beside, target)
    except FileExistsError:
        raise
    except OSError as error:
        raise _refused(path, error) from error


def _write_new(path: Path, data: bytes, like: os.stat_result | None) -> None:
    """Write a new file to the disk, with the mode and, where that is allowed, the owner of the one that it is to replace."""

    def create(name: str, flags: int) -> int:
        return os.open(name, flags, 0o666 if like is None else 0o600)

    with open(path, "xb", opener=create) as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    if like is not None:
        if hasattr(os, "chown"):
            with suppress(OSError):  # only root may give files away
                os.chown(path, like.st_uid, like.st_gid)
        os.chmod(path, stat.S_IMODE(like.st_mode))


def check_place(path: Path) -> None:
    """OutputError if nothing can be written at `path`: a check to make before long work on what goes there."""
    try:
        target, there = _target(path)
        if there is None or stat.S_ISREG(there.st_mode):
            beside = target.parent / f".shv-{os.urandom(8).hex()}.tmp"
            with at_the_end(partial(beside.unlink, missing_ok=True)):
                beside.touch(exist_ok=False)
    except OSError as error:
        raise _refused(path, error) from error


@dataclass(frozen=True)
class Replacing:
    """What a command may replace: never one of its `inputs`, and a file that this program did not write only with `force`."""

    inputs: tuple[Path, ...] = ()
    force: bool = False

    def check(self, path: Path) -> None:
        """OutputError if writing `path` would destroy what must stay: a check to make before it is written."""
        if _identity(path) in self._read:
            raise OutputError(f"{path}: the light or a comparison is read from this file; write another one")
        if not (self.force or _may_go(path)):
            raise OutputError(
                f"{path}: exists, and shviewer did not write it; write another file, or --force (in Python force=True)"
            )

    @cached_property
    def _read(self) -> set[tuple[int, int]]:
        """The inputs, looked at once: a batch has thousands, and as many outputs."""
        return set(filter(None, map(_identity, self.inputs)))


def _identity(path: Path) -> tuple[int, int] | None:
    """What two names of one file have in common; None for no file."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    return status.st_dev, status.st_ino


ANYTHING = Replacing(force=True)
"""The rule of a caller who knows what is there."""

OURS = (
    b"shviewer-coefficients",
    "shviewer-coefficients".encode("utf-32-le"),  # in an NPZ
    b"shviewer\0",  # the key of the stamp in a PNG, the attribute in an EXR
    b'"world_from_view"',  # a key of that stamp, the comment of a GIF and the description of a WebP
    b'"shviewer-report/',  # the schema of a report's JSON
    b"section,method,light,n_bands,samples,",  # the head of its CSV
    b"How long it takes to project a light onto spherical harmonics",  # the first words of its page
    b"<dc:title>shviewer</dc:title>",  # who made an SVG
)
"""Bytes of the stamps: each file of this program has some of them within OURS_BYTES of one of its ends."""

OURS_BYTES = 2**16


def _may_go(path: Path) -> bool:
    """Whether there is nothing at `path` to be lost: no file, an empty one, a pipe or device, or one of this program."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            return True
        with _opened(path) as file:
            size = os.fstat(file.fileno()).st_size
            ends = file.read(OURS_BYTES)
            file.seek(max(0, size - OURS_BYTES))
            ends += file.read(OURS_BYTES)
    except (OSError, ValueError):  # what cannot be looked at is for the writer to refuse
        return True
    return not ends or any(mark in ends for mark in OURS)


def _target(path: Path) -> tuple[Path, os.stat_result | None]:
    """The file that `path` leads to, and its status; None where there is none. OSError for a folder or a read-only file."""
    target = Path(os.path.realpath(path))
    try:
        there = os.stat(path)
    except FileNotFoundError:
        return target, None
    if stat.S_ISDIR(there.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if stat.S_ISREG(there.st_mode) and not there.st_mode & 0o222:
        raise PermissionError(errno.EACCES, f"it is read-only (mode {stat.S_IMODE(there.st_mode):04o})")
    return target, there


def _refused(path: Path, error: OSError) -> OutputError:
    reason = "no such folder" if isinstance(error, FileNotFoundError) else error.strerror or error
    return OutputError(f"{path}: cannot be written: {reason}; choose another place")


def _place_exclusively(written: Path, path: Path) -> None:
    """Give a file that is whole the name `path`. FileExistsError if that is taken."""
    try:
        os.link(written, path)
    except FileExistsError:
        raise
    except OSError:  # a file system without links: the name is taken first
        os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        try:
            os.replace(written, path)
        except OSError:
            path.unlink(missing_ok=True)
            raise


def file_stem(name: str) -> str:
    """The name of a light, made fit for a file name on every system."""
    return re.sub(r"[^\w.+-]+", "-", name).strip("-.") or "light"
