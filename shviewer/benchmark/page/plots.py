"""The report's plots, made from its rows: time against error, error against bands, frame time against bands.

They fit a column of print: 86 mm wide, 8 pt, with a colour, a marker and a dash for each curve (M. Okabe, K. Ito, "Color
Universal Design", 2008), and a legend below the axes. Equal rows give equal bytes with the same version of matplotlib.
"""

from __future__ import annotations

import io
import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from shviewer.benchmark import reconstruction_rows as reconstruction
from shviewer.benchmark.experiments import METHODS
from shviewer.benchmark.measured_lights import TOLERANCES
from shviewer.benchmark.page.further_plots import STEMS, further_plots
from shviewer.benchmark.page.plot_marks import INCHES, STYLE, Curve, draw_curves, log_axes, padded, shorten
from shviewer.benchmark.page.tables import plain
from shviewer.benchmark.projection_rows import SECTION as PROJECTION
from shviewer.benchmark.row import Row
from shviewer.harmonics.metrics import pareto_front
from shviewer.outputs import write_atomically

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MISSING = "no plots: matplotlib is not installed; python -m pip install 'shviewer[report]'"

ERROR_BANDS, FRAME_TIME = "error-bands", "frame-time"
"""Stems of the files of two plots."""

PIXELS_PER_INCH = 240
FLOOR = 1e-5
"""Errors below this share are drawn on the lower edge."""

BAND_FLOOR = 1e-3
"""The same in the plot of error against bands, where tolerances of 10 to 1 % matter."""

SIXTY_HERTZ = 1000 / 60
MARKED: dict[str, Any] = {"color": "0.45", "linewidth": 0.7, "linestyle": (0, (1, 2)), "zorder": 1}
"""The look of a level that is marked across the axes."""

BELOW: dict[str, Any] = {"loc": "outside lower left", "ncols": 2}
"""The place of a legend: below the axes, in columns."""


def make_plots(
    rows: Sequence[Row], folder: Path, extra: Mapping[str, Any] | None = None
) -> tuple[tuple[Path, ...], str]:
    """Write the plots for which there are rows, or results in a report's `extra`, as .svg and .png.

    Returns the files, and MISSING if matplotlib is missing.

    OutputError if a file cannot be written.
    """
    try:
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        return (), MISSING
    written: list[Path] = []
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        for stem, draw in (_plots(rows) | further_plots(extra or {})).items():
            figure = Figure(figsize=INCHES)
            FigureCanvasAgg(figure)
            draw(figure)
            stamps = {".svg": {"Date": None, "Creator": "shviewer"}, ".png": {"Software": None, "shviewer": stem}}
            for suffix, metadata in stamps.items():
                buffer = io.BytesIO()
                figure.savefig(buffer, format=suffix[1:], dpi=PIXELS_PER_INCH, metadata=metadata)
                written.append(folder / f"{stem}{suffix}")
                write_atomically(written[-1], buffer.getvalue())
    return tuple(written), ""


def _plots(rows: Sequence[Row]) -> dict[str, Callable[[Figure], None]]:
    """File stem -> the function that draws the plot."""
    plots: dict[str, Callable[[Figure], None]] = {}
    lights = list(dict.fromkeys(row.light for row in rows if row.section == PROJECTION))
    for light, stem in zip(lights, time_error_stems(lights), strict=True):
        curves = time_error_curves(rows, light)
        if curves:
            plots[stem] = partial(draw_time_error, light=light, curves=curves)
    errors, frames = error_curves(rows), frame_curves(rows)
    if errors:
        plots[ERROR_BANDS] = partial(draw_errors, curves=errors)
    if frames:
        plots[FRAME_TIME] = partial(draw_frames, curves=frames)
    return plots


def names_of(lights: Sequence[str]) -> list[str]:
    """The names of all files that the plots of a report on these lights may have."""
    stems = (*time_error_stems(lights), ERROR_BANDS, FRAME_TIME, *STEMS)
    return [f"{stem}{suffix}" for stem in stems for suffix in (".svg", ".png")]


def time_error_stems(lights: Sequence[str]) -> list[str]:
    """A file stem for each light's plot, all different."""
    stems: list[str] = []
    for light in lights:
        stem = f"time-error-{''.join(c if c.isalnum() or c in '-_' else '-' for c in light)}"
        while stem in stems:
            stem += "-"
        stems.append(stem)
    return stems


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


def error_curves(rows: Sequence[Row]) -> list[Curve]:
    """A curve (bands, percent left out) for each light."""
    curves = []
    for look, light in enumerate(dict.fromkeys(row.light for row in rows if row.truncation is not None)):
        found = {
            row.n_bands: 100 * max(row.truncation, BAND_FLOOR)
            for row in rows
            if row.light == light and row.truncation is not None and row.n_bands
        }
        curves.append(Curve(light, tuple(sorted(found.items())), look))
    return [curve for curve in curves if len(curve.points) > 1]


def frame_curves(rows: Sequence[Row]) -> list[Curve]:
    """A curve (bands, milliseconds) for each way of drawing and for making the map: medians over the lights, quartiles."""
    drawn = ("milliseconds", "low_quartile", "high_quartile")
    columns = (
        ("direct sum", reconstruction.DIRECT, drawn),
        ("cached map", reconstruction.CACHED, drawn),
        ("making the map", reconstruction.CACHED, ("set_up_milliseconds",)),
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
    broad: dict[str, Any] = {"color": "0.85", "linewidth": 5, "zorder": 1, "solid_joinstyle": "miter"}
    axes.step(*zip(*stairs, strict=True), where="post", **broad, label="Pareto front")
    figure.legend(**BELOW)


def draw_errors(figure: Figure, curves: Sequence[Curve]) -> None:
    """Draw the error of n bands for each light, with the tolerances."""
    lowest = min(y for curve in curves for _, y in curve.points)
    bottom = lowest if lowest == 100 * BAND_FLOOR else min(lowest / 1.3, 0.8)
    axes = _band_axes(figure, "relative L2 error of the first bands", curves, (bottom, 115.0))
    ticks = [tick for tick in (0.1, 1, 5, 10, 100) if tick >= bottom]
    axes.set_yticks(ticks, [f"{'< ' * (tick == 100 * BAND_FLOOR == lowest)}{plain(tick)} %" for tick in ticks])
    for tolerance in TOLERANCES:
        axes.axhline(100 * tolerance, **MARKED)
    draw_curves(axes, curves)
    axes.plot([], [], **MARKED, label="tolerances")
    figure.legend(**BELOW)


def draw_frames(figure: Figure, curves: Sequence[Curve]) -> None:
    """Draw milliseconds per frame; at 60 frames a second there are 16.7."""
    y = padded((*(y for curve in curves for _, y in curve.points), SIXTY_HERTZ))
    title = "milliseconds per frame of 1280 \N{MULTIPLICATION SIGN} 640"
    axes = _band_axes(figure, title, curves, y, unit="")
    draw_curves(axes, curves)
    axes.axhline(SIXTY_HERTZ, **MARKED, label="60 a second")
    figure.legend(**BELOW)


def _band_axes(figure: Figure, title: str, curves: Sequence[Curve], y: tuple[float, float], unit: str = " %") -> Axes:
    """Axes on which the band counts of the curves go to the right."""
    bands = [x for curve in curves for x, _ in curve.points]
    low, high = min(bands) / 1.12, max(bands) * 1.12
    axes = log_axes(figure, title, (low, high), y, unit)
    ticks = [n for n in (*reconstruction.BANDS, 128) if low <= n <= high]
    axes.set_xticks(ticks, [plain(n) for n in ticks])
    axes.set_xlabel("bands")
    return axes
