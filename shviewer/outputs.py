"""Files written safely: whole or not at all, and never over what must stay."""

from __future__ import annotations

import errno
import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path

from shviewer.ending import at_the_end
from shviewer.errors import OutputError
from shviewer.files import opened


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
        with _beside(target) as beside:
            _write_new(beside, data, there)
            if exclusive:
                _place_exclusively(beside, target)
            else:
                os.replace(beside, target)
    except FileExistsError:
        raise
    except OSError as error:
        raise _refused(path, error) from error


@contextmanager
def _beside(target: Path) -> Iterator[Path]:
    """The name of a new file in the same folder, where no end of the block leaves one."""
    path = target.parent / f".shv-{os.urandom(8).hex()}.tmp"
    with at_the_end(partial(path.unlink, missing_ok=True)):
        yield path


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


def make_folder(folder: Path) -> None:
    """Make the folder, if need be. OutputError if that cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"{folder}: cannot be made a folder: {error.strerror or error}; choose another place"
        ) from error


def check_place(path: Path) -> None:
    """OutputError if nothing can be written at `path`: a check to make before long work on what goes there."""
    try:
        target, there = _target(path)
        if there is None or stat.S_ISREG(there.st_mode):
            with _beside(target) as beside:
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
        if not (self.force or may_be_replaced(path)):
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
    b"How many bands of spherical harmonics a light needs",  # the first words of its page
    b"<dc:title>shviewer</dc:title>",  # who made an SVG
)
"""Bytes of the stamps: each file of this program has some of them within OURS_BYTES of one of its ends."""

OURS_BYTES = 2**16


def may_be_replaced(path: Path) -> bool:
    """Whether there is nothing at `path` to be lost: no file, an empty one, a pipe or device, or one of this program."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            return True
        with opened(path) as file:
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
