"""The memory that this process may still take: what the machine has left, within every limit that is set on the process.

And what becomes of memory that it has freed.

Sources
    Linux    proc(5): MemAvailable, statm; getrlimit(2); the kernel's admin-guide/cgroup-v2 and cgroup-v1/memory: the limit
             of every level above counts, and pages of files that nobody uses (inactive_file) are given back first
    macOS    mach/vm_statistics.h: free and inactive pages
    Windows  GlobalMemoryStatusEx: physical memory, memory that may be committed, and address space
"""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

_CGROUP_2 = ("memory.max", "memory.current", "inactive_file")
_CGROUP_1 = ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")


LARGEST_KEPT = 2**25
"""Bytes up to which a block is kept where it was freed."""

_TRIM, _MMAP = -1, -3  # of mallopt(3)


def keep_freed() -> None:
    """Let glibc keep blocks that are freed, twice LARGEST_KEPT together at the end of the heap, for those that come next.

    It does so by itself from the first time on that so large a block was freed. Until then every array of more than 128 KiB
    takes fresh pages, and to fetch them costs several times what it takes to fill them.
    """
    with suppress(Exception):  # another system, or another C library
        mallopt = ctypes.CDLL(None).mallopt
        mallopt(_MMAP, LARGEST_KEPT)
        mallopt(_TRIM, 2 * LARGEST_KEPT)


def available_bytes() -> int | None:
    """The bytes; None where the system does not tell."""
    left: list[int] = []
    with suppress(Exception):  # what a system tells in another way than it should limits nothing
        if sys.platform == "win32":
            left += windows(ctypes.windll.kernel32)
        elif sys.platform == "darwin":
            left += macos(ctypes.CDLL(None), os.sysconf("SC_PAGE_SIZE"))
        else:
            left += linux(Path("/"))
    return max(0, min(left)) if left else None


def linux(root: Path) -> Iterator[int]:
    """Bytes that each limit leaves, of those that are set and told below `root`, where /proc and /sys are."""
    with suppress(OSError, KeyError):
        yield 1024 * _table(root / "proc/meminfo")["MemAvailable"]
    with suppress(OSError, ValueError, ImportError, IndexError):
        import resource

        pages = [int(word) for word in (root / "proc/self/statm").read_text().split()]
        for kind, used in ((resource.RLIMIT_AS, pages[0]), (resource.RLIMIT_DATA, pages[5])):
            limit = resource.getrlimit(kind)[0]
            if limit != resource.RLIM_INFINITY:
                yield limit - used * resource.getpagesize()
    with suppress(OSError, ValueError, IndexError):
        yield from _cgroups(root)


def _cgroups(root: Path) -> Iterator[int]:
    """Bytes that the memory controllers leave, whichever version they are of."""
    groups = [line.split(":", 2) for line in (root / "proc/self/cgroup").read_text().splitlines()]
    for line in (root / "proc/self/mountinfo").read_text().splitlines():
        mount, _, kind = line.partition(" - ")
        _, _, _, top, point = mount.split()[:5]
        version, _, options = kind.split()[:3]
        one = version == "cgroup" and "memory" in options.split(",")
        if not one and version != "cgroup2":
            continue
        for _, controllers, path in groups:
            if ("memory" in controllers.split(",")) if one else not controllers:
                inside = path.removeprefix(top.rstrip("/")) if path.startswith(top) else ""
                yield from _levels(root / point[1:], inside, _CGROUP_1 if one else _CGROUP_2)


def _levels(mount: Path, inside: str, files: tuple[str, str, str]) -> Iterator[int]:
    """Bytes that each level leaves, from the group `inside` the hierarchy up to its mount."""
    parts = [part for part in inside.split("/") if part not in ("", "..")]
    for depth in range(len(parts), -1, -1):
        folder = mount.joinpath(*parts[:depth])
        with suppress(OSError, ValueError):  # "max" is no number: no limit
            limit, used = (int((folder / name).read_text()) for name in files[:2])
            yield limit - used + _table(folder / "memory.stat").get(files[2], 0)


def _table(path: Path) -> dict[str, int]:
    """A file of lines with a name and a number."""
    rows = [line.replace(":", " ").split() for line in path.read_text().splitlines()]
    return {row[0]: int(row[1]) for row in rows if len(row) > 1 and row[1].isdigit()}


def macos(library: Any, page: int) -> Iterator[int]:
    """library: the C library. page: bytes of a page."""
    counts, filled = (ctypes.c_uint32 * 64)(), ctypes.c_uint32(38)  # vm_statistics64: free, active, inactive, ...
    if library.host_statistics64(library.mach_host_self(), 4, ctypes.byref(counts), ctypes.byref(filled)) == 0:
        yield (counts[0] + counts[2]) * page


class MemoryStatus(ctypes.Structure):
    """MEMORYSTATUSEX."""

    _fields_ = [("length", ctypes.c_uint32), ("load", ctypes.c_uint32)] + [
        (name, ctypes.c_uint64)
        for name in ("physical", "left", "commit", "commit_left", "address", "address_left", "extended")
    ]


def windows(kernel: Any) -> Iterator[int]:
    """kernel: kernel32."""
    status = MemoryStatus(length=ctypes.sizeof(MemoryStatus))
    if kernel.GlobalMemoryStatusEx(ctypes.byref(status)):
        yield from (status.left, status.commit_left, status.address_left)
