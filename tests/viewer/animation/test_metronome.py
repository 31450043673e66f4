"""When a sweep takes its steps, by a clock that the test holds."""

from __future__ import annotations

from shviewer.viewer.animation.metronome import SWEEP_SECONDS, Metronome


def test_the_first_step_is_a_whole_period_after_the_sweep_began_and_each_other_after_the_last() -> None:
    metronome = Metronome()
    beats = [quarter for quarter in range(12) if metronome.beats(0.5, 100 + quarter / 4)]
    assert beats == [2, 4, 6, 8, 10]


def test_nothing_beats_while_nothing_plays_and_the_next_sweep_begins_anew() -> None:
    metronome = Metronome()
    assert not any(metronome.beats(None, now) for now in (0.0, 1.0, 2.0))
    assert not metronome.beats(0.5, 3.0)
    assert not metronome.beats(None, 3.4)
    assert not metronome.beats(0.5, 3.6)  # 0.6 s after the sweep before this one
    assert metronome.beats(0.5, 4.1)


def test_sleep_lasts_exactly_until_the_next_step_but_never_longer_than_allowed() -> None:
    metronome = Metronome()
    assert metronome.wait(7.0, 0.25) == 0.25
    metronome.beats(0.5, 8.0)
    assert metronome.wait(8.0, 0.25) == 0.25
    assert metronome.wait(8.375, 0.25) == 0.125
    assert metronome.wait(8.5, 0.25) == 0
    assert metronome.wait(9.0, 0.25) == 0  # late: never negative, which GLFW refuses
    metronome.beats(None, 9.0)
    assert metronome.wait(9.0, 0.25) == 0.25


def test_a_step_that_comes_late_is_taken_once_and_not_made_up_for() -> None:
    metronome = Metronome()
    metronome.beats(0.5, 0.0)
    assert metronome.beats(0.5, 3.0)
    assert not metronome.beats(0.5, 3.25)
    assert metronome.beats(0.5, 3.5)


def test_sleeping_as_told_takes_one_wake_per_step_and_a_few_between() -> None:
    """The loop of the window: 10 steps of 0.7 s with wakes at most 0.25 s apart are 3 wakes each, and no polling."""
    metronome, now, steps, wakes = Metronome(), 0.0, 0, 0
    metronome.beats(SWEEP_SECONDS, now)
    while steps < 10:
        now += metronome.wait(now, 0.25)
        wakes += 1
        steps += metronome.beats(SWEEP_SECONDS, now)
    assert wakes <= 40
    assert abs(now - 10 * SWEEP_SECONDS) < 1e-9
