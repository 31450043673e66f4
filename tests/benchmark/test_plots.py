"""Plots are made of rows alone: what they show, how they are labelled, and that equal rows give equal files."""

from __future__ import annotations

import builtins
import json
import re
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from shviewer.benchmark.experiments import METHODS
from shviewer.benchmark.measured_lights import measured_light
from shviewer.benchmark.page.plot_marks import DASHES, INCHES, LOOKS, STYLE, nice_ticks
from shviewer.benchmark.page.plots import (
    FLOOR,
    draw_time_error,
    error_curves,
    frame_curves,
    make_plots,
    names_of,
    time_error_curves,
)
from shviewer.benchmark.page.tables import plain
from shviewer.benchmark.reconstruction_rows import CACHED, DIRECT, PER_FRAME
from shviewer.benchmark.roughness import as_extra, as_markdown, staircases
from shviewer.benchmark.row import Row
from shviewer.lights.find import find_light


def projected(method: str, milliseconds: float, error: float, light: str = "green") -> Row:
    return Row(
        section="projection", method=method, light=light, n_bands=9, milliseconds=milliseconds, total_error=error
    )


def drawn(method: str, n_bands: int, milliseconds: float, truncation: float, light: str = "green") -> Row:
    return Row(
        section="reconstruction",
        method=method,
        light=light,
        n_bands=n_bands,
        milliseconds=milliseconds,
        low_quartile=0.9 * milliseconds,
        high_quartile=1.1 * milliseconds,
        set_up_milliseconds=30.0 if method == CACHED else None,
        truncation=truncation,
        note=PER_FRAME,
    )


ROWS = [
    projected("best", 0.1, 0.1),
    projected("best", 0.4, 0.01),
    projected("jittered", 1.0, 0.3),
    projected("jittered", 30.0, 0.08),
    projected("jittered", 20.0, 0.5),
    *(drawn(DIRECT, n, 20 + n * n / 8, 0.9 / n) for n in (1, 5, 32)),
    *(drawn(CACHED, n, 23, 0.9 / n) for n in (1, 5, 32)),
]


@pytest.fixture
def matplotlib() -> Any:
    return pytest.importorskip("matplotlib", reason="plots need matplotlib: python -m pip install matplotlib")


@pytest.mark.usefixtures("matplotlib")
def test_equal_rows_give_equal_bytes_of_every_plot(tmp_path: Path) -> None:
    folders = [tmp_path / "first", tmp_path / "second"]
    for folder in folders:
        folder.mkdir()
        files, reason = make_plots(ROWS, folder)
        assert reason == ""
        assert {file.name for file in files} == {
            f"{stem}.{suffix}"
            for stem in ("time-error-green", "error-bands", "frame-time")
            for suffix in ("svg", "png")
        }
    for file in folders[0].iterdir():
        assert file.read_bytes() == (folders[1] / file.name).read_bytes(), file.name


@pytest.mark.usefixtures("matplotlib")
def test_files_name_no_date_and_no_machine(tmp_path: Path) -> None:
    for file in make_plots(ROWS, tmp_path)[0]:
        if file.suffix == ".svg":
            text = file.read_text()
            assert not re.search(r"20\d\d-\d\d-\d\d|<dc:date", text)
            assert str(tmp_path) not in text
        else:
            with Image.open(file) as image:
                assert not {"Software", "Creation Time"} & set(image.info)


@pytest.mark.usefixtures("matplotlib")
def test_a_plot_is_white_paper_with_dark_ink(tmp_path: Path) -> None:
    for file in make_plots(ROWS, tmp_path)[0]:
        if file.suffix == ".png":
            with Image.open(file) as image:
                grey = np.asarray(image.convert("L"))
            assert (grey[[0, -1]] == 255).all()
            assert (grey == 255).mean() > 0.8
            assert grey.min() < 30


def test_without_matplotlib_there_are_no_files_and_the_line_that_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = builtins.__import__

    def refuse(name: str, *rest: Any) -> Any:
        if name.partition(".")[0] == "matplotlib":
            raise ImportError(name)
        return real(name, *rest)

    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(builtins, "__import__", refuse)
    files, reason = make_plots(ROWS, tmp_path)
    assert files == ()
    assert "pip install 'shviewer[report]'" in reason
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("matplotlib")
def test_names_that_mean_something_to_a_file_system_or_to_tex_are_drawn_as_they_are(tmp_path: Path) -> None:
    names = ("../a/$x^$", "a $b$ % name that is far too long for any margin", "---a--x--")
    rows = [projected("best", 0.1 * k, 0.1 / k, name) for name in names for k in (1, 2)]
    rows += [drawn(DIRECT, n, n, 1 / n, name) for name in names for n in (1, 4)]
    files, _ = make_plots(rows, tmp_path)
    assert len(files) == len(set(files)) == 2 * (3 + 2)
    assert {file.parent for file in files} == {tmp_path}


@pytest.mark.usefixtures("matplotlib")
def test_no_rows_give_no_plots(tmp_path: Path) -> None:
    assert make_plots([], tmp_path) == ((), "")


@pytest.mark.usefixtures("matplotlib")
def test_one_point_and_exact_results_can_be_drawn(tmp_path: Path) -> None:
    exact = [projected("best", 0.1, 0.0), *(drawn(DIRECT, n, 20.0, 0.0) for n in (1, 2))]
    assert len(make_plots(exact, tmp_path)[0]) == 6


def test_a_method_is_shown_where_it_does_not_beat_itself() -> None:
    curves = {curve.name: curve.points for curve in time_error_curves(ROWS, "green")}
    assert curves["jittered (paper)"] == ((1.0, 30.0), (30.0, 8.0))
    assert curves["best way"] == ((0.1, 10.0), (0.4, 1.0))


def test_rows_without_a_time_or_an_error_are_not_drawn() -> None:
    whole = projected("best", 1.0, 0.1)
    rows = [whole, replace(whole, milliseconds=None), replace(whole, total_error=None)]
    rows.append(replace(whole, total_error=float("inf")))
    assert [curve.points for curve in time_error_curves(rows, "green")] == [((1.0, 10.0),)]
    assert time_error_curves(rows[1:], "green") == []


def test_errors_that_cannot_be_told_from_nothing_stand_on_the_edge() -> None:
    (curve,) = time_error_curves([projected("best", 1.0, 0.0)], "green")
    assert curve.points == ((1.0, 100 * FLOOR),)


def test_errors_against_bands_come_from_every_row_that_knows_them() -> None:
    (curve,) = error_curves(ROWS)
    assert curve.name == "green"
    np.testing.assert_allclose(curve.points, [(1, 90), (5, 18), (32, 90 / 32)], rtol=1e-12)


def test_frame_times_are_medians_over_the_lights_with_their_quartiles() -> None:
    lights = [drawn(DIRECT, n, n * factor, 0.5, f"light {factor}") for n in (1, 2) for factor in (10, 20, 90)]
    (curve,) = frame_curves(lights)
    assert curve.points == ((1, 20), (2, 40))
    np.testing.assert_allclose(curve.spread, [(18, 22), (36, 44)], rtol=1e-12)


def test_nine_looks_differ_in_colour_and_in_marker_and_neighbours_in_dash() -> None:
    assert len({colour for colour, _ in LOOKS}) == len({marker for _, marker in LOOKS}) == len(LOOKS) == 9
    assert len({str(dash) for dash in DASHES}) == len(DASHES)


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (0.05, 200, ["0.1", "1", "10", "100"]),
        (0.8, 80, ["1", "3", "10", "30"]),
        (4, 60, ["5", "10", "20", "50"]),
        (93.4, 97.8, ["94", "95", "96", "97"]),
        (99.3, 100.4, ["99.4", "99.6", "99.8", "100", "100.2", "100.4"]),
    ],
)
def test_ticks_are_few_and_plain(low: float, high: float, ticks: list[str]) -> None:
    assert [plain(tick) for tick in nice_ticks(low, high)] == ticks


def test_a_number_on_an_axis_has_no_power_of_ten() -> None:
    assert [plain(value) for value in (1e-5, 0.30000000000000004, 12.5, 1e6)] == ["0.00001", "0.3", "12.5", "1000000"]


def test_the_legend_names_every_curve_and_lies_outside_the_axes(matplotlib: Any) -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    names = [method.words for method in METHODS]
    rows = [projected(each.name, 2.0**k, 0.5 / (k + j + 1)) for j, each in enumerate(METHODS) for k in range(4)]
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=INCHES)
        FigureCanvasAgg(figure)
        draw_time_error(figure, "a name that is far too long for any margin", time_error_curves(rows, "green"))
        figure.draw_without_rendering()
    (legend,), (axes,) = figure.legends, figure.axes
    assert [text.get_text() for text in legend.get_texts()] == [*names, "Pareto front"]
    box, whole = legend.get_window_extent(), figure.bbox
    assert not box.overlaps(axes.get_tightbbox())
    assert whole.x0 <= box.x0 < box.x1 <= whole.x1
    assert whole.y0 <= box.y0
    assert axes.bbox.height > 0.45 * whole.height
    title = figure.get_suptitle(), figure._suptitle.get_window_extent()
    assert title[1].x1 <= whole.x1, title[0]


@pytest.mark.usefixtures("matplotlib")
def test_bands_by_roughness_are_drawn_also_where_a_light_needs_more_than_there_are(tmp_path: Path) -> None:
    steps = staircases([measured_light(find_light("green")), measured_light(find_light("sun-sky"))])
    assert steps["sun-sky"][0.05].counts[0] is None
    extra = {"roughness": json.loads(json.dumps(as_extra(steps)))}
    files, _ = make_plots([], tmp_path, extra)
    assert [file.name for file in files] == ["roughness-bands.svg", "roughness-bands.png"]
    assert {file.name for file in files} <= set(names_of(["green", "sun-sky"]))
    none = {"roughness": {"roughness": [0.1, 0.2], "fewest_bands": {"dark": {"0.05": [None, None]}}}}
    assert len(make_plots([], tmp_path, none)[0]) == 2
    page = as_markdown(steps)
    assert "- sun-sky: for 5 %: 5 bands serve shading, 3 serve no roughness, 9 serve roughness 0.52 and rougher" in page
    assert "| 0.76 to 0.89 " in page
