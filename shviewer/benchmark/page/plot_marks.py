"""How the report's plots look: axes with plain numbers, curves that are told apart without colour, and names beside them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INCHES = (3.39, 2.75)
"""86 mm wide."""

STYLE: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "lines.linewidth": 1.2,
    "lines.markersize": 4,
    "svg.hashsalt": "shviewer",
    "svg.fonttype": "path",
    "text.parse_math": False,
    "savefig.facecolor": "white",
}

DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (5, 1.5, 1.2, 1.5)))
LOOKS = (
    ("#000000", "o"),
    ("#0072B2", "s"),
    ("#009E73", "^"),
    ("#D55E00", "D"),
    ("#E69F00", "v"),
    ("#CC79A7", "P"),
    ("#56B4E9", "X"),
    ("#595959", "<"),
    ("#8C8C8C", ">"),
)
"""Colour and marker; with nine of them and four dashes no two of 36 curves look alike."""

LEFT = 0.165
"""Where the axes begin, of the figure's width."""


@dataclass(frozen=True)
class Curve:
    """Points (x, y) in the axes' units, drawn in one look and called by its name."""

    name: str
    points: tuple[tuple[float, float], ...]
    look: int
    """Of LOOKS and DASHES; -1 for a grey one."""
    spread: tuple[tuple[float, float], ...] = ()
    """The quartiles of each y, where they are known."""


def log_axes(figure: Figure, title: str, x: tuple[float, float], y: tuple[float, float], unit: str = " %") -> Axes:
    """Log-log axes with a light grid and plain numbers; the title says what the upright axis is."""
    axes = figure.add_axes((LEFT, 0.15, 0.94 - LEFT, 0.74))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(*x)
    axes.set_ylim(*y)
    figure.text(0.02, 0.92, title)
    for axis, (low, high), after in ((axes.xaxis, x, ""), (axes.yaxis, y, unit)):
        ticks = nice_ticks(low, high)
        axis.set_ticks(ticks, [f"{plain(tick)}{after}" for tick in ticks])
        axis.set_ticks([], minor=True)
    axes.grid(True)
    return axes


def draw_curves(axes: Axes, curves: Sequence[Curve]) -> None:
    for curve in curves:
        look, order = _glyph(curve), 3 + 0.01 * curve.look
        axes.plot(*zip(*curve.points, strict=True), **look, linestyle=_dash(curve), clip_on=False, zorder=order)
        for (x, _), ends in zip(curve.points, curve.spread, strict=False):
            axes.plot((x, x), ends, color=look["color"], linewidth=0.6, clip_on=False, zorder=3)


def _glyph(curve: Curve) -> dict[str, Any]:
    if curve.look < 0:
        return {"color": "0.85", "linewidth": 5, "solid_capstyle": "butt"}
    colour, marker = LOOKS[curve.look % len(LOOKS)]
    return {"color": colour, "marker": marker, "markeredgecolor": "white", "markeredgewidth": 0.4}


def _dash(curve: Curve) -> Any:
    return DASHES[curve.look % len(DASHES)] if curve.look >= 0 else "-"


def _name_colour(curve: Curve) -> tuple[float, float, float]:
    return darker(LOOKS[curve.look % len(LOOKS)][0]) if curve.look >= 0 else GREY


def name_ends(axes: Axes, curves: Sequence[Curve]) -> None:
    """Each name right of the axes, at the height of its curve's end or as near as its neighbours allow."""
    low, high = axes.get_ylim()
    span = math.log(high / low)
    ends = sorted(((math.log(curve.points[-1][1] / low) / span, curve) for curve in curves), key=lambda end: end[0])
    names = {curve.name: shorten(curve.name) for curve in curves}
    room = max(_text_size(axes, name)[0] for name in names.values()) + LEADER
    left, bottom, _, height = axes.get_position().bounds
    width = 0.99 - left - room / (72 * INCHES[0])
    axes.set_position((left, bottom, width, height))
    begin = 1 + LEADER / (72 * INCHES[0] * width)
    for (_, curve), place in zip(ends, spread([height for height, _ in ends], NAME_HEIGHT), strict=True):
        axes.annotate(
            names[curve.name],
            curve.points[-1],
            (begin, place),
            textcoords="axes fraction",
            color=_name_colour(curve),
            verticalalignment="center_baseline",
            arrowprops={"arrowstyle": "-", "color": "0.7", "linewidth": 0.5, "shrinkA": 1, "shrinkB": 3},
        )


def shorten(name: str) -> str:
    return name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 3]}..."


def _text_size(axes: Axes, text: str) -> tuple[float, float]:
    """Width and height in points."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    drawn = axes.text(0, 0, text)
    box = drawn.get_window_extent(figure.canvas.get_renderer())  # type: ignore[attr-defined]  # of Agg
    drawn.remove()
    return box.width * 72 / figure.dpi, box.height * 72 / figure.dpi


LEADER = 11.0
"""Points between the axes and the names."""

GLYPH = 17.0
"""Points before a name for a piece of its curve."""

LONGEST_NAME = 20
GREY = (0.35, 0.35, 0.35)

NAME_HEIGHT = 0.075
"""Of a line of text and its gap, in heights of the axes."""


def spread(heights: Sequence[float], gap: float) -> list[float]:
    """Rising numbers moved by as little as puts them `gap` apart, alike for those that collide."""
    groups: list[tuple[float, int]] = []  # mean height, count
    for height in heights:
        groups.append((height, 1))
        while len(groups) > 1 and groups[-1][0] - groups[-2][0] < gap * (groups[-1][1] + groups[-2][1]) / 2:
            (upper, above), (lower, below) = groups.pop(), groups.pop()
            groups.append(((upper * above + lower * below) / (above + below), above + below))
    return [mean + gap * (k - (count - 1) / 2) for mean, count in groups for k in range(count)]


def place_names(axes: Axes, curves: Sequence[Curve]) -> None:
    """Each marker and name beside its curve, where they cover least of the others and no other name."""
    from matplotlib.patheffects import withStroke

    scale = axes.bbox.width / (axes.get_position().width * 72 * INCHES[0])
    paths = [_along(axes.transData.transform(np.array(curve.points))) for curve in curves]
    taken: list[Place] = []
    for number, (curve, path) in enumerate(zip(curves, paths, strict=True)):
        width, height = (scale * size for size in _text_size(axes, curve.name))
        width += GLYPH * scale
        places: list[tuple[float, Place]] = []
        for order, (x, y) in enumerate(path[::-8].tolist()):
            for turn, (across, up, away) in enumerate(BESIDE):
                left = x + across * (width / 2 + away * scale) - width / 2
                bottom = y + up * (height / 2 + away * scale) - height / 2
                place = left, bottom, left + width, bottom + height
                cost = 1000.0 * _outside(place, axes.bbox.extents, 6 * scale)
                cost += 500.0 * sum(_overlap(place, other) for other in taken)
                covered = [_covered(place, other, 3 * scale) for other in paths]
                cost += 3.0 * sum(covered) + 0.1 * order + 0.2 * turn
                gaps = [_gap(place, other) for other in paths]
                cost += 10.0 * (gaps[number] > 2 * min(gaps) + scale)  # it would be read as another's
                places.append((cost, place))
        best = min(places)[1]
        taken.append(best)
        left, bottom = best[0], best[1]
        x, y, end, middle = (
            *axes.transAxes.inverted().transform((left, bottom)),
            *axes.transAxes.inverted().transform((left + (GLYPH - 3) * scale, bottom + 0.45 * height)),
        )
        halo = [withStroke(linewidth=1.5, foreground="white")]
        axes.text(
            end + 0.25 * (end - x),
            y,
            curve.name,
            color=_name_colour(curve),
            transform=axes.transAxes,
            va="bottom",
            zorder=5,
            path_effects=halo,
        )
        sample = {**_glyph(curve), "markevery": [1], "transform": axes.transAxes, "clip_on": False, "zorder": 5}
        axes.plot((x, (x + end) / 2, end), (middle,) * 3, linestyle=_dash(curve), **sample)


BESIDE = tuple(
    (across, up, away)
    for away in (4, 12, 24, 40)
    for across, up in ((1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1), (-1, 0))
)
"""Where a name may stand from a point, right, above, below ..., and how many points away."""

Place = tuple[float, float, float, float]
"""left, bottom, right, top in pixels."""


def _outside(place: Place, frame: Any, margin: float) -> bool:
    """Whether a name leaves the axes, but for the free margin on the right."""
    left, bottom, right, top = frame
    return bool(place[0] < left or place[1] < bottom or place[2] > right + margin or place[3] > top)


def _along(points: Any) -> Any:
    """Pixels (k, 2) -> points every few pixels on the way."""
    if len(points) == 1:
        return points
    steps = [np.linspace(a, b, 2 + int(np.hypot(*(b - a)) / 4)) for a, b in pairwise(points)]
    return np.concatenate(steps)


def _covered(place: Place, path: Any, margin: float) -> int:
    left, bottom, right, top = place
    x, y = path.T
    return int(((x > left - margin) & (x < right + margin) & (y > bottom - margin) & (y < top + margin)).sum())


def _gap(place: Place, path: Any) -> float:
    """Pixels from the name to the nearest point of the path."""
    left, bottom, right, top = place
    x, y = path.T
    across = np.maximum(0, np.maximum(left - x, x - right))
    up = np.maximum(0, np.maximum(bottom - y, y - top))
    return float(np.hypot(across, up).min())


def _overlap(a: Place, b: Place) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def darker(colour: str) -> tuple[float, float, float]:
    """Two thirds of a "#rrggbb", so that thin letters of it can be read on white."""
    red, green, blue = (int(colour[i : i + 2], 16) / 255 * 2 / 3 for i in (1, 3, 5))
    return red, green, blue


def nice_ticks(low: float, high: float) -> list[float]:
    """Powers of ten; 1, 2, 5 of them for fewer than three decades; round steps where not even that gives three."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for factors in ((1,), (1, 3), (1, 2, 5)):
        ticks = [factor * 10.0**decade for decade in decades for factor in factors]
        ticks = [tick for tick in ticks if low <= tick <= high]
        if len(ticks) >= 4 or (factors == (1, 2, 5) and len(ticks) >= 3):
            return ticks
    step = 10.0 ** math.floor(math.log10((high - low) / 3))
    step *= next(factor for factor in (5, 2, 1) if (high - low) / (factor * step) >= 3)
    return [step * k for k in range(math.ceil(low / step), math.floor(high / step) + 1)]


def plain(value: float) -> str:
    """Four digits at most, and never a power of ten."""
    return np.format_float_positional(value, 4, unique=False, fractional=False, trim="-")


def padded(values: Iterable[float], highest: float = math.inf) -> tuple[float, float]:
    """A little more than the values span, at least by a little; up to `highest`, if the values allow."""
    known = list(values)
    low, high = min(known), max(known)
    room = max((high / low) ** 0.06, 1.004)
    return low / room, max(min(high * room, highest), high)
