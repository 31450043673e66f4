"""The window: an event of GLFW becomes a new state, and a changed state becomes a frame."""

from __future__ import annotations

import math
from collections.abc import Callable
from time import perf_counter
from typing import Any

import glfw
import moderngl

from shviewer.viewer.composing.composition import Composition, compose
from shviewer.viewer.control.commands import Command
from shviewer.viewer.control.keys import ACTIONS, SYMBOLS
from shviewer.viewer.desktop.behind.saving import coefficients_text
from shviewer.viewer.desktop.behind.task import Task
from shviewer.viewer.desktop.canvas import Canvas
from shviewer.viewer.desktop.clipboard import named_files
from shviewer.viewer.desktop.frames import Frames
from shviewer.viewer.desktop.glfw_window import key_name, open_window, scale_of, side_context
from shviewer.viewer.desktop.session import PATIENCE, Session
from shviewer.viewer.desktop.showing import PLAIN, Settings
from shviewer.viewer.gl.carrier import Carrier
from shviewer.viewer.message import DONE, WARNING
from shviewer.viewer.overlay.directions.probe import direction_at
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.command_line import command_line
from shviewer.viewer.state import State
from shviewer.viewer.work import Work

OUTSIDE = (-1.0, -1.0)
"""The place of a mouse that has left the window."""


def run(first: Task[Picture], size: tuple[int, int], settings: Settings = PLAIN) -> tuple[int, int] | None:
    """Open a window of `size` screen coordinates, show the first picture when it is there, and stay until it is closed.

    NoDisplayError without a display, GraphicsError without OpenGL 3.3, and what the first picture raises.
    Return the size that it had at the end, if it showed anything.
    """
    if first.wait(PATIENCE):
        first.result()  # what is refused at once is refused without a window
    with open_window(size) as handle:
        canvas = canvas_of(handle)
        try:
            if _wait_for(first, handle, canvas):
                shown = Window(handle, canvas, first.result(), settings)
                shown.loop()
                size = shown.size_in_points()
                glfw.hide_window(handle)
                shown.session.saving.finish()  # what was asked for is written before the end
                return size
        finally:
            canvas.release()
    return None


def canvas_of(handle: Any) -> Canvas:
    """The canvas of a window whose context is current, with a thread for large textures where there can be one."""
    context = moderngl.create_context(require=330)
    wake = glfw.post_empty_event
    return Canvas(context, Carrier.beside(context, side_context(handle), wake), wake)


def _wait_for(first: Task[Picture], handle: Any, canvas: Canvas) -> bool:
    """Say what is done for the first picture, until it is there; return False if the window is closed before."""
    said: Work | None = None
    while not first.wait(PATIENCE):
        glfw.poll_events()
        if glfw.window_should_close(handle) or glfw.get_key(handle, glfw.KEY_ESCAPE) == glfw.PRESS:
            first.stop()
            return False
        width, height = glfw.get_framebuffer_size(handle)
        if first.work != said and first.status and width * height:
            said = first.work
            canvas.wait(said, compose(width, height, 1.0, scale_of(handle)))
            glfw.swap_buffers(handle)
    return True


class Window(Frames):
    """One window: its events, and what only a window can do."""

    def __init__(self, handle: Any, canvas: Canvas, first: Picture, settings: Settings = PLAIN) -> None:
        super().__init__(handle, canvas, Session(first.state, first, settings, glfw.post_empty_event))
        self.band: int | None = None
        """The band under the mouse."""
        self.done_by_key = False
        """Whether the key pressed last did something; then what it types does nothing."""
        self.has_clipboard = True
        self.fullscreen = False
        self.windowed_place = (0, 0, 1280, 640)
        glfw.set_key_callback(handle, self._on_key)
        glfw.set_char_callback(handle, self._on_char)
        glfw.set_mouse_button_callback(handle, self._on_button)
        glfw.set_cursor_pos_callback(handle, self._on_cursor)
        glfw.set_cursor_enter_callback(handle, self._on_enter)
        glfw.set_scroll_callback(handle, self._on_scroll)
        glfw.set_drop_callback(handle, self._on_drop)  # type: ignore[arg-type]  # the stub shows the C signature

    def change(self, state: State) -> None:
        """Take a new state."""
        self.session.state = state
        self.due()

    def press(self, key: str) -> None:
        """Do what a key asks for; commands that the session returns are done here."""
        if key == "Esc" and self.session.work is None and self.canvas.pending and self.shown is not None:
            self.session.back_to(self.shown, f"stopped {self.canvas.pending}")
            self.due()
            return
        command = self.session.press(key)
        composition = self.composition()
        if command is Command.FULL_SCREEN or (command is Command.LEAVE and self.fullscreen):
            self._toggle_fullscreen()
        elif command in (Command.CLOSE, Command.LEAVE):
            glfw.set_window_should_close(self.handle, True)
        elif command is Command.SAVE and (asked := self.framed(self.session.state.view)) is not None:
            self.session.save(self.canvas.renderer, asked)
        elif command is Command.COPY and composition is not None:
            size = composition.width, composition.height
            self._copy("the command of this picture", lambda: command_line(self.session.picture, size))
        elif command is Command.COPY_COEFFICIENTS:
            self._copy("the coefficients", lambda: coefficients_text(self.session.picture))
        elif command is Command.PASTE:
            self._paste()
        self.due()

    def _paste(self) -> None:
        """Open what the clipboard names: paths or addresses of files, a line each, as file managers copy them."""
        text = glfw.get_clipboard_string(None) or b""  # type: ignore[arg-type]  # a window is deprecated here
        if paths := named_files(text if isinstance(text, str) else text.decode(errors="replace")):
            self.session.drop(*paths)
        else:
            self.session.say("no path of a file is copied: copy one, or drop the file on the window", WARNING)

    def size_in_points(self) -> tuple[int, int]:
        """The size in points of the design; of a full screen, that of the window before."""
        if self.fullscreen:
            self._toggle_fullscreen()
            glfw.poll_events()
        width, height = glfw.get_framebuffer_size(self.handle)
        return round(width / scale_of(self.handle)), round(height / scale_of(self.handle))

    def _toggle_fullscreen(self) -> None:
        self.fullscreen = not self.fullscreen
        if self.fullscreen:
            self.windowed_place = (*glfw.get_window_pos(self.handle), *glfw.get_window_size(self.handle))
            monitor = glfw.get_primary_monitor()
            mode = glfw.get_video_mode(monitor)
            glfw.set_window_monitor(self.handle, monitor, 0, 0, mode.size.width, mode.size.height, mode.refresh_rate)
        else:
            glfw.set_window_monitor(self.handle, None, *self.windowed_place, 0)  # type: ignore[arg-type]  # None: no monitor
        self.redraw()

    def _copy(self, what: str, make: Callable[[], str]) -> None:
        """Give a text to the clipboard, when the picture is there; where there is none, to the terminal."""
        self.session.make_text(f"writing {what}", make, lambda text: self._give(what, text))

    def _give(self, what: str, text: str) -> None:
        if self.has_clipboard:
            glfw.get_error()  # of whatever was before
            glfw.set_clipboard_string(self.handle, text)
            if glfw.get_error()[0] == glfw.NO_ERROR:
                self.session.say(f"copied {what}", DONE)
                return
            self.session.say(f"no clipboard here: {what} is printed in the terminal", WARNING)
        self.has_clipboard = False
        print(text, flush=True)

    def _on_key(self, window: Any, code: int, scancode: int, action: int, modifiers: int) -> None:
        if action == glfw.RELEASE:
            return  # a key held down repeats
        name = key_name(code, scancode, modifiers)
        self.done_by_key = name in ACTIONS
        self.press(name)

    def _on_char(self, window: Any, codepoint: int) -> None:
        """Press a symbol; not where its key has done something, as the digit 7 with Shift, which types "?" on some layouts."""
        if chr(codepoint) in SYMBOLS and not self.done_by_key:
            self.press(chr(codepoint))

    def _on_button(self, window: Any, button: int, action: int, modifiers: int) -> None:
        if action == glfw.PRESS:
            self.mouse.press(button)
            return
        dragged, composition = self.mouse.dragged, self.composition()
        if self.mouse.release(button) and composition is not None:
            bars = self.canvas.overlay.bars if self.canvas.overlay is not None else {}
            picture = self.session.picture.seen(self.session.state)
            self._take(self.mouse.click(picture, composition, bars, perf_counter()))
        elif dragged and not self.mouse.dragged:
            self.redraw()

    def _on_cursor(self, window: Any, x: float, y: float) -> None:
        """Remember where the mouse is, in pixels of the framebuffer, and drag.

        The place comes with the event: GLFW, if asked, would tell where the mouse is by now, some events later.
        """
        window_size, pixels = glfw.get_window_size(self.handle), glfw.get_framebuffer_size(self.handle)
        scale = pixels[0] / max(window_size[0], 1), pixels[1] / max(window_size[1], 1)
        at = math.floor(x * scale[0]) + 0.5, math.floor(y * scale[1]) + 0.5  # the middle of a pixel
        composition = self.composition()
        if composition is None:
            self.mouse.at = at
            return
        shift = any(glfw.get_key(self.handle, key) for key in (glfw.KEY_LEFT_SHIFT, glfw.KEY_RIGHT_SHIFT))
        self._take(self.mouse.move(at, self.session.placed, composition, shift=shift))
        if self.mouse.held is None:
            self._hover(composition)

    def _on_scroll(self, window: Any, across: float, steps: float) -> None:
        if (composition := self.composition()) is not None:
            self._take(self.mouse.scroll(steps, self.session.state, composition))

    def _take(self, state: State | None) -> None:
        """Take what the mouse made of the state, if anything."""
        if state is not None:
            self.change(state)

    def _hover(self, composition: Composition) -> None:
        """Show the values under the mouse, of a direction or of a band, or take them away."""
        over = direction_at(self.session.picture, composition, *self.mouse.at) is not None
        over = over and not self.session.state.view.lobe_view and not self.session.state.view.help_visible
        band, self.band = self.band, self.canvas.band_at(self.mouse.at)
        if over or self.hovering or band != self.band:
            self.hovering = over
            self.due()

    def _on_enter(self, window: Any, entered: int) -> None:
        if not entered and (self.hovering or self.band is not None):
            self.mouse.at, self.hovering, self.band = OUTSIDE, False, None
            self.due()

    def _on_drop(self, window: Any, paths: list[str]) -> None:
        if paths:
            self.session.drop(*paths)
            self.due()
