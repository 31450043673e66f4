"""What is made behind the window: the pictures of one state, each better than the one before, until another is wished for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from threading import Event
from typing import Any

from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import read_again, read_once
from shviewer.viewer.animation.animation import ranged
from shviewer.viewer.control.playing import wants_range
from shviewer.viewer.desktop.behind.task import Task, Wake
from shviewer.viewer.overlay.overlay import foresee
from shviewer.viewer.picture import Picture, stages, still
from shviewer.viewer.state import State
from shviewer.viewer.work import Work

SHOWN: dict[str, Any] = {
    name: getattr(Recipe, name) for name in ("n_bands", "muted", "window", "window_width", "tolerance")
}
"""What is shown of a projection, in which a key held down changes one: it is projected once for all of them."""


class Making:
    """The task at work. The newest wish wins: a task whose pictures nobody wants any more is ended before the next begins."""

    def __init__(self, wake: Wake) -> None:
        self._wake = wake
        self._task: Task[Picture] | None = None
        self._ended: Task[Picture] | None = None
        """The task before it, which may still be at its last step."""
        self._steps: tuple[object, ...] = ()
        """What its first steps depend on: what it reads, and what it projects."""
        self._wish: object = None
        """What the task makes: the still part of a state, and how it is read."""
        self._taken: Picture | None = None
        """What was last taken from the task."""

    @property
    def working(self) -> bool:
        return self._task is not None

    @property
    def doing(self) -> str:
        """What the task does, in words without figures."""
        return self._task.status.partition(";")[0].rstrip("0123456789 %") if self._task is not None else ""

    @property
    def status(self) -> str:
        """What the task does, once it has taken a while; "" while nothing is at work."""
        task = self._task
        return task.status if task is not None and not task.quiet else ""

    @property
    def work(self) -> Work | None:
        """The same with how far it is, for the hairline; None while nothing is at work."""
        return self._task.work if self._task is not None and self.status else None

    @property
    def news(self) -> bool:
        """Whether there is something to take."""
        return self._task is not None and (self._task.finished or self._task.latest is not self._taken)

    def want(self, state: State, by_map: bool, reading: Event | None) -> None:
        """Begin with the pictures of a state, unless they are at work already. reading: set once its light was read again."""
        wish = still(state), wants_range(state), reading
        if self._task is None or wish != self._wish:
            read = state.recipe.light, state.recipe.reading, reading
            steps = read, (read, replace(state.recipe, **SHOWN))
            self.end(sum(one == other for one, other in zip(steps, self._steps, strict=False)))
            self._wish, self._steps, self._taken = wish, steps, None
            self._task = Task(lambda: _pictures_of(state, by_map, reading), self._ended, self._wake)

    def wait(self, patience: float | None) -> bool:
        """Wait until all is made, so many seconds since it was wished for (None: as long as it takes); return whether it is."""
        assert self._task is not None
        return self._task.wait(None if patience is None else patience - self._task.seconds)

    def latest(self) -> Picture | None:
        """What was made since the last time that this was asked."""
        assert self._task is not None
        last, self._taken = self._taken, self._task.latest
        return None if self._taken is last else self._taken

    def result(self) -> Picture:
        """What was made last, when all is made. Raises what the task raised."""
        task, self._task = self._task, None
        assert task is not None
        return task.result()

    def end(self, needed: int = 0) -> None:
        """Want the pictures no more. needed: but so many of the first steps that they took."""
        if self._task is not None:
            self._task.stop(needed)
            self._ended, self._task = self._task, None


def _pictures_of(state: State, by_map: bool, reading: Event | None) -> Iterator[Picture | None]:
    """The pictures of a state as `stages` has them, with everything ready that their text needs.

    First nothing, when its light has been read. What plays is given the range of its error.
    """
    if reading is not None and not reading.is_set():
        read_again(state.recipe)
        reading.set()  # a later wish need not read it once more
    read_once(state.recipe)
    yield None
    for picture in stages(ranged(state), by_map=by_map):
        foresee(picture)
        yield picture
