"""The look of the report's plots: axes with plain numbers, curves that differ even without colour, a legend below."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from shviewer.benchmark.page.tables import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INCHES = (3.39, 3.2)
"""Size of a plot with its legend: 86 mm wide."""

STYLE: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    **dict.fromkeys(("font.size", "figure.titlesize", "axes.labelsize", "xtick.labelsize", "ytick.labelsize"), 8),
    **dict.fromkeys(("axes.linewidth", "grid.linewidth", "xtick.major.width", "ytick.major.width"), 0.6),
    **dict.fromkeys(("xtick.major.size", "ytick.major.size"), 2.5),
    **dict.fromkeys(("axes.spines.top", "axes.spines.right", "legend.frameon", "text.parse_math"), False),
    "axes.axisbelow": True,
    "grid.color": "0.9",
    "figure.constrained_layout.use": True,
    "legend.handlelength": 3.6,
    "legend.columnspacing": 1.2,
    "legend.labelspacing": 0.3,
    "lines.linewidth": 1.2,
    "lines.markersize": 4,
    "svg.hashsalt": "shviewer",
    "svg.fonttype": "path",
    "savefig.facecolor": "white",
}

DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (5, 1.5, 1.2, 1.5)))
COLOURS = ("#000000", "#0072B2", "#009E73", "#D55E00", "#E69F00", "#CC79A7", "#56B4E9", "#595959", "#8C8C8C")
LOOKS = tuple(zip(COLOURS, "os^DvPX<>", strict=True))
"""Colours and markers; with nine of them and four dashes, no two of 36 curves look alike."""

LONGEST_NAME = 20


class Curve(NamedTuple):
    """A named curve of points (x, y), in the axes' units, drawn in one look."""

    name: str
    points: tuple[tuple[float, float], ...]
    look: int
    """The index of its colour and marker in LOOKS and of its dash in DASHES; both lists start again at their end."""
    spread: tuple[tuple[float, float], ...] = ()
    """The quartiles of each y; empty if they are not known."""


def log_axes(figure: Figure, title: str, x: tuple[float, float], y: tuple[float, float], unit: str = " %") -> Axes:
    """Log-log axes with a light grid and plain numbers; the title says what the upright axis is."""
    axes = figure.add_subplot(xscale="log", yscale="log", xlim=x, ylim=y)
    figure.suptitle(title, x=0.02, horizontalalignment="left")
    for axis, (low, high), after in ((axes.xaxis, x, ""), (axes.yaxis, y, unit)):
        ticks = nice_ticks(low, high)
        axis.set_ticks(ticks, [f"{plain(tick)}{after}" for tick in ticks])
        axis.set_ticks([], minor=True)
    axes.grid(True)
    return axes


def draw_curves(axes: Axes, curves: Sequence[Curve]) -> None:
    for curve in curves:
        colour, marker = LOOKS[curve.look % len(LOOKS)]
        axes.plot(
            *zip(*curve.points, strict=True),
            label=shorten(curve.name),
            color=colour,
            marker=marker,
            markeredgecolor="white",
            markeredgewidth=0.4,
            linestyle=DASHES[curve.look % len(DASHES)],
            clip_on=False,
            zorder=3 + 0.01 * curve.look,
        )
        for (x, _), ends in zip(curve.points, curve.spread, strict=False):
            axes.plot((x, x), ends, color=colour, linewidth=0.6, clip_on=False, zorder=3)


def shorten(name: str) -> str:
    return name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 3]}..."


def nice_ticks(low: float, high: float) -> list[float]:
    """Ticks: powers of ten; below three decades, 1, 2 and 5 times these; round steps if that gives fewer than three."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for factors in ((1,), (1, 3), (1, 2, 5)):
        ticks = [factor * 10.0**decade for decade in decades for factor in factors]
        ticks = [tick for tick in ticks if low <= tick <= high]
        if len(ticks) >= 4 or (factors == (1, 2, 5) and len(ticks) >= 3):
            return ticks
    step = 10.0 ** math.floor(math.log10((high - low) / 3))
    step *= next(factor for factor in (5, 2, 1) if (high - low) / (factor * step) >= 3)
    return [step * k for k in range(math.ceil(low / step), math.floor(high / step) + 1)]


def padded(values: Iterable[float], highest: float = math.inf) -> tuple[float, float]:
    """A range a little wider than that of the values, and never empty; it ends at `highest` if the values allow."""
    known = list(values)
    low, high = min(known), max(known)
    room = max((high / low) ** 0.06, 1.004)
    return low / room, max(min(high * room, highest), high)
