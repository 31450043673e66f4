"""Repeats, turns and budgets of the timer; never how long anything takes."""

from __future__ import annotations

from time import perf_counter, sleep

import pytest

from shviewer.benchmark.timing import MOST_REPEATS, summarise, time_interleaved, time_it


def test_the_median_and_the_quartiles_are_those_of_the_times() -> None:
    found = summarise([5.0, 1.0, 2.0, 4.0, 3.0])
    assert (found.low_quartile, found.median, found.high_quartile, found.repeats) == (2.0, 3.0, 4.0, 5)
    assert found.spread == pytest.approx(2 / 3)


def test_no_times_have_no_median() -> None:
    with pytest.raises(ValueError, match="no times"):
        summarise([])


def test_work_takes_turns_after_a_warm_up() -> None:
    calls: list[str] = []
    time_interleaved({name: lambda name=name: calls.append(name) for name in "abc"}, budget=0.0, at_least=2)
    assert "".join(calls) == "abcabcabc"


def test_what_comes_before_a_run_is_told_its_number_and_not_timed() -> None:
    seen: list[int] = []

    def before(name: str, repeat: int) -> None:
        seen.append(repeat)
        sleep(0.01)

    found = time_interleaved({"": lambda: None}, budget=0.0, at_least=3, before=before)
    assert seen == [-1, 0, 1, 2]
    assert found[""].high_quartile < 10


def test_a_budget_of_nothing_still_gives_as_many_repeats_as_asked_for() -> None:
    assert time_it(lambda: None, budget=0.0, at_least=7).repeats == 7


def test_what_is_fast_is_repeated_more_often_and_not_for_ever() -> None:
    found = time_interleaved({"fast": lambda: None, "slow": lambda: sleep(0.02)}, budget=0.3, at_least=2)
    assert found["fast"].repeats == MOST_REPEATS
    assert 2 <= found["slow"].repeats < 12


def test_the_budget_ends_the_repeats() -> None:
    start = perf_counter()
    found = time_it(lambda: sleep(0.02), budget=0.1, at_least=1)
    assert found.repeats <= 5
    assert perf_counter() - start < 5
