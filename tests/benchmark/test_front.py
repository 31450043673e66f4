"""The Pareto front, and the sentences made of measured rows."""

from __future__ import annotations

from dataclasses import replace

import pytest

from shviewer.benchmark.front import front_of, sentences
from shviewer.benchmark.measured_lights import MeasuredLight, measured_light
from shviewer.benchmark.page import tables
from shviewer.benchmark.row import Row
from shviewer.harmonics.metrics import pareto_front
from shviewer.lights.find import find_light


def row(method: str, n_bands: int, ms: float, total: float, samples: int | None = None, spread: float = 0.01) -> Row:
    return Row(
        section="projection",
        light="green",
        method=method,
        n_bands=n_bands,
        samples=samples,
        milliseconds=ms,
        low_quartile=ms * (1 - spread),
        high_quartile=ms * (1 + spread),
        repeats=5,
        total_error=total,
    )


@pytest.fixture(scope="module")
def green(green: MeasuredLight) -> MeasuredLight:
    return replace(green, needs={0.05: green.needs[0.05]})


def test_the_front_is_what_nothing_beats_in_both() -> None:
    points = [(3.0, 1.0), (1.0, 3.0), (2.0, 2.0), (2.5, 2.5), (1.0, 4.0), (4.0, 1.0), (0.5, 9.0)]
    assert pareto_front(points) == [6, 1, 2, 0]


def test_of_equal_points_the_first_is_on_the_front() -> None:
    assert pareto_front([(1.0, 1.0), (1.0, 1.0), (2.0, 1.0)]) == [0]


def test_nothing_has_no_front() -> None:
    assert pareto_front([]) == []


def test_errors_below_what_can_be_told_are_equal_on_the_front() -> None:
    rows = [row("fejer", 9, 2.0, 1e-9), row("best", 9, 1.0, 3e-8)]
    assert front_of(rows) == [rows[1]]
    rough = [row("fejer", 9, 2.0, 2e-3), row("best", 9, 1.0, 3e-3)]
    assert front_of(rough) == [rough[1], rough[0]]
    assert front_of(rough, accuracy=5e-3) == [rough[1]]


def test_a_time_within_the_spread_of_a_better_one_buys_nothing() -> None:
    rows = [row("random", 3, 0.95, 0.5, 100, spread=0.1), row("best", 3, 1.0, 0.1, spread=0.1)]
    assert front_of(rows) == [rows[1]]
    steady = [replace(each, low_quartile=each.milliseconds, high_quartile=each.milliseconds) for each in rows]
    assert front_of(steady) == steady


def test_rows_without_a_time_or_an_error_are_not_on_the_front() -> None:
    rows = [replace(row("best", 3, 1.0, 0.1), milliseconds=None), replace(row("fejer", 3, 1.0, 0.1), total_error=None)]
    assert front_of(rows) == []


def test_the_sentence_has_the_cheapest_way_and_what_the_paper_would_do(green: MeasuredLight) -> None:
    rows = [row("best", 15, 0.2, 0.046), row("jittered", 15, 15.0, 0.0534, 10_000), row("best", 16, 0.19, 0.0411)]
    assert sentences(green, rows) == [  # 16 bands are more than it needs, though faster
        "for 5 % relative L2: 15 bands, closed form, 0.200 ms, which leaves 4.6 %; the paper's 10 000 jittered samples"
        " take 75 times as long and stop at 5.34 %."
    ]


def test_a_sampled_winner_is_compared_with_the_best_way(green: MeasuredLight) -> None:
    rows = [row("best", 15, 0.4, 0.046), row("fejer", 15, 0.1, 0.048, 1000)]
    said = (
        "for 5 % relative L2: 15 bands, Fejer lat-long, 1 000 samples, 0.100 ms, which leaves 4.8 %;"
        " closed form takes 4 times as long"
    )
    assert sentences(green, rows) == [f"{said}."]
    rows.append(row("jittered", 15, 1.6, 0.0534, 10_000))
    assert sentences(green, rows) == [
        f"{said}; the paper's 10 000 jittered samples take 16 times as long as Fejer lat-long,"
        " 4 times as long as closed form, and stop at 5.34 %."
    ]


def test_an_error_next_to_1_has_the_digits_that_tell_it_from_1() -> None:
    shares = (None, 0, 1, 1.04, 0.0512, 0.1, 0.957, 0.99731, 0.9999974)
    words = ["-", "0", "1.0e+00", "1.0e+00", "5.1e-02", "1.0e-01", "0.957", "0.9973", "0.9999974"]
    assert [tables.error(share) for share in shares] == words


def test_times_within_the_spread_are_not_called_different(green: MeasuredLight) -> None:
    rows = [row("best", 15, 1.0, 0.046, spread=0.3), row("jittered", 15, 1.2, 0.049, 10_000, spread=0.3)]
    assert sentences(green, rows)[0].endswith("take as long, within the spread and reach 4.9 %.")


def test_the_best_way_is_named_before_another_that_is_as_fast(green: MeasuredLight) -> None:
    rows = [row("best", 15, 1.05, 0.046, spread=0.2), row("fejer", 15, 1.0, 0.048, 1000, spread=0.2)]
    assert sentences(green, rows) == ["for 5 % relative L2: 15 bands, closed form, 1.05 ms, which leaves 4.6 %."]


def test_a_light_that_needs_too_many_bands_is_said_to() -> None:
    sun = measured_light(find_light("sun-sky"), (0.05, 0.01))
    assert sentences(sun, []) == [
        "for 5 % relative L2 or less: this light needs more than 128 bands, whatever the method: 128 leave 95.7 %."
    ]


def test_a_tolerance_that_no_row_reaches_is_not_made_up(green: MeasuredLight) -> None:
    assert sentences(green, [row("best", 9, 0.1, 0.11)]) == [
        "for 5 % relative L2: 15 bands, of which nothing that was measured is within it; give it a larger --budget."
    ]
