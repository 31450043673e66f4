"""What plays in the window shows its error in one range of colours, that of a file of it, until something else is shown."""

from __future__ import annotations

import pytest

from shviewer.progress import listening
from shviewer.viewer.animation.animation import band_sweep, ranged
from shviewer.viewer.animation.turning import light_turn
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.control.playing import SWEEP_BANDS, step_sweep, step_turn
from shviewer.viewer.desktop import session as sessions
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.picture import prepare
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.saving.stamp_reading import state_of_stamp
from shviewer.viewer.state import State, changed, state_of

SAMPLED = {"n_bands": 4, "method": "jittered", "samples": 100}


class Played:
    """A session in which a key was pressed, and the states of its pictures since."""

    def __init__(self, *keys: str, **values: object) -> None:
        self.session = Session(state_of("green", **{"error": "signed", "n_bands": 6, **values}))
        self.now = 0.0
        for key in keys:
            self.press(key)

    def press(self, key: str) -> State:
        self.session.press(key)
        self.session.prepare()
        return self.shown

    def beat(self) -> State:
        self.now += 1.0
        self.session.tick(self.now)
        self.session.prepare()
        return self.shown

    def shown_soon(self) -> State:
        self.session.prepare()
        return self.shown

    @property
    def shown(self) -> State:
        assert self.session.picture.state == self.session.state
        return self.session.picture.state

    @property
    def end(self) -> float:
        assert self.session.picture.error_scale is not None
        return self.session.picture.error_scale.end


@pytest.mark.parametrize("error", ["signed", "relative"])
def test_space_plays_the_frames_of_the_file(error: str) -> None:
    window = Played("Space", error=error)
    states = [window.shown]
    window.beat()  # from which a period is counted
    while states[-1].view.sweep_to is not None:
        states.append(window.beat())
    assert tuple(states) == band_sweep(state_of("green", error=error, n_bands=6), 1, 6).states
    assert len({state.view.error_range for state in states}) == 1


def test_a_sweep_from_the_one_band_that_is_shown_has_a_range_before_its_first_step() -> None:
    window = Played("Space", n_bands=1)
    (first, *_) = band_sweep(state_of("green", error="signed", n_bands=1), 1, SWEEP_BANDS).states
    assert window.shown == first
    assert window.end == first.view.error_range


@pytest.mark.parametrize("key", ["Q", "Shift+Q"])
def test_a_light_that_turns_keeps_the_range_of_its_first_frame(key: str) -> None:
    window = Played(key, **SAMPLED)
    first = light_turn(state_of("green", error="signed", **SAMPLED), 72, 0.08, fresh=True).states[0]
    shown = [window.beat() for _ in range(4)]
    assert {state.view.error_range for state in shown} == {first.view.error_range}
    assert shown[-1].recipe.turn != shown[0].recipe.turn


@pytest.mark.parametrize("key", ["Up", "D", "0", "W", "I", "M"])
def test_what_is_shown_afterwards_has_its_own_range(key: str) -> None:
    window = Played("Space", "Space")
    assert window.shown.view.range_held
    state = window.press(key)
    assert (state.view.error_range, state.view.range_held) == (None, False)
    assert window.end == prepare(state).error_scale.end


def test_another_error_while_it_plays_gets_the_range_of_the_same_sweep() -> None:
    window = Played("Space", "D")
    wanted = band_sweep(state_of("green", error="absolute", n_bands=6), 1, 6).states[0]
    assert window.shown.view.error_range == wanted.view.error_range


def test_a_range_that_was_given_stays() -> None:
    window = Played("Space", error_range=0.3)
    assert (window.beat().view.error_range, window.press("Up").view.error_range) == (0.3, 0.3)


def test_looking_around_and_stopping_change_no_colours() -> None:
    window = Played("Space")
    held = window.end
    for key in ("X", "E", ",", "G", "Space", "F"):
        window.press(key)
        assert window.end == held


def test_a_picture_saved_while_it_plays_is_its_state_again() -> None:
    window = Played("Space")
    picture = window.session.picture
    read = state_of_stamp(metadata(picture, compose(320, 160), "4.5"))
    assert (read.recipe, read.view) == (picture.state.recipe, picture.state.view)
    assert changed(read, n_bands=9).view.error_range is None


def test_a_picture_that_was_asked_for_before_its_range_was_found_is_saved(monkeypatch: pytest.MonkeyPatch) -> None:
    window, saved = Played(), list[State]()
    monkeypatch.setattr(
        window.session.saving, "picture", lambda renderer, picture, at: saved.append(picture.state) or True
    )
    monkeypatch.setattr(sessions, "PATIENCE", 0.0)
    window.session.press("Space")
    window.session.save(None, compose(320, 160))
    assert window.shown_soon() == saved[0]
    assert saved[0].view.range_held


def test_steps_keep_a_range_only_while_it_is_held() -> None:
    state = changed(state_of("green", error="signed", n_bands=2, sweep_to=5), error_range=0.4, range_held=True)
    assert step_sweep(state).view.error_range == 0.4
    assert step_turn(changed(state, turning="same")).view.error_range == 0.4
    assert changed(state, encode="l1").view.error_range is None


def test_while_the_range_is_sought_it_is_said_how_far_that_is() -> None:
    said: list[tuple[str, float | None]] = []
    with listening(lambda what, share: said.append((what, share))):
        ranged(changed(state_of("green", n_bands=1, error="signed"), sweep_to=8))
    shares = [share for what, share in said if what == "finding the range of the errors"]
    assert shares == [number / 8 for number in range(8)]
