"""Errands: what is done behind the window, one after the other, whatever is shown meanwhile."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from shviewer.errors import ShviewerError
from shviewer.progress import Stopped, tell
from shviewer.viewer.desktop.behind.task import Task, Wake
from shviewer.viewer.work import Work

T = TypeVar("T")

AT_ONCE = 0.02
"""Seconds within which an errand is done before the next frame: most are."""


class Errands:
    """Errands done behind the window, one after the other. What comes of each is taken in the window's thread."""

    def __init__(self, wake: Wake = None) -> None:
        self._wake = wake
        self._begun: list[tuple[Task[Any], Callable[[Any], None], Callable[[ShviewerError], None]]] = []

    def run(
        self,
        words: str,
        make: Callable[[], T],
        then: Callable[[T], None],
        failed: Callable[[ShviewerError], None],
        *,
        soon: bool = True,
    ) -> None:
        """Make something and hand it to `then`, or why it could not be made to `failed`. words: what is being done.

        soon: whether to wait for it AT_ONCE seconds.
        """

        def made() -> Iterator[T]:
            tell(words)
            yield make()

        before = self._begun[-1][0] if self._begun else None
        task = Task(made, before, self._wake)
        self._begun.append((task, then, failed))
        if before is None and soon:
            task.wait(AT_ONCE)
            self.take()

    @property
    def working(self) -> bool:
        return bool(self._begun)

    @property
    def work(self) -> Work | None:
        """What is being done and how far it is, once it has taken a while."""
        task = self._begun[0][0] if self._begun else None
        return task.work if task is not None and not task.quiet and task.status else None

    def take(self) -> None:
        """Hand over what has been done."""
        while self._begun and self._begun[0][0].finished:
            task, then, failed = self._begun.pop(0)
            try:
                made = task.result()
            except Stopped:
                continue
            except ShviewerError as error:
                failed(error)
            except Exception as error:  # a fault of this program, which goes on
                traceback.print_exception(error)
                failed(ShviewerError("internal error, see the terminal"))
            else:
                then(made)

    def stop(self) -> None:
        """Want none of them any more."""
        for task, *_ in self._begun:
            task.stop()
        self._begun.clear()

    def finish(self) -> None:
        """Wait until all are done, and hand them over."""
        while self._begun:
            self._begun[0][0].wait(None)
            self.take()
