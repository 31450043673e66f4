"""Several lights in the window: dropped together, gone through, and those that cannot be opened named and passed over."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from helpers import frame_of, picture_of
from viewer.desktop.sessions import SCENE, pressed

from shviewer.viewer.desktop.session import Session
from shviewer.viewer.saving.picture_files import write_png
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.state import changed, state_of


@pytest.fixture
def some(tmp_path: Path) -> dict[str, str]:
    """Lights that can be read, and two that cannot."""
    for number in (1, 2, 10):
        (tmp_path / f"sky-{number}.toml").write_text(SCENE.format(number))
    (tmp_path / "bad.toml").write_text("[[lobe]]\nprofile = 7\n")
    (tmp_path / "worse.hdr").write_text("no image")
    return {path.name: str(path) for path in tmp_path.iterdir()}


def test_left_and_right_go_through_what_was_dropped_together_and_over_what_is_bad(some: dict[str, str]) -> None:
    session = Session(state_of("green", some["sky-2.toml"]))
    dropped = [some[name] for name in ("sky-1.toml", "bad.toml", "worse.hdr", "sky-2.toml")]
    session.drop(*dropped)
    session.prepare()
    assert session.picture.light.name == "sky-1"
    assert session.state.lights == ("green", *dropped)
    assert pressed(session, "Right").picture.light.name == "sky-2"
    assert session.state.view.message.startswith("skipped bad.toml, worse.hdr; the last: ")
    assert session.state.lights == ("green", some["sky-1.toml"], some["sky-2.toml"])
    assert pressed(session, "Left").picture.light.name == "sky-1"
    assert session.state.view.message == ""
    assert pressed(session, "Left", "Left").picture.light.name == "sky-2"
    assert session.state == session.picture.state


def test_the_first_of_a_drop_that_can_be_opened_is_shown_and_where_none_can_nothing_changes(
    some: dict[str, str],
) -> None:
    session = Session(state_of("green", "constant"))
    session.drop(some["bad.toml"], some["sky-1.toml"])
    session.prepare()
    assert (session.picture.light.name, session.state.lights[2:]) == ("sky-1", (some["sky-1.toml"],))
    assert session.state.view.message.startswith("skipped ")
    assert "bad.toml" in session.state.view.message
    before = session.state
    session.drop(some["bad.toml"], some["worse.hdr"])
    session.prepare()
    assert changed(session.state, message="") == changed(before, message="")
    assert "worse.hdr" in session.state.view.message


def test_a_folder_is_dropped_by_names_and_never_code(tmp_path: Path, some: dict[str, str]) -> None:
    session = Session(state_of("green"))
    session.drop(str(tmp_path), f"{tmp_path / 'light.py'}:f")
    session.prepare()
    names = [Path(str(light)).name for light in session.state.lights]
    assert names == ["green", "sky-1.toml", "sky-2.toml", "sky-10.toml", "worse.hdr"]  # bad.toml was passed over
    assert "bad.toml" in session.state.view.message


def test_of_a_thousand_files_the_first_hundred_are_opened_and_that_is_said(tmp_path: Path) -> None:
    paths = [tmp_path / f"{number}.toml" for number in range(1000)]
    paths[0].write_text(SCENE.format(1))
    session = Session(state_of("green"))
    session.drop(*map(str, paths))
    session.prepare()
    assert session.state.view.message == "the first 100 of 1000 files are opened"
    assert session.state.lights == ("green", *map(str, paths[:100]))


@pytest.mark.usefixtures("fresh_memory")
def test_pictures_among_several_lights_are_the_states_that_they_were_saved_from(tmp_path: Path) -> None:
    for name, n_bands in (("a.png", 3), ("b.png", 7), ("broken.png", 5)):
        shown = picture_of("studio", n_bands=n_bands)
        text = metadata(shown, frame_of(shown), "none") if name != "broken.png" else "{"
        write_png(tmp_path / name, np.zeros((2, 2, 3), np.uint8), text)
    session = Session(state_of("green"))
    session.drop(str(tmp_path))
    session.prepare()
    assert (session.state.recipe.light, session.state.recipe.n_bands) == ("studio", 3)
    assert pressed(session, "Right").state.recipe.n_bands == 7
    assert pressed(session, "Right").state.recipe.light == "green"
    assert "broken.png: its stamp is damaged" in session.state.view.message
    assert pressed(session, "Left").state.recipe.n_bands == 7
