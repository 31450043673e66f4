"""The size of the last window is kept only where that is asked for, and taken only if it is a size."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from viewer.desktop.desktop import PATIENCE, Viewer

from shviewer.viewer.desktop.last_size import keep_size, last_size


@pytest.fixture
def kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where it is kept."""
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "state" / "shviewer" / "window.json"


def test_a_size_that_was_kept_is_the_last_one(kept: Path) -> None:
    assert last_size() is None
    keep_size((700, 500))
    keep_size((800, 400))
    assert last_size() == (800, 400)
    assert [path.name for path in kept.parent.iterdir()] == ["window.json"]


@pytest.mark.parametrize("text", ["", "{", "[]", '{"size": 3}', '{"size": [1, 2]}', '{"size": [640.5, 320]}', "\xff"])
def test_what_is_no_size_is_none(kept: Path, text: str) -> None:
    kept.parent.mkdir(parents=True)
    kept.write_text(text, "latin-1")
    assert last_size() is None


def test_where_nothing_can_be_kept_nothing_fails(kept: Path) -> None:
    kept.parent.parent.write_text("in the way")
    keep_size((700, 500))
    assert last_size() is None


def test_the_window_opens_at_the_size_it_had_only_if_asked(
    start: Callable[..., Viewer], kept: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer = start("--last-size", "--size", "640", "360")
    viewer.forget()
    viewer.xdotool("windowsize", viewer.window, "660", "350")
    viewer.wait_for("660 x 350")
    viewer.xdotool("key", "ctrl+q")
    assert viewer.process.wait(PATIENCE) == 0
    assert last_size() == (660, 350)
    again = start("--last-size")
    assert any("660 x 350" in line for line in again.seen)
    again.xdotool("key", "ctrl+q")
    assert again.process.wait(PATIENCE) == 0
    unasked = start("--size", "640", "320")
    unasked.xdotool("key", "ctrl+q")
    assert unasked.process.wait(PATIENCE) == 0
    assert last_size() == (660, 350)
