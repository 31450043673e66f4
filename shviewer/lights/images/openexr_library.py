"""The official OpenEXR library, imported late, asked quietly, and believed only when it returns something.

Traps of the library (3.5.3), each with a test:
    a damaged chunk raises nothing: it prints one line on stderr (from C) and one on sys.stdout, and `parts` is empty;
    damage in HTJ2K is printed on stdout from C, into a buffer that may be written out as late as at exit;
    a header may claim any window, and pixels of that size are allocated at once: open with header_only first;
    every part is decoded, even a deep one, whose size no header tells: see openexr_parts.py.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys
import threading
from collections.abc import Iterator
from types import ModuleType
from typing import Any

from shviewer.errors import LightError

_one_at_a_time = threading.Lock()
"""A lock, since decoding redirects the standard streams of the whole process."""


def import_openexr() -> ModuleType:
    """Import the library only when it is needed: other lights start faster and do without it. LightError if it is missing."""
    try:
        import OpenEXR
    except ImportError as error:
        raise LightError(f"an OpenEXR file needs the OpenEXR library ({error}): pip install OpenEXR") from None
    return OpenEXR  # type: ignore[no-any-return]


def open_openexr(openexr: ModuleType, data: bytes, *, header_only: bool) -> Any:
    """An OpenEXR.File with at least one part, its channels not grouped: RGB of mixed pixel types cannot be.

    Raises LightError with whatever the library printed or raised, MemoryError if it ran out of memory.
    """
    printed = io.StringIO()
    try:
        with _one_at_a_time, _c_output_silenced(), contextlib.redirect_stdout(printed):
            file = openexr.File(io.BytesIO(data), separate_channels=True, header_only=header_only)
    except MemoryError:
        raise
    except Exception as error:  # RuntimeError, ValueError, TypeError, ... by file and version
        raise damaged(str(error)) from None
    if not file.parts:
        if "bad_alloc" in printed.getvalue():
            raise MemoryError
        raise damaged(printed.getvalue().removeprefix("Warning: ") or "no parts")
    return file


def damaged(reason: str) -> LightError:
    """The error for a file that the library rejects; `reason` may be of any length and hold any characters."""
    line = ascii(" ".join(reason.split())[:160])[1:-1]
    return LightError(
        f"damaged or cut short, the OpenEXR library says: {line or 'nothing'}; fetch or export the file again"
    )


@contextlib.contextmanager
def _c_output_silenced() -> Iterator[None]:
    """Point file descriptors 1 and 2 nowhere for a while: the C part of the library writes past Python's streams.

    A stream that was closed when Python started, as under a service manager, is left alone: its descriptor may belong to
    another file by now.
    """
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
    _flush_c()
    with contextlib.ExitStack() as restored:
        for stream, descriptor in ((sys.__stdout__, 1), (sys.__stderr__, 2)):
            if stream is not None:
                with contextlib.suppress(OSError):  # closed since: nothing to keep clean
                    restored.enter_context(_to_nowhere(descriptor))
        restored.callback(_flush_c)
        yield


@contextlib.contextmanager
def _to_nowhere(descriptor: int) -> Iterator[None]:
    saved = _copy(descriptor)
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), descriptor)
        yield
    finally:
        os.dup2(saved, descriptor)
        os.close(saved)


def _copy(descriptor: int) -> int:
    """A copy of a descriptor, above 2: at a free 1 or 2 the library would print to it."""
    copy = os.dup(descriptor)
    if copy > 2:
        return copy
    try:
        return _copy(descriptor)
    finally:
        os.close(copy)


def _flush_c() -> None:
    """Flush the streams of the C library."""
    import ctypes

    with contextlib.suppress(OSError, AttributeError):  # in a Python that is linked in another way
        ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fflush(None)
