"""The lights of a batch in several processes at a time, their results in the order of the lights.

If a process is killed, perhaps for want of memory, its lights are given to others; a light that kills a second one fails alone.
"""

from __future__ import annotations

import io
import multiprocessing
import os
import signal
import sys
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from functools import partial
from time import perf_counter
from typing import TypeVar

from shviewer.children import end_after
from shviewer.errors import LightError, ShviewerError, within_memory
from shviewer.limits import share_memory

T = TypeVar("T")

PAYS = 3.0
"""Seconds of work that must be left for more processes, which take half a second to start, to be worth it."""

PROCESS_BYTES = 2**29
"""Available memory for each process, without which no more are started."""

AHEAD = 2
"""Lights given out for each process, so that none waits for the next one."""

UNSAID = "ignore:resource_tracker"
"""Python warns of semaphores that a process ended by a signal has left behind; it removes them itself."""


def in_order(work: Callable[[str], T], lights: Sequence[str], jobs: int | None) -> Iterator[T | ShviewerError]:
    """work(light) for every light, in their order, or the error that it ended with: none stops the others.

    jobs: the number of processes; None: one as long as the rest is soon done, then as many as there are cores and memory
    for. With more than one, `work` and its results must be picklable.
    """
    attempt = partial(_attempt, work)
    start = perf_counter()
    for done, light in enumerate(lights):
        left = len(lights) - done
        wanted = jobs or (_most() if done and left * (perf_counter() - start) / done > PAYS else 1)
        if min(wanted, left) > 1:
            yield from _spread(attempt, deque(lights[done:]), min(wanted, left))
            return
        yield attempt(light)


def _attempt(work: Callable[[str], T], light: str) -> T | ShviewerError:
    try:
        with redirect_stdout(sys.stderr), within_memory(light):  # code of a light may print; stdout is for results
            return work(light)
    except ShviewerError as error:
        return error


def _most() -> int:
    """The processes that there are cores and memory for."""
    from shviewer.memory import available_bytes

    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    free = available_bytes()
    return cores if free is None else max(1, min(cores, free // PROCESS_BYTES))


def _spread(work: Callable[[str], T], lights: deque[str], jobs: int) -> Iterator[T | LightError]:
    os.environ.setdefault("PYTHONWARNINGS", UNSAID)
    while lights:
        yield from _pool(work, lights, jobs)
        if lights:  # a process was killed: by the first light that has no result, or by one beside it
            alone = deque([lights.popleft()])
            yield from _pool(work, alone, 1)
            if alone:
                yield LightError(
                    f"{alone[0]}: the process that worked on it was killed; free some memory, or see --jobs 1"
                )


def _pool(work: Callable[[str], T], lights: deque[str], jobs: int) -> Generator[T, None, None]:
    """Take lights from the left as their results come; those that are left when a process is killed stay."""
    context = multiprocessing.get_context("spawn")
    executor = ProcessPoolExecutor(jobs, context, _begin, (jobs,))
    given: deque[Future[tuple[T, str]]] = deque()
    try:
        while lights:
            while len(given) < min(AHEAD * jobs, len(lights)):
                with _no_interrupt():
                    given.append(executor.submit(_heard, work, lights[len(given)]))
            found, said = given[0].result()
            given.popleft()
            lights.popleft()
            sys.stderr.write(said)
            yield found
    except BrokenProcessPool:
        return
    finally:
        processes = list((executor._processes or {}).values())
        executor.shutdown(wait=not lights, cancel_futures=True)
        for process in processes:
            process.kill()


def _heard(work: Callable[[str], T], light: str) -> tuple[T, str]:
    """work(light), and what it said on stderr, which is said in the order of the lights, whole lines at a time."""
    with redirect_stderr(io.StringIO()) as said:
        return work(light), said.getvalue()


@contextmanager
def _no_interrupt() -> Iterator[None]:
    """Ctrl-C waits for the end of the block, and processes that are started in it never see it, not even while they import."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(jobs: int) -> None:
    """In a new process: take a share of the memory, leave Ctrl-C to the parent, and end with it."""
    share_memory(jobs)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if parent := multiprocessing.parent_process():
        end_after(parent.join)
