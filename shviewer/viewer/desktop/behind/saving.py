"""What is written and copied of pictures: drawn between the frames of the window, and written behind it."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator
from contextlib import suppress
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import NamedTuple, ParamSpec

import numpy as np
from numpy.typing import NDArray

from shviewer.analysis.projected import Projected, project_recipe
from shviewer.coefficients.programs import OURS
from shviewer.errors import ShviewerError
from shviewer.outputs import file_stem, write_atomically
from shviewer.viewer import camera
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.desktop.behind.errands import Errands
from shviewer.viewer.desktop.behind.task import QUIET, Wake
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.picture_files import write_numbered, write_png
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.screenshot import render_in_parts
from shviewer.viewer.work import Work

P = ParamSpec("P")

Read = Callable[[], NDArray[np.uint8]]
"""Gives the pixels that were read back."""


class Written(NamedTuple):
    """A file that was written."""

    path: Path
    what: str = ""
    """What is in it, where that is not plain."""


class Saving(Errands):
    """Pictures, coefficients and texts that were asked for. A picture that is drawn has its maps in OpenGL until it is."""

    def __init__(self, wake: Wake, written: Callable[[Written], None], failed: Callable[[ShviewerError], None]) -> None:
        """written, failed: hear of every file that was written, and of whatever could not be."""
        super().__init__(wake)
        self._written, self._failed = written, failed
        self._drawing: list[_Drawing] = []

    @property
    def drawing(self) -> bool:
        """Whether a picture is still to be drawn."""
        return bool(self._drawing)

    @property
    def work(self) -> Work | None:
        return (self._drawing[0].work if self._drawing else None) or super().work

    def picture(self, renderer: Renderer, picture: Picture, composition: Composition) -> bool:
        """Draw and write a picture; False, and nothing is done, while a map or a surface is on its way to OpenGL."""
        if not renderer.ready(picture, composition):
            return False
        self._drawing.append(_Drawing(renderer, picture, composition))
        renderer.held.pinned = self._drawing[0].picture
        return True

    def go_on(self, seconds: float | None) -> None:
        """Draw what is to be drawn for about so long; None: all of it."""
        end = None if seconds is None else perf_counter() + seconds
        while self._drawing and (end is None or perf_counter() < end):
            first, raw = self._drawing[0], None
            try:
                raw = first.go_on()
            except ShviewerError as error:  # OpenGL that cannot draw it
                self._over()
                self._failed(error)
            if raw is not None:
                self._over()
                self.write("saving the picture", write_picture, first.picture, first.composition, first.opengl, raw)

    def stop(self) -> None:
        while self._drawing:
            self._over()
        super().stop()

    def finish(self) -> None:
        self.go_on(None)
        super().finish()

    def write(self, words: str, write: Callable[P, Written], *arguments: P.args, **named: P.kwargs) -> None:
        """Write a file."""
        self.run(words, lambda: write(*arguments, **named), self._written, self._failed)

    def text(self, words: str, make: Callable[[], str], give: Callable[[str], None]) -> None:
        """Make a text, and give it."""
        self.run(words, make, give, self._failed)

    def _over(self) -> None:
        """Draw no more of the first picture."""
        first = self._drawing.pop(0)
        first.release()
        first.renderer.held.pinned = self._drawing[0].picture if self._drawing else None


class _Drawing:
    """A picture on its way into a framebuffer."""

    def __init__(self, renderer: Renderer, picture: Picture, composition: Composition) -> None:
        self.renderer, self.picture, self.composition = renderer, picture, composition
        self.opengl = renderer.version
        self._parts: Generator[float, None, Read] = render_in_parts(renderer, picture, composition)
        self._share = 0.0
        self._begun = perf_counter()

    @property
    def work(self) -> Work | None:
        """How far it is, once it has taken a while."""
        return Work("drawing the picture", round(self._share, 2)) if perf_counter() - self._begun > QUIET else None

    def go_on(self) -> Read | None:
        """Draw a part; what gives the pixels, when that was the last."""
        try:
            self._share = next(self._parts)
        except StopIteration as last:
            pixels: Read = last.value
            return pixels
        return None

    def release(self) -> None:
        self._parts.close()


def write_picture(picture: Picture, composition: Composition, opengl: str, pixels: Read) -> Written:
    """Write the picture, with the pixels that OpenGL drew of it, under the next free name. OutputError if that fails."""
    text = metadata(picture, composition, opengl)

    def write(path: Path) -> None:
        write_png(path, pixels(), text, exclusive=True)

    return Written(write_numbered(_stem(picture), write, folder=_folder()))


def write_coefficients(picture: Picture) -> Written:
    """Write what `shviewer project` would, with the light turned as it is shown. OutputError if that fails."""
    projected = projected_of(picture)
    data, what = projected.encode(OURS, "json"), projected.extent if projected.encoding else ""
    if projected.encoding and projected.stored is None:
        what += f", as {projected.encoding} has no numbers with a window or muted bands"
    write = partial(write_atomically, data=data, exclusive=True)
    return Written(write_numbered(_stem(picture), write, suffix=".json", folder=_folder()), what)


def coefficients_text(picture: Picture) -> str:
    """The same as CSV with its stamp."""
    return projected_of(picture).encode(OURS, "csv").decode()


def projected_of(picture: Picture) -> Projected:
    """What is shown, turned as it is shown."""
    view = picture.state.view
    projected, rotation = project_recipe(picture.state.recipe, view.encode), view.light_rotation
    return projected if rotation == camera.IDENTITY else projected.turned(camera.matrix(rotation))


def _folder() -> Path:
    """The present folder, or the user's own, where nothing can be written there: a window may be opened by a click anywhere."""
    if not os.access(".", os.W_OK):
        with suppress(RuntimeError):  # a user without one
            return Path.home()
    return Path()


def _stem(picture: Picture) -> str:
    return f"shviewer-{file_stem(picture.light.name)}"
