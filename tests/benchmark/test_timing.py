"""Repeats, turns and budgets of the timer; never how long anything takes."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from shviewer.benchmark.measuring import timing
from shviewer.benchmark.measuring.timing import MOST_REPEATS, summarise, time_interleaved


@pytest.fixture
def taking(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], Callable[[], None]]:
    """Makes work that takes so many seconds of a clock which nothing else moves."""
    now = 0.0

    def work(seconds: float) -> None:
        nonlocal now
        now += seconds

    monkeypatch.setattr(timing, "perf_counter", lambda: now)
    return lambda seconds: lambda: work(seconds)


def test_the_median_and_the_quartiles_are_those_of_the_times() -> None:
    found = summarise([5.0, 1.0, 2.0, 4.0, 3.0])
    assert (found.low_quartile, found.milliseconds, found.high_quartile, found.repeats) == (2.0, 3.0, 4.0, 5)


def test_no_times_have_no_median() -> None:
    with pytest.raises(ValueError, match="no times"):
        summarise([])


def test_work_takes_turns_after_a_warm_up() -> None:
    calls: list[str] = []
    time_interleaved({name: lambda name=name: calls.append(name) for name in "abc"}, budget=0.0, at_least=2)
    assert "".join(calls) == "abcabcabc"


def test_what_comes_before_a_run_is_told_its_number_and_not_timed(
    taking: Callable[[float], Callable[[], None]],
) -> None:
    seen: list[int] = []
    prepare = taking(10.0)

    def before(name: str, repeat: int) -> None:
        seen.append(repeat)
        prepare()

    found = time_interleaved({"": taking(0.002)}, budget=0.0, at_least=3, before=before)
    assert seen == [-1, 0, 1, 2]
    assert found[""].high_quartile == pytest.approx(2.0)


def test_a_budget_of_nothing_still_gives_as_many_repeats_as_asked_for() -> None:
    assert time_interleaved({"": lambda: None}, budget=0.0, at_least=7)[""].repeats == 7


def test_what_is_fast_is_repeated_more_often_and_not_for_ever(taking: Callable[[float], Callable[[], None]]) -> None:
    found = time_interleaved({"fast": taking(2**-20), "slow": taking(2**-6)}, budget=2**-2, at_least=2)
    assert found["fast"].repeats == MOST_REPEATS
    assert found["slow"].repeats == 8  # its half of the budget


def test_the_budget_ends_the_repeats(taking: Callable[[float], Callable[[], None]]) -> None:
    assert time_interleaved({"": taking(2**-6)}, budget=2**-3, at_least=1)[""].repeats == 8
    assert time_interleaved({"": taking(1.0)}, budget=2**-3, at_least=3)[""].repeats == 3


def test_what_does_not_fit_by_its_warm_up_is_not_repeated_and_what_comes_after_the_time_not_begun(
    taking: Callable[[float], Callable[[], None]],
) -> None:
    calls: list[str] = []

    def work(name: str, seconds: float) -> Callable[[], object]:
        take = taking(seconds)
        return lambda: (calls.append(name), take())

    works = {
        name: work(name, seconds) for name, seconds in (("a", 1.0), ("b", 9.0), ("c", 2.0), ("d", 20.0), ("e", 1.0))
    }
    found = time_interleaved(works, budget=0.0, at_most=30.0, at_least=3)
    assert {name: timing.repeats for name, timing in found.items()} == {"a": 3, "c": 3}
    assert "".join(calls) == "abcd" + 3 * "ac"
