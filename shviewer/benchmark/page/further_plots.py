"""Plots of what a report holds beside its rows: bands against roughness, and lights that move."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from shviewer.benchmark.page.bands_page import staircases_of
from shviewer.benchmark.page.moving_page import curves
from shviewer.benchmark.page.plot_marks import (
    BELOW,
    DASHES,
    MARKED,
    MARKERS,
    Curve,
    draw_curves,
    log_axes,
    padded,
    shorten,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TICKS = (1, 2, 3, 5, 9, 16, 32, 64, 128)
PLOTTED = 0.05


def draw_staircases(figure: Figure, found: Mapping[str, Any]) -> None:
    """Draw the fewest bands within 5 % against roughness, a staircase for each light; it begins where there is a count.

    found: the report's `extra` on roughness.
    """
    counts = {name: steps_of[PLOTTED].counts for name, steps_of in staircases_of(found).items()}
    roughness = found["roughness"]
    most = max([max(filter(None, row), default=1) for row in counts.values()], default=1)
    axes = log_axes(figure, "fewest bands to reflect within 5 %", (roughness[0], roughness[-1]), (0.9, 1.15 * most), "")
    axes.set_xscale("linear")
    axes.set_xticks([0.1, 0.2, 0.4, 0.6, 0.8, 1.0])
    ticks = [tick for tick in TICKS if tick <= 1.15 * most]
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
    for name, points in curves(samples).items():
        look = families.setdefault(name.partition(",")[0], len(families))
        found.append(Curve(name, tuple(points), look, dash=sum(other.look == look for other in found)))
    x, y = padded(n for n, _ in found[0].points), padded(error for curve in found for _, error in curve.points)
    axes = log_axes(figure, f"{shorten(samples[0]['light'])}, turning: RMS error", x, y)
    axes.set_xticks([n for n, _ in found[0].points], [f"{n:g}" for n, _ in found[0].points])
    axes.set_xlabel("bands")
    axes.axhline(100, **MARKED)
    draw_curves(axes, found)
    figure.legend(**BELOW)
