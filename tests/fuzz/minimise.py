"""A failing input made small, so that a reader sees why it fails."""

from __future__ import annotations

import time
from collections.abc import Callable


def minimised(data: bytes, fails: Callable[[bytes], bool], seconds: float = 10.0) -> bytes:
    """A part of `data` that still fails: blocks are left out, large ones first, until none can be or time is up."""
    end, size = time.monotonic() + seconds, len(data) // 2
    while size:
        place, smaller = 0, False
        while place < len(data) and time.monotonic() < end:
            shorter = data[:place] + data[place + size :]
            if fails(shorter):
                data, smaller = shorter, True
            else:
                place += size
        if not smaller:
            size //= 2
        if time.monotonic() >= end:
            break
    return data
