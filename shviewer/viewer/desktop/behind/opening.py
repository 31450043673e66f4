"""Opening a light in the window: a picture that this program saved is the state that it was saved from."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace

from shviewer.analysis.recipe import light_name
from shviewer.coefficients.writing import FORMATS
from shviewer.errors import ShviewerError
from shviewer.harmonics.quantities.names import IRRADIANCE
from shviewer.lights.find import built_in_lights, find_light, split_light
from shviewer.lights.light import Light
from shviewer.viewer.control.actions import show_light
from shviewer.viewer.desktop.behind.errands import Errands
from shviewer.viewer.desktop.behind.task import Wake
from shviewer.viewer.message import ERROR, WARNING, Message
from shviewer.viewer.saving.restoring import restored
from shviewer.viewer.state import State, changed, started
from shviewer.viewer.view import STOPPED

MOST_DROPPED = 100

WRITTEN = tuple(f".{kind}" for kind in FORMATS)
"""The suffixes of files that `shviewer project` writes."""


def opened(state: State, *, as_image: bool) -> State:
    """The state of a light that was just chosen. LightError for a picture whose stamp cannot be read.

    as_image: whether pictures are images.
    """
    light = state.recipe.light
    if as_image or not isinstance(light, str) or light in built_in_lights():
        return state
    path, part = split_light(light)
    if path.suffix.lower() in WRITTEN and state.recipe.quantity != IRRADIANCE:
        return _as_irradiance(state, light)
    picture = None if part else restored(path, state.recipe.reading.limits)
    if picture is None:
        return state
    shown = replace(picture.state, lights=state.lights, entry=light)
    words = "; ".join(filter(None, (state.view.message, picture.said or picture.state.view.message)))
    message = Message(words, WARNING if picture.said else "")
    reading = replace(shown.recipe.reading, isolated=True)
    return started(changed(shown, reading=reading, message=message, **STOPPED))


def _as_irradiance(state: State, light: str) -> State:
    """The state for irradiance where a file holds what engines store of it: that is its light, as the command line has it."""
    about = find_light(light, state.recipe.reading).about
    if about.file is None or about.file.stored is None:
        return state
    said = f"{light_name(light)} holds irradiance, which is shown"
    words = "; ".join(filter(None, (state.view.message, said)))
    return changed(state, quantity=IRRADIANCE, message=words)


class Opening(Errands):
    """The lights to go through from one that was chosen, behind the window, until one of them can be opened.

    A picture may have to look at the whole file of its light.
    """

    def __init__(
        self,
        wake: Wake,
        then: Callable[[State, bool], None],
        failed: Callable[[ShviewerError], None],
        *,
        as_image: bool,
    ) -> None:
        """then: takes the state of the light that could be opened, and whether its file is read again."""
        super().__init__(wake)
        self._then, self._failed, self._as_image = then, failed, as_image
        self._again = False
        self._others: list[str | Light] = []
        self._passed: list[str] = []
        """The names of those that could not be opened."""

    def begin(self, state: State, others: Sequence[str | Light], shown: State, *, again: bool) -> None:
        """Open the light that was chosen, as `opened`, or where it cannot be opened the first of the others that can.

        shown: the state of the picture there is, which then gets another light.
        """
        self.stop()
        self._others, self._passed, self._again = list(others), [], again
        self._try(state, shown)

    @property
    def more(self) -> bool:
        """Whether there are others to go on to."""
        return bool(self._others)

    def go_on(self, tried: State, error: ShviewerError, shown: State) -> None:
        """Go over a light that cannot be opened to the next, or say that there is none."""
        if not self._others:
            self._failed(error)
            return
        place, light = tried.place, self._others.pop(0)
        bad = tried.lights[place] if place is not None else tried.recipe.light
        self._passed.append(light_name(bad))
        print(f"shviewer: {error}; skipped", file=sys.stderr, flush=True)
        left = tuple(one for one in tried.lights if one != bad)
        message = Message(_skipped(self._passed, str(error)), ERROR)
        self._try(changed(show_light(shown, light), lights=left, message=message), shown)

    def end(self) -> None:
        """Go on to none any more."""
        self._others = []

    def _try(self, state: State, shown: State) -> None:
        self.run(
            f"opening {light_name(state.recipe.light)}",
            lambda: opened(state, as_image=self._as_image),
            lambda found: self._then(found, self._again),
            lambda error: self.go_on(state, error, shown),
            soon=not self._passed,
        )


def _skipped(names: list[str], reason: str) -> str:
    """The message about lights that could not be opened and are gone over."""
    return f"skipped {reason}" if len(names) == 1 else f"skipped {', '.join(names)}; the last: {reason}"
