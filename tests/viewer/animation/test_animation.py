"""The states of an animation, before anything is drawn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shviewer.errors import OutputError, UsageError
from shviewer.outputs import check_place
from shviewer.viewer.animation.animation import HOLD, MAX_PIXELS, band_sweep, save_animation, turntable
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.control.keys import press
from shviewer.viewer.control.playing import step_sweep
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import changed, state_of

START = state_of("studio", muted=frozenset({2}), camera=(300.0, -10.0), zoom=1.5)


def test_a_band_sweep_changes_nothing_but_the_bands_and_ends_as_the_screenshot_of_the_last() -> None:
    animation = band_sweep(START, 2, 6)
    assert [state.recipe.n_bands for state in animation.states] == [2, 3, 4, 5, 6]
    assert [changed(state, n_bands=5, sweep_to=None) for state in animation.states] == [START] * 5
    assert [state.view.sweep_to for state in animation.states] == [
        6,
        6,
        6,
        6,
        None,
    ]  # the bars of 6 bands are there all along
    assert animation.states[-1] == animation.portrait == changed(START, n_bands=6)


def test_a_band_sweep_is_what_space_plays() -> None:
    played = [press(changed(START, n_bands=7), "Space")]
    while played[-1].view.sweep_to is not None:
        played.append(step_sweep(played[-1]))
    assert band_sweep(START, 1, 7).states == tuple(played)


def test_a_basis_function_and_a_cursor_above_the_bands_of_a_frame_are_left() -> None:
    states = band_sweep(changed(START, n_bands=8, basis=(4, -3), cursor=6), 2, 8).states
    assert [state.view.cursor for state in states] == [1] * 7
    assert {state.view.basis for state in states} == {None}


@pytest.mark.parametrize("error", ["signed", "relative"])
def test_the_colours_of_the_error_mean_the_same_in_every_frame(error: str) -> None:
    """The range is that of the largest error, to two digits upwards; one that is given stays."""
    states = band_sweep(changed(START, error=error), 1, 5).states
    (error_range,) = {state.view.error_range for state in states}
    ends = [prepare(changed(state, error_range=None)).error_scale.end for state in states]
    assert error_range is not None
    assert max(ends) * (1 - 1e-3) <= error_range < 1.11 * max(ends)  # the grid's largest error, and the true one
    assert min(ends) < error_range
    given = band_sweep(changed(START, error=error, error_range=0.3), 1, 5).states
    assert {state.view.error_range for state in given} == {0.3}
    assert band_sweep(START, 1, 5).states[0].view.error_range is None


def test_a_sweep_of_one_band_count_is_one_frame() -> None:
    animation = band_sweep(START, 3, 3, 0.5)
    assert animation.states == (changed(START, n_bands=3),)
    assert animation.milliseconds == (1500,)


def test_the_last_band_count_is_held_and_times_are_hundredths_of_a_second() -> None:
    assert band_sweep(START, 1, 4, 0.25).milliseconds == (250, 250, 250, 250 * HOLD)
    assert band_sweep(START, 1, 2, 0.0349).milliseconds == (30, 30 * HOLD)
    assert turntable(START, 3, 0.29).milliseconds == (290,) * 3


def test_a_turntable_goes_once_round_in_equal_steps_from_where_the_camera_stands() -> None:
    animation = turntable(START, 8)
    azimuths = [state.view.camera[0] for state in animation.states]
    assert azimuths == [300, 345, 30, 75, 120, 165, 210, 255]
    assert animation.states[0] == animation.portrait == START
    assert [changed(state, camera=START.view.camera) for state in animation.states] == [START] * 8
    assert {state.view.camera[1] for state in animation.states} == {-10.0}
    steps = np.diff([state.view.camera[0] for state in turntable(START).states], append=300) % 360
    np.testing.assert_allclose(steps, 5, rtol=0, atol=1e-9)


def test_an_animation_that_would_fill_the_memory_is_refused_with_a_size_that_fits(tmp_path: Path) -> None:
    out = tmp_path / "a.gif"
    animation = turntable(START, 700)
    with pytest.raises(UsageError, match="700 frames of 4000 x 1000: at most 537 megapixels") as refused:
        save_animation(animation, compose(4000, 1000), out)
    width, height = map(int, str(refused.value).split()[-2:])
    assert 0.99 * MAX_PIXELS < 700 * width * height <= MAX_PIXELS
    assert list(tmp_path.iterdir()) == []


def test_a_place_is_checked_and_left_as_it_is(tmp_path: Path) -> None:
    kept = tmp_path / "kept.gif"
    kept.write_text("kept")
    check_place(kept)
    check_place(tmp_path / "new.gif")
    assert (list(tmp_path.iterdir()), kept.read_text()) == ([kept], "kept")
    with pytest.raises(OutputError, match=r"gone/a\.gif: cannot be written: no such folder; choose"):
        check_place(tmp_path / "gone" / "a.gif")
    with pytest.raises(OutputError, match="s a directory"):
        check_place(tmp_path)
    with pytest.raises(OutputError, match=r"[Nn]ot a directory"):
        check_place(kept / "a.gif")
