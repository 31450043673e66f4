"""Files read and written safely: looked at before they are opened, written whole or not at all, with versions told apart."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from shviewer.errors import LightError, OutputError
from shviewer.limits import Limits
from shviewer.words import one_line


@contextlib.contextmanager
def naming(name: str) -> Iterator[None]:
    """Let the errors raised inside begin with `name`, quoted and escaped if it holds a line break or bytes that are no text."""
    shown = name if name.isprintable() else ascii(name)
    try:
        yield
    except LightError as error:
        raise LightError(f"{shown}: {error}") from None
    except MemoryError:
        raise LightError(f"{shown}: not enough memory to decode it; close something or make it smaller") from None


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


def read_bytes(path: Path, limits: Limits) -> bytes:
    """The whole file, read once. Looks before it opens, so that no pipe or device can block or be disturbed."""
    try:
        _check_is_small_file(os.stat(path), limits)
        # The file may have been replaced since: without O_NONBLOCK a pipe in its place would block for ever.
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        with open(descriptor, "rb") as file:
            size = _check_is_small_file(os.fstat(descriptor), limits)
            data = file.read(size + 1)
    except (OSError, ValueError) as error:
        raise LightError(_reason(error)) from None
    if len(data) != size:
        raise LightError(f"{len(data)} bytes read where it had {size}; it changed meanwhile: try again")
    return data


def _check_is_small_file(status: os.stat_result, limits: Limits) -> int:
    """Return the size in bytes. LightError unless it is a regular file, not empty, and within the limits."""
    if stat.S_ISDIR(status.st_mode):
        raise LightError("a directory; name one image in it")
    if not stat.S_ISREG(status.st_mode):
        raise LightError("a pipe, socket or device; only a regular file is read: save it as one first")
    if status.st_size == 0:
        raise LightError("an empty file (0 bytes); fetch or export it again")
    limits.check_file(status.st_size)
    return status.st_size


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
            with open(os.open(target, os.O_WRONLY), "wb") as through:
                through.write(data)
            return
        handle, name = tempfile.mkstemp(prefix=".shv-", suffix=".tmp", dir=target.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            if there is not None and hasattr(os, "chown"):
                with suppress(OSError):  # only root may give files away
                    os.chown(name, there.st_uid, there.st_gid)
            os.chmod(name, 0o666 & ~_umask() if there is None else stat.S_IMODE(there.st_mode))
            if exclusive:
                _place_exclusively(name, target, data)
            else:
                os.replace(name, target)
        finally:
            with suppress(FileNotFoundError):
                os.unlink(name)
    except FileExistsError:
        raise
    except OSError as error:
        raise _refused(path, error) from error


def writing_folder(path: Path) -> Path | None:
    """The folder in which a file is made before it becomes `path`; None, the system's own, for a pipe or a device."""
    target, there = _target(path)
    return target.parent if there is None or stat.S_ISREG(there.st_mode) else None


def check_place(path: Path) -> None:
    """OutputError if nothing can be written at `path`: a check to make before long work on what goes there."""
    try:
        target, there = _target(path)
        if there is None or stat.S_ISREG(there.st_mode):
            with tempfile.TemporaryFile(dir=target.parent):
                pass
    except OSError as error:
        raise _refused(path, error) from error


@dataclass(frozen=True)
class Replacing:
    """What a command may replace: never one of its `inputs`, and a file that this program did not write only with `force`."""

    inputs: tuple[Path, ...] = ()
    force: bool = False

    def check(self, path: Path) -> None:
        """OutputError if writing `path` would destroy what must stay: a check to make before it is written."""
        for source in self.inputs:
            with suppress(OSError, ValueError):  # what does not exist is not destroyed
                if os.path.samefile(path, source):
                    raise OutputError(f"{path}: the light or a comparison is read from this file; write another one")
        if not (self.force or _may_go(path)):
            raise OutputError(f"{path}: exists, and shviewer did not write it; write another file, or --force")


ANYTHING = Replacing(force=True)
"""The rule of a caller who knows what is there."""

OURS = (
    b"shviewer-coefficients",
    "shviewer-coefficients".encode("utf-32-le"),  # in an NPZ
    b"shviewer\0",  # the key of the stamp in a PNG, the attribute in an EXR
    b'"world_from_view"',  # a key of that stamp, the comment of a GIF and the description of a WebP
)
"""Bytes of the stamps: each file of this program has some of them within OURS_BYTES of one of its ends."""

OURS_BYTES = 2**16


def _may_go(path: Path) -> bool:
    """Whether there is nothing at `path` to be lost: no file, an empty one, a pipe or device, or one of this program."""
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode) or not status.st_size:
            return True
        with path.open("rb") as file:
            ends = file.read(OURS_BYTES)
            file.seek(max(0, status.st_size - OURS_BYTES))
            ends += file.read(OURS_BYTES)
    except (OSError, ValueError):  # what cannot be looked at is for the writer to refuse
        return True
    return any(mark in ends for mark in OURS)


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


def _place_exclusively(name: str, path: Path, data: bytes) -> None:
    try:
        os.link(name, path)
    except FileExistsError:
        raise
    except OSError:  # a file system without links
        with path.open("xb") as file:
            file.write(data)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def file_stem(name: str) -> str:
    """The name of a light, made fit for a file name on every system."""
    return re.sub(r"[^\w.+-]+", "-", name).strip("-.") or "light"
