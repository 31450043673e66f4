"""Frames of a window: drawn when they are due, a part at a time, so that no event waits long for one.

Nothing is drawn and no time is spent while nothing happens. GLFW is asked to return four times a second all the same, so
that Ctrl-C in the terminal is heard at once; a watched file is looked at then, too.
"""

from __future__ import annotations

import sys
from time import perf_counter, sleep
from typing import Any

import glfw

from shviewer.errors import ShviewerError
from shviewer.viewer.composing.composition import Composition, frame_for
from shviewer.viewer.desktop.canvas import Canvas
from shviewer.viewer.desktop.glfw_window import scale_of
from shviewer.viewer.desktop.mouse import Mouse
from shviewer.viewer.desktop.session import PATIENCE, STATUS_SECONDS, Session
from shviewer.viewer.picture import Picture
from shviewer.viewer.view import View

IDLE_SECONDS = 0.25

PASS_SECONDS = 0.02
"""How long a frame, or a picture that is saved, is drawn until events are looked at."""

LEAVE_SECONDS = 0.1
"""The longest pause after that while something is at work behind the window, which gets no turn while OpenGL draws."""


class Frames:
    """One window, one session, one canvas: what is due is drawn."""

    def __init__(self, handle: Any, canvas: Canvas, session: Session) -> None:
        self.handle, self.canvas, self.session = handle, canvas, session
        self.frames_due = 2  # the first swap may still have the old size
        self.frame_count = 0
        self.mouse = Mouse()
        self.hovering = False
        self.title = ""
        self.shown: Picture | None = None
        """The last picture that this OpenGL could hold."""
        self._ready = False
        """Whether the frame that was begun is that of the state, with all figures."""
        self._seconds = 0.0
        self._framed = False
        """Whether the last pass went to a frame, and not to a picture that is saved."""
        glfw.set_framebuffer_size_callback(handle, lambda *_: self.redraw())
        glfw.set_window_refresh_callback(handle, lambda *_: self.redraw())
        self._entitle()

    def loop(self) -> None:
        """Draw what is due, then sleep until something happens or what plays takes its next step."""
        while not glfw.window_should_close(self.handle):
            if self.pass_on():
                glfw.poll_events()
            else:
                most = STATUS_SECONDS if self.canvas.pending else IDLE_SECONDS
                glfw.wait_events_timeout(self.session.wait(perf_counter(), most))
            if self.session.tick(perf_counter()) or self.canvas.pending or self.canvas.news:
                self.due()

    def pass_on(self) -> bool:
        """Draw for about PASS_SECONDS, a frame and a picture that is saved by turns; return whether there is more to draw."""
        start, session, canvas = perf_counter(), self.session, self.canvas
        due, saving = bool(self.frames_due) or canvas.drawing, session.saving.drawing
        self._framed = due and not (saving and self._framed)
        if self._framed:
            self.frame(PASS_SECONDS)
            if session.working or canvas.pending:  # they leave it half of the time
                sleep(min(perf_counter() - start, LEAVE_SECONDS))
        elif saving:
            session.saving.go_on(PASS_SECONDS)
        return bool(self.frames_due) or canvas.drawing or session.saving.drawing

    def frame(self, seconds: float | None = None) -> None:
        """Draw the present state for about so long, or on with what was begun; None: all of it."""
        start = perf_counter()
        if self.canvas.drawing:
            before = self.session.picture
            self.session.prepare(self.canvas.by_map(self.session.state, self._begun), 0.0)
            if self.session.picture is not before:
                self.due()
        elif not self._begin():
            return
        whole = self.canvas.go_on(seconds)
        if whole:
            glfw.swap_buffers(self.handle)
            self.frame_count += 1
        if self.canvas.again:
            self.due()
        self._seconds += perf_counter() - start
        if whole:
            self._report()

    def _begin(self) -> bool:
        """Begin with a frame of the present state; return whether there is one to be drawn."""
        self.frames_due -= 1
        self._seconds = 0.0
        session, canvas, composition = self.session, self.canvas, self.composition()
        if composition is None:
            return False
        ready = session.prepare(canvas.by_map(session.state, composition), PATIENCE)
        if not ready and canvas.too_slow(session.picture, composition):
            return False  # its map will be there before the sum were drawn
        composition = self.composition() or composition  # a state that was refused has left another one
        try:
            uploaded = canvas.show(session.picture, composition, session.work, self.mouse.at, session.pace, self.framed)
        except ShviewerError as error:  # a map that this OpenGL cannot hold
            if self.shown is None:
                raise
            session.keep(error, self.shown)
            uploaded = canvas.show(session.picture, composition)
        if uploaded:
            self.shown = session.picture
            if session.waiting and ready:  # for what is there now
                self.due()
        elif canvas.renderer.carrier is None:
            self.due()
        composition = canvas.composition or composition  # of the picture that stays, while the new one is on its way
        self._ready, self._begun = ready and uploaded, composition
        self._entitle()
        pointing = self.hovering and not self.mouse.dragged and self._ready  # a probe asks the light
        canvas.begin(composition, self.mouse.at if pointing else None, alone=self._ready)
        return True

    def redraw(self) -> None:
        """Draw anew: the framebuffer has another size, or has lost what was in it."""
        self.canvas.give_up()
        self.frames_due = 2

    def due(self) -> None:
        """Note that a frame has to be drawn."""
        self.frames_due = max(self.frames_due, 1)

    def composition(self) -> Composition | None:
        """The layout of the picture in the framebuffer; None while minimised."""
        return self.framed(self.session.view)

    def framed(self, view: View) -> Composition | None:
        """The layout of a view in the framebuffer, which may be larger than the window (HiDPI)."""
        width, height = glfw.get_framebuffer_size(self.handle)
        return frame_for(view, width, height, scale_of(self.handle)) if width * height else None

    def _entitle(self) -> None:
        if self.session.title != self.title:
            self.title = self.session.title
            glfw.set_window_title(self.handle, self.title)

    def _report(self) -> None:
        """Say that a frame is whole, to whoever wants to hear it."""
        session, at = self.session, self._begun
        if session.settings.verbose:
            said = session.status or self.canvas.pending
            print(
                f"{'frame' if self._ready else 'meanwhile'} {self.frame_count}: {session.picture.light.name}, "
                f"{session.picture.state.recipe.n_bands} bands, {at.width} x {at.height}, {1000 * self._seconds:.1f} ms"
                + (f", {said}" if said else ""),
                file=sys.stderr,
                flush=True,
            )
