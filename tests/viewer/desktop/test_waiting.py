"""A session never waits for a light: what takes time goes on behind the picture that there is."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from viewer.desktop.desktop import output_of

from shviewer.analysis import subjects
from shviewer.errors import ShaderError
from shviewer.lights.find import find_light
from shviewer.lights.function import FunctionLight
from shviewer.lights.light import Light
from shviewer.progress import Stopped, listening, tell
from shviewer.viewer.control.commands import Command
from shviewer.viewer.desktop.behind import making
from shviewer.viewer.desktop.behind import saving as savings
from shviewer.viewer.desktop.behind import task as tasks
from shviewer.viewer.desktop.behind.task import Task
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.message import WARNING, kind_of
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import State, changed, state_of

NOW = 0.0
"""Seconds of patience: none at all."""


class Gate:
    """A light that answers only while its gate is open."""

    def __init__(self, name: str = "slow") -> None:
        self.open, self.asked = threading.Event(), threading.Event()
        self.light = FunctionLight(self._radiance, name)

    def _radiance(self, directions: np.ndarray) -> np.ndarray:
        self.asked.set()
        assert self.open.wait(60)
        return 2 + directions[:, 2]


@pytest.fixture
def gate() -> Iterator[Gate]:
    gate = Gate()
    yield gate
    gate.open.set()


def drawn_at_once(*picture: object) -> Generator[float, None, Callable[[], None]]:
    yield 0.5
    return lambda: None


def waiting(gate: Gate, **values: Any) -> Session:
    """A session that shows Green's light and waits for the slow one."""
    session = Session(state_of("green", gate.light, **values))
    session.press("Right")
    assert not session.prepare(patience=NOW)
    assert gate.asked.wait(60)
    return session


def test_the_last_picture_can_be_turned_zoomed_and_exposed_while_a_light_is_awaited(gate: Gate) -> None:
    session = waiting(gate)
    session.state = changed(session.state, camera=(10.0, 20.0), zoom=2.0)
    session.press("E")
    session.press("H")
    before = session.picture
    assert not session.prepare(patience=NOW)
    shown = session.picture
    assert shown.light.name == "green"
    assert (shown.state.view.camera, shown.state.view.zoom, shown.state.view.help_visible) == ((10.0, 20.0), 2.0, True)
    assert not np.allclose(shown.world_from_view, before.world_from_view)
    assert shown.exposure_stops != before.exposure_stops
    gate.open.set()
    assert session.prepare()
    assert session.picture.light is gate.light
    assert session.picture.state == session.state
    assert session.state.view.camera == (10.0, 20.0)


def test_the_newest_wish_wins_and_what_it_makes_stale_never_shows(gate: Gate) -> None:
    session = waiting(gate)
    session.press("Left")
    session.press("Up")
    assert session.prepare(patience=NOW) in (True, False)
    gate.open.set()
    seen = set()
    while not session.prepare(patience=0.01):
        seen.add(session.picture.light.name)
    assert seen <= {"green"}
    assert (session.picture.light.name, session.state.recipe.n_bands) == ("green", 6)


def test_a_key_that_takes_nothing_away_from_the_task_does_not_begin_it_again(gate: Gate) -> None:
    session = waiting(gate)
    task = session.making._task
    session.press("X")
    assert not session.prepare(patience=NOW)
    assert session.making._task is task


def test_escape_stops_the_work_before_it_closes_anything(gate: Gate) -> None:
    session = waiting(gate)
    assert session.press("Esc") is None
    assert session.prepare(patience=NOW)
    assert session.picture.light.name == session.state.recipe.light == "green"
    assert session.state.view.message.startswith("stopped")
    assert session.press("Esc") is Command.LEAVE


def test_what_is_refused_late_keeps_the_picture_and_where_the_camera_is_by_then(gate: Gate) -> None:
    session = Session(state_of("green", FunctionLight(lambda d: gate.open.wait(60) and np.nan * d, "bad")))
    session.press("Right")
    assert not session.prepare(patience=NOW)
    session.state = changed(session.state, camera=(1.0, 2.0))
    gate.open.set()
    assert session.prepare()
    assert "must be finite" in session.state.view.message
    assert (session.state.recipe.light, session.state.view.camera) == ("green", (1.0, 2.0))
    assert session.picture.state == session.state


def test_a_command_that_needs_the_picture_is_carried_out_when_it_is_there(gate: Gate) -> None:
    session = waiting(gate, tolerance=0.2)
    session.press("T")
    assert session.state.recipe.n_bands == 5
    gate.open.set()
    assert session.prepare()
    assert session.state.recipe.n_bands == session.picture.needs.radiance == 2
    assert session.picture.state == session.state


def test_saving_waits_for_the_picture_that_was_asked_for(gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    saved = []
    monkeypatch.setattr(savings, "render_in_parts", drawn_at_once)
    monkeypatch.setattr(savings, "metadata", lambda picture, *rest: picture.light.name)
    monkeypatch.setattr(savings, "write_png", lambda path, pixels, text, exclusive: saved.append((path, text)))
    monkeypatch.setattr(savings, "write_numbered", lambda stem, write, folder: write(stem) or Path("it"))

    opengl = SimpleNamespace(version="", ready=lambda *picture: True, held=SimpleNamespace(pinned=None))
    session = waiting(gate)
    session.save(opengl, None)
    assert saved == []
    gate.open.set()
    assert session.prepare()
    assert saved == [("shviewer-slow", "slow")]
    assert session.state.view.message.startswith("saved it")


def test_a_picture_that_was_left_before_it_was_there_is_not_saved_as_another(
    gate: Gate, monkeypatch: pytest.MonkeyPatch
) -> None:
    """P, then Left: what was saved was the light before."""
    monkeypatch.setattr(savings, "render_in_parts", drawn_at_once)
    opengl = SimpleNamespace(version="", ready=lambda *picture: True, held=SimpleNamespace(pinned=None))
    session = waiting(gate)
    session.save(opengl, None)
    session.press("Left")
    session.prepare(patience=NOW)
    gate.open.set()
    assert session.prepare()
    assert session.picture.light.name == "green"
    assert session.state.view.message.startswith("not saved")
    assert kind_of(session.state.view.message) == WARNING


def test_a_picture_that_opengl_cannot_draw_is_said_and_ends_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*picture: object) -> Generator[float, None, None]:
        yield 0.5
        raise ShaderError("no shaders here")

    monkeypatch.setattr(savings, "render_in_parts", refused)
    opengl = SimpleNamespace(version="", ready=lambda *picture: True, held=SimpleNamespace(pinned=None))
    session = Session(state_of("green"))
    session.save(opengl, None)
    session.saving.go_on(60.0)
    assert (session.state.view.message, session.saving.drawing, opengl.held.pinned) == ("no shaders here", False, None)


def test_a_sweep_waits_for_its_pictures(gate: Gate) -> None:
    session = waiting(gate)
    session.press("Space")
    bands = session.state.recipe.n_bands
    assert not session.prepare(patience=NOW)
    for second in range(4):
        session.tick(float(second))
    assert session.state.recipe.n_bands == bands


def test_work_is_spoken_of_only_once_it_has_taken_a_while(gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tasks, "QUIET", 1e9)
    session = waiting(gate)
    assert session.status == ""
    assert not session.tick(1.0)
    monkeypatch.setattr(tasks, "QUIET", 0.0)
    assert session.status == "projecting"
    assert session.tick(2.0)
    assert not session.tick(3.0)


@pytest.mark.parametrize("keys", [["Up"], ["H", "H"], ["D"], ["Up", "D", "Up"]], ids="-".join)
def test_what_is_at_work_is_told_until_it_ends_whatever_is_asked_for_since(
    gate: Gate, monkeypatch: pytest.MonkeyPatch, keys: list[str]
) -> None:
    """A step of a Python function cannot be stopped: what comes after it waits, and is said to wait."""
    monkeypatch.setattr(tasks, "QUIET", 0.0)
    session = waiting(gate)
    for key in keys:
        session.press(key)
        assert not session.prepare(patience=NOW)
        assert session.work is not None
        assert session.work.words.startswith("projecting")
    assert ("comes after it" in session.status) == (keys != ["H", "H"])
    assert "; " not in session.status.partition("; ")[2]
    gate.open.set()
    assert session.prepare()
    assert session.work is None
    session.press("Esc")


def test_panes_come_with_their_picture(gate: Gate) -> None:
    """D asks for a third one; until it is there, there are two."""
    session = waiting(gate)
    session.press("D")
    session.state = changed(session.state, zoom=2.0)
    assert not session.prepare(patience=NOW)
    assert (session.view.n_spheres, session.view.zoom) == (2, 2.0)
    gate.open.set()
    assert session.prepare()
    assert session.view == session.state.view
    assert session.view.n_spheres == 3


def test_keys_pressed_while_a_file_is_read_do_not_read_it_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever held an arrow key never saw the file: each key began anew with it."""
    path, begun, go = tmp_path / "slow.toml", threading.Semaphore(0), threading.Event()
    path.write_text('[[lobe]]\nprofile = "constant"\nradiance = 1\n')
    read: list[str] = []

    def find(text: str, reading: Any) -> Light:
        if text == str(path):
            read.append(text)
            begun.release()
            while not go.wait(0.001):
                tell(share=0.5)
        return find_light(text, reading)

    monkeypatch.setattr(subjects, "find_light", find)
    session = Session(state_of("green", str(path)))
    for opened in (1, 2):
        session.press("Right")
        assert not session.prepare(patience=NOW)
        assert begun.acquire(timeout=60)
        for key in ("Up", "D", "Up"):
            session.press(key)
            assert not session.prepare(patience=NOW)
            time.sleep(0.02)
        assert len(read) == opened
        if opened == 1:
            session.press("Left")  # another light: nobody needs the file
            assert session.prepare(patience=60.0)
            assert session.picture.light.name == "green"
    go.set()
    assert session.prepare()
    assert (session.picture.light.name, len(read)) == ("slow", 2)


def test_bands_that_change_while_a_light_is_projected_do_not_project_it_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor is a picture made that nobody waits for, when several were wished for meanwhile."""
    begun, go, projected, made = threading.Event(), threading.Event(), 0, []
    evaluate = making.stages

    def radiance(directions: np.ndarray) -> np.ndarray:
        nonlocal projected
        if not go.is_set():
            projected += 1
            begun.set()
            while not go.wait(0.001):
                tell(share=0.5)
        return 2 + directions[:, 2]

    def stages(state: State, *, by_map: bool) -> Iterator[Picture]:
        for picture in evaluate(state, by_map=by_map):
            made.append(state.recipe.n_bands)
            yield picture

    monkeypatch.setattr(making, "stages", stages)
    session = Session(state_of("green", FunctionLight(radiance, "slow")))
    session.press("Right")
    assert not session.prepare(patience=NOW)
    assert begun.wait(60)
    for _ in range(3):
        session.press("Up")
        assert not session.prepare(patience=NOW)
        time.sleep(0.02)
    assert projected == 1
    go.set()
    assert session.prepare()
    assert session.picture.state.recipe.n_bands == 8
    assert set(made) == {5, 8}


def test_a_task_ends_at_its_next_step_and_the_next_one_begins_then() -> None:
    order, go = [], threading.Event()

    def first() -> list[str]:
        assert go.wait(60)
        tell("first")
        order.append("never")
        return []

    def second() -> list[str]:
        order.append("second")
        return ["made"]

    task = Task(first)
    task.stop()
    after = Task(second, after=task)
    assert not after.wait(0.01)
    go.set()
    assert after.result() == "made"
    assert order == ["second"]
    with pytest.raises(Stopped):
        task.result()


def test_who_is_told_of_a_result_finds_it_and_who_is_told_of_the_end_finds_the_task_finished() -> None:
    found: list[bool] = []
    made = threading.Event()
    task: list[Task[None]] = []

    def done() -> None:
        made.wait(60)
        found.append(task[0].finished)

    task.append(Task(lambda: [None], wake=done))
    made.set()
    task[0]._thread.join()
    assert found == [False, True]


def test_a_listener_hears_one_thread_and_only_as_long_as_it_listens() -> None:
    heard: list[tuple[str, float | None]] = []
    with listening(lambda what, share: heard.append((what, share))):
        tell("reading", 0.5)
        thread = threading.Thread(target=tell, args=("elsewhere",))
        thread.start()
        thread.join()
    tell("too late")
    assert heard == [("reading", 0.5)]


QUITTING = """
import sys, time
import numpy as np
from shviewer.lights.function import FunctionLight
from shviewer.viewer.state import changed, state_of
from viewer.desktop.still_window import frames, window, window_of
frames.PATIENCE = 0.05
asleep = FunctionLight(lambda directions: time.sleep(3600), "asleep")
import glfw
with window.open_window((640, 320)) as handle:
    shown = window_of(handle, state_of("green", asleep))
    shown.frame()
    shown.press("Right")
    start, slowest = time.perf_counter(), 0.0
    turn = 0
    while turn < 19 or shown.session.making.doing != "projecting":
        turn = min(turn + 1, 19)
        begin = time.perf_counter()
        shown.change(changed(shown.session.state, camera=(float(turn), 20.0)))
        shown.frame()
        slowest = max(slowest, time.perf_counter() - begin)
    picture = shown.session.picture
    print(picture.light.name, picture.state.view.camera, shown.session.status != "" or time.perf_counter() - start < 0.3)
    print(glfw.window_should_close(handle))
    shown.press("Esc")
    print(glfw.window_should_close(handle), shown.session.state.view.message)
    shown.frame()
    shown.press("Esc")
    print(glfw.window_should_close(handle))
"""


def test_a_window_turns_and_closes_while_a_light_sleeps(display: str) -> None:
    printed = output_of(display, QUITTING).splitlines()
    assert printed == ["green (19.0, 20.0) True", "0", "0 stopped projecting", "1"]
