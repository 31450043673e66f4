"""The window: what GLFW reports becomes a new state, and a changed state becomes a frame.

Nothing is drawn and no time is spent while nothing happens. GLFW is asked to return four times a second all the same, so
that Ctrl-C in the terminal is heard at once; a watched file is looked at then, too.
"""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from time import perf_counter
from typing import Any

import glfw
import moderngl

from shviewer.analysis.figures import needs
from shviewer.analysis.subjects import keep_light, read_again, version_read
from shviewer.errors import ShviewerError
from shviewer.files import file_stem
from shviewer.lights.light import Light
from shviewer.limits import MAX_BANDS, MAX_DIRECT_BANDS
from shviewer.viewer.actions import open_light, orbit, reload, rotate_light, step_sweep, toggle_band, with_bands, zoom
from shviewer.viewer.animation.metronome import Metronome
from shviewer.viewer.camera import facing
from shviewer.viewer.composition import Composition, compose
from shviewer.viewer.desktop.canvas import Canvas
from shviewer.viewer.desktop.glfw_window import key_name, open_window
from shviewer.viewer.desktop.messages import notes_of, reading_news, with_keys
from shviewer.viewer.desktop.watching import Watch
from shviewer.viewer.keys import press
from shviewer.viewer.overlay.marks import marks_of
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.picture_files import metadata, write_numbered
from shviewer.viewer.screenshot import render_rgb
from shviewer.viewer.state import ViewState

IDLE_SECONDS = 0.25
LOOK_SECONDS = 0.2
"""At least so far apart are two looks at a watched file, also while events come; just below IDLE_SECONDS."""

LONG_PROJECTION = 1e8
"""Basis values, about half a second of them."""

CLICK_PIXELS = 4.0
"""A press that moves less than this before its release is a click."""


def run(state: ViewState, size: tuple[int, int], *, verbose: bool = False, watch: bool = False) -> None:
    """Open a window of `size` screen coordinates and stay until it is closed.

    NoDisplayError without a display, GraphicsError without OpenGL 3.3. verbose: one line on stderr per frame. watch: read
    the light's file again when it changes.
    """
    with open_window(size) as handle:
        window = Window(handle, state, verbose, watch)
        try:
            window.loop()
        finally:
            window.canvas.release()


class Window:
    """One window, one state, one canvas."""

    def __init__(self, handle: Any, state: ViewState, verbose: bool, watch: bool = False) -> None:
        self.handle = handle
        first = prepare(state)
        self.state = replace(state, reading=replace(state.reading, isolated=True))
        message = self.state.message or notes_of(first.light)
        self.state = replace(self.state, message=message)
        self.picture: Picture = replace(first, state=self.state)
        self.watch = Watch() if watch else None
        self.looked_at = perf_counter()
        self.metronome = Metronome()
        self.verbose = verbose
        self.canvas = Canvas(moderngl.create_context(require=330))
        self.frames_due = 2  # the first swap may still have the old size
        self.frame_count = 0
        self.pressed_at: tuple[float, float] | None = None
        self.mouse = self.dragged_to = (0.0, 0.0)
        self.dragged = self.hovering = False
        self.by_map = False
        self.windowed_place = (0, 0, 1280, 640)
        glfw.set_key_callback(handle, self._on_key)
        glfw.set_char_callback(handle, self._on_char)
        glfw.set_mouse_button_callback(handle, self._on_button)
        glfw.set_cursor_pos_callback(handle, self._on_cursor)
        glfw.set_cursor_enter_callback(handle, self._on_enter)
        glfw.set_scroll_callback(handle, lambda window, dx, dy: self.change(zoom(self.state, dy)))
        glfw.set_drop_callback(handle, self._on_drop)  # type: ignore[arg-type]  # the stub shows the C signature
        glfw.set_framebuffer_size_callback(handle, lambda *_: self.redraw())
        glfw.set_window_refresh_callback(handle, lambda *_: self.redraw())
        glfw.set_window_title(handle, f"shviewer - {self.picture.light.name}")

    def loop(self) -> None:
        """Draw what is due, then sleep until something happens or a sweep takes its next step."""
        while not glfw.window_should_close(self.handle):
            if self.frames_due:
                self.frame()
            if self.frames_due:
                glfw.poll_events()
            else:
                glfw.wait_events_timeout(self.metronome.wait(perf_counter(), IDLE_SECONDS))
            if self.metronome.beats(self.state.sweep_to is not None, perf_counter()):
                self.change(step_sweep(self.state))
            if self.watch is not None:
                self._look(self.watch)

    def redraw(self) -> None:
        self.frames_due = 2

    def change(self, state: ViewState) -> None:
        """Take a new state and grant its wishes; one that cannot be shown leaves the present light and says why."""
        last = self.state
        self.state = state
        if state.closing:
            glfw.set_window_should_close(self.handle, True)
        if state.fullscreen != last.fullscreen:
            self._set_fullscreen(state.fullscreen)
        if state.screenshots != last.screenshots:
            self._save()
        if state.fits != last.fits:
            self._fit()
        if state.looks != last.looks:
            self._face_mark()
        self.frames_due = max(self.frames_due, 1)

    def frame(self) -> None:
        """Draw the present state."""
        self.frames_due -= 1
        composition = self.composition()
        if composition is None:
            return
        start = perf_counter()
        self._announce(composition)
        last = self.picture
        self._prepare(self.canvas.by_map(self.state, composition))
        composition = self.composition() or composition  # a state that was refused has left another one
        try:
            self.canvas.show(self.picture, composition)
        except ShviewerError as error:  # a map that this OpenGL cannot hold
            self.picture = last
            glfw.set_window_title(self.handle, f"shviewer - {last.light.name}")
            self._keep(error)
            self.canvas.show(self.picture, composition)
        if self.canvas.draw(composition, self.mouse if self.hovering and not self.dragged else None):
            self.frames_due = max(self.frames_due, 1)
        glfw.swap_buffers(self.handle)
        self.frame_count += 1
        if self.verbose:
            milliseconds = 1000 * (perf_counter() - start)
            print(
                f"frame {self.frame_count}: {self.picture.light.name}, {self.state.n_bands} bands, "
                f"{composition.width} x {composition.height}, {milliseconds:.1f} ms",
                file=sys.stderr,
                flush=True,
            )

    def composition(self) -> Composition | None:
        """The layout of the framebuffer, which may be larger than the window (HiDPI); None while minimised."""
        width, height = glfw.get_framebuffer_size(self.handle)
        if width * height == 0:
            return None
        scale = float(glfw.get_window_content_scale(self.handle)[1])
        return compose(width, height, self.state.zoom, scale if scale > 0 else 1.0, self.state.n_spheres)

    def _look(self, watch: Watch) -> None:
        """Read the light's file again if it has changed."""
        now = perf_counter()
        if now - self.looked_at < LOOK_SECONDS:
            return
        self.looked_at = now
        if isinstance(self.state.light, str) and watch.changed(self.state.light, version_read(self.state)):
            self.change(reload(replace(self.state, message="")))

    def _keep(self, error: ShviewerError) -> None:
        """Stay with the picture there is, and say why; a sweep ends, whose next step would take that away."""
        keep_light(self.picture.state, self.picture.subject.whole)
        names = ("fullscreen", "closing", "screenshots", "fits", "looks", "layout_tried")
        wishes = {name: getattr(self.state, name) for name in names}
        message = with_keys(str(error), self.state.light, self.picture.state.reading)
        self.state = replace(self.picture.state, message=message, sweep_to=None, **wishes)
        self.picture = replace(self.picture, state=self.state)
        if self.verbose:
            print(f"kept {self.picture.light.name}: {error}", file=sys.stderr, flush=True)

    def _announce(self, composition: Composition) -> None:
        """Before a projection that takes long, say so over the last picture."""
        state = self.state
        last = self.picture.state
        new = (state.light, state.reading, state.method, state.samples, state.reloads) != (
            last.light,
            last.reading,
            last.method,
            last.samples,
            last.reloads,
        )
        bands = MAX_DIRECT_BANDS if state.n_bands <= MAX_DIRECT_BANDS else MAX_BANDS
        if state.method != "jittered" or not new or state.samples * bands**2 < LONG_PROJECTION:
            return
        message = f"projecting {state.samples} samples to {bands} bands ..."
        self.canvas.say(message, self.picture, composition)
        glfw.swap_buffers(self.handle)

    def _prepare(self, by_map: bool = False) -> None:
        last = self.picture
        if last.state == self.state and self.by_map == by_map:
            return
        anew = self.state.reloads != last.state.reloads
        try:
            if anew:
                read_again(self.state)
            picture = prepare(self.state, by_map=by_map)
        except ShviewerError as error:
            self._keep(error)
            return
        if picture.light is not last.light:
            glfw.set_window_title(self.handle, f"shviewer - {picture.light.name}")
            message = self._news(picture.light, again=anew and self.state.light == last.state.light)
            message = "; ".join(filter(None, (reading_news(last.state, self.state), message)))
            if message and not self.state.message:
                self.state = replace(self.state, message=message)
                picture = replace(picture, state=self.state)
        self.picture, self.by_map = picture, by_map

    def _news(self, light: Light, *, again: bool) -> str:
        """What is worth saying of a light that was not shown before."""
        notes = notes_of(light)
        if not again:
            return notes
        if self.verbose:
            print(f"reloaded {light.name}", file=sys.stderr, flush=True)
        return f"reloaded {notes or light.name}"

    def _save(self) -> None:
        composition = self.composition()
        if composition is None:
            return
        self._prepare()
        self.state = replace(self.state, message="")
        self._prepare()
        try:
            pixels = render_rgb(self.canvas.renderer, self.picture, composition)
            text = metadata(self.picture, composition, self.canvas.renderer.version)
            path = write_numbered(f"shviewer-{file_stem(self.picture.light.name)}", pixels, text)
        except ShviewerError as error:
            self.state = replace(self.state, message=str(error))
        else:
            self.state = replace(self.state, message=f"saved {path}")
            if self.verbose:
                print(f"saved {path}", file=sys.stderr, flush=True)

    def _fit(self) -> None:
        """As many bands as the tolerance needs; where none are enough, the best there is, and say so."""
        self._prepare()
        found = needs(self.state)
        wanted = found.irradiance if self.state.quantity == "irradiance" else found.radiance
        if wanted is None:
            best = f"the best is {100 * found.best:.3g} % with {found.best_bands}"
            message = f"no band count is within {100 * found.tolerance:g} %: {best}"
            self.state = replace(with_bands(self.state, found.best_bands), message=message)
        else:
            self.state = with_bands(self.state, wanted)

    def _face_mark(self) -> None:
        """Turn the spheres so that the next mark is in front."""
        self._prepare()
        marks = marks_of(self.picture)
        if not marks:
            message = "nothing is marked: X marks what is negative, D shows the error and marks where it is largest"
            self.state = replace(self.state, message=message)
            return
        direction = self.picture.light_from_world.T @ marks[(self.state.looks - 1) % len(marks)].direction
        self.state = replace(self.state, camera=facing(direction))

    def _set_fullscreen(self, fullscreen: bool) -> None:
        if fullscreen:
            self.windowed_place = (*glfw.get_window_pos(self.handle), *glfw.get_window_size(self.handle))
            monitor = glfw.get_primary_monitor()
            mode = glfw.get_video_mode(monitor)
            glfw.set_window_monitor(self.handle, monitor, 0, 0, mode.size.width, mode.size.height, mode.refresh_rate)
        else:
            glfw.set_window_monitor(self.handle, None, *self.windowed_place, 0)  # type: ignore[arg-type]  # None: no monitor
        self.redraw()

    def _on_key(self, window: Any, code: int, scancode: int, action: int, modifiers: int) -> None:
        if action != glfw.RELEASE:  # a key held down repeats
            self.change(press(self.state, key_name(code, scancode, modifiers)))

    def _on_char(self, window: Any, codepoint: int) -> None:
        if chr(codepoint) == "?":  # wherever the layout has it
            self.change(press(self.state, "?"))

    def _on_button(self, window: Any, button: int, action: int, modifiers: int) -> None:
        if button != glfw.MOUSE_BUTTON_LEFT:
            return
        if action == glfw.PRESS:
            self.pressed_at = self.dragged_to = self.mouse
            self.dragged = False
        elif self.pressed_at is not None:
            overlay = None if self.dragged or self.state.help_visible else self.canvas.overlay
            bars = overlay.bars if overlay is not None else {}
            for band, box in bars.items():
                if box.contains(*self.pressed_at):
                    self.change(toggle_band(replace(self.state, message=""), band))
            self.pressed_at = None
            if self.dragged:
                self.dragged = False
                self.redraw()

    def _on_cursor(self, window: Any, x: float, y: float) -> None:
        """Remember where the mouse is, in pixels of the framebuffer, and drag.

        The place comes with the event: asking for it would give where the mouse is by now, events later.
        """
        window_size, pixels = glfw.get_window_size(self.handle), glfw.get_framebuffer_size(self.handle)
        scale = pixels[0] / max(window_size[0], 1), pixels[1] / max(window_size[1], 1)
        self.mouse = math.floor(x * scale[0]) + 0.5, math.floor(y * scale[1]) + 0.5  # the middle of a pixel
        composition = self.composition()
        if composition is None:
            return
        if self.pressed_at is None:
            self._hover(composition)
            return
        moved = max(abs(self.mouse[0] - self.pressed_at[0]), abs(self.mouse[1] - self.pressed_at[1]))
        if not self.dragged and moved < CLICK_PIXELS:
            return
        self.dragged = True
        radius = composition.spheres[0].radius
        right, up = (self.mouse[0] - self.dragged_to[0]) / radius, (self.dragged_to[1] - self.mouse[1]) / radius
        self.dragged_to = self.mouse
        shift = any(glfw.get_key(self.handle, key) for key in (glfw.KEY_LEFT_SHIFT, glfw.KEY_RIGHT_SHIFT))
        self.change((rotate_light if shift else orbit)(self.state, right, up))

    def _hover(self, composition: Composition) -> None:
        """Show the values under the mouse, or show them no more."""
        over = any(sphere.position(*self.mouse) is not None for sphere in composition.spheres)
        over = over and not self.state.lobe_view and not self.state.help_visible
        if over or self.hovering:
            self.hovering = over
            self.frames_due = max(self.frames_due, 1)

    def _on_enter(self, window: Any, entered: int) -> None:
        if not entered and self.hovering:
            self.hovering = False
            self.frames_due = max(self.frames_due, 1)

    def _on_drop(self, window: Any, paths: list[str]) -> None:
        if paths:
            self.change(reload(open_light(self.state, paths[0])))  # it may have been edited since it was last opened
