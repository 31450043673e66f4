"""How long a user waits: from LIGHT to a picture, and from a key to the next one; and the cost of an idle window.

Cold means a new process, Python's start included; warm means a process that has drawn, but has forgotten every light.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import moderngl

from shviewer.analysis.cache import MEMORY
from shviewer.analysis.recipe import Recipe
from shviewer.benchmark.measuring.timing import Timing, Work, summarise, time_interleaved
from shviewer.benchmark.rows.row import Row, not_measured
from shviewer.children import leash
from shviewer.ending import temporary_folder
from shviewer.errors import GraphicsError
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import first_picture, prepare
from shviewer.viewer.saving.picture_files import write_png
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.screenshot import offscreen, render_rgb
from shviewer.viewer.state import State, changed, state_of

SECTION = "end to end"
FRAME = compose(1280, 640)
KEY_BANDS = (5, 32)
"""Band counts at which Up is pressed: the default, and the last one of the direct sum."""

VERSION, SCREENSHOT = "start, --version", "LIGHT to PNG, new process"
FIRST, COMPLETE = "LIGHT to first picture, warm", "LIGHT to all figures, warm"
SAVED = "LIGHT to PNG, warm"
NEW_KEY, KNOWN_KEY = "key to picture, new bands", "key to picture, known bands"
IDLE = "idle window"

NOTES = {
    VERSION: "a new process; the floor of all others",
    SCREENSHOT: "a new process, start of Python included",
    FIRST: "in a running process that does not know the light; figures that take a search are pending",
    COMPLETE: "the same, until no figure is pending",
    SAVED: "the same, read back and written",
    NEW_KEY: "Up, to bands not shown before",
    KNOWN_KEY: "Up, to bands shown before",
    IDLE: "CPU milliseconds per second",
}

IDLE_SECONDS = 4
PATIENCE = 60.0
"""The most seconds that a process may take to start, draw or end."""

WATCHED_WINDOW = """
import _thread, signal, sys, threading, time
from shviewer.children import follow_parent
from shviewer.errors import GraphicsError
from shviewer.viewer.desktop import window
from shviewer.viewer.desktop.behind.task import Task
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import State

follow_parent()
signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job is started without it

def watch():
    time.sleep(0.5)
    for _ in range(int(sys.argv[1])):
        before, start = time.process_time(), time.perf_counter()
        time.sleep(1)
        print((time.process_time() - before) / (time.perf_counter() - start))
    _thread.interrupt_main()

class Watched(window.Window):
    watched = False

    def frame(self, *rest):
        super().frame(*rest)
        if self.frame_count == 2 and not self.watched:
            self.watched = True
            threading.Thread(target=watch, daemon=True).start()

window.Window = Watched
try:
    window.run(Task(lambda: [prepare(State())]), (1280, 640))
except KeyboardInterrupt:
    pass
except GraphicsError as error:
    sys.exit(str(error))
"""
"""A program that prints the share of one core that its window takes, each second, once two frames are drawn."""


def process_rows(
    text: str, name: str, drawing: Renderer | str, *, budget: float, at_most: float = math.inf, at_least: int = 5
) -> list[Row]:
    """Rows of new processes: `--version`, the floor of all, and a screenshot of the LIGHT `text`, which the rows call `name`.

    drawing: a renderer, or why nothing can be drawn, and then the screenshot is absent. budget: seconds. at_most: seconds
    beyond which nothing is measured.
    """
    with temporary_folder() as folder:
        works = {VERSION: partial(_shviewer, "--version")}
        if not isinstance(drawing, str):
            works[SCREENSHOT] = partial(_shviewer, "screenshot", str(folder / "out.png"), text)
        times = time_interleaved(works, budget=budget, at_most=at_most, at_least=at_least)
    places = {VERSION: ("", None), SCREENSHOT: (name, Recipe.n_bands)}
    return [_row(method, *places[method], times.get(method)) for method in works]


def session_rows(
    text: str,
    name: str,
    drawing: Renderer | str,
    *,
    budget: float,
    at_most: float = math.inf,
    key_bands: Sequence[int] = KEY_BANDS,
    at_least: int = 5,
) -> list[Row]:
    """Rows of this process: from the LIGHT `text` to its picture, and from Up to the next. It forgets every light.

    A picture is done when OpenGL says so, in the window's size and format, overlay included. No rows where nothing draws.
    budget: seconds. at_most: seconds beyond which nothing is measured.
    """
    if isinstance(drawing, str):
        return []
    start = state_of(text)
    works: dict[tuple[str, int], Work] = {}
    with offscreen(drawing, FRAME) as target, temporary_folder() as folder:
        frames = _Frames(drawing, target)
        works[FIRST, start.recipe.n_bands] = lambda: frames.first(start)
        works[COMPLETE, start.recipe.n_bands] = lambda: frames.complete(start)
        works[SAVED, start.recipe.n_bands] = lambda: frames.save(start, folder / "out.png")
        for n_bands in key_bands:
            works[NEW_KEY, n_bands + 1] = works[KNOWN_KEY, n_bands + 1] = frames.press_up

        def before(work: tuple[str, int], repeat: int) -> None:
            if work[0] == KNOWN_KEY:
                prepare(changed(start, n_bands=work[1]))
            else:
                MEMORY.clear()
            if work[0] in (NEW_KEY, KNOWN_KEY):
                frames.open(changed(start, n_bands=work[1] - 1))

        times = time_interleaved(works, budget=budget, at_most=at_most, at_least=at_least, before=before)
    MEMORY.clear()
    return [_row(method, name, n_bands, times.get((method, n_bands))) for method, n_bands in works]


def idle_row(seconds: int = IDLE_SECONDS, at_most: float = math.inf) -> Row | str:
    """The row of an idle window, in milliseconds of CPU time per second; or a text that says why there is none.

    at_most: seconds; no window is opened if watching it would take longer.
    """
    if at_most < seconds:
        return _row(IDLE, "green", Recipe.n_bands, None)
    patience = PATIENCE + seconds
    try:
        done = _run("-c", WATCHED_WINDOW, str(seconds), patience=patience)
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"no window within {patience:g} s ({type(error).__name__})"
    if done.returncode:
        return (done.stderr.strip().splitlines() or [f"the window ended with {done.returncode}"])[-1]
    shares = [float(line) for line in done.stdout.split()]
    return _row(IDLE, "green", Recipe.n_bands, summarise([1000 * share for share in shares]))


class _Frames:
    """A session as a window has it, on a framebuffer of its size and format."""

    def __init__(self, renderer: Renderer, target: moderngl.Framebuffer) -> None:
        self.renderer = renderer
        self.target = target
        self.layers: tuple[Layer, ...] = ()

    def open(self, state: State) -> None:
        self.session = Session(state)
        self._upload()

    def first(self, state: State) -> None:
        self.session = Session(state, first_picture(state))
        self._upload()
        self._draw()

    def complete(self, state: State) -> None:
        self.open(state)
        self._draw()

    def press_up(self) -> None:
        self.session.press("Up")
        self.session.prepare()
        self._upload()
        self._draw()

    def save(self, state: State, out: Path) -> None:
        picture = prepare(state)
        write_png(out, render_rgb(self.renderer, picture, FRAME), metadata(picture, FRAME, self.renderer.version))

    def _upload(self) -> None:
        self.renderer.show(self.session.picture)
        self.layers = draw_overlay(self.session.picture, FRAME, timing=True).layers

    def _draw(self) -> None:
        self.renderer.draw(self.target, FRAME, self.layers)
        self.renderer.context.finish()


def _shviewer(*arguments: str) -> None:
    """Run the program in a new process. GraphicsError if it fails."""
    done = _run("-m", "shviewer", *arguments)
    if done.returncode:
        raise GraphicsError(f"shviewer {' '.join(arguments)} ended with {done.returncode}: {done.stderr.strip()}")


def _run(*arguments: str, patience: float = PATIENCE) -> subprocess.CompletedProcess[str]:
    """Run a new Python, which may cache bytecode: a program is not compiled at every start."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    command = [sys.executable, *arguments]
    with leash(environment) as (stdin, environment):
        return subprocess.run(
            command, stdin=stdin, env=environment, capture_output=True, text=True, timeout=patience, check=False
        )


def _row(method: str, light: str, n_bands: int | None, timing: Timing | None) -> Row:
    if timing is None:
        return not_measured(SECTION, method, light, n_bands)
    return Row(section=SECTION, method=method, light=light, n_bands=n_bands, **timing._asdict(), note=NOTES[method])
