"""When a sweep takes its steps, by a clock that the test holds."""

from __future__ import annotations

from shviewer.viewer.animation.metronome import SWEEP_SECONDS, Metronome


def test_the_first_step_is_a_whole_period_after_the_sweep_began_and_each_other_after_the_last() -> None:
    metronome = Metronome(0.5)
    beats = [quarter for quarter in range(12) if metronome.beats(True, 100 + quarter / 4)]
    assert beats == [2, 4, 6, 8, 10]


def test_nothing_beats_while_nothing_plays_and_the_next_sweep_begins_anew() -> None:
    metronome = Metronome(0.5)
    assert not any(metronome.beats(False, now) for now in (0.0, 1.0, 2.0))
    assert not metronome.beats(True, 3.0)
    assert not metronome.beats(False, 3.4)
    assert not metronome.beats(True, 3.6)  # 0.6 s after the sweep before this one
    assert metronome.beats(True, 4.1)


def test_sleep_lasts_exactly_until_the_next_step_but_never_longer_than_allowed() -> None:
    metronome = Metronome(0.5)
    assert metronome.wait(7.0, 0.25) == 0.25
    metronome.beats(True, 8.0)
    assert metronome.wait(8.0, 0.25) == 0.25
    assert metronome.wait(8.375, 0.25) == 0.125
    assert metronome.wait(8.5, 0.25) == 0
    assert metronome.wait(9.0, 0.25) == 0  # late: never negative, which GLFW refuses
    metronome.beats(False, 9.0)
    assert metronome.wait(9.0, 0.25) == 0.25


def test_a_step_that_comes_late_is_taken_once_and_not_made_up_for() -> None:
    metronome = Metronome(0.5)
    metronome.beats(True, 0.0)
    assert metronome.beats(True, 3.0)
    assert not metronome.beats(True, 3.25)
    assert metronome.beats(True, 3.5)


def test_sleeping_as_told_takes_one_wake_per_step_and_a_few_between() -> None:
    """The loop of the window: 10 steps of 0.7 s with wakes at most 0.25 s apart are 3 wakes each, and no polling."""
    metronome, now, steps, wakes = Metronome(), 0.0, 0, 0
    metronome.beats(True, now)
    while steps < 10:
        now += metronome.wait(now, 0.25)
        wakes += 1
        steps += metronome.beats(True, now)
    assert wakes <= 40
    assert abs(now - 10 * SWEEP_SECONDS) < 1e-9
