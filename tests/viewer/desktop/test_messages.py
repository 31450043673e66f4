"""Messages have a kind and a time, and work tells how far it is."""

from __future__ import annotations

import threading
from pathlib import Path
from time import perf_counter, sleep

import pytest

from shviewer.errors import UsageError
from shviewer.progress import tell
from shviewer.viewer.desktop.behind.saving import Written
from shviewer.viewer.desktop.behind.task import Task
from shviewer.viewer.desktop.messages import notes_of
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.message import DONE, ERROR, SECONDS, WARNING, Message, kind_of, passes, warning
from shviewer.viewer.state import state_of


def test_a_message_is_its_text_and_knows_its_kind() -> None:
    said = warning("2 NaN texels repaired")
    assert said == "2 NaN texels repaired"
    assert (kind_of(said), kind_of("a note"), kind_of(warning(""))) == (WARNING, "", "")
    assert [passes(Message("a", kind)) for kind in ("", DONE, WARNING, ERROR)] == [True, True, False, False]


@pytest.mark.parametrize("kind", ["", DONE, WARNING, ERROR])
def test_what_is_done_goes_after_four_seconds_and_what_is_wrong_at_the_next_key(kind: str) -> None:
    session = Session(state_of("green"))
    session.say("a message", kind)
    now = perf_counter()
    session.tick(now)
    session.tick(now + SECONDS - 0.1)
    assert session.state.view.message == "a message"
    changed = session.tick(now + SECONDS + 0.1)
    assert bool(session.state.view.message) == (kind in (WARNING, ERROR))
    assert changed == (kind not in (WARNING, ERROR))
    session.press("Up")
    assert session.state.view.message == ""


def test_repairs_are_not_claimed_where_nothing_is_bad() -> None:
    session = Session(state_of("venice_sunset"))
    said = []
    for _ in range(2):
        session.press("Z")
        session.prepare()
        said.append(session.state.view.message)
    assert said == ["bad values repaired: there are none", "bad values as they are: there are none"]


def test_each_thing_that_is_said_has_its_kind(tmp_path: Path) -> None:
    session = Session(state_of("green"))
    session.saving.write("writing", lambda: Written(tmp_path / "a.png"))
    assert kind_of(session.state.view.message) == DONE
    session.keep(UsageError("too many"))
    assert kind_of(session.state.view.message) == ERROR
    session.drop(str(tmp_path / "missing.hdr"))
    session.prepare()
    assert kind_of(session.state.view.message) == ERROR
    noted = session.picture.light
    assert kind_of(notes_of(noted)) == ""


def test_a_task_tells_how_far_it_is_and_how_long_it_will_take() -> None:
    told, over = threading.Event(), threading.Event()

    def make() -> list[int]:
        tell("reading sky.exr", 0.0)
        sleep(0.1)
        tell("reading sky.exr", 0.25)
        told.set()
        over.wait(10)
        tell("looking for suns")
        return [1]

    task = Task(make)
    assert told.wait(10)
    work = task.work
    assert (work.words, work.share) == ("reading sky.exr", 0.25)
    assert work.seconds_left is not None
    assert work.seconds_left == pytest.approx(3 * 0.1, abs=2)  # three quarters are left, on a busy machine
    over.set()
    assert task.wait(10)
    assert (task.work.words, task.work.share, task.work.seconds_left) == ("looking for suns", None, None)
