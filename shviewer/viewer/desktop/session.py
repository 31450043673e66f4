"""The session: between a key and a frame, what is asked for and when it is done. Knows no window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from threading import Event

from shviewer.analysis.recipe import light_name
from shviewer.analysis.subjects import version_read
from shviewer.lights.several import several
from shviewer.viewer.animation.metronome import SWEEP_SECONDS, TURN_SECONDS, Metronome
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.control.actions import open_light
from shviewer.viewer.control.commands import Command
from shviewer.viewer.control.keys import press
from shviewer.viewer.control.playing import step_sweep, step_turn, wants_range
from shviewer.viewer.desktop.answers import face_mark, fit
from shviewer.viewer.desktop.behind.opening import MOST_DROPPED
from shviewer.viewer.desktop.behind.saving import Saving, Written, write_coefficients
from shviewer.viewer.desktop.behind.task import Wake
from shviewer.viewer.desktop.history import History
from shviewer.viewer.desktop.showing import PLAIN, Settings, Showing
from shviewer.viewer.desktop.watching import Watch
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.message import DONE, WARNING, Passing, warning
from shviewer.viewer.picture import Picture, prepare, still
from shviewer.viewer.state import State, changed, released
from shviewer.viewer.work import Work

PATIENCE = 0.05
"""The longest that a window waits for a task, in seconds."""

STATUS_SECONDS = 0.1
"""Seconds between two looks at how far a task is."""


class Session(Showing):
    """What keys, files and time ask of a picture: states, commands that wait for it, and what plays."""

    def __init__(
        self, state: State, first: Picture | None = None, settings: Settings = PLAIN, wake: Wake = None
    ) -> None:
        super().__init__(state, first, settings, wake)
        self.metronome = Metronome()
        self.saving = Saving(wake, self._written, self.failed)
        self._watch = Watch() if settings.watch else None
        self._marks_faced = 0
        self._later: list[Callable[[], object]] = []
        """Commands that wait for the picture and all its figures."""
        self._said: Work | None = None
        self._message = Passing()
        self._history = History(self.state)

    def press(self, key: str) -> Command | None:
        """Do what a key asks for; a command that only a window can carry out is returned."""
        self._history.note(self.state, by_key=False)
        found = self._press(key)
        self._history.note(self.state, by_key=True)
        return found

    def _press(self, key: str) -> Command | None:
        making = self.making.working and not self.shown and not self.stepping
        if key == "Esc" and (self.work is not None or making):
            self.stop()
            return None
        state, refused = self.state, self.refused
        self.refused = None
        if refused is not None and key in ("L", "Z"):
            state = changed(open_light(state, refused), layout_tried=state.view.layout_tried)
        done = press(state, key)
        if isinstance(done, Command):
            return self.do(done)
        if done.place != state.place:
            around = [done]
            while len(around) < len(done.lights) and isinstance(one := press(around[-1], key), State):
                around.append(one)
            self.open(done, [one.recipe.light for one in around[1:] if one.place != state.place])
        else:
            self.state = done
        return None

    def do(self, command: Command) -> Command | None:
        """Carry a command out; one that only a window can carry out is returned."""
        self.state = changed(self.state, message="")
        match command:
            case Command.RELOAD:
                self.reading = Event()
            case Command.FIT:
                self.when_ready(self._fit)
            case Command.FACE_MARK:
                self.when_ready(self._face_mark)
            case Command.UNDO | Command.REDO:
                self._go_back(undo=command is Command.UNDO)
            case Command.EXPORT:
                self.when_ready(lambda: self.saving.write("writing the coefficients", write_coefficients, self.picture))
            case _:
                return command
        return None

    def _go_back(self, *, undo: bool) -> None:
        """Undo the last step, or do again what was undone."""
        if self.opening.working:  # a light that is not there yet is no step
            self.stop()
            return
        found = self._history.undo(self.state) if undo else self._history.redo(self.state)
        if found is None:
            self.say("there is nothing to undo" if undo else "nothing was undone that could be done again")
            return
        self.state = found
        self.say("undone; Ctrl+Y does it again" if undo else "done again")

    @property
    def working(self) -> bool:
        """Whether anything is done behind the window."""
        return self.making.working or self.saving.working or self.opening.working

    @property
    def waiting(self) -> bool:
        """Whether a command waits for the picture to be there."""
        return bool(self._later)

    @property
    def pace(self) -> float | None:
        """Frames a second of a light that turns, where it cannot keep up; None as long as it does, or is not known."""
        return self.metronome.pace if self.state.view.turning else None

    @property
    def status(self) -> str:
        """What is done behind the window, once it has taken a while; "" while nothing is, or only the light turns on."""
        made = "" if self.stepping else self.making.status
        return made or (self.work.words if self.work is not None else "")

    @property
    def work(self) -> Work | None:
        """The same with how far it is, for the hairline; None where there is no status."""
        return self.opening.work or (None if self.stepping else self.making.work) or self.saving.work

    def stop(self) -> None:
        """End the task, and stay with the picture there is; where there is none, end what is written and copied."""
        work = self.work
        if self.opening.working or not self.making.working:
            (self.opening if self.opening.working else self.saving).stop()
            self.say(f"stopped {work.words if work is not None else ''}".rstrip())
        else:
            what = self.making.doing
            self.making.end()
            self._later.clear()
            self.reading = None
            self.opening.end()
            self.back_to(self.picture, f"stopped {what}".rstrip())

    def back_to(self, picture: Picture, message: str = "") -> None:
        super().back_to(picture, message)
        self._history.back(self.state)

    def drop(self, *paths: str) -> None:
        """Open files, which may have been edited since they were last opened, and what folders hold; never code.

        Left and Right go through them. The first that can be opened is shown.
        """
        found = several(paths, most=MOST_DROPPED)
        if not found.lights:
            self.say("; ".join(found.said) or "nothing that could be opened", WARNING)
            return
        first, *others = found.lights
        if others:  # they come together, wherever some of them were
            lights = (*(light for light in self.state.lights if light not in found.lights), *found.lights)
            self.state = replace(self.state, lights=lights, entry=self.state.entry or self.state.recipe.light)
        self.open(changed(open_light(self.state, first), message=warning("; ".join(found.said))), others, again=True)

    def tick(self, now: float) -> bool:
        """Take a step of what plays and a look at a watched file, where they are due; return whether anything changed."""
        last, reading, said = self.state, self.reading, self._said
        self.opening.take()
        self.saving.take()
        self._said = self.work
        if self._message.over(self.state.view.message, now):
            self.state = changed(self.state, message="")
        self._play(now)
        if self._watch is not None and self._watch.due(now):
            self._look(self._watch)
        return self.making.news or self.state is not last or self.reading is not reading or self._said != said

    def _play(self, now: float) -> None:
        """Take the next step of a sweep or of a light that turns, if it is due and the last one is there."""
        view, ready = self.state.view, not (self.making.working or wants_range(self.state))
        if view.turning:
            if self.metronome.beats(TURN_SECONDS, now, ready=ready and self.shown and not self._later):
                self.state = step_turn(self.placed)  # from where the camera is, or it would go round with the light
        elif self.metronome.beats(None if view.sweep_to is None else SWEEP_SECONDS, now, ready=ready):
            self.state = step_sweep(self.state)

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
        if self.making.working or self._later:
            return min(most, STATUS_SECONDS)
        most = min(most, STATUS_SECONDS) if self.working else most
        return self.metronome.wait(now, most)

    def prepare(self, by_map: bool = False, patience: float | None = None) -> bool:
        """Make the picture of the state; return whether it is complete. For a state that cannot be shown, keep the last one.

        patience: the seconds to wait for it since it was first wished for; None: as long as it takes.
        """
        if patience is None:
            self.opening.finish()
        while self.make(by_map, patience):
            if not self.picture.complete:  # what needs all figures does not get them
                self._later.clear()
            if not self._later:
                if patience is not None or not (self.saving.drawing or self.saving.working):
                    return True
                self.saving.finish()
                continue
            command = self._later.pop(0)
            if command() is False:
                self._later.insert(0, command)
                return True
        return False

    def when_ready(self, command: Callable[[], object]) -> None:
        """Carry a command out that needs the picture with all figures: now, or when they are there.

        One that returns False is tried again in the next frame.
        """
        self.enough = None
        self._later.append(command)
        self.prepare(self.by_map, PATIENCE)

    def save(self, renderer: Renderer, composition: Composition) -> None:
        """Save the picture, as soon as it is there, under the next free name in the current folder."""
        asked = still(self.state)
        self.when_ready(lambda: self._save(asked, renderer, composition))

    def _save(self, asked: State, renderer: Renderer, composition: Composition) -> bool:
        """Have the picture drawn and saved, if it is the one asked for; False while its map is on its way to OpenGL."""
        ranged = not asked.view.range_held  # what plays may have been given its range since
        if still(changed(self.state, **released(self.state.view)) if ranged else self.state) != asked:
            if not self.state.view.message:
                self.say("not saved: there was another wish before the picture was there", WARNING)
            return True
        state = changed(self.state, message="")
        return self.saving.picture(renderer, prepare(state) if self.by_map else self.picture.seen(state), composition)

    def make_text(self, words: str, make: Callable[[], str], give: Callable[[str], None]) -> None:
        """Make a text behind the window, when the picture is there, and give it."""
        self.when_ready(lambda: self.saving.text(words, make, give))

    def _written(self, written: Written) -> None:
        path, what = written
        self.say(f"saved {path.name}{f' ({what})' if what else ''} in {path.parent.absolute()}", DONE)
        self.log(f"saved {path}")

    def _fit(self) -> None:
        self.state = fit(self.state, self.picture)

    def _face_mark(self) -> None:
        self.state, self._marks_faced = face_mark(self.state, self.picture, self._marks_faced)
