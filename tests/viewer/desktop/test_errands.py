"""What is written, copied and looked at behind the window: no key stops it, and nothing that was asked for is lost."""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from shviewer.errors import OutputError
from shviewer.harmonics.rotation import rotate
from shviewer.progress import Stopped, listening, tell
from shviewer.viewer.desktop import session as sessions
from shviewer.viewer.desktop.behind import errands, opening, saving, task
from shviewer.viewer.desktop.behind.errands import Errands
from shviewer.viewer.desktop.behind.saving import Written
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.message import DONE, ERROR, kind_of
from shviewer.viewer.saving.file_marks import mark_of
from shviewer.viewer.state import State, changed, state_of

NOW = 0.0


class Held:
    """A function that waits until it may go on, telling now and then that it is still there."""

    def __init__(self, function: Callable[..., object]) -> None:
        self.function, self.asked, self.open = function, threading.Event(), threading.Event()

    def __call__(self, *arguments: object) -> object:
        self.asked.set()
        while not self.open.wait(0.01):
            tell(share=0.5)
        return self.function(*arguments)


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """No errand is waited for, and each is spoken of at once."""
    monkeypatch.setattr(errands, "AT_ONCE", NOW)
    monkeypatch.setattr(task, "QUIET", -1.0)


@pytest.fixture
def writing(at_once: None, monkeypatch: pytest.MonkeyPatch) -> Iterator[Held]:
    held = Held(lambda picture: Written(Path(f"{picture.state.recipe.n_bands}.json")))
    monkeypatch.setattr(sessions, "write_coefficients", held)
    yield held
    held.open.set()


def test_the_picture_lives_while_coefficients_are_written(writing: Held) -> None:
    session = Session(state_of("green"))
    assert session.press("Ctrl+E") is None
    assert writing.asked.wait(60)
    session.state = changed(session.state, camera=(10.0, 20.0))
    session.press("Up")
    while not session.prepare(patience=NOW):
        pass
    assert session.picture.state.recipe.n_bands == 6
    assert session.work is not None
    assert session.work.words == "writing the coefficients"
    writing.open.set()
    session.saving.finish()
    assert session.state.view.message.startswith(
        "saved 5.json in "
    )  # the picture that there was when the key was pressed
    assert kind_of(session.state.view.message) == DONE
    assert session.work is None


def test_escape_stops_what_is_written_and_leaves_the_picture(writing: Held) -> None:
    session = Session(state_of("green"))
    session.press("Ctrl+E")
    assert writing.asked.wait(60)
    assert session.press("Esc") is None
    assert session.state.view.message == "stopped writing the coefficients"
    assert not session.working
    session.tick(1.0)
    assert session.state.view.message == "stopped writing the coefficients"


def test_errands_are_done_in_order_and_the_end_waits_for_all(at_once: None) -> None:
    done: list[int] = []
    first = Held(lambda: 1)
    made = Errands()
    made.run("first", first, done.append, lambda error: None)
    made.run("second", lambda: 2, done.append, lambda error: None)
    assert first.asked.wait(60)
    made.take()
    assert done == []
    threading.Timer(0.02, first.open.set).start()
    made.finish()
    assert done == [1, 2]
    assert not made.working


def test_what_cannot_be_written_is_said_and_a_fault_ends_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refused(picture: object) -> Path:
        raise OutputError("the disk is full")

    session = Session(state_of("green"))
    monkeypatch.setattr(sessions, "write_coefficients", refused)
    session.press("Ctrl+E")
    assert (session.state.view.message, kind_of(session.state.view.message)) == ("the disk is full", ERROR)
    monkeypatch.setattr(sessions, "write_coefficients", lambda picture: 1 / 0)
    session.press("Ctrl+E")
    assert session.state.view.message == "internal error, see the terminal"
    assert "ZeroDivisionError" in capsys.readouterr().err
    assert session.prepare()


def test_a_picture_whose_map_is_on_its_way_to_opengl_is_saved_when_it_is_there(
    at_once: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    def drawn(*picture: object) -> Generator[float, None, str]:
        yield 0.5
        return "pixels"

    saved: list[object] = []
    monkeypatch.setattr(saving, "render_in_parts", drawn)
    monkeypatch.setattr(saving, "write_picture", lambda *rest: saved.append(rest[-1]) or Written(Path("a.png")))
    opengl = SimpleNamespace(version="", ready=lambda *picture: False, held=SimpleNamespace(pinned=None))
    session = Session(state_of("green"))
    session.save(opengl, None)
    assert session.prepare(patience=NOW)
    assert session.waiting
    assert not session.saving.drawing
    opengl.ready = lambda *picture: True
    assert session.prepare(patience=NOW)
    assert (saved, session.waiting, session.saving.drawing) == ([], False, True)
    assert opengl.held.pinned is not None  # what it is drawn from stays
    session.saving.finish()
    assert (saved, session.saving.drawing, opengl.held.pinned) == (["pixels"], False, None)


def test_a_dropped_picture_is_opened_behind_the_window_and_the_newest_wish_wins(
    at_once: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name in ("one", "two"):
        np.save(tmp_path / f"{name}.npy", np.ones((4, 8, 3), np.float32))

    def restored(path: Path, *rest: object) -> None:
        if path.stem == "one":
            slow(path)

    slow = Held(lambda path: None)
    monkeypatch.setattr(opening, "restored", restored)
    session = Session(state_of("green"))
    session.drop(str(tmp_path / "one.npy"))
    assert slow.asked.wait(60)
    assert session.prepare(patience=NOW)
    assert session.work is not None
    assert (session.work.words, session.picture.light.name) == ("opening one.npy", "green")
    session.drop(str(tmp_path / "two.npy"))
    session.prepare()
    assert session.picture.light.name == "two"
    slow.open.set()
    session.prepare()
    assert session.picture.light.name == "two"


def test_whoever_looks_at_a_whole_file_tells_how_far_it_is_and_can_be_stopped(tmp_path: Path) -> None:
    from shviewer.files import version_of

    path, told = tmp_path / "large", []
    path.write_bytes(bytes(3 * 2**20))
    with listening(lambda what, share: told.append(share)):
        mark = mark_of(path, version_of(path))
    assert mark == {"bytes": 3 * 2**20, "sha256": hashlib.sha256(bytes(3 * 2**20)).hexdigest()}
    assert told == [1 / 3, 2 / 3, 1.0]

    def stop(what: str, share: float | None) -> None:
        raise Stopped

    with pytest.raises(Stopped), listening(stop):
        rotate(np.ones((16, 3)), np.eye(3))


def test_a_turned_light_is_written_behind_the_window(
    at_once: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    turned: State = state_of("green", light_rotation=(np.cos(0.2), 0.0, 0.0, np.sin(0.2)))
    session = Session(turned)
    session.press("Ctrl+E")
    session.saving.finish()
    assert session.state.view.message.startswith("saved shviewer-green-001.json")
    assert (tmp_path / "shviewer-green-001.json").exists()


def test_where_nothing_can_be_written_files_go_home_and_the_message_says_so(
    at_once: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A window that is opened by a click may stand in a folder of the system."""
    home, system = tmp_path / "home", tmp_path / "system"
    home.mkdir()
    system.mkdir()
    monkeypatch.chdir(system)
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("USERPROFILE", str(home))
    monkeypatch.setattr(saving.os, "access", lambda path, mode: False)
    session = Session(state_of("green"))
    for number in ("001", "002"):
        session.press("Ctrl+E")
        session.saving.finish()
        assert session.state.view.message == f"saved shviewer-green-{number}.json in {home}"
    assert len(list(home.iterdir())) == 2
    assert not list(system.iterdir())
