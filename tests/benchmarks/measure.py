"""What the benchmarks share: interleaved medians, because the machines are noisy, and the machine's own description."""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable, Mapping

os.environ.pop("OPENBLAS_CORETYPE", None)  # may be set to slow numpy down; read when numpy is first imported
os.environ.pop("OPENBLAS_L2_SIZE", None)
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # an installed program is compiled once, not at every start


def cpu_milliseconds(work: Callable[[], object]) -> float:
    """CPU time of all threads of this process."""
    start = time.process_time()
    work()
    return 1000 * (time.process_time() - start)


def wall_milliseconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return 1000 * (time.perf_counter() - start)


def medians(
    candidates: Mapping[str, Callable[[], object]],
    repeats: int,
    clock: Callable[[Callable[[], object]], float] = wall_milliseconds,
    before: Callable[[], object] = lambda: None,
) -> dict[str, float]:
    """Milliseconds of each candidate: one warm-up, then A B C A B C ..., the median of `repeats`.

    `before` runs before each, outside the clock, and gives all of them the same cache.
    """
    for work in candidates.values():
        work()
    times: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(repeats):
        for name, work in candidates.items():
            before()
            times[name].append(clock(work))
    return {name: statistics.median(values) for name, values in times.items()}


def machine() -> str:
    """What everything was measured on and with, as the report says it."""
    from shviewer.benchmark.measuring.machine import machine_line, versions

    made_with = versions(["numpy"])
    return f"{machine_line()}, Python {made_with['Python']}, numpy {made_with['numpy']}"
