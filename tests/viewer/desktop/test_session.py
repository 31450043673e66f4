"""A session without a window: what keys ask for is done, and what cannot be shown leaves the picture that there is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from helpers import frame_of, picture_of
from viewer.desktop.sessions import SCENE, pressed

from shviewer.errors import LightError
from shviewer.viewer.control.commands import Command
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.desktop.showing import Settings
from shviewer.viewer.saving.picture_files import write_png
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.state import changed, state_of


def test_a_first_light_that_cannot_be_read_makes_no_session() -> None:
    with pytest.raises(LightError, match="unknown light"):
        Session(state_of("gren"))


def test_only_what_a_window_can_do_is_given_back() -> None:
    session = Session(state_of())
    given = {}
    for key in ("Up", "F11", "P", "T", "Y", "F5", "Esc"):
        given[key] = session.press(key)
        session.prepare()
    commands = {"F11": Command.FULL_SCREEN, "P": Command.SAVE, "Esc": Command.LEAVE}
    assert {key: command for key, command in given.items() if command is not None} == commands


def test_t_takes_as_many_bands_as_the_tolerance_needs() -> None:
    assert pressed(Session(state_of(tolerance=0.1)), "T").state.recipe.n_bands == 10
    session = pressed(Session(state_of("hemisphere", tolerance=0.0001)), "T")
    assert "no band count is within 0.01 %" in session.state.view.message
    assert session.picture.state == session.state


def test_y_faces_one_mark_after_the_other_and_says_where_there_is_none() -> None:
    session = pressed(Session(state_of(error="signed")), "Y")
    first = session.state.view.camera
    second = pressed(session, "Y").state.view.camera
    assert first != second
    assert pressed(session, "Y").state.view.camera == first
    assert "nothing is marked" in pressed(Session(state_of("constant")), "Y").state.view.message


def test_what_t_and_y_find_done_they_say() -> None:
    session = Session(state_of("green"))
    said = []
    for key in ("T", "T", "Y", "Y", "Home", "T", "D", "Y", "Y"):
        session.press(key)
        session.prepare()
        said.append(session.state.view.message)
    assert said == ["", "15 bands are what 5 % needs", "", "the only mark is in front", "", "", "", "", ""]


def test_a_file_that_is_dropped_or_edited_is_read_and_a_bad_one_leaves_the_picture(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(SCENE.format(1))
    session = Session(state_of())
    session.drop(str(path))
    session.prepare()
    assert session.picture.light.name == "mine"
    path.write_text(SCENE.format(3))
    session.do(Command.RELOAD)
    session.prepare()
    assert session.picture.coefficients[0, 0] == pytest.approx(3 * np.sqrt(4 * np.pi))
    assert session.state.view.message == "reloaded mine"
    before = session.picture.coefficients
    path.write_text("no scene")
    session.do(Command.RELOAD)
    session.prepare()
    assert session.picture.coefficients is before
    assert "mine.toml" in session.state.view.message
    assert session.state == session.picture.state
    session.drop(str(tmp_path / "gone.hdr"))
    session.prepare()
    assert session.picture.coefficients is before
    assert session.state.lights[-1] == str(path)


def test_left_and_right_go_on_from_a_light_that_is_not_among_the_others() -> None:
    session = Session(state_of("green", "studio", light="constant"))
    assert pressed(session, "Right").state.recipe.light == "studio"


def test_a_sweep_plays_by_the_clock_and_ends() -> None:
    session = pressed(Session(state_of(n_bands=3)), "Space")
    assert not session.tick(0.0)  # the first beat is a period away
    assert session.tick(0.8)
    session.prepare()
    assert session.state.recipe.n_bands == 2
    assert session.tick(1.6)
    assert (session.state.recipe.n_bands, session.state.view.sweep_to) == (3, None)
    assert not session.tick(2.4)


def test_what_a_sweep_cannot_show_ends_it(tmp_path: Path) -> None:
    session = Session(state_of(n_bands=32, window="dering", sweep_to=40))
    session.tick(0.0)
    assert session.tick(0.8)
    session.prepare()
    assert (session.state.recipe.n_bands, session.state.view.sweep_to) == (32, None)
    assert "dering takes at most 32" in session.state.view.message


def test_the_title_is_that_of_the_light_shown_however_it_came_there() -> None:
    """T makes the picture before the next frame does: a window that compares pictures from frame to frame misses it."""
    session = Session(state_of("green", "constant"))
    assert session.press("Right") is None
    assert session.press("T") is None
    session.prepare()
    assert session.title == "shviewer - constant (2 of 2)"


@pytest.mark.usefixtures("fresh_memory")
def test_a_picture_that_is_dropped_is_the_state_that_it_was_saved_from(tmp_path: Path) -> None:
    shown = picture_of("studio", n_bands=7, error="signed", camera=(1.0, 2.0), sweep_to=9)
    write_png(tmp_path / "p.png", np.zeros((2, 2, 3), np.uint8), metadata(shown, frame_of(shown), "none"))
    session = Session(state_of("green", "constant"))
    session.drop(str(tmp_path / "p.png"))
    session.prepare()
    state = session.state
    assert (state.recipe.light, state.recipe.n_bands, state.view.error, state.view.camera) == (
        "studio",
        7,
        "signed",
        (1.0, 2.0),
    )
    assert state.lights == ("green", "constant", str(tmp_path / "p.png"))
    assert pressed(session, "Left").state.recipe.light == "constant"
    assert changed(pressed(session, "Right").state, message="") == changed(state, message="")
    assert state.view.sweep_to is None  # it is looked at, not played on
    assert session.picture.state == state
    write_png(tmp_path / "p.png", np.zeros((2, 2, 3), np.uint8), "{")
    session.drop(str(tmp_path / "p.png"))
    session.prepare()
    assert "its stamp is damaged" in session.state.view.message
    assert changed(session.state, message="") == changed(state, message="")
    image = Session(state_of(), settings=Settings(as_image=True))
    image.drop(str(tmp_path / "p.png"))
    assert image.state.recipe.light == str(tmp_path / "p.png")
