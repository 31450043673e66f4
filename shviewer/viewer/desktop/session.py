"""The session: between a key and a frame, one state and its picture, kept together whatever fails. Knows no window."""

from __future__ import annotations

import sys
import traceback
from dataclasses import replace
from time import perf_counter

from shviewer.analysis.figures import needs
from shviewer.analysis.subjects import keep_light, read_again, version_read
from shviewer.errors import ShviewerError
from shviewer.files import file_stem
from shviewer.lights.find import split_light
from shviewer.lights.light import Light
from shviewer.viewer.actions import Command, open_light, step_sweep, with_bands
from shviewer.viewer.animation.metronome import Metronome
from shviewer.viewer.camera import facing
from shviewer.viewer.composition import Composition
from shviewer.viewer.desktop.messages import notes_of, reading_news, with_keys
from shviewer.viewer.desktop.watching import Watch
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.keys import press
from shviewer.viewer.overlay.marks import marks_of
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.saving.picture_files import write_numbered
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.screenshot import render_rgb
from shviewer.viewer.state import State, changed
from shviewer.words import one_line

LOOK_SECONDS = 0.2
"""The least time between two looks at a watched file, also while events come."""

LONG_PROJECTION = 1e8
"""The number of basis values from which a projection is announced: about half a second."""


class Session:
    """The state, and its picture or that of the last state that could be shown."""

    def __init__(self, state: State, *, verbose: bool = False, watch: bool = False) -> None:
        """LightError or UsageError if the first state cannot be shown."""
        first = prepare(state)
        isolated = replace(state.recipe.reading, isolated=True)
        self.state = changed(state, reading=isolated, message=state.view.message or notes_of(first.light))
        self.picture: Picture = replace(first, state=self.state)
        self.by_map = False
        self.verbose = verbose
        self.metronome = Metronome()
        self._watch = Watch() if watch else None
        self._looked_at = perf_counter()
        self._read_anew = False
        self._marks_faced = 0

    @property
    def title(self) -> str:
        return f"shviewer - {self.picture.light.name}"

    def press(self, key: str) -> Command | None:
        """Do what a key asks for; a command that only a window can carry out is returned."""
        done = press(self.state, key)
        if isinstance(done, Command):
            return self.do(done)
        self.state = done
        return None

    def do(self, command: Command) -> Command | None:
        """Carry a command out; one that only a window can carry out is returned."""
        self.state = changed(self.state, message="")
        if command is Command.RELOAD:
            self._read_anew = True
        elif command is Command.FIT:
            self._fit()
        elif command is Command.FACE_MARK:
            self._face_mark()
        else:
            return command
        return None

    def drop(self, path: str) -> None:
        """Open a file, which may have been edited since it was last opened; never code, which is no file."""
        file, part = split_light(path)
        if part and file.suffix.lower() == ".py":
            message = one_line(f"{path}: code runs only when the command line names it")
            self.state = changed(self.state, message=message)
            return
        self.state = open_light(self.state, path)
        self._read_anew = True

    def tick(self, now: float) -> bool:
        """Take a step of the sweep and a look at a watched file, where they are due; return whether anything changed."""
        last, anew = self.state, self._read_anew
        if self.metronome.beats(self.state.view.sweep_to is not None, now):
            self.state = step_sweep(self.state)
        if self._watch is not None and now - self._looked_at >= LOOK_SECONDS:
            self._looked_at = now
            recipe = self.state.recipe
            if isinstance(recipe.light, str) and self._watch.changed(recipe.light, version_read(recipe)):
                self.do(Command.RELOAD)
        return self.state is not last or self._read_anew != anew

    def prepare(self, by_map: bool = False) -> None:
        """Make the picture of the state. For a state that cannot be shown, keep the present picture and say why."""
        last, anew = self.picture, self._read_anew
        if last.state == self.state and self.by_map == by_map and not anew:
            return
        self._read_anew = False
        try:
            if anew:
                read_again(self.state.recipe)
            picture = prepare(self.state, by_map=by_map)
        except ShviewerError as error:
            self.keep(error)
            return
        except Exception:  # a fault of this program: the session goes on with the picture there is
            traceback.print_exc()
            self.keep(ShviewerError("internal error, see the terminal"))
            return
        if picture.light is not last.light:
            message = self._news(picture.light, again=anew and self.state.recipe.light == last.state.recipe.light)
            message = "; ".join(filter(None, (reading_news(last.state.recipe, self.state.recipe), message)))
            if message and not self.state.view.message:
                self.state = changed(self.state, message=message)
                picture = replace(picture, state=self.state)
        self.picture, self.by_map = picture, by_map

    def keep(self, error: ShviewerError, picture: Picture | None = None) -> None:
        """Stay with the picture there is, or go back to another one, and say why; a sweep ends."""
        shown = picture or self.picture
        keep_light(shown.state.recipe, shown.subject.whole)
        message = with_keys(str(error), self.state.recipe.light, shown.state.recipe.reading)
        tried = self.state.view.layout_tried
        self.state = changed(shown.state, message=message, sweep_to=None, layout_tried=tried)
        self.picture = replace(shown, state=self.state)
        self._log(f"kept {shown.light.name}: {error}")

    def announcement(self) -> str:
        """The message over the last picture while a long projection runs; "" if the projection is short."""
        recipe, last = self.state.recipe, self.picture.state.recipe
        new = self._read_anew or (recipe.light, recipe.reading, recipe.method, recipe.samples) != (
            last.light,
            last.reading,
            last.method,
            last.samples,
        )
        if recipe.method != "jittered" or not new or recipe.samples * recipe.projected_bands**2 < LONG_PROJECTION:
            return ""
        return f"projecting {recipe.samples} samples to {recipe.projected_bands} bands ..."

    def save(self, renderer: Renderer, composition: Composition) -> None:
        """Save the picture under the next free name in the current folder."""
        self.prepare()
        self.state = changed(self.state, message="")
        self.prepare()
        try:
            pixels = render_rgb(renderer, self.picture, composition)
            text = metadata(self.picture, composition, renderer.version)
            path = write_numbered(f"shviewer-{file_stem(self.picture.light.name)}", pixels, text)
        except ShviewerError as error:
            self.state = changed(self.state, message=str(error))
        else:
            self.state = changed(self.state, message=f"saved {path}")
            self._log(f"saved {path}")

    def _news(self, light: Light, *, again: bool) -> str:
        """The message about a light that was not shown before."""
        notes = notes_of(light)
        if not again:
            return notes
        self._log(f"reloaded {light.name}")
        return f"reloaded {notes or light.name}"

    def _fit(self) -> None:
        """Use as many bands as the tolerance needs; where none are enough, say what is the best there is."""
        self.prepare()
        found = needs(self.state.recipe)
        wanted = found.irradiance if self.state.recipe.quantity == "irradiance" else found.radiance
        if wanted is None:
            best = f"the best is {100 * found.best:.3g} % with {found.best_bands}"
            message = f"no band count is within {100 * found.tolerance:g} %: {best}"
            self.state = changed(with_bands(self.state, found.best_bands), message=message)
        else:
            self.state = with_bands(self.state, wanted)

    def _face_mark(self) -> None:
        """Turn the spheres so that the next mark is in front."""
        self.prepare()
        marks = marks_of(self.picture)
        if not marks:
            message = "nothing is marked: X marks what is negative, D shows the error and marks where it is largest"
            self.state = changed(self.state, message=message)
            return
        direction = self.picture.light_from_world.T @ marks[self._marks_faced % len(marks)].direction
        self._marks_faced += 1
        self.state = changed(self.state, camera=facing(direction))

    def _log(self, text: str) -> None:
        if self.verbose:
            print(text, file=sys.stderr, flush=True)
