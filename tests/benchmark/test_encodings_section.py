"""The section on encodings of irradiance says what each keeps, of every kind of light."""

from dataclasses import asdict

import numpy as np
import pytest

from shviewer.analysis.recipe import Recipe
from shviewer.analysis.reconstruction import reconstruction_of
from shviewer.benchmark.measuring.encodings import KEY, kept_of
from shviewer.benchmark.measuring.measured_lights import measured_light
from shviewer.benchmark.page.encodings_page import lines
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.rows.report import Report
from shviewer.harmonics.quantities.encodings import ENCODINGS, REPORTED
from shviewer.harmonics.zonal import Constant
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light


def test_a_light_has_a_row_for_each_encoding_and_a_sentence_on_the_best_of_four_five_and_nine() -> None:
    found = kept_of(measured_light(find_light("venice_sunset")))
    assert [kept.encoding for kept in found] == list(REPORTED)
    report = Report(0, "", {}, {}, extra={KEY: [asdict(kept) for kept in found]})
    page = "\n".join(lines(Page(report)))
    best = (
        "of four floats ZH3 hallucinated is best and leaves 8.30 % of the irradiance (L1 as it is leaves 11.6 %); of five"
        " ZH3, solved, 6.20 %; of nine L2, linear, 1.43 %."
    )
    assert best in " ".join(page.split())
    assert sum(line.startswith("| venice_sunset ") for line in page.splitlines()) == len(REPORTED)


def test_rounding_is_not_called_an_error() -> None:
    """A hemisphere's irradiance is linear: "5.46e-15 %" of it was left."""
    report = Report(
        0, "", {}, {}, extra={KEY: [asdict(kept) for kept in kept_of(measured_light(find_light("hemisphere")))]}
    )
    page = " ".join("\n".join(lines(Page(report))).split())
    assert "of four floats L1, linear is best and leaves 0 % of the irradiance; of five ZH3, 0 %" in page


def test_what_a_float_saves_is_the_error_that_the_mean_alone_has_more() -> None:
    light = find_light("green").irradiance()
    alone = np.sqrt(1 - (light.coefficients(1) ** 2).sum() / np.trace(light.products()))
    for kept in kept_of(measured_light(find_light("green"))):
        assert kept.relative_l2 + kept.saved_by_a_float * (kept.floats - 1) == pytest.approx(alone, rel=1e-12)


def test_the_figures_are_those_of_the_window() -> None:
    figures = reconstruction_of(Recipe("green", n_bands=3, quantity="irradiance")).figures
    kept = next(kept for kept in kept_of(measured_light(find_light("green"))) if kept.encoding == "l2")
    assert kept.relative_l2 == pytest.approx(figures.relative_l2, rel=1e-9)
    assert kept.largest_error == pytest.approx(figures.extremes.max_error / figures.extremes.peak, rel=0.01)


def test_a_black_light_has_no_rows_and_a_negative_one_all_but_the_deringed() -> None:
    black = LobeLight((Lobe(Constant(), np.array([0.0, 0, 1]), np.zeros(3)),))
    assert kept_of(measured_light(black)) == []
    negative = CoefficientLight(np.repeat([[-1.0], [0.1], [0.2], [0.0]], 3, axis=1))
    assert {kept.encoding for kept in kept_of(measured_light(negative))} == set(REPORTED) - {"l2-deringed"}
    assert "l2-deringed" in ENCODINGS
