"""Plots of what a report holds beside its rows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from shviewer.benchmark.page.moving_page import curves
from shviewer.benchmark.page.plot_marks import DASHES, LOOKS, Curve, draw_curves, log_axes, padded, shorten

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ROUGHNESS_BANDS = "roughness-bands"
"""Stem of the files of the plot of bands against roughness."""

MOVING = "moving-bands"
"""That of the error of a light that turns."""

STEMS = (ROUGHNESS_BANDS, MOVING)
TICKS = (1, 2, 3, 5, 9, 16, 32, 64, 128)
PLOTTED = "0.05"


def further_plots(extra: Mapping[str, Any]) -> dict[str, Callable[[Figure], None]]:
    """File stem -> the function that draws the plot, for what there is in a report's `extra`."""
    plots: dict[str, Callable[[Figure], None]] = {}
    if found := extra.get("roughness"):
        plots[ROUGHNESS_BANDS] = partial(draw_staircases, roughness=found["roughness"], counts=found["fewest_bands"])
    if found := extra.get("moving", {}).get("sampled"):
        plots[MOVING] = partial(draw_moving, samples=found)
    return plots


def draw_staircases(figure: Figure, roughness: list[float], counts: dict[str, dict[str, list[int | None]]]) -> None:
    """Draw the fewest bands within 5 % against roughness, a staircase for each light; it begins where there is a count."""
    most = max([max(filter(None, row[PLOTTED]), default=1) for row in counts.values()], default=1)
    axes = log_axes(figure, "fewest bands within 5 %", (roughness[0], roughness[-1]), (0.9, 1.15 * most), "")
    axes.set_xscale("linear")
    axes.set_xticks([0.1, 0.2, 0.4, 0.6, 0.8, 1.0])
    axes.set_yticks(
        [tick for tick in TICKS if tick <= 1.15 * most], [str(tick) for tick in TICKS if tick <= 1.15 * most]
    )
    axes.set_xlabel("roughness")
    for look, (name, row) in enumerate(counts.items()):
        values = [float("nan") if count is None else float(count) for count in row[PLOTTED]]
        shift = 1 + 0.012 * (look - len(counts) / 2)  # counts that are equal are seen beside each other
        line = {"color": LOOKS[look % len(LOOKS)][0], "linestyle": DASHES[look % len(DASHES)]}
        axes.step(roughness, [shift * value for value in values], where="post", label=shorten(name), **line)
    figure.legend(loc="outside lower left", ncols=2)


def draw_moving(figure: Figure, samples: list[dict[str, Any]]) -> None:
    """Draw the RMS error of a light that turns against bands, for each way to sample its frames; beyond 100 % it is noise."""
    found = [Curve(name, tuple(points), look) for look, (name, points) in enumerate(curves(samples).items())]
    x, y = padded(n for n, _ in found[0].points), padded(error for curve in found for _, error in curve.points)
    axes = log_axes(figure, f"{shorten(samples[0]['light'])}: RMS over frames", x, y)
    axes.set_xticks([n for n, _ in found[0].points], [f"{n:g}" for n, _ in found[0].points])
    axes.set_xlabel("bands")
    axes.axhline(100, color="0.45", linewidth=0.7, linestyle=(0, (1, 2)), zorder=1)
    draw_curves(axes, found)
    figure.legend(loc="outside lower left", ncols=2)
