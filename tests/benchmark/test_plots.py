"""Plots are made of rows alone: what they show, how they are labelled, and that equal rows give equal files."""

from __future__ import annotations

import builtins
import json
import re
import sys
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from shviewer.analysis.roughness import ROUGHNESS
from shviewer.benchmark.measuring.bands import ROUGHNESS_KEY, roughness_extra
from shviewer.benchmark.measuring.evaluations import CACHED, DIRECT, PER_FRAME
from shviewer.benchmark.measuring.experiments import METHODS
from shviewer.benchmark.measuring.measured_lights import measured_light
from shviewer.benchmark.measuring.moving import BANDS, WAYS, SamplingError
from shviewer.benchmark.measuring.moving import SECTION as MOVING
from shviewer.benchmark.page.bands_page import serves_lines
from shviewer.benchmark.page.plot_marks import (
    DASHES,
    INCHES,
    MARKERS,
    SCREEN,
    WHITE,
    Paper,
    add_faces,
    nice_ticks,
    style,
    tick_text,
)
from shviewer.benchmark.page.plots import (
    FLOOR,
    error_curves,
    frame_curves,
    make_plots,
    names_of,
    plots_of,
    time_error_curves,
)
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.tables import plain
from shviewer.benchmark.rows.report import LightRecord, Report
from shviewer.benchmark.rows.row import Row
from shviewer.lights.find import find_light
from shviewer.viewer.colour.colour_maps import linear


def projected(method: str, milliseconds: float, error: float, light: str = "green") -> Row:
    return Row(
        section="projection", method=method, light=light, n_bands=9, milliseconds=milliseconds, total_error=error
    )


def drawn(method: str, n_bands: int, milliseconds: float, left_out: float, light: str = "green") -> Row:
    return Row(
        section="reconstruction",
        method=method,
        light=light,
        n_bands=n_bands,
        milliseconds=milliseconds,
        low_quartile=0.9 * milliseconds,
        high_quartile=1.1 * milliseconds,
        set_up_milliseconds=30.0 if method == CACHED else None,
        left_out=left_out,
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


def reported(rows: list[Row] | None = None, **extra: Any) -> Report:
    """A report of these rows, on lights of whose bands each leaves less."""
    rows = ROWS if rows is None else rows
    records = {row.light: LightRecord("", "", 0.0, {}, [1 / n for n in range(1, 129)]) for row in rows}
    return Report(0, "", {}, {}, rows=rows, lights=records, extra=extra)


def everything() -> Report:
    """A report with every plot, and with every method in one of them, their points all over it."""
    rows = [
        projected(each.name, 2.0**k * (1 + j), 0.5 / (k + j + 1)) for j, each in enumerate(METHODS) for k in range(4)
    ]
    sampled = [
        asdict(SamplingError("green", way, n, b, 0.1, 0.1, 0.1, 1.0))
        for way in WAYS
        for n in (100, 961, 10_000)
        for b in BANDS
    ]
    steps = {"mirror": 15, "shading": 3, "searched": 128, "counts": [13] * len(ROUGHNESS)}
    roughness = {"roughness": list(ROUGHNESS), "fewest_bands": {f"light {n}": {"0.05": steps} for n in range(5)}}
    return reported(rows + ROWS, **{MOVING: {"sampled": sampled}, ROUGHNESS_KEY: roughness})


@pytest.fixture
def matplotlib() -> Any:
    return pytest.importorskip("matplotlib", reason="plots need matplotlib: python -m pip install matplotlib")


@pytest.mark.usefixtures("matplotlib")
def test_equal_rows_give_equal_bytes_of_every_plot(tmp_path: Path) -> None:
    folders = [tmp_path / "first", tmp_path / "second"]
    for folder in folders:
        folder.mkdir()
        files, reason = make_plots(reported(), folder)
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
    for file in make_plots(reported(), tmp_path)[0]:
        if file.suffix == ".svg":
            text = file.read_text()
            assert not re.search(r"20\d\d-\d\d-\d\d|<dc:date", text)
            assert str(tmp_path) not in text
        else:
            with Image.open(file) as image:
                assert not {"Software", "Creation Time"} & set(image.info)


@pytest.mark.usefixtures("matplotlib")
def test_a_png_is_white_paper_with_dark_ink_and_an_svg_has_the_ground_of_the_picture(tmp_path: Path) -> None:
    for file in make_plots(reported(), tmp_path)[0]:
        if file.suffix == ".png":
            with Image.open(file) as image:
                grey = np.asarray(image.convert("L"))
            assert (grey[[0, -1]] == 255).all()
            assert (grey == 255).mean() > 0.8
            assert grey.min() < 30
        else:
            text = file.read_text()
            assert f"fill: {SCREEN.ground}" in text
            assert "#ffffff" not in text
            assert set(re.findall("#[0-9a-f]{6}", text)) <= {SCREEN.ground, SCREEN.ink, SCREEN.rule, *SCREEN.colours}
    assert SCREEN.ground == "#27272a"  # the picture's, sRGB 39 39 42


@pytest.mark.parametrize("paper", [SCREEN, WHITE])
def test_every_curve_can_be_seen_on_its_paper(paper: Paper) -> None:
    """WCAG 2.1, 1.4.11: graphics have a contrast of 3 : 1; on white the colours of Okabe and Ito reach less, and are kept."""
    least = {SCREEN: 3.0, WHITE: 2.1}[paper]
    assert min(contrast(colour, paper.ground) for colour in paper.colours[: len(MARKERS) + 1]) > least
    assert contrast(paper.ink, paper.ground) > 7


def contrast(first: str, second: str) -> float:
    """The contrast of two sRGB colours by WCAG 2.1."""
    light = [
        0.05 + linear(np.frombuffer(bytes.fromhex(colour[1:]), np.uint8)) @ (0.2126, 0.7152, 0.0722)
        for colour in (first, second)
    ]
    return float(max(light) / min(light))


@pytest.mark.usefixtures("matplotlib")
def test_plots_are_lettered_in_the_face_of_the_picture() -> None:
    from matplotlib.font_manager import FontProperties, findfont

    add_faces()
    settings = style(SCREEN)
    assert Path(findfont(FontProperties(family=settings["font.family"][0]))).name == "Inter-Regular.otf"
    assert tick_text(1000, " %") == "1\u202f000\u202f%"


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
    files, reason = make_plots(reported(), tmp_path)
    assert files == ()
    assert "pip install 'shviewer[report]'" in reason
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("matplotlib")
def test_names_that_mean_something_to_a_file_system_or_to_tex_are_drawn_as_they_are(tmp_path: Path) -> None:
    names = ("../a/$x^$", "a $b$ % name that is far too long for any margin", "---a--x--")
    rows = [projected("best", 0.1 * k, 0.1 / k, name) for name in names for k in (1, 2)]
    rows += [drawn(DIRECT, n, n, 1 / n, name) for name in names for n in (1, 4)]
    files, _ = make_plots(reported(rows), tmp_path)
    assert len(files) == len(set(files)) == 2 * (3 + 2)
    assert {file.parent for file in files} == {tmp_path}


@pytest.mark.usefixtures("matplotlib")
def test_no_rows_give_no_plots(tmp_path: Path) -> None:
    assert make_plots(reported([]), tmp_path) == ((), "")


@pytest.mark.usefixtures("matplotlib")
def test_one_point_and_exact_results_can_be_drawn(tmp_path: Path) -> None:
    exact = [projected("best", 0.1, 0.0), *(drawn(DIRECT, n, 20.0, 0.0) for n in (1, 2))]
    assert len(make_plots(reported(exact), tmp_path)[0]) == 6


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


def test_the_error_of_every_band_count_is_drawn_and_marked_where_it_first_meets_a_tolerance() -> None:
    """Only the band counts of rows were, though all are known exactly."""
    (curve,) = error_curves(reported().lights)
    assert curve.name == "green"
    assert [n for n, _ in curve.points] == list(range(1, 129))
    np.testing.assert_allclose([error for _, error in curve.points], 100 / np.arange(1, 129), rtol=1e-12)
    assert [curve.points[i][0] for i in curve.marked or ()] == [10, 20, 100]


def test_frame_times_are_medians_over_the_lights_with_their_quartiles() -> None:
    lights = [drawn(DIRECT, n, n * factor, 0.5, f"light {factor}") for n in (1, 2) for factor in (10, 20, 90)]
    (curve,) = frame_curves(lights)
    assert curve.points == ((1, 20), (2, 40))
    np.testing.assert_allclose(curve.spread, [(18, 22), (36, 44)], rtol=1e-12)


def test_nine_looks_differ_in_colour_and_in_marker_and_neighbours_in_dash() -> None:
    for paper in (SCREEN, WHITE):
        assert len(set(paper.colours)) == len(paper.colours) == len(MARKERS) + 2
    assert len(set(MARKERS)) == len(MARKERS) == 9
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


def test_a_legend_names_every_curve_and_covers_neither_a_point_nor_a_label(matplotlib: Any) -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.transforms import Bbox

    add_faces()
    plots = plots_of(everything())
    assert len(plots) == 5
    for stem, draw in plots.items():
        with matplotlib.rc_context(style(SCREEN)):
            figure = Figure(figsize=INCHES)
            FigureCanvasAgg(figure)
            draw(figure)
            figure.draw_without_rendering()
        (legend,), (axes,) = figure.legends, figure.axes
        names = [text.get_text() for text in legend.get_texts()]
        assert len(names) == len(set(names))
        if stem == "time-error-green":
            assert names == [*(method.words for method in METHODS), "Pareto front"]
        box, whole, title = legend.get_window_extent(), figure.bbox, figure._suptitle.get_window_extent()
        drawn = [
            axes.transData.transform(line.get_xydata()) for line in axes.lines if line.get_transform() == axes.transData
        ]
        points = [Bbox([place - 4, place + 4]) for places in drawn for place in places if np.isfinite(place).all()]
        assert len(points) > 10
        assert box.count_overlaps(points) == title.count_overlaps(points) == 0, stem
        assert not box.overlaps(axes.get_tightbbox()), stem
        assert not title.overlaps(axes.get_tightbbox()), stem
        assert whole.x0 <= box.x0 < box.x1 <= whole.x1, stem
        assert whole.y0 <= box.y0, stem
        assert axes.bbox.height > 0.45 * whole.height, stem
        assert title.x1 <= whole.x1, stem
        labels = [label.get_window_extent() for label in (*axes.get_xticklabels(), *axes.get_yticklabels())]
        assert not any(label.count_overlaps(labels[n + 1 :]) for n, label in enumerate(labels)), stem


@pytest.mark.usefixtures("matplotlib")
def test_bands_by_roughness_are_drawn_also_where_a_light_needs_more_than_there_are(tmp_path: Path) -> None:
    found = roughness_extra([measured_light(find_light("green")), measured_light(find_light("sun-sky"))])
    assert found["fewest_bands"]["sun-sky"]["0.05"]["counts"][0] is None
    extra = {ROUGHNESS_KEY: json.loads(json.dumps(found))}
    files, _ = make_plots(reported([], **extra), tmp_path)
    assert [file.name for file in files] == ["roughness-bands.svg", "roughness-bands.png"]
    assert {file.name for file in files} <= set(names_of(["green", "sun-sky"]))
    page = "\n".join(serves_lines(Page(reported([], **extra))))
    for steps_of in extra[ROUGHNESS_KEY]["fewest_bands"].values():
        steps_of["0.05"]["counts"] = [None] * len(ROUGHNESS)
    assert len(make_plots(reported([], **extra), tmp_path)[0]) == 2
    assert "- sun-sky: for 5 %: 5 bands serve shading, 3 serve no roughness, 9 serve roughness 0.52 and rougher" in page
    assert "| 0.76 to 0.89 " in page
