"""What a user waits for: which rows there are, what they time, and what is said where there is nothing to draw on."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable

import pytest
from helpers import unavailable
from viewer.desktop.desktop import missing_programs, virtual_display

from shviewer.analysis.cache import MEMORY
from shviewer.analysis.figures import figures_of
from shviewer.benchmark.measuring import end_to_end
from shviewer.benchmark.measuring.end_to_end import (
    COMPLETE,
    FIRST,
    IDLE,
    KNOWN_KEY,
    NEW_KEY,
    SAVED,
    SCREENSHOT,
    VERSION,
    idle_row,
    process_rows,
    session_rows,
)
from shviewer.benchmark.rows.row import Row
from shviewer.errors import GraphicsError
from shviewer.lights.reading import DEFAULT_READING
from shviewer.viewer.gl.renderer import Renderer

Work = Callable[[], object]
Before = Callable[[tuple[str, int], int], object]

NO_OPENGL = "GraphicsError: no OpenGL here"


def test_without_opengl_only_the_start_is_timed() -> None:
    rows = process_rows("green", "green", NO_OPENGL, budget=0, at_least=1)
    assert [(row.method, row.light, row.n_bands) for row in rows] == [(VERSION, "", None)]
    assert session_rows("green", "green", NO_OPENGL, budget=0) == []


def test_what_is_timed_in_new_processes_is_the_start_alone_and_a_whole_screenshot(
    renderer: Renderer, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, ran = subprocess.run, []

    def noting(command: list[str], **options: object) -> object:
        ran.append(command[2:])
        return run(command, **options)

    monkeypatch.setattr(subprocess, "run", noting)
    start, whole = process_rows("green", "mine", renderer, budget=0, at_least=1)
    assert (start.method, whole.method, whole.light, whole.n_bands) == (VERSION, SCREENSHOT, "mine", 5)
    assert start.milliseconds
    assert whole.milliseconds
    assert [(command[1], command[-1]) for command in ran] == [("--version", "--version"), ("screenshot", "green")] * 2


def test_a_process_that_fails_is_no_time(renderer: Renderer) -> None:
    with pytest.raises(GraphicsError, match=r"ended with 3: shviewer: unknown light 'grene'"):
        process_rows("grene", "grene", renderer, budget=0, at_least=1)


def test_a_session_times_the_first_picture_and_a_key_on_either_side(renderer: Renderer) -> None:
    rows = session_rows("green", "mine", renderer, budget=0, key_bands=(5, 32), at_least=1)
    assert [(row.method, row.n_bands) for row in rows] == [
        (FIRST, 5),
        (COMPLETE, 5),
        (SAVED, 5),
        (NEW_KEY, 6),
        (KNOWN_KEY, 6),
        (NEW_KEY, 33),
        (KNOWN_KEY, 33),
    ]
    for row in rows:
        assert row.light == "mine"
        assert row.repeats == 1
        assert row.low_quartile is not None
        assert row.milliseconds is not None
        assert row.high_quartile is not None
        assert 0 < row.low_quartile <= row.milliseconds <= row.high_quartile


def test_what_is_new_is_computed_anew_and_what_is_known_is_not(
    renderer: Renderer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whichever is run first: whether the light is known when a run begins, and how many pictures it computes."""
    seen = {}

    def in_reverse(works: dict[tuple[str, int], Work], before: Before, **_: object) -> dict[object, object]:
        for name, work in reversed(works.items()):
            before(name, 0)
            light = MEMORY.named(("green", DEFAULT_READING))
            known = 0 if light is None else len(MEMORY.results(light, figures_of))
            work()
            light = MEMORY.named(("green", DEFAULT_READING))
            assert light is not None
            seen[name[0]] = known, len(MEMORY.results(light, figures_of))
        return {}

    monkeypatch.setattr(end_to_end, "time_interleaved", in_reverse)
    rows = session_rows("green", "green", renderer, budget=0, key_bands=(5,))
    assert {row.note for row in rows} == {"not measured"}
    assert seen == {KNOWN_KEY: (2, 2), NEW_KEY: (1, 2), SAVED: (0, 1), FIRST: (0, 0), COMPLETE: (0, 1)}


def test_a_session_leaves_nothing_remembered_and_the_renderer_free_of_errors(renderer: Renderer) -> None:
    session_rows("constant", "constant", renderer, budget=0, key_bands=(), at_least=1)
    assert not MEMORY._known
    assert renderer.context.error == "GL_NO_ERROR"


def test_without_a_display_the_idle_window_is_absent_with_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    if os.name != "posix":
        pytest.skip("other systems always have a display")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "XDG_SESSION_TYPE"):
        monkeypatch.delenv(name, raising=False)
    reason = idle_row(1)
    if isinstance(reason, Row):
        pytest.skip("there is a display without a variable that names it")
    assert "no display to open a window on" in reason
    assert "\n" not in reason


def test_an_idle_window_on_a_display_is_a_share_of_a_core(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a background job, too, which is started with SIGINT ignored."""
    if "Xvfb" in missing_programs():
        unavailable("a window needs Xvfb (apt-get install -y xvfb)")
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        row = row_of_an_idle_window(monkeypatch)
    finally:
        signal.signal(signal.SIGINT, before)
    assert isinstance(row, Row), row
    assert (row.method, row.repeats) == (IDLE, 1)
    assert row.milliseconds is not None
    assert 0 < row.milliseconds < 1000  # of a second of one core


def row_of_an_idle_window(monkeypatch: pytest.MonkeyPatch) -> Row | str:
    with virtual_display() as display:
        monkeypatch.setenv("DISPLAY", display)
        monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
        monkeypatch.delenv("XDG_SESSION_TYPE", raising=False)
        return idle_row(1)


def test_times_are_of_the_program_as_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    code = "import os, sys; print('PYTHONDONTWRITEBYTECODE' in os.environ, sys.dont_write_bytecode)"
    assert end_to_end._run("-c", code).stdout.split() == ["False", "False"]


def test_a_window_is_not_opened_where_there_is_no_time_to_watch_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subprocess, "run", lambda *rest, **options: pytest.fail("opened"))
    row = idle_row(seconds=4, at_most=3.9)
    assert isinstance(row, Row)
    assert (row.method, row.note) == (IDLE, "not measured")
