"""Work behind the window: one thread that tells how far it is, and ends early when nobody wants its results."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from threading import Event, Thread
from time import perf_counter
from typing import Generic, TypeAlias, TypeVar

from shviewer.progress import Stopped, in_words, listening
from shviewer.viewer.work import Work

T = TypeVar("T")

Wake: TypeAlias = Callable[[], None] | None
"""Called from another thread when it has made something, so that the window's thread takes it."""

QUIET = 0.3
"""Seconds after which a task is spoken of."""

COMES_AFTER = "; what was asked for since comes after it"

LEAST_DONE = 0.03
"""The share of a work that must be done before the rest is estimated from it."""


class Task(Generic[T]):
    """One computation, of results each better than the one before. It begins when the task before it has ended."""

    def __init__(self, make: Callable[[], Iterable[T | None]], after: Task[T] | None = None, wake: Wake = None) -> None:
        """make: gives the results, at least one, and None where a step is over without one."""
        self.started = perf_counter()
        self._before = after
        self._status, self._words = "", ""
        self._share: float | None = None
        self._begun = (self.started, 0.0)
        """When it began with that, and the share that was done by then."""
        self._stopped = False
        self._steps = self._needed = 0
        """How many are over, and how many have to be before it may stop."""
        self._over = Event()
        """Set before `wake` is called, which must find the task finished."""
        self.latest: T | None = None
        """The best result so far."""
        self._error: BaseException | None = None
        self._thread: Thread = Thread(target=self._run, args=(make, after and after._thread, wake), daemon=True)
        self._thread.start()

    @property
    def seconds(self) -> float:
        return perf_counter() - self.started

    @property
    def _ahead(self) -> Task[T] | None:
        """The task at work that has to end before this one begins: a step of it may take long."""
        before = self._before
        return None if before is None or before.finished else before._ahead or before

    @property
    def quiet(self) -> bool:
        """Whether neither it nor the task that it waits for has taken long enough to be spoken of."""
        ahead = self._ahead
        return self.seconds <= QUIET and (ahead is None or ahead.seconds <= QUIET)

    @property
    def status(self) -> str:
        """What it is doing, in words; or what it waits for."""
        ahead = self._ahead
        return self._status if ahead is None or not ahead._words else f"{ahead._words}{COMES_AFTER}"

    @property
    def work(self) -> Work:
        """What it is doing and how far it is; how long it will take as soon as a part of it is done."""
        if (ahead := self._ahead) is not None:
            return replace(ahead.work, words=self.status)
        share, (begun, before) = self._share, self._begun
        if share is None:
            return Work(self._words, seconds=round(self.seconds, 1))
        spent, done = perf_counter() - begun, share - before
        left = spent * (1 - share) / done if done > LEAST_DONE else None
        return Work(self._words, round(share, 3), None if left is None else float(round(left)))

    @property
    def finished(self) -> bool:
        return self._over.is_set()

    def wait(self, seconds: float | None) -> bool:
        """Wait for the end, at most so many seconds (None: as long as it takes); return whether it has come."""
        return self._over.wait(None if seconds is None else max(seconds, 0.0))

    def stop(self, needed: int = 0) -> None:
        """Want the result no more: the thread ends soon, as does what it waits for.

        needed: how many of its first steps who comes after it needs, too. If it has begun, it does not stop before.
        """
        before = self._before
        self._needed = needed if before is None else 0
        self._stopped = True
        if before is not None and not needed:
            before.stop()

    def result(self) -> T:
        """What was made last. Raises what the computation raised, or Stopped."""
        self._over.wait()
        if self._error is not None:
            raise self._error
        return self.latest  # type: ignore[return-value]  # without an error, it was made

    def _run(self, make: Callable[[], Iterable[T | None]], before: Thread | None, wake: Wake) -> None:
        """Make the results, and wake at every step, and at the end in any case."""
        if before is not None:
            before.join()
        self._before = None
        try:
            with listening(self._hear):
                self._hear("", None)
                for result in make():
                    self.latest = result if result is not None else self.latest
                    self._steps += 1
                    if wake is not None:
                        wake()
        except BaseException as error:
            self._error = error
        self._over.set()
        if wake is not None:
            wake()

    def _hear(self, what: str, share: float | None) -> None:
        if self._stopped and self._steps >= self._needed:
            raise Stopped
        if what and what != self._words:
            self._words, self._begun = what, (perf_counter(), share or 0.0)
        self._share = share
        if what:
            self._status = in_words(what, share)
