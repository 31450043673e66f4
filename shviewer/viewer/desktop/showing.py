"""One state and its picture, kept together whatever fails; what takes time is made behind the window.

Until there is a picture, the last one stays, seen from where the camera is now. Figures that are searched for come after the
picture.
"""

from __future__ import annotations

import sys
import traceback
from collections.abc import Sequence
from dataclasses import replace
from threading import Event
from typing import NamedTuple

from shviewer.analysis.recipe import light_name
from shviewer.analysis.subjects import keep_light
from shviewer.errors import ShviewerError, within_memory
from shviewer.lights.light import Light
from shviewer.viewer.animation.turning import followed, is_next, only_turned
from shviewer.viewer.control.playing import wants_range
from shviewer.viewer.desktop.behind.making import Making
from shviewer.viewer.desktop.behind.opening import Opening
from shviewer.viewer.desktop.behind.task import Wake
from shviewer.viewer.desktop.messages import notes_of, reading_news, why_whole, with_keys
from shviewer.viewer.message import ERROR, WARNING, Message
from shviewer.viewer.picture import Picture, prepare, still
from shviewer.viewer.state import State, changed, started
from shviewer.viewer.view import STOPPED, View
from shviewer.words import one_line


class Settings(NamedTuple):
    """What the command line asks of a window for as long as it is open."""

    verbose: bool = False
    """Say every frame and every file in a line on stderr."""
    watch: bool = False
    """Read the light's file again when it changes."""
    as_image: bool = False
    """Take pictures that this program saved for images."""


PLAIN = Settings()


class Showing:
    """The state, and its picture or that of the last state that could be shown."""

    def __init__(
        self, state: State, first: Picture | None = None, settings: Settings = PLAIN, wake: Wake = None
    ) -> None:
        """first: the picture of the state; without it, it is made here: LightError or UsageError if that is impossible."""
        first = first or prepare(state)
        reading = state.recipe.reading  # from now on no pipe is waited for: it was read where the command line named it
        isolated = replace(reading, isolated=True, limits=replace(reading.limits, pipe_seconds=0))
        self.state = started(changed(state, reading=isolated))
        self.state = changed(
            self.state, message=state.view.message or notes_of(first.light) or why_whole(first.subject)
        )
        self.picture: Picture = replace(first, state=self.state)
        self.settings = settings
        self.reading: Event | None = None
        """The wish to read the light's file again, set once it has been read; None if there is no such wish."""
        self.refused: str | Light | None = None
        """The light that could not be read just now: the next key may say how to read it."""
        self.opening = Opening(wake, self._opened, self.failed, as_image=settings.as_image)
        self.making = Making(wake)
        self.enough: State | None = None
        """The still part of the state whose figures are not wanted any more: the search was stopped, or failed."""

    @property
    def placed(self) -> State:
        """The state, with the camera where the picture has it."""
        return self.picture.placed(self.state)

    @property
    def view(self) -> View:
        """The view of the picture that there is, as the state has turned and moved it."""
        return self.picture.seen(self.state).state.view

    @property
    def title(self) -> str:
        shown = self.picture.state
        place = (
            f" ({shown.place + 1} of {len(shown.lights)})" if shown.place is not None and len(shown.lights) > 1 else ""
        )
        return f"shviewer - {self.picture.light.name}{place}"

    @property
    def shown(self) -> bool:
        """Whether the picture is that of the state, with its figures or without."""
        same = still(self.state) == still(self.picture.state)
        return self.reading is None and same and not wants_range(self.state)

    @property
    def by_map(self) -> bool:
        """Whether the picture is drawn from a map although it could be summed."""
        return not self.picture.suits(by_map=False)

    @property
    def stepping(self) -> bool:
        """Whether what is being made is the next frame of a light that turns."""
        state, last = self.state, self.picture.state
        return bool(state.view.turning) and only_turned(last.recipe, state.recipe) and self.reading is None

    def say(self, text: str, kind: str = "") -> None:
        """Show a message of a kind, on one line."""
        self.state = changed(self.state, message=Message(one_line(text), kind))

    def open(self, state: State, others: Sequence[str | Light], *, again: bool = False) -> None:
        """Show the light that the state was given, or where it cannot be opened the next of the others.

        again: read the light's file again.
        """
        self.opening.begin(state, others, self.picture.state, again=again)

    def _opened(self, found: State, again: bool) -> None:
        self.state = found
        if again:
            self.reading = Event()

    def failed(self, error: ShviewerError) -> None:
        """Say why something that was asked for could not be done."""
        self.say(str(error), ERROR)

    def make(self, by_map: bool, patience: float | None) -> bool:
        """Make the picture; return whether it has all figures that are wanted. by_map, patience: as in `Session.prepare`."""
        last, state, reading = self.picture, self.state, self.reading
        if self.shown and last.suits(by_map) and (last.complete or still(state) == self.enough):
            self.making.end()
            self.picture = last if last.state == state else last.seen(state)
            return True
        self.making.want(state, by_map, reading)
        if not self.making.wait(patience):
            if (latest := self.making.latest()) is not None:
                self._take(latest)
            elif last.state.view != state.view:
                self.picture = last.seen(state)
            return False
        self.reading = None
        try:
            with within_memory(light_name(state.recipe.light)):
                picture = self.making.result()
        except ShviewerError as error:
            if not self.opening.more:
                self.keep(error)
                return True
            self.back_to(last)
            self.opening.go_on(state, error, last.state)
            if patience is None:
                self.opening.finish()
            return self.make(by_map, patience)
        except Exception as error:  # a fault of this program: the session goes on with the picture there is
            traceback.print_exception(error)
            self.keep(ShviewerError("internal error, see the terminal"))
            return True
        self.refused = None
        self.opening.end()
        self._take(picture, again=reading is not None)
        return picture.suits(by_map) or self.make(by_map, patience)

    def _take(self, made: Picture, again: bool | None = None) -> None:
        """Show a picture that was made for the state. again: whether its light was read again."""
        last, state = self.picture, self.state
        if state.view.turning and made.light is last.light and is_next(last.state.recipe, made.state.recipe):
            state = self.state = followed(state, made.light, last.coefficients, made.coefficients)
        if wants_range(state):
            shown = made.state.view
            state = self.state = changed(state, error_range=shown.error_range, range_held=shown.range_held)
        picture = made.seen(state)
        said, other = [], picture.light is not last.light
        if other:
            again = self.reading is not None if again is None else again
            said.append(reading_news(last.state.recipe, state.recipe, picture.light))
            said.append(self._news(picture.light, again=again and state.recipe.light == last.state.recipe.light))
        if other or not last.subject.refusal:
            said.append(why_whole(picture.subject))
        if any(said) and not state.view.message:
            kind = WARNING if (other and picture.light.notes) or said[-1] else ""
            self.state = changed(state, message=Message("; ".join(filter(None, said)), kind))
            picture = replace(picture, state=self.state)
        self.picture = picture

    def keep(self, error: ShviewerError, picture: Picture | None = None) -> None:
        """Stay with the picture there is, or go back to another one, and say why; what plays ends."""
        shown, refused = picture or self.picture, self.state
        message = Message(with_keys(str(error), refused.recipe.light, shown.state.recipe.reading), ERROR)
        self.back_to(shown, message)
        self.refused = None if refused.recipe.light == shown.state.recipe.light else refused.recipe.light
        self.state = changed(self.state, layout_tried=refused.view.layout_tried)
        self.picture = replace(self.picture, state=self.state)
        self.log(f"kept {shown.light.name}: {error}")

    def back_to(self, picture: Picture, message: str = "") -> None:
        """Go back to a picture, seen as the one now is, with a message; what plays ends."""
        shown = picture.seen(self.state)
        keep_light(shown.state.recipe, shown.subject.whole)
        self.state = changed(shown.state, message=message, **STOPPED)
        self.picture = replace(shown, state=self.state)
        self.enough = still(self.state)

    def log(self, text: str) -> None:
        if self.settings.verbose:
            print(text, file=sys.stderr, flush=True)

    def _news(self, light: Light, *, again: bool) -> str:
        """The message about a light that was not shown before."""
        notes = notes_of(light)
        if not again:
            return notes
        self.log(f"reloaded {light.name}")
        return f"reloaded {notes or light.name}"
