"""The official OpenEXR library, imported late, asked quietly, and believed only when it returns something.

Traps of the library (3.5.3), each with a test:
    a damaged chunk raises nothing: it prints one line on stderr (from C) and one on sys.stdout, and `parts` is empty;
    a header may claim any window, and pixels of that size are allocated at once: open with header_only first;
    every part is decoded, also the deep ones, whose size no header tells: see openexr_parts.py.
"""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Iterator
from types import ModuleType
from typing import Any

from shviewer.errors import LightError


def import_openexr() -> ModuleType:
    """Imported here, so that lights without an .exr start faster and need no library."""
    try:
        import OpenEXR
    except ImportError as error:
        raise LightError(f"an OpenEXR file needs the OpenEXR library ({error}): pip install OpenEXR") from None
    return OpenEXR  # type: ignore[no-any-return]


def open_openexr(openexr: ModuleType, data: bytes, *, header_only: bool) -> Any:
    """An OpenEXR.File with at least one part, its channels apart: RGB of mixed pixel types cannot be grouped.

    Raises LightError with whatever the library printed or raised, MemoryError if it ran out of memory.
    """
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), _c_stderr_silenced():
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
def _c_stderr_silenced() -> Iterator[None]:
    """File descriptor 2 points nowhere meanwhile: the C part of the library writes past sys.stderr."""
    try:
        saved = os.dup(2)
    except OSError:  # closed, as under a service manager: nothing to keep clean
        yield
        return
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(saved, 2)
        os.close(saved)
