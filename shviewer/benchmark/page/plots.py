"""The report's plots: time against error; error, frame time and roughness against bands; and lights that move.

They fit a column of print: 86 mm wide, 8 pt, with a colour, a marker and a dash for each curve, and a legend below the axes.
Equal reports give equal bytes with the same version of matplotlib.
"""

from __future__ import annotations

import io
import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from shviewer.benchmark.measuring import evaluations
from shviewer.benchmark.measuring import reconstruction_rows as reconstruction
from shviewer.benchmark.measuring.bands import ROUGHNESS_KEY
from shviewer.benchmark.measuring.experiments import METHODS
from shviewer.benchmark.measuring.measured_lights import TOLERANCES
from shviewer.benchmark.measuring.moving import SECTION as MOVING
from shviewer.benchmark.measuring.projection_rows import SECTION as PROJECTION
from shviewer.benchmark.page.bands_page import BANDS_STEM, ROUGHNESS_STEM, staircases_of
from shviewer.benchmark.page.moving_page import STEM as MOVING_STEM
from shviewer.benchmark.page.moving_page import curves as moving_curves
from shviewer.benchmark.page.plot_marks import (
    BELOW,
    DASHES,
    FRONT,
    INCHES,
    MARKED,
    MARKERS,
    SCREEN,
    WHITE,
    Curve,
    add_faces,
    draw_curves,
    log_axes,
    padded,
    shorten,
    style,
    tick_text,
)
from shviewer.benchmark.page.rows_pages import FRAME_STEM
from shviewer.benchmark.page.use_page import time_error_stems
from shviewer.benchmark.rows.report import LightRecord, Report
from shviewer.benchmark.rows.row import Row
from shviewer.harmonics.metrics import pareto_front
from shviewer.outputs import write_atomically

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MISSING = "no plots: matplotlib is not installed; python -m pip install 'shviewer[report]'"

PIXELS_PER_INCH = 240
FLOOR = 1e-5
"""Errors below this share are drawn on the lower edge."""

BAND_FLOOR = 1e-3
"""The same in the plot of error against bands, where tolerances of 10 to 1 % matter."""

SIXTY_HERTZ = 1000 / 60

BAND_TICKS = (*reconstruction.BANDS, 128)


def make_plots(report: Report, folder: Path) -> tuple[tuple[Path, ...], str]:
    """Write the plots of what there is in a report: .svg on the ground of the picture, .png on white paper, for print.

    Returns the files, and MISSING if matplotlib is missing.

    OutputError if a file cannot be written.
    """
    try:
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        return (), MISSING
    add_faces()
    written: list[Path] = []
    for stem, draw in plots_of(report).items():
        for suffix, paper in ((".svg", SCREEN), (".png", WHITE)):
            with matplotlib.rc_context():
                matplotlib.rcdefaults()
                matplotlib.rcParams.update(style(paper))
                figure = Figure(figsize=INCHES)
                FigureCanvasAgg(figure)
                draw(figure)
                stamps = {".svg": {"Date": None, "Creator": "shviewer"}, ".png": {"Software": None, "shviewer": stem}}
                buffer = io.BytesIO()
                figure.savefig(buffer, format=suffix[1:], dpi=PIXELS_PER_INCH, metadata=stamps[suffix])
            written.append(folder / f"{stem}{suffix}")
            write_atomically(written[-1], buffer.getvalue())
    return tuple(written), ""


def plots_of(report: Report) -> dict[str, Callable[[Figure], None]]:
    """File stem -> the function that draws the plot, for what there is in the report."""
    plots: dict[str, Callable[[Figure], None]] = {}
    lights = list(report.lights)
    for light, stem in zip(lights, time_error_stems(lights), strict=True):
        if curves := time_error_curves(report.rows, light):
            plots[stem] = partial(draw_time_error, light=light, curves=curves)
    if errors := error_curves(report.lights):
        plots[BANDS_STEM] = partial(draw_errors, curves=errors)
    if frames := frame_curves(report.rows):
        plots[FRAME_STEM] = partial(draw_frames, curves=frames)
    if found := report.extra.get(ROUGHNESS_KEY):
        plots[ROUGHNESS_STEM] = partial(draw_staircases, found=found)
    if samples := report.extra.get(MOVING, {}).get("sampled"):
        plots[MOVING_STEM] = partial(draw_moving, samples=samples)
    return plots


def names_of(lights: Sequence[str]) -> list[str]:
    """The names of all files that the plots of a report on these lights may have."""
    stems = (*time_error_stems(list(lights)), BANDS_STEM, FRAME_STEM, ROUGHNESS_STEM, MOVING_STEM)
    return [f"{stem}{suffix}" for stem in stems for suffix in (".svg", ".png")]


def time_error_curves(rows: Sequence[Row], light: str) -> list[Curve]:
    """(milliseconds, percent) of each method: its own Pareto front over all band counts and samples."""
    curves = []
    for look, method in enumerate(METHODS):
        points = [
            (row.milliseconds, 100 * max(row.total_error, FLOOR))
            for row in rows
            if row.section == PROJECTION and row.light == light and row.method == method.name
            if row.milliseconds and row.total_error is not None and math.isfinite(row.total_error)
        ]
        if points:
            curves.append(Curve(method.words, tuple(points[i] for i in pareto_front(points)), look))
    return curves


def error_curves(lights: Mapping[str, LightRecord]) -> list[Curve]:
    """A curve (bands, percent left out) for each light, of every band count; marked where it first meets a tolerance."""
    curves = []
    for look, (name, record) in enumerate(lights.items()):
        errors = record.error_by_bands
        first = (next((i for i, error in enumerate(errors) if error <= tolerance), None) for tolerance in TOLERANCES)
        points = tuple((n, 100 * max(error, BAND_FLOOR)) for n, error in enumerate(errors, 1))
        curves.append(Curve(name, points, look, marked=tuple(i for i in first if i is not None)))
    return curves


def frame_curves(rows: Sequence[Row]) -> list[Curve]:
    """A curve (bands, milliseconds) for each way of drawing and for making the map: medians over the lights, quartiles."""
    drawn = ("milliseconds", "low_quartile", "high_quartile")
    columns = (
        ("direct sum", evaluations.DIRECT, drawn),
        ("cached map", evaluations.CACHED, drawn),
        ("making the map", evaluations.CACHED, ("set_up_milliseconds",)),
    )
    curves = []
    for look, (name, method, names) in enumerate(columns):
        found: dict[int, list[Row]] = {}
        for row in rows:
            known = all(getattr(row, column) for column in names)
            if row.section == reconstruction.SECTION and row.method == method and row.n_bands and known:
                found.setdefault(row.n_bands, []).append(row)
        table = [
            (float(n), *(statistics.median(getattr(row, column) for row in group) for column in names))
            for n, group in sorted(found.items())
        ]
        spread = tuple((line[2], line[3]) for line in table if len(line) > 2)
        curves.append(Curve(name, tuple((line[0], line[1]) for line in table), look, spread))
    return [curve for curve in curves if len(curve.points) > 1]


def draw_time_error(figure: Figure, light: str, curves: Sequence[Curve]) -> None:
    """Draw both axes logarithmic; the front of all points is a broad grey staircase with no point to the left and below."""
    everything = [point for curve in curves for point in curve.points]
    front = [everything[i] for i in pareto_front(everything)]
    x, y = padded(x for x, _ in everything), padded((y for _, y in everything), highest=115.0)
    axes = log_axes(figure, f"{shorten(light)}: total error", x, y)
    axes.set_xlabel("milliseconds to project")
    stairs = [(front[0][0], y[1]), *front, (x[1], front[-1][1])]
    draw_curves(axes, curves)
    broad: dict[str, Any] = {"color": FRONT, "linewidth": 5, "zorder": 1, "solid_joinstyle": "miter"}
    axes.step(*zip(*stairs, strict=True), where="post", **broad, label="Pareto front")
    figure.legend(**BELOW)


def draw_errors(figure: Figure, curves: Sequence[Curve]) -> None:
    """Draw the error of every number of bands for each light, with the tolerances."""
    lowest = min(y for curve in curves for _, y in curve.points)
    bottom = lowest if lowest == 100 * BAND_FLOOR else min(lowest / 1.3, 0.8)
    axes = _band_axes(figure, "relative L2 error of the first n bands", curves, (bottom, 115.0))
    ticks = [tick for tick in (0.1, 1, 5, 10, 100) if tick >= bottom]
    axes.set_yticks(ticks, [f"{'< ' * (tick == 100 * BAND_FLOOR == lowest)}{tick_text(tick, ' %')}" for tick in ticks])
    for tolerance in TOLERANCES:
        axes.axhline(100 * tolerance, **MARKED)
    draw_curves(axes, curves)
    axes.plot([], [], **MARKED, label="10, 5 and 1 %")
    figure.legend(**BELOW)


def draw_frames(figure: Figure, curves: Sequence[Curve]) -> None:
    """Draw milliseconds per frame; at 60 frames a second there are 16.7."""
    y = padded((*(y for curve in curves for _, y in curve.points), SIXTY_HERTZ))
    title = "milliseconds per frame of 1280 \N{MULTIPLICATION SIGN} 640"
    axes = _band_axes(figure, title, curves, y, unit="")
    draw_curves(axes, curves)
    axes.axhline(SIXTY_HERTZ, **MARKED, label="60 a second")
    figure.legend(**BELOW)


def draw_staircases(figure: Figure, found: Mapping[str, Any]) -> None:
    """Draw the fewest bands within 5 % against roughness, a staircase for each light; it begins where there is a count.

    found: the report's `extra` on roughness.
    """
    counts = {name: steps_of[0.05].counts for name, steps_of in staircases_of(found).items()}
    roughness = found["roughness"]
    most = max([max(filter(None, row), default=1) for row in counts.values()], default=1)
    axes = log_axes(figure, "fewest bands to reflect within 5 %", (roughness[0], roughness[-1]), (0.9, 1.15 * most), "")
    axes.set_xscale("linear")
    axes.set_xticks([0.1, 0.2, 0.4, 0.6, 0.8, 1.0])
    ticks = [tick for tick in BAND_TICKS if tick <= 1.15 * most]
    axes.set_yticks(ticks, [str(tick) for tick in ticks])
    axes.set_xlabel("roughness of the surface (GGX)")
    for look, (name, row) in enumerate(counts.items()):
        values = [float("nan") if count is None else float(count) for count in row]
        shift = 1 + 0.012 * (look - len(counts) / 2)  # counts that are equal are seen beside each other
        line = {"color": f"C{look % len(MARKERS)}", "linestyle": DASHES[look % len(DASHES)]}
        axes.step(roughness, [shift * value for value in values], where="post", label=shorten(name), **line)
    figure.legend(**BELOW)


def draw_moving(figure: Figure, samples: list[dict[str, Any]]) -> None:
    """Draw the RMS error of a light that turns against bands; beyond 100 % it is noise.

    A way to sample its frames has a colour, a number of samples a dash.
    """
    found: list[Curve] = []
    families = dict[str, int]()
    for name, points in moving_curves(samples).items():
        look = families.setdefault(name.partition(",")[0], len(families))
        found.append(Curve(name, tuple(points), look, dash=sum(other.look == look for other in found)))
    x, y = padded(n for n, _ in found[0].points), padded(error for curve in found for _, error in curve.points)
    axes = log_axes(figure, f"{shorten(samples[0]['light'])}, turning: RMS error", x, y)
    axes.set_xticks([n for n, _ in found[0].points], [f"{n:g}" for n, _ in found[0].points])
    axes.set_xlabel("bands")
    axes.axhline(100, **MARKED)
    draw_curves(axes, found)
    figure.legend(**BELOW)


def _band_axes(figure: Figure, title: str, curves: Sequence[Curve], y: tuple[float, float], unit: str = " %") -> Axes:
    """Axes on which the band counts of the curves go to the right."""
    bands = [x for curve in curves for x, _ in curve.points]
    low, high = min(bands) / 1.12, max(bands) * 1.12
    axes = log_axes(figure, title, (low, high), y, unit)
    ticks = [n for n in BAND_TICKS if low <= n <= high]
    axes.set_xticks(ticks, [tick_text(n) for n in ticks])
    axes.set_xlabel("bands n" if "first n" in title else "bands")
    return axes
