"""The Pareto front, and the sentences made of measured rows."""

from __future__ import annotations

from dataclasses import replace

import pytest

from shviewer.benchmark.measuring.measured_lights import MeasuredLight, measured_light
from shviewer.benchmark.page import tables, use_page
from shviewer.benchmark.page.advice import front_of, sentences
from shviewer.benchmark.rows.report import LightRecord
from shviewer.benchmark.rows.row import Row
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
def record(green: MeasuredLight) -> LightRecord:
    return replace(green, needs={0.05: green.needs[0.05]}).record


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


def test_the_sentence_has_the_cheapest_way_and_what_the_paper_would_do(record: LightRecord) -> None:
    rows = [row("best", 15, 0.2, 0.046), row("jittered", 15, 15.0, 0.0534, 10_000), row("best", 16, 0.19, 0.0411)]
    assert sentences(record, rows) == [  # 16 bands are more than it needs, though faster
        "for a total error of 5 %: 15 bands, fastest by closed form in 0.200 ms, which leaves 4.60 %; the paper's 10 000"
        " jittered samples take 75 times as long as closed form and stop at 5.34 %."
    ]


def test_the_way_of_a_function_reads_as_one_thing(record: LightRecord) -> None:
    """What it may miss stands where the accuracy of the reference does."""
    words = "Gauss-Legendre, 51 200 points; features narrower than 0.5 degrees may be missed"
    function = replace(record, best_method=words, accuracy=1e-8)
    rows = [row("best", 15, 0.4, 0.046), row("fejer", 15, 0.1, 0.048, 1000)]
    (said,) = sentences(function, rows)
    assert "; Gauss-Legendre (51 200 points) takes 4 times as long as Fejer lat-long and leaves 4.60 %." in said
    page = "\n".join(use_page.advised(function, rows))
    assert page.count("may be missed") == 1
    assert "may be off by 1.0e-6 %, and features narrower than 0.5 degrees may be missed." in page


def test_a_sampled_winner_is_compared_with_the_best_way(record: LightRecord) -> None:
    rows = [row("best", 15, 0.4, 0.046), row("fejer", 15, 0.1, 0.048, 1000)]
    said = (
        "for a total error of 5 %: 15 bands, fastest by Fejer lat-long, 1 000 samples, in 0.100 ms, which leaves 4.80 %;"
        " closed form takes 4 times as long as Fejer lat-long and leaves 4.60 %"
    )
    assert sentences(record, rows) == [f"{said}."]
    rows.append(row("jittered", 15, 1.6, 0.0534, 10_000))
    assert sentences(record, rows) == [
        f"{said}; the paper's 10 000 jittered samples take 16 times as long as Fejer lat-long,"
        " 4 times as long as closed form, and stop at 5.34 %."
    ]


def test_an_error_next_to_1_has_the_digits_that_tell_it_from_1() -> None:
    shares = (None, 0, 1, 1.04, 0.0512, 0.1, 0.957, 0.99731, 0.9999974)
    words = ["-", "0 %", "100 %", "104 %", "5.12 %", "10.0 %", "95.7 %", "99.7 %", "99.9997 %"]
    assert [tables.error(share) for share in shares] == words
    assert [tables.error(share) for share in (1.2e-5, 9.9e-6, 2.2e-7, 12.3)] == [
        "0.00120 %",
        "9.9e-4 %",
        "2.2e-5 %",
        "1230 %",
    ]


def test_values_that_differ_are_told_apart_and_the_others_are_short() -> None:
    """For a light that no bands hold, 0.99 and more was the same "1.0e+00" in every line of the front."""
    values = [0.99999936, 0.99999934, 0.957, 0.957, None, 0.95701]
    said = ["99.99994 %", "99.99993 %", "95.700 %", "95.700 %", "-", "95.701 %"]
    assert tables.told_apart(values, tables.error) == said
    assert tables.told_apart([0.0418, 0.04181, 12.0], tables.milliseconds) == ["0.04180", "0.04181", "12.0"]


def test_times_within_the_spread_are_not_called_different(record: LightRecord) -> None:
    rows = [row("best", 15, 1.0, 0.046, spread=0.3), row("jittered", 15, 1.2, 0.049, 10_000, spread=0.3)]
    assert sentences(record, rows)[0].endswith("take as long as closed form within the spread and reach 4.90 %.")


def test_the_best_way_is_named_before_another_that_is_as_fast(record: LightRecord) -> None:
    rows = [row("best", 15, 1.05, 0.046, spread=0.2), row("fejer", 15, 1.0, 0.048, 1000, spread=0.2)]
    assert sentences(record, rows) == [
        "for a total error of 5 %: 15 bands, fastest by closed form in 1.05 ms, which leaves 4.60 %."
    ]


def test_a_light_that_needs_too_many_bands_is_said_to() -> None:
    sun = measured_light(find_light("sun-sky"), (0.05, 0.01))
    assert sentences(sun.record, []) == [
        "for a total error of 5 % or less: more than 128 bands, whatever the method, since the exact first 128 leave 95.7 %."
    ]


def test_a_tolerance_that_no_row_reaches_is_not_made_up(record: LightRecord) -> None:
    assert sentences(record, [row("best", 9, 0.1, 0.11)]) == [
        "for a total error of 5 %: 15 bands, but nothing measured is within it; give it a larger --budget."
    ]


def test_tolerances_of_which_the_same_can_be_said_share_a_sentence(record: LightRecord) -> None:
    """For coefficients, which their own bands hold whole, the same sentence stood there three times."""
    given = replace(record, bands_within={"0.1": 3, "0.05": 3, "0.01": 3}, error_by_bands=[0.9, 0.5, 0.0])
    (said,) = sentences(given, [row("best", 3, 0.1, 0.0)])
    assert said.startswith("for a total error of 10 %, 5 % and 1 %: 3 bands, fastest by closed form")
