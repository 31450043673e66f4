"""What the window writes and copies of its picture, behind the window: the picture itself and its coefficients."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from shviewer.analysis.projected import Projected, project_recipe
from shviewer.coefficients.programs import OURS
from shviewer.errors import ShviewerError
from shviewer.outputs import file_stem, write_atomically
from shviewer.progress import Stopped, tell
from shviewer.viewer import camera
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.desktop.task import Task
from shviewer.viewer.overlay.foot import Work
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.picture_files import write_numbered, write_png
from shviewer.viewer.saving.stamp import metadata

T = TypeVar("T")

AT_ONCE = 0.02
"""Seconds within which an errand is done before the next frame: most are."""


class Errands:
    """Errands done behind the window, one after the other. What comes of each is taken in the window's thread."""

    def __init__(self, wake: Callable[[], None] | None = None) -> None:
        """wake: called from another thread when one is done."""
        self._wake = wake
        self._begun: list[tuple[Task[Any], Callable[[Any], None], Callable[[ShviewerError], None]]] = []

    def run(
        self, words: str, make: Callable[[], T], then: Callable[[T], None], failed: Callable[[ShviewerError], None]
    ) -> None:
        """Make something and hand it to `then`, or why it could not be made to `failed`. words: what is being done."""

        def made() -> Iterator[T]:
            tell(words)
            yield make()

        before = self._begun[-1][0] if self._begun else None
        task = Task(made, before, self._wake)
        self._begun.append((task, then, failed))
        if before is None:
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


def save_picture(picture: Picture, composition: Composition, opengl: str, pixels: NDArray[np.uint8]) -> Path:
    """Write the picture, with the pixels that OpenGL drew of it, under the next free name in the present folder.

    Return its path. OutputError if that fails.
    """
    text = metadata(picture, composition, opengl)
    return write_numbered(_stem(picture), lambda path: write_png(path, pixels, text, exclusive=True))


def save_coefficients(picture: Picture) -> Path:
    """Write what `shviewer project` would, with the light turned as it is shown. OutputError if that fails."""
    data = _projected(picture).encode(OURS, "json")
    return write_numbered(_stem(picture), lambda path: write_atomically(path, data, exclusive=True), suffix=".json")


def coefficients_text(picture: Picture) -> str:
    """The same as CSV with its stamp."""
    return _projected(picture).encode(OURS, "csv").decode()


def _projected(picture: Picture) -> Projected:
    projected, rotation = project_recipe(picture.state.recipe), picture.state.view.light_rotation
    return projected if rotation == camera.IDENTITY else projected.turned(camera.matrix(rotation))


def _stem(picture: Picture) -> str:
    return f"shviewer-{file_stem(picture.light.name)}"
