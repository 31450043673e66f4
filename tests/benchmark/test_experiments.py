"""The table of methods, their rows, and how far a budget goes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from shviewer.benchmark.measuring import projection_rows
from shviewer.benchmark.measuring.experiments import BEST, METHODS, Method, method
from shviewer.benchmark.measuring.measured_lights import MeasuredLight, find_measured_lights, measured_light
from shviewer.benchmark.measuring.projection_rows import Experiment, projection_errors
from shviewer.benchmark.page.tables import lines_not_measured
from shviewer.benchmark.rows.row import Row, not_measured
from shviewer.errors import UsageError
from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.metrics import channel_figures
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.function import FunctionLight
from shviewer.lights.light import Light

RANDOM = {"jittered", "random"}


def small_image() -> EnvironmentLight:
    texels = np.random.default_rng(0).gamma(2.0, size=(32, 64, 3)).astype(np.float32)
    return EnvironmentLight(texels, name="noise")


def project(each: Method, light: Light, samples: int, seed: int, n_bands: int) -> np.ndarray:
    return each.prepare(light, samples, seed, n_bands).project()


@pytest.fixture(scope="module")
def green(green: MeasuredLight) -> MeasuredLight:
    return replace(green, needs={0.1: green.needs[0.1]})


def rows_of(
    measured: MeasuredLight, seed: int, bands: tuple[int, ...] = (3, 5), samples: tuple[int, ...] = (100, 400)
) -> list[Row]:
    rows: list[Row] = []
    rounds = projection_rows.plan([measured], bands, samples)
    projection_rows.measure(rounds, lambda: 1e3, seed, rows.extend, lambda what: None, filling=0.0)
    return rows


@pytest.fixture(scope="module")
def green_rows(green: MeasuredLight) -> list[Row]:
    return rows_of(green, 0)


def test_every_method_comes_near_the_lights_own_coefficients() -> None:
    """Within 5 %: twice what 40 000 random samples leave of 16 coefficients; the others are far below."""
    for light in (find_light("cosine"), small_image()):
        exact = light.coefficients(4)
        for each in METHODS:
            if each.applies(light):
                found = project(each, light, 40_000, 1, 4)
                assert found.shape == (16, 3), each.name
                assert np.linalg.norm(found - exact) < 0.05 * np.linalg.norm(exact), (each.name, light.name)


@pytest.mark.parametrize(("name", "low", "high"), [("random", -0.7, -0.3), ("jittered", -1.2, -0.8)])
def test_errors_of_random_methods_fall_as_theory_says(name: str, low: float, high: float) -> None:
    """On a smooth light N^(-1/2) for independent points and N^-1 for one per cell; medians of nine seeds."""
    measured = measured_light(FunctionLight(lambda d: np.exp(d @ [1.0, 0.5, -0.3])))
    medians = []
    for samples in (400, 25_600):
        found = [project(method(name), measured.light, samples, seed, 3) for seed in range(9)]
        medians.append(np.median([projection_errors(measured, each).error for each in found]))
    assert low < np.log(medians[1] / medians[0]) / np.log(64) < high


def test_gauss_legendre_is_exact_once_there_are_points_enough() -> None:
    """For a light of n bands n rows do, products of the light and the basis having 2n - 1 degrees at most in cos(theta)."""
    n_bands = 8
    coefficients = np.random.default_rng(3).normal(size=(n_bands**2, 3))
    light = FunctionLight(lambda d: evaluate_basis(d, n_bands) @ coefficients)

    def error(rows: int) -> float:
        found = project(method("gauss-legendre"), light, 2 * rows**2, 0, n_bands)
        return float(np.abs(found - coefficients).max())

    assert error(n_bands) < 1e-13
    assert error(n_bands - 1) > 1e-3


def test_methods_for_images_apply_to_images_alone() -> None:
    names = {each.name for each in METHODS if not each.applies(find_light("green"))}
    assert names == {"per-texel", "half", "quarter"}
    assert all(each.applies(small_image()) for each in METHODS)


def test_an_image_that_cannot_be_halved_is_not() -> None:
    odd = EnvironmentLight(np.ones((6, 12, 3), np.float32))
    assert (method("half").applies(odd), method("quarter").applies(odd)) == (True, False)


def test_half_resolution_takes_the_means_of_four_texels() -> None:
    image = small_image()
    means = image.pixels.reshape(16, 2, 32, 2, 3).mean(axis=(1, 3))
    wanted = EnvironmentLight(means).coefficients(3)
    assert project(method("half"), image, 0, 0, 3) == pytest.approx(wanted, abs=1e-5)  # float32 sums of four


def test_evaluations_are_what_the_light_was_asked_for() -> None:
    asked = 0

    def counting(directions: np.ndarray) -> np.ndarray:
        nonlocal asked
        asked += len(directions)
        return np.exp(directions[:, 2])

    light = FunctionLight(counting)
    for each in METHODS:
        if each.applies(light):
            prepared = each.prepare(light, 100, 0, 3)
            asked = 0
            prepared.project()
            assert prepared.evaluations == asked > 0, each.name
    assert method(BEST).prepare(find_light("green"), 0, 0, 3).evaluations == 0


def test_the_best_way_starts_from_nothing_every_time() -> None:
    asked = 0

    def counting(directions: np.ndarray) -> np.ndarray:
        nonlocal asked
        asked += len(directions)
        return np.ones(len(directions))

    prepared = method(BEST).prepare(FunctionLight(counting), 0, 0, 3)
    asked = 0
    prepared.project()
    first, asked = asked, 0
    prepared.project()
    assert asked == first > 0


def test_a_method_that_is_not_in_the_table_is_refused_in_one_line() -> None:
    with pytest.raises(UsageError, match="method 'lebedev': it must be one of best, gauss-legendre, fejer"):
        method("lebedev")


def test_errors_in_the_rows_are_those_of_the_metrics_module(green: MeasuredLight, green_rows: list[Row]) -> None:
    light = green.light
    for row in green_rows:
        seeds = range(projection_rows.SEEDS) if row.method in RANDOM else [0]
        found = [project(method(row.method), light, row.samples or 0, seed, row.n_bands) for seed in seeds]
        exact = light.coefficients(row.n_bands)
        figures = [channel_figures(light.products(), exact, shown, 1.0)["all"] for shown in found]
        # the sums are the same but for their order: a few roundings
        assert row.total_error == pytest.approx(np.median([each.relative_l2 for each in figures]), rel=1e-9)
        assert row.left_out == pytest.approx(figures[0].left_out, rel=1e-9)
        if row.error is not None:
            added = np.array([each.added for each in figures])
            kept = np.sqrt(1 - row.left_out**2)
            assert row.error * kept == pytest.approx(np.median(added), rel=1e-6, abs=1e-12)
            if row.error_low is not None:
                assert row.error_low * kept == pytest.approx(added.min(), rel=1e-6)
                assert row.error_high * kept == pytest.approx(added.max(), rel=1e-6)


def test_the_reference_has_no_error_of_its_own_and_nothing_random_no_spread(green_rows: list[Row]) -> None:
    for row in green_rows:
        assert (row.error is None) == (row.method == BEST)
        assert (row.error_low is not None) == (row.method in RANDOM)
        assert row.milliseconds is not None
        assert row.repeats >= projection_rows.AT_LEAST
        assert row.low_quartile <= row.milliseconds <= row.high_quartile
        assert row.set_up_milliseconds is not None
        assert row.peak_mib > 0
        assert row.reference_accuracy == 0


def test_one_seed_gives_identical_errors_and_another_does_not(green: MeasuredLight, green_rows: list[Row]) -> None:
    def errors(rows: list[Row]) -> dict[object, tuple[object, ...]]:
        return {row.key: (row.error, row.error_low, row.error_high, row.left_out, row.total_error) for row in rows}

    first, again, other = errors(green_rows), errors(rows_of(green, 0)), errors(rows_of(green, 7))
    assert again == first
    assert {key[2] for key in first if other[key] != first[key]} == RANDOM


def test_a_bright_light_has_the_errors_of_a_dim_one() -> None:
    def scaled(factor: float) -> Light:
        return FunctionLight(lambda d: factor * np.exp(2 * d[:, 0]), "lobe")

    names = ("gauss-legendre", "random")
    small, large = measured_light(scaled(1.0)), measured_light(scaled(1e29))
    for name in names:
        errors = [projection_errors(each, project(method(name), each.light, 1000, 0, 4)) for each in (small, large)]
        assert errors[0].error == pytest.approx(errors[1].error, rel=1e-6)
        assert errors[0].total == pytest.approx(errors[1].total, rel=1e-6)


def test_each_light_has_the_band_counts_that_it_needs(green: MeasuredLight) -> None:
    assert green.needs == {0.1: 10}
    rounds = projection_rows.plan([green], (3,), (100, 1_000_000))
    assert {each.n_bands for each in rounds} == {3, 10}
    assert {count for each in rounds if each.n_bands == 10 for _, count in each.experiments} == {None, 100, 10_000}


def test_a_plan_keeps_the_chosen_methods_and_the_reference(green: MeasuredLight) -> None:
    rounds = projection_rows.plan([replace(green, needs={})], (3,), (100,), ("fejer",))
    assert [each.name for round_ in rounds for each, _ in round_.experiments] == [BEST, "fejer"]


def test_rounds_come_smallest_first_and_light_by_light(green: MeasuredLight) -> None:
    other = replace(green, name="other", needs={})
    rounds = projection_rows.plan([replace(green, needs={}), other], (9, 3), (1000, 100), ("fejer",))
    places = [(round_.experiments[0][1], round_.n_bands, round_.measured.name) for round_ in rounds]
    names = ("green", "other")
    assert places == [(count, n, name) for count in (None, 100, 1000) for n in (3, 9) for name in names]


def test_the_papers_samples_take_turns_with_the_best_way(green: MeasuredLight) -> None:
    first = projection_rows.plan([green], (3,), (100, 10_000))[0]
    assert [(each.name, count) for each, count in first.experiments] == [(BEST, None), ("jittered", 10_000)]


def test_every_texel_is_a_sample_where_rounds_are_ordered() -> None:
    rounds = projection_rows.plan(
        [measured_light(small_image(), ())], (3,), (100, 10_000), ("per-texel", "half", "random")
    )
    assert [[(each.name, count) for each, count in round_.experiments] for round_ in rounds] == [
        [(BEST, None), ("half", None)],
        [("random", 100)],
        [("per-texel", None)],  # 2048 of them
        [("random", 10_000)],
    ]


def limited(measured: MeasuredLight, seconds: float, monkeypatch: pytest.MonkeyPatch) -> tuple[list[Row], float]:
    """Rows of so many seconds, and the seconds that they took, where a run takes a millisecond for every sample."""
    now = 0.0

    def cold(experiment: Experiment, *rest: object) -> float:
        nonlocal now
        now += (experiment[1] or 1) / 1000
        return float(experiment[1] or 1)

    def warm(experiment: Experiment, *rest: object) -> object:
        cold(experiment)
        return object()

    def measure_round(round_: projection_rows.Round, running: dict[Experiment, object], *rest: object) -> list[Row]:
        for experiment in running:
            for _ in range(projection_rows.AT_LEAST):
                cold(experiment)
        return [
            Row(section="projection", light="", method=each.name, samples=n, n_bands=round_.n_bands, milliseconds=1.0)
            for each, n in running
        ]

    monkeypatch.setattr(projection_rows, "_cold", cold)
    monkeypatch.setattr(projection_rows, "_warm", warm)
    monkeypatch.setattr(projection_rows, "_measure_round", measure_round)
    rows: list[Row] = []
    rounds = projection_rows.plan([measured], (3, 5), (100, 1000, 10_000), ("fejer", "random"))
    projection_rows.measure(rounds, lambda: seconds - now, 0, rows.extend, lambda what: None)
    return rows, now


def test_what_the_time_does_not_reach_is_the_largest_and_is_a_row_that_says_so(
    green: MeasuredLight, monkeypatch: pytest.MonkeyPatch
) -> None:
    everything, _ = limited(replace(green, needs={}), 1e6, monkeypatch)
    assert all(row.measured for row in everything)
    rows, _ = limited(replace(green, needs={}), 20.0, monkeypatch)
    assert {row.key[2:] for row in rows} == {row.key[2:] for row in everything}
    assert {row.samples for row in rows if row.measured} == {None, 100, 1000}
    missing = [row for row in rows if not row.measured]
    assert {(row.light, row.note, row.repeats, row.error) for row in missing} == {("green", "not measured", None, None)}
    assert {row.samples for row in missing} == {1000, 10_000}


@pytest.mark.parametrize("seconds", [0.5, 5.0, 20.0, 100.0, 250.0])
def test_nothing_is_begun_that_is_known_not_to_fit(
    green: MeasuredLight, seconds: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Times in proportion to the samples are foreseen from the smallest ones, which are tried: 0.1 s each."""
    _, took = limited(replace(green, needs={}), seconds, monkeypatch)
    assert took < seconds + 0.1


def test_a_single_experiment_that_is_too_long_is_run_once_and_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    slow = measured_light(small_image(), ())
    runs: list[str] = []
    monkeypatch.setattr(projection_rows, "_cold", lambda experiment, *rest: runs.append(experiment[0].name) or 1e4)
    rows: list[Row] = []
    rounds = projection_rows.plan([slow], (3, 5), (100,), ("per-texel",))
    projection_rows.measure(rounds, lambda: 30.0, 0, rows.extend, lambda what: None)
    assert runs == [BEST, "per-texel"]
    assert not any(row.measured for row in rows)


def test_what_was_not_measured_is_listed_by_light_and_bands() -> None:
    rows = [not_measured("projection", "jittered", light, n, 1_000_000) for light in ("b", "a") for n in (3, 5)]
    rows += [not_measured("end to end", "start, --version", "", None), replace(rows[0], milliseconds=1.0)]
    rows.append(not_measured("reconstruction", "CPU, map float32", "a", 9))
    assert lines_not_measured(rows) == [
        "jittered (paper) 1 000 000: a, 3 5 bands; b, 3 5 bands",
        "start, --version",
        "CPU, map float32: a, 9 bands",
    ]


def test_every_light_is_measured_once_and_two_of_a_name_are_told_apart(tmp_path: Path) -> None:
    text = '[[lobe]]\nprofile = "constant"\nradiance = 1\n'
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "sky.toml").write_text(text)
    texts = [str(tmp_path / "a/sky.toml"), "green", "green", str(tmp_path / "b/sky.toml")]
    assert [measured.name for measured in find_measured_lights(texts)] == ["sky", "green", texts[3]]
