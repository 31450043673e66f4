"""What a band costs and brings: errors against the metrics module's and float64, and the sentence made of rows."""

from __future__ import annotations

from dataclasses import replace
from itertools import count

import numpy as np
import pytest

from shviewer.analysis.figures import errors_of
from shviewer.analysis.projections import BEST
from shviewer.benchmark.measuring import reconstruction_rows as module
from shviewer.benchmark.measuring.evaluations import (
    BASIS,
    CACHED,
    DIRECT,
    FRAME,
    MAP_32,
    MAP_64,
    PER_FRAME,
    PER_MILLION,
    SCATTERED,
    Evaluations,
    ShaderFrame,
)
from shviewer.benchmark.measuring.measured_lights import MeasuredLight, measured_light
from shviewer.benchmark.measuring.reconstruction_rows import reconstruction_rows
from shviewer.benchmark.page.advice import where_bands_stop_paying
from shviewer.benchmark.rows.row import Row
from shviewer.harmonics.zonal import Constant, Disc, Gaussian
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.viewer.drawn import DirectSum
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.screenshot import offscreen

NO_OPENGL = "GraphicsError: no OpenGL here"
SHADER, CPU = {DIRECT, CACHED}, {SCATTERED, BASIS, MAP_64, MAP_32}


def by_name(rows: list[Row]) -> dict[tuple[str, int | None], Row]:
    found = {(row.method, row.n_bands): row for row in rows}
    assert len(found) == len(rows)
    return found


def test_without_opengl_the_rows_of_the_shader_are_absent_and_all_others_are_there(green: MeasuredLight) -> None:
    rows = by_name(reconstruction_rows(green, NO_OPENGL, budget=0, bands=(1, 5), at_least=1))
    assert set(rows) == {(method, n_bands) for method in CPU for n_bands in (1, 5)}
    assert all(row.milliseconds and row.repeats == 1 and row.note == PER_MILLION for row in rows.values())


@pytest.mark.parametrize(("seconds", "reached"), [(0.0, []), (4.0, [1]), (5.0, [1, 3]), (1e3, [1, 3, 9])])
def test_band_counts_come_smallest_first_as_far_as_the_time_allows(
    green: MeasuredLight, seconds: float, reached: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every look at the clock takes a second."""
    ticks = count()
    monkeypatch.setattr(module, "perf_counter", lambda: float(next(ticks)))
    rows = module.reconstruction_rows(green, NO_OPENGL, budget=0, at_most=seconds, bands=(9, 1, 3), at_least=1)
    assert [row.n_bands for row in rows if row.method == MAP_32 and row.measured] == reached
    assert sorted((row.n_bands or 0, row.method) for row in rows) == [
        (n, name) for n in (1, 3, 9) for name in sorted(CPU)
    ]
    assert {row.note for row in rows if not row.measured} <= {"not measured"}


def test_what_the_bands_leave_out_is_what_the_window_says(green: MeasuredLight) -> None:
    errors = errors_of(green.light, BEST)
    for row in reconstruction_rows(green, NO_OPENGL, budget=0, bands=(2, 9), at_least=1):
        assert row.n_bands is not None
        assert row.left_out == errors[row.n_bands - 1]
        arithmetic = row.arithmetic_error or 0.0
        assert row.total_error == pytest.approx(np.hypot(row.left_out or 0.0, arithmetic), rel=1e-12)


def test_the_cpu_is_as_exact_as_its_number_type(green: MeasuredLight) -> None:
    rows = by_name(reconstruction_rows(green, NO_OPENGL, budget=0, bands=(16,), at_least=1))
    assert rows[BASIS, 16].arithmetic_error is None  # the others are compared with it
    for method in (SCATTERED, MAP_64):
        assert 0 < (rows[method, 16].arithmetic_error or 0) < 1e-13  # 16 bands, 2^-53 each, with room
    assert 1e-9 < (rows[MAP_32, 16].arithmetic_error or 0) < 1e-6  # float32 rounds to 6e-8


def test_the_shader_is_as_exact_as_float32_at_every_band_count(green: MeasuredLight, renderer: Renderer) -> None:
    rows = by_name(reconstruction_rows(green, renderer, budget=0, bands=(3, 33), at_least=1))
    assert {name for name in rows if name[0] in SHADER} == {(DIRECT, 3), (CACHED, 3), (CACHED, 33)}
    for (method, n_bands), row in rows.items():
        if method in SHADER:
            assert n_bands is not None
            assert 1e-9 < (row.arithmetic_error or 0) < 1e-6 * n_bands  # the bound of the hard cases
            assert row.note == PER_FRAME
            assert (row.set_up_milliseconds is not None) == (method == CACHED)


def test_an_error_in_the_coefficients_drawn_is_seen(green: MeasuredLight, renderer: Renderer) -> None:
    """The shader's error is not the difference of two equal wrongs: one per cent more light is one per cent of error."""
    stage = Evaluations(green, 5)
    brighter = replace(stage.direct, drawn=DirectSum(1.01 * stage.coefficients))
    with offscreen(renderer, FRAME) as target:
        found = ShaderFrame(renderer, target)._error(stage, brighter)
    kept = np.sqrt(1 - green.left_out[4] ** 2)
    assert found == pytest.approx(0.01 * kept, rel=0.1)  # on the part of the sphere that is compared


def test_the_arithmetic_error_of_any_radiance_is_relative_to_the_light() -> None:
    for radiance in (1e-20, 1.0, 1e20):
        light = LobeLight((Lobe(Gaussian(8.0), np.array([0.0, 0.6, 0.8]), np.full(3, radiance)),))
        rows = by_name(reconstruction_rows(measured_light(light), NO_OPENGL, budget=0, bands=(9,), at_least=1))
        assert 1e-9 < (rows[MAP_32, 9].arithmetic_error or 0) < 1e-6


def test_a_black_light_has_rows_without_error() -> None:
    light = LobeLight((Lobe(Disc(0.5), np.array([0.0, 0.0, 1.0]), np.zeros(3)),))
    for row in reconstruction_rows(measured_light(light), NO_OPENGL, budget=0, bands=(3,), at_least=1):
        assert row.total_error == 0


def made_up(left_out_by: list[float], direct: list[float], cached: list[float], arithmetic: float = 1e-7) -> list[Row]:
    """Rows of 1, 2, 4, ... bands, whose quartiles are 1 % around the times."""

    def row(method: str, number: int, time: float) -> Row:
        return Row(
            section="reconstruction",
            light="lamp",
            method=method,
            n_bands=2**number,
            milliseconds=time,
            low_quartile=0.99 * time,
            high_quartile=1.01 * time,
            set_up_milliseconds=40.0 if method == CACHED else None,
            left_out=left_out_by[number],
            arithmetic_error=arithmetic,
            total_error=float(np.hypot(left_out_by[number], arithmetic)),
        )

    return [row(DIRECT, i, time) for i, time in enumerate(direct)] + [
        row(CACHED, i, time) for i, time in enumerate(cached)
    ]


def test_bands_stop_paying_in_the_direct_sum_where_time_grows_faster_than_the_error_falls() -> None:
    text = where_bands_stop_paying(made_up([0.8, 0.4, 0.3, 0.28], [20, 22, 40, 90], [23, 23, 23, 23]))
    assert (
        "summed in the shader they stop paying at 2 bands: 4 take 1.8 times as long as 2 and leave 0.75 of their error"
        in text
    )
    assert (
        "from 4 bands on a cached map draws faster than the direct sum, 23.0 ms a frame against 40.0 ms, after 40.0 ms"
        in text
    )
    assert text.startswith("lamp: more bands bring less error up to the 8 measured, where 28.0 % is left out")


def test_a_longer_time_within_the_spread_is_none() -> None:
    text = where_bands_stop_paying(made_up([0.8, 0.795, 0.79], [20, 20.3, 20.6], [23, 23, 23]))
    assert "they pay up to 4 bands" in text
    assert "faster" not in text


def test_bands_stop_where_what_they_leave_out_is_lost_in_rounding() -> None:
    text = where_bands_stop_paying(made_up([0.5, 2e-7, 1e-9], [20, 21, 60], [23, 23, 23], arithmetic=3e-7))
    assert "more than 2 bands bring nothing: no more than 3.0e-5 % is left out" in text


def test_a_constant_light_needs_one_band() -> None:
    light = LobeLight((Lobe(Constant(), np.array([0.0, 0.0, 1.0]), np.ones(3)),))
    rows = reconstruction_rows(measured_light(light), NO_OPENGL, budget=0, bands=(1, 3), at_least=1)
    assert "more than 1 band bring nothing" in where_bands_stop_paying(rows)


def test_without_opengl_the_sentence_is_about_the_map(green: MeasuredLight) -> None:
    rows = reconstruction_rows(green, NO_OPENGL, budget=0, bands=(1, 5), at_least=1)
    assert "up to the 5 measured, where 28.3 % is left out" in where_bands_stop_paying(rows)
    assert where_bands_stop_paying([]) == ""


def test_a_light_that_its_bands_hold_whole_has_no_error_to_divide_by() -> None:
    """Coefficients as a light: from their own number of bands on nothing is left out."""
    text = where_bands_stop_paying(made_up([0.5, 0.0, 0.0], [20, 21, 22], [23, 23, 23], arithmetic=0.0))
    assert "more than 2 bands bring nothing" in text
    assert "stop paying at 2 bands" in text
    assert where_bands_stop_paying(made_up([0.0, 0.0, 0.0], [20, 21, 22], [23, 23, 23], arithmetic=0.0))
