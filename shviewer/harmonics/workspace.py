"""Memory for intermediate values, kept from one call to the next: to fetch it from the system takes as long as to fill it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

Made = TypeVar("Made")

_kept = threading.local()


@contextmanager
def borrowed(make: Callable[..., Made], *size: int, keep: bool = True) -> Iterator[Made]:
    """make(*size), or what this thread has kept of the last time if it has the same size. Nobody else has it meanwhile."""
    shelf: dict[Any, tuple[tuple[int, ...], Made]] = _kept.__dict__.setdefault("shelf", {})
    held = shelf.pop(make, None)
    if held is None or held[0] != size:
        held = size, make(*size)
    yield held[1]
    if keep:
        shelf[make] = held
