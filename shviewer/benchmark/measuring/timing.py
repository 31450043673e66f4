"""Wall time: medians and quartiles of runs that take turns, since the machine drifts."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping
from time import perf_counter, thread_time
from typing import NamedTuple, TypeVar

import numpy as np

MOST_REPEATS = 101

Name = TypeVar("Name", bound=Hashable)
Work = Callable[[], object]


class Timing(NamedTuple):
    """The median and the quartiles of a number of repeats, in milliseconds, named as in a Row."""

    milliseconds: float
    low_quartile: float
    high_quartile: float
    repeats: int


def summarise(milliseconds: list[float]) -> Timing:
    """Median and quartiles of times. ValueError if there are none."""
    if not milliseconds:
        raise ValueError("no times")
    low, middle, high = np.quantile(milliseconds, (0.25, 0.5, 0.75))
    return Timing(float(middle), float(low), float(high), len(milliseconds))


def wall_milliseconds(work: Work) -> float:
    start = perf_counter()
    work()
    return 1000 * (perf_counter() - start)


def wall_and_cpu_milliseconds(work: Work) -> tuple[float, float]:
    """The time that work takes on the wall, and that of its thread's processor."""
    start, begun = perf_counter(), thread_time()
    work()
    return 1000 * (perf_counter() - start), 1000 * (thread_time() - begun)


def time_interleaved(
    works: Mapping[Name, Work],
    *,
    budget: float,
    at_most: float = math.inf,
    at_least: int = 5,
    warm_up: bool = True,
    before: Callable[[Name, int], object] | None = None,
) -> dict[Name, Timing]:
    """Time all works in turn, A B C A B C ..., so that a slow moment of the machine hits all of them.

    `budget`: seconds for all together, exceeded only to reach `at_least` repeats; each gets an equal share, so that fast work
    is repeated more often, up to MOST_REPEATS. `before`(name, repeat) prepares a run and is not timed; repeats are counted
    from 0, warm-ups have -1. `at_most`: seconds for everything; work that by its warm-up does not fit in `at_least` times is
    left out, and is not even begun if no time is left.
    """
    start, turn = perf_counter(), 0.0
    waiting = {} if warm_up else dict(works)
    for name, work in works.items() if warm_up else ():
        begun = perf_counter()
        if begun - start + at_least * turn >= at_most:
            continue
        if before is not None:
            before(name, -1)
        work()
        end = perf_counter()
        if end - start + at_least * (turn + end - begun) < at_most:
            turn += end - begun
            waiting[name] = work
    times: dict[Name, list[float]] = {name: [] for name in waiting}
    share = 1000 * budget / max(1, len(waiting))
    start = perf_counter()
    while waiting:
        for name, work in waiting.items():
            if before is not None:
                before(name, len(times[name]))
            times[name].append(wall_milliseconds(work))
        late = perf_counter() - start >= budget
        waiting = {
            name: work
            for name, work in waiting.items()
            if len(times[name]) < at_least
            or not (late or sum(times[name]) >= share or len(times[name]) >= MOST_REPEATS)
        }
    return {name: summarise(found) for name, found in times.items()}
