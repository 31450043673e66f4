"""Lights that move: what is simulated agrees with the formulas, and with simulations by others."""

from __future__ import annotations

from dataclasses import asdict
from itertools import count
from pathlib import Path

import numpy as np
import pytest
from places import kernels

from shviewer.benchmark.measuring import moving
from shviewer.benchmark.measuring.measured_lights import MeasuredLight, measured_light
from shviewer.benchmark.measuring.moving import BANDS, MOST, WAYS, SamplingError, sampled, turned_exactly
from shviewer.benchmark.measuring.moving_texels import noise, sun
from shviewer.benchmark.options import Options
from shviewer.benchmark.page.moving_page import STEM, answer, lines
from shviewer.benchmark.page.plots import plots_of
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.rows.report import Report
from shviewer.benchmark.run import write_report
from shviewer.errors import UsageError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light

FRESH, SAME, INDEPENDENT = WAYS
REFERENCE = kernels()["C"]


@pytest.fixture(scope="module")
def green() -> MeasuredLight:
    return measured_light(find_light("green"))


@pytest.fixture(scope="module")
def few(green: MeasuredLight) -> list[SamplingError]:
    return [one for way in WAYS for number in (100, 1000) for one in sampled(green, way, number, 0)]


def of(found: list[SamplingError], way: str, samples: int, n_bands: int) -> SamplingError:
    return next(one for one in found if (one.way, one.samples, one.n_bands) == (way, samples, n_bands))


def test_a_light_that_is_projected_exactly_does_not_flicker_when_it_turns(green: MeasuredLight) -> None:
    flicker = turned_exactly(green)
    assert flicker is not None
    assert flicker < 1e-13  # a rotation of 16 bands keeps a thousandth of that
    assert turned_exactly(measured_light(find_light("venice_sunset"))) is None


def test_independent_samples_have_the_error_of_the_formula(few: list[SamplingError]) -> None:
    for samples in (100, 1000):
        for n_bands in BANDS[2:]:  # 64 frames of n^2 numbers each
            one = of(few, INDEPENDENT, samples, n_bands)
            assert one.rms == pytest.approx(one.formula, rel=0.12)
            assert one.flicker == pytest.approx(np.sqrt(2) * one.rms, rel=0.1)  # fresh ones know nothing of each other


def test_sampled_lights_flicker_as_others_have_simulated(few: list[SamplingError]) -> None:
    """Other seeds and another axis: a fifth is what 64 frames leave open where the errors of few cells are alike."""
    for key, way in (("jittered new seed|100", FRESH), ("independent new seed|100", INDEPENDENT)):
        wanted = REFERENCE["sampling"][f"green|{key}"]
        for n_bands in (3, 5, 9, 16):
            one = of(few, way, 100, n_bands)
            assert one.rms == pytest.approx(wanted["rms"][str(n_bands)], rel=0.2)
            assert one.flicker == pytest.approx(wanted["frame_to_frame"][str(n_bands)], rel=0.2)
            assert one.formula == pytest.approx(wanted["theory_independent"][str(n_bands)], rel=1e-3)


def test_a_frame_takes_milliseconds_of_the_clock(green: MeasuredLight, monkeypatch: pytest.MonkeyPatch) -> None:
    ticks = count(step=0.25)
    monkeypatch.setattr(moving, "perf_counter", lambda: next(ticks))
    assert {one.milliseconds for one in sampled(green, SAME, 100, 0)} == {250.0}


def test_the_same_samples_flicker_less_and_are_as_wrong(few: list[SamplingError]) -> None:
    fresh, same = of(few, FRESH, 961, 5), of(few, SAME, 961, 5)
    assert same.flicker < fresh.flicker / 5
    assert same.rms == pytest.approx(fresh.rms, rel=0.5)
    wanted = REFERENCE["sampling"]["green|jittered same seed|1000"]
    for n_bands in (5, 9, 16):  # one pattern of samples here, another there
        one, key = of(few, SAME, 961, n_bands), str(n_bands)
        crawl = wanted["frame_to_frame"][key] / wanted["rms"][key]
        assert one.flicker / one.rms == pytest.approx(crawl, rel=0.4)


def test_noise_of_the_original_is_what_the_formulas_leave_of_it() -> None:
    found = noise(0)
    for one in found:
        # 300 images of n^2 numbers; texels are wider than waves of 16 bands, which they weaken by 4.4 %
        room = 0.06 if one.n_bands == MOST else 0.08 if one.n_bands == 1 else 0.04
        assert one.simulated == pytest.approx(one.formula, rel=room)
    reference = REFERENCE["texel_noise"]["64"]
    for one in found[: len(BANDS)]:
        assert one.formula == pytest.approx(reference[f"rms_{one.n_bands}"]["theory"], rel=1e-9)
    shaded = [one for one in found if "irradiance" in one.what]
    assert [one.formula for one in shaded] == pytest.approx(
        [reference["irr_over_pi_3"]["theory"], reference["irr_all"]]
    )


def test_below_n_squared_samples_there_is_more_noise_than_in_the_noisy_light() -> None:
    read = {one.n_bands: one.simulated for one in noise(1) if "read" in one.what}
    assert read[16] > 1.3  # 121 texels for 256 numbers
    assert read[9] < 1  # and for 81


def test_a_sun_that_hops_moves_all_bands_and_one_that_is_sampled_at_points_comes_and_goes() -> None:
    *hops, points = sun(0)
    for one in hops:
        assert one.simulated == pytest.approx(one.formula, rel=0.03)  # to first order in the angle, 16 bands 1.3 % off
    reference = REFERENCE["sun_snapped_random_places"]["64"]
    for one in hops[:-1]:
        assert one.simulated == pytest.approx(reference[str(one.n_bands)]["sim"], rel=0.04)  # of other latitudes
    assert points.formula > 10
    assert points.simulated == pytest.approx(points.formula, rel=0.3)  # about 30 of 4000 places are lit


def test_the_answer_names_the_figures_of_the_run_and_stands_without_samples(few: list[SamplingError]) -> None:
    stated = [*noise(0), *sun(0)]
    said = answer(few, stated)
    assert said.startswith("Half true.")
    assert f"green in 16 bands by {100 * of(few, FRESH, 100, 16).flicker:.0f} % of its norm" in said
    assert f"and by {100 * of(few, FRESH, 961, 16).flicker:.1f} % with 961" in said
    assert "Irradiance is calm because it is a blur" in answer([], stated)
    extra = {"turned_exactly": {"green": 2e-15, "room": None}}
    extra |= {"sampled": [asdict(one) for one in few], "stated": [asdict(one) for one in stated]}
    report = Report(0, "", {}, {}, extra={"moving": extra})
    page = "\n".join(lines(Page(report)))
    assert "- green, projected in closed form, and turned back: it changes by 2e-15 of its norm." in page
    rows = [row for row in page.splitlines() if row.startswith(("| jittered", "| independent"))]
    assert len(rows) == len(WAYS) * 2  # from 100 and from 961 points
    assert max(map(len, page.splitlines())) <= 128
    assert STEM in plots_of(report)
    extra["sampled"] = []
    assert plots_of(report) == {}
    assert "### green" not in "\n".join(lines(Page(report)))


def test_coefficients_cannot_move(tmp_path: Path) -> None:
    for light in ("probe.json", CoefficientLight(np.ones((4, 3)))):
        with pytest.raises(
            UsageError, match="--moving projects a light in every frame; coefficients are projected already"
        ):
            write_report([light], tmp_path / "report", Options(moving=True))
    assert not list(tmp_path.iterdir())
