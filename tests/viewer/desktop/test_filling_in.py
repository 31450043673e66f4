"""The picture comes first: figures that take a search are pending, and fill in behind it."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest
from viewer.overlay.written import texts_of

from shviewer.analysis.figures import PENDING, Figures
from shviewer.errors import LightError
from shviewer.progress import tell
from shviewer.viewer import picture as pictures
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.control.commands import Command
from shviewer.viewer.desktop.behind import task as desktop_task
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.desktop.unchanged import overlay_key
from shviewer.viewer.overlay.directions.marks import marks_of
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.overlay.plots import band_series
from shviewer.viewer.picture import first_picture, prepare, stages
from shviewer.viewer.state import state_of


@pytest.fixture
def search(monkeypatch: pytest.MonkeyPatch) -> Iterator[threading.Event]:
    """Set to let searches end."""
    over, real = threading.Event(), pictures.figures_of

    def slowly(*arguments: Any) -> Figures:
        tell("comparing")
        assert over.wait(60)
        return real(*arguments)

    monkeypatch.setattr(pictures, "figures_of", slowly)
    yield over
    over.set()


def without_figures(**values: Any) -> Session:
    """A session that shows another light after a key, and still searches for its figures."""
    session = Session(first_picture(state_of("green", "studio", **values)).state, first_picture(state_of("green")))
    session.press("Right")
    while session.picture.light.name != "studio":
        assert not session.prepare(patience=0.01)
    return session


def test_a_picture_shows_before_the_figures_that_take_a_search(search: threading.Event) -> None:
    session = without_figures()
    assert session.picture.state == session.state
    assert session.picture.figures.relative_l2 > 0
    assert (session.picture.extremes, session.picture.needs) == (PENDING, PENDING)
    assert session.working
    assert not session.prepare(patience=0.0)
    search.set()
    assert session.prepare()
    assert session.picture.complete
    assert not session.working


def test_the_last_of_the_stages_is_the_whole_picture_and_none_takes_a_figure_back() -> None:
    state = state_of("studio", error="relative", split_sun=True)
    first, *_, last = stages(state)
    whole = prepare(state)
    assert (last.figures, last.needs, last.needs_unsplit) == (whole.figures, whole.needs, whole.needs_unsplit)
    assert last.error_scale is whole.error_scale
    assert {name: getattr(whole.figures, name) for name in vars(first.figures)} == vars(first.figures)
    assert first.coefficients is whole.coefficients


def test_pending_figures_are_dots_on_the_picture_and_never_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pictures, "figures_of", None)
    monkeypatch.setattr(band_series, "errors_of", None)
    picture = first_picture(state_of("studio", error="absolute", tolerance=0.2))
    drawn = draw_overlay(picture, compose(1600, 800, n_spheres=3))
    pending = {text.name for text in texts_of(drawn) if text.text == "\u2026"}
    assert pending == {"max_error", "minimum", "negative_area", "radiance_answer", "shading_answer"}
    assert {"relative_l2", "energy"} <= set(drawn.boxes)
    assert {mark.name for mark in marks_of(picture)} == {"peak"}  # the light's own, which is there at once


def test_the_text_is_written_anew_when_the_figures_come() -> None:
    at = compose(640, 320)
    assert len({str(overlay_key(picture, at)) for picture in stages(state_of("studio"))}) == 3


def test_saving_waits_for_the_figures(search: threading.Event, monkeypatch: pytest.MonkeyPatch) -> None:
    saved: list[bool] = []
    monkeypatch.setattr(Session, "_save", lambda self, *rest: saved.append(self.picture.complete))
    session = without_figures()
    session.save(None, None)
    assert saved == []
    search.set()
    assert session.prepare()
    assert saved == [True]


def test_escape_stops_the_search_and_what_needs_the_figures_takes_it_up_again(
    search: threading.Event, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(desktop_task, "QUIET", 0.0)
    session = without_figures(tolerance=0.3)
    task = session.making._task
    assert session.press("Esc") is None
    assert session.state.view.message.startswith("stopped")
    assert session.prepare()
    assert not session.working
    assert session.picture.light.name == "studio"
    search.set()
    assert task is not None
    assert task.wait(60)
    session.do(Command.FIT)
    assert session.prepare()
    assert session.picture.complete
    assert session.state.recipe.n_bands == session.picture.needs.radiance


def test_a_search_that_fails_keeps_the_picture_and_is_not_begun_again(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []

    def failing(*arguments: object) -> None:
        asked.append(arguments)
        raise LightError("too large to search")

    monkeypatch.setattr(pictures, "figures_of", failing)
    session = Session(state_of("studio"), first_picture(state_of("studio")))
    for _ in range(3):
        assert session.prepare()
    assert (session.state.view.message, len(asked)) == ("too large to search", 1)
    session.do(Command.FIT)
    assert session.prepare()
    assert session.state.recipe.n_bands == 5
