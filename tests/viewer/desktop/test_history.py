"""What keys changed is undone and done again, step by step; what the mouse has placed since then stays."""

from __future__ import annotations

import random

import pytest

from shviewer.viewer.control.keys import ACTIONS, press
from shviewer.viewer.desktop.clipboard import named_files
from shviewer.viewer.desktop.history import MOST, STEPS, History
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.state import State, changed, state_of

GO = (("recipe", "n_bands"), ("recipe", "window"), ("view", "error"), ("view", "camera"))


def told(state: State) -> dict[str, object]:
    return {name: getattr(getattr(state, part), name) for part, name in GO}


def pressed(session: Session, *keys: str) -> dict[str, object]:
    for key in keys:
        assert session.press(key) is None, key
        session.prepare()
    return told(session.state)


def test_every_step_is_undone_and_done_again_in_its_order() -> None:
    session = Session(state_of())
    steps = [told(session.state), *(pressed(session, key) for key in ("Up", "W", "D", "Up"))]
    assert [pressed(session, "Ctrl+Z") for _ in range(4)] == steps[-2::-1]
    assert pressed(session, "Ctrl+Z") == steps[0]
    assert session.state.view.message == "there is nothing to undo"
    assert [pressed(session, key) for key in ("Ctrl+Y", "Ctrl+Shift+Z", "Ctrl+Y", "Ctrl+Y")] == steps[1:]
    assert pressed(session, "Ctrl+Y") == steps[-1]
    assert session.state.view.message == "nothing was undone that could be done again"
    assert session.picture.state == session.state


def test_another_key_ends_what_could_be_done_again() -> None:
    session = Session(state_of())
    pressed(session, "Up", "W", "Ctrl+Z", "D", "Ctrl+Y")
    assert "nothing was undone" in session.state.view.message
    assert told(session.state)["window"] == "none"


def test_a_reset_that_was_not_meant_is_undone_and_the_camera_is_back() -> None:
    session = Session(state_of())
    before = pressed(session, "Up", "Up", "W", "V")
    session.state = changed(session.state, camera=(40.0, 10.0))
    assert pressed(session, "R")["n_bands"] == 5
    assert pressed(session, "Ctrl+Z") == {**before, "camera": (40.0, 10.0)}


def test_a_drag_is_no_step_and_stays() -> None:
    session = Session(state_of())
    pressed(session, "W")
    session.state = changed(session.state, camera=(40.0, 10.0), zoom=2.0)
    assert pressed(session, "Ctrl+Z") == {**told(state_of()), "camera": (40.0, 10.0)}
    assert session.state.view.zoom == 2.0


def test_what_the_tolerance_and_a_click_on_a_band_changed_is_undone_too() -> None:
    session = Session(state_of(tolerance=0.1))
    assert pressed(session, "T")["n_bands"] == 10
    session.state = changed(session.state, muted=frozenset((3,)))
    pressed(session, "Ctrl+Z")
    assert (session.state.recipe.muted, session.state.recipe.n_bands) == (frozenset(), 10)
    assert pressed(session, "Ctrl+Z")["n_bands"] == 5


def test_the_light_before_comes_back_with_its_place() -> None:
    session = Session(state_of("green", lights=("green", "constant")))
    pressed(session, "Right", "Up")
    assert session.picture.light.name == "constant"
    pressed(session, "Ctrl+Z", "Ctrl+Z")
    assert (session.picture.light.name, session.state.place) == ("green", 0)


def test_messages_help_and_the_cursor_make_no_steps_and_an_undone_sweep_stops() -> None:
    session = Session(state_of())
    assert pressed(session, "Up", "H", "H", ".", ",", "Ctrl+Z")["n_bands"] == 5
    pressed(session, "Space", "Ctrl+Z")
    assert (session.state.recipe.n_bands, session.state.view.sweep_to) == (5, None)


def test_what_could_not_be_is_no_step() -> None:
    """A layout that the image cannot have was shown by Ctrl+Z as a refusal, again and again."""
    session = Session(state_of("venice_sunset"))
    before = pressed(session, "W")
    while not session.state.view.message.startswith("venice_sunset"):
        pressed(session, "L")
    layout = session.state.recipe.reading.layout
    assert layout == "lat-long"
    pressed(session, "Ctrl+Z")
    assert (told(session.state), session.state.recipe.reading.layout) == (before, "auto")
    assert session.state.view.message.startswith("undone")
    assert pressed(session, "Ctrl+Z")["window"] == "none"


@pytest.mark.parametrize("seed", range(5))
def test_any_keys_are_undone_to_the_beginning(seed: int) -> None:
    """Without a picture, so that hundreds are tried: all that keys make of a state is a step or passes."""
    keys = random.Random(seed)
    state = first = state_of("green", lights=("green", "constant", "studio"))
    history = History(state)
    for _ in range(80):
        history.note(state, by_key=False)
        done = press(
            state, keys.choice([key for key in sorted(ACTIONS) if key not in ("Esc", "Q", "Shift+Q", "Space")])
        )
        state = done if isinstance(done, State) else state
        history.note(state, by_key=True)
    last = state
    while (before := history.undo(state)) is not None:
        state = before
    assert [getattr(state.view, name) for name in STEPS] == [getattr(first.view, name) for name in STEPS]
    assert (state.recipe, state.lights) == (first.recipe, first.lights)
    while (after := history.redo(state)) is not None:
        state = after
    assert [getattr(state.view, name) for name in STEPS] == [getattr(last.view, name) for name in STEPS]
    assert state.recipe == last.recipe


def test_no_more_steps_are_kept_than_anybody_goes_back() -> None:
    history, state = History(state_of()), state_of()
    for count in range(MOST + 50):
        state = changed(state, n_bands=1 + count % 2)
        history.note(state, by_key=True)
    steps = 0
    while (before := history.undo(state)) is not None:
        state, steps = before, steps + 1
    assert steps == MOST


def test_the_clipboard_names_files_as_file_managers_copy_them(tmp_path, monkeypatch) -> None:
    sky, other = tmp_path / "sky \u65e5.hdr", tmp_path / "b.exr"
    sky.touch()
    other.touch()
    monkeypatch.setenv("HOME", str(tmp_path))
    assert named_files(f"{sky.as_uri()}\r\n{other}\n") == [str(sky), str(other)]
    assert named_files(f'"{sky}"') == [str(sky)]
    assert named_files("~/b.exr") == [str(other)]
    assert named_files("some words\n\n/nowhere/x.hdr\nfile://[bad\na\0b") == []
