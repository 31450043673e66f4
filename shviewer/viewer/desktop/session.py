"""The session: between a key and a frame, one state and its picture, kept together whatever fails. Knows no window.

What takes time is made behind the window. Until there is a picture, the last one stays, seen from where the camera is now.
Figures that are searched for come after the picture.
"""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import ParamSpec

from shviewer.analysis.recipe import light_name
from shviewer.analysis.subjects import keep_light, version_read
from shviewer.errors import ShviewerError, within_memory
from shviewer.lights.light import Light
from shviewer.lights.several import several
from shviewer.viewer.actions import Command, open_light, step_sweep
from shviewer.viewer.animation.animation import wants_range
from shviewer.viewer.animation.metronome import Metronome
from shviewer.viewer.animation.turning import followed, is_next, only_turned, step_turn
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.desktop.answers import face_mark, fit
from shviewer.viewer.desktop.errands import Errands, save_coefficients, save_picture
from shviewer.viewer.desktop.making import Making
from shviewer.viewer.desktop.messages import notes_of, reading_news, with_keys
from shviewer.viewer.desktop.opening import MOST_DROPPED, Opening
from shviewer.viewer.desktop.turning import Turning
from shviewer.viewer.desktop.watching import Watch
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.keys import press
from shviewer.viewer.message import DONE, ERROR, WARNING, Message, Passing
from shviewer.viewer.overlay.foot import Work
from shviewer.viewer.picture import Picture, prepare, still
from shviewer.viewer.screenshot import render_rgb
from shviewer.viewer.state import State, changed, started
from shviewer.viewer.view import View
from shviewer.words import one_line

P = ParamSpec("P")

PATIENCE = 0.05
"""The longest that a window waits for a task, in seconds."""

STATUS_SECONDS = 0.1
"""Seconds between two looks at how far a task is."""


class Session:
    """The state, and its picture or that of the last state that could be shown."""

    def __init__(
        self,
        state: State,
        first: Picture | None = None,
        *,
        verbose: bool = False,
        watch: bool = False,
        as_image: bool = False,
        wake: Callable[[], None] | None = None,
    ) -> None:
        """first: the picture of the state; without it, it is made here: LightError or UsageError if that is impossible.

        as_image: take pictures that this program saved for images. wake: called from another thread when a task has ended.
        """
        first = first or prepare(state)
        reading = state.recipe.reading  # from now on no pipe is waited for: it was read where the command line named it
        isolated = replace(reading, isolated=True, limits=replace(reading.limits, pipe_seconds=0))
        self.state = started(changed(state, reading=isolated))
        self.state = changed(self.state, message=state.view.message or notes_of(first.light))
        self.picture: Picture = replace(first, state=self.state)
        self.by_map = False
        self.verbose = verbose
        self.metronome = Metronome()
        self.turn = Turning()
        self._watch = Watch() if watch else None
        self._reading: Event | None = None
        """The wish to read the light's file again, set once it has been read; None if there is no such wish."""
        self._opening = Opening(wake, as_image=as_image)
        self._refused: str | Light | None = None
        """The light that could not be read just now: the next key may say how to read it."""
        self._marks_faced = 0
        self._making = Making(wake)
        self._enough: State | None = None
        """The still part of the state whose figures are not wanted any more: the search was stopped, or failed."""
        self._later: list[Callable[[], object]] = []
        """Commands that wait for the picture and all its figures."""
        self.errands = Errands(wake)
        self._said: Work | None = None
        self._message = Passing()

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
        return f"shviewer - {self.picture.light.name}"

    def press(self, key: str) -> Command | None:
        """Do what a key asks for; a command that only a window can carry out is returned."""
        making = self._making.working and not self._shown and not self._stepping
        if key == "Esc" and (self.work is not None or making):
            self.stop()
            return None
        state, refused = self.state, self._refused
        self._refused = None
        if refused is not None and key in ("L", "Z"):
            state = changed(open_light(state, refused), layout_tried=state.view.layout_tried)
        done = press(state, key)
        if isinstance(done, Command):
            return self.do(done)
        if done.place != state.place:
            around = [done]
            while len(around) < len(done.lights) and isinstance(one := press(around[-1], key), State):
                around.append(one)
            self._open(done, [one.recipe.light for one in around[1:] if one.place != state.place])
        else:
            self.state = done
        return None

    def do(self, command: Command) -> Command | None:
        """Carry a command out; one that only a window can carry out is returned."""
        self.state = changed(self.state, message="")
        if command is Command.RELOAD:
            self._reading = Event()
        elif command is Command.FIT:
            self.when_ready(self._fit)
        elif command is Command.FACE_MARK:
            self.when_ready(self._face_mark)
        elif command is Command.EXPORT:
            self.when_ready(lambda: self._write("writing the coefficients", save_coefficients, self.picture))
        else:
            return command
        return None

    @property
    def working(self) -> bool:
        """Whether anything is done behind the window."""
        return self._making.working or self.errands.working or self._opening.working

    @property
    def waiting(self) -> bool:
        """Whether a command waits for the picture to be there."""
        return bool(self._later)

    @property
    def _shown(self) -> bool:
        """Whether the picture is that of the state, with its figures or without."""
        same = still(self.state) == still(self.picture.state)
        return self._reading is None and same and not wants_range(self.state)

    @property
    def _stepping(self) -> bool:
        """Whether what is being made is the next frame of a light that turns."""
        state, last = self.state, self.picture.state
        return bool(state.view.turning) and only_turned(last.recipe, state.recipe) and self._reading is None

    @property
    def pace(self) -> float | None:
        """Frames a second of a light that turns, where it cannot keep up; None as long as it does, or is not known."""
        return self.turn.pace if self.state.view.turning else None

    @property
    def status(self) -> str:
        """What is done behind the window, once it has taken a while; "" while nothing is, or only the light turns on."""
        made = "" if self._stepping else self._making.status
        return made or (self.work.words if self.work is not None else "")

    @property
    def work(self) -> Work | None:
        """The same with how far it is, for the hairline; None where there is no status."""
        return self._opening.work or (None if self._stepping else self._making.work) or self.errands.work

    def stop(self) -> None:
        """End the task, and stay with the picture there is; where there is none, end what is written and copied."""
        work = self.work
        if self._opening.working or not self._making.working:
            (self._opening if self._opening.working else self.errands).stop()
            self.say(f"stopped {work.words if work is not None else ''}".rstrip())
        else:
            what = self._making.doing
            self._making.end()
            self._later.clear()
            self._reading = None
            self._opening.end()
            keep_light(self.picture.state.recipe, self.picture.subject.whole)
            self.state = changed(self.picture.state, message=f"stopped {what}".rstrip(), sweep_to=None, turning="")
            self._enough = still(self.picture.state)

    def drop(self, *paths: str) -> None:
        """Open files, which may have been edited since they were last opened, and what folders hold; never code.

        Left and Right go through them. The first that can be opened is shown.
        """
        found = several(paths, most=MOST_DROPPED)
        if not found.lights:
            self.say("; ".join(found.said) or "nothing that could be opened")
            return
        first, *others = found.lights
        if others:  # they come together, wherever some of them were
            lights = (*(light for light in self.state.lights if light not in found.lights), *found.lights)
            self.state = replace(self.state, lights=lights, entry=self.state.entry or self.state.recipe.light)
        self._open(changed(open_light(self.state, first), message="; ".join(found.said)), others, again=True)

    def _open(self, state: State, others: Sequence[str | Light], *, again: bool = False) -> None:
        """Show the light that the state was given, or where it cannot be opened the next of the others.

        again: read the light's file again.
        """

        def opened(found: State) -> None:
            self.state = found
            if again:
                self._reading = Event()

        def refused(error: ShviewerError) -> None:
            if not self._pass_over(state, error):
                self.say(str(error), ERROR)
            elif again:
                self._reading = Event()

        self._opening.begin(state, others, opened, refused)

    def _pass_over(self, tried: State, error: ShviewerError) -> bool:
        """Go on from a light that cannot be opened to the next of those that were asked for; return whether there is one."""
        state = self._opening.next(tried, error, self.picture.state)
        self.state = state or self.state
        return state is not None

    def say(self, text: str, kind: str = "") -> None:
        """Show a message of a kind, on one line."""
        self.state = changed(self.state, message=Message(one_line(text), kind))

    def tick(self, now: float) -> bool:
        """Take a step of what plays and a look at a watched file, where they are due; return whether anything changed."""
        last, reading, said = self.state, self._reading, self._said
        self._opening.take()
        self.errands.take()
        self._said = self.work
        if self._message.over(self.state.view.message, now):
            self.state = changed(self.state, message="")
        settled = not (self._making.working or wants_range(self.state))
        if settled and self.metronome.beats(self.state.view.sweep_to is not None, now):
            self.state = step_sweep(self.state)
        ready = self._shown and not self._making.working and not self._later
        if self.turn.beats(bool(self.state.view.turning), now, ready=ready):
            self.state = step_turn(self.placed)  # from where the camera is, or it would go round with the light
        if self._watch is not None and self._watch.due(now):
            self._look(self._watch)
        return self._making.news or self.state is not last or self._reading is not reading or self._said != said

    def _look(self, watch: Watch) -> None:
        """Look at the watched file: read it again if it has changed, and say once that it is gone."""
        recipe = self.state.recipe
        if not isinstance(recipe.light, str):
            return
        before = watch.gone
        if watch.changed(recipe.light, version_read(recipe)):
            self.do(Command.RELOAD)
        elif watch.gone and not before:
            self.say(f"{light_name(recipe.light)} is gone: shown as it was read, and waited for", WARNING)

    def wait(self, now: float, most: float) -> float:
        """The seconds until the next tick is due, at most `most`."""
        if self._making.working or self._later:
            return min(most, STATUS_SECONDS)
        most = min(most, STATUS_SECONDS) if self.working else most
        return self.turn.wait(now, self.metronome.wait(now, most))

    def prepare(self, by_map: bool = False, patience: float | None = None) -> bool:
        """Make the picture of the state; return whether it is complete. For a state that cannot be shown, keep the last one.

        patience: the seconds to wait for it since it was first wished for; None: as long as it takes.
        """
        if patience is None:
            self._opening.finish()
        while self._make(by_map, patience):
            if not self.picture.complete:  # what needs all figures does not get them
                self._later.clear()
            if not self._later:
                if patience is None:
                    self.errands.finish()
                return True
            command = self._later.pop(0)
            if command() is False:
                self._later.insert(0, command)
                return True
        return False

    def _make(self, by_map: bool, patience: float | None) -> bool:
        """Make the picture; return whether it has all figures that are wanted."""
        last, state, reading = self.picture, self.state, self._reading
        if self._shown and by_map == self.by_map and (last.complete or still(state) == self._enough):
            self._making.end()
            self.picture = last if last.state == state else last.seen(state)
            return True
        self._making.want(state, by_map, reading)
        if not self._making.wait(patience):
            if (latest := self._making.latest()) is not None:
                self._take(*latest)
            elif last.state.view != state.view:
                self.picture = last.seen(state)
            return False
        self._reading = None
        try:
            with within_memory(light_name(state.recipe.light)):
                picture, made_by_map = self._making.result()
        except ShviewerError as error:
            if self._pass_over(state, error):
                return self._make(by_map, patience)
            self.keep(error)
            return True
        except Exception as error:  # a fault of this program: the session goes on with the picture there is
            traceback.print_exception(error)
            self.keep(ShviewerError("internal error, see the terminal"))
            return True
        self._refused = None
        self._opening.end()
        self._take(picture, made_by_map, again=reading is not None)
        return made_by_map == by_map or self._make(by_map, patience)

    def _take(self, made: Picture, by_map: bool, again: bool | None = None) -> None:
        """Show a picture that was made for the state. again: whether its light was read again."""
        last, state = self.picture, self.state
        if state.view.turning and made.light is last.light and is_next(last.state.recipe, made.state.recipe):
            state = self.state = followed(state, made.light, last.coefficients, made.coefficients)
        if wants_range(state):
            shown = made.state.view
            state = self.state = changed(state, error_range=shown.error_range, range_held=shown.range_held)
        picture = made.seen(state)
        if picture.light is not last.light:
            again = self._reading is not None if again is None else again
            message = self._news(picture.light, again=again and state.recipe.light == last.state.recipe.light)
            message = "; ".join(filter(None, (reading_news(last.state.recipe, state.recipe), message)))
            if message and not state.view.message:
                message = Message(message, WARNING if picture.light.notes else "")
                self.state = changed(state, message=message)
                picture = replace(picture, state=self.state)
        self.picture, self.by_map = picture, by_map

    def when_ready(self, command: Callable[[], object]) -> None:
        """Carry a command out that needs the picture with all figures: now, or when they are there.

        One that returns False is tried again in the next frame.
        """
        self._enough = None
        self._later.append(command)
        self.prepare(self.by_map, PATIENCE)

    def keep(self, error: ShviewerError, picture: Picture | None = None) -> None:
        """Stay with the picture there is, or go back to another one, and say why; what plays ends."""
        shown, refused = picture or self.picture, self.state
        message = Message(with_keys(str(error), refused.recipe.light, shown.state.recipe.reading), ERROR)
        self.back_to(shown, message)
        self._refused = None if refused.recipe.light == shown.state.recipe.light else refused.recipe.light
        self.state = changed(self.state, layout_tried=refused.view.layout_tried)
        self.picture = replace(self.picture, state=self.state)
        self._log(f"kept {shown.light.name}: {error}")

    def back_to(self, picture: Picture, message: str) -> None:
        """Go back to a picture, seen as the one now is, with a message; what plays ends."""
        shown = picture.seen(self.state)
        keep_light(shown.state.recipe, shown.subject.whole)
        self.state = changed(shown.state, message=message, sweep_to=None, turning="")
        self.picture = replace(shown, state=self.state)
        self._enough = still(self.state)

    def save(self, renderer: Renderer, composition: Composition) -> None:
        """Save the picture, as soon as it is there, under the next free name in the current folder."""
        self.when_ready(lambda: self._save(renderer, composition))

    def _save(self, renderer: Renderer, composition: Composition) -> bool:
        """Draw and save the picture; False while its map is on its way to OpenGL."""
        state = changed(self.state, message="")
        picture = prepare(state) if self.by_map else self.picture.seen(state)
        if not renderer.show(picture, 0.0):
            return False
        pixels = render_rgb(renderer, picture, composition)
        self._write("saving the picture", save_picture, picture, composition, renderer.version, pixels)
        return True

    def _write(self, words: str, write: Callable[P, Path], *arguments: P.args, **named: P.kwargs) -> None:
        """Write a file behind the window, and say which one and in which folder, or why not."""
        self.errands.run(words, lambda: write(*arguments, **named), self._written, self._failed)

    def _written(self, path: Path) -> None:
        self.say(f"saved {path} in {Path.cwd()}", DONE)
        self._log(f"saved {path}")

    def _failed(self, error: ShviewerError) -> None:
        self.say(str(error), ERROR)

    def make_text(self, words: str, make: Callable[[], str], give: Callable[[str], None]) -> None:
        """Make a text behind the window, when the picture is there, and give it."""
        self.when_ready(lambda: self.errands.run(words, make, give, self._failed))

    def _news(self, light: Light, *, again: bool) -> str:
        """The message about a light that was not shown before."""
        notes = notes_of(light)
        if not again:
            return notes
        self._log(f"reloaded {light.name}")
        return f"reloaded {notes or light.name}"

    def _fit(self) -> None:
        self.state = fit(self.state, self.picture)

    def _face_mark(self) -> None:
        self.state, self._marks_faced = face_mark(self.state, self.picture, self._marks_faced)

    def _log(self, text: str) -> None:
        if self.verbose:
            print(text, file=sys.stderr, flush=True)
