"""The look of the report's plots: that of the picture, or white; plain numbers, curves that differ even without colour."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from shviewer.benchmark.page.tables import plain
from shviewer.resources import resource_folder
from shviewer.viewer.overlay.inks import ACCENT, ERROR, FAINT, GREY, GROUND, INK, RULE, WARNING, Ink
from shviewer.viewer.overlay.letters.lettering import REGULAR, SEMIBOLD
from shviewer.viewer.overlay.letters.numerals import typeset
from shviewer.words import grouped

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INCHES = (3.39, 3.2)
"""Size of a plot with its legend: 86 mm wide."""

FAMILY, HEAD_FAMILY = ["Inter", "DejaVu Sans"], ["Inter Semi Bold", "DejaVu Sans"]
"""The face of the picture, and one of matplotlib's for letters that it lacks."""

DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (5, 1.5, 1.2, 1.5)))
MARKERS = "os^DvPX<>"
"""With nine markers and colours and four dashes, no two of 36 curves look alike."""

LEVEL = f"C{len(MARKERS)}"
FRONT = f"C{len(MARKERS) + 1}"
"""The colours of a level across the axes and of the Pareto front, after those of the curves."""


MARKED: dict[str, Any] = {"color": LEVEL, "linewidth": 0.7, "linestyle": (0, (1, 2)), "zorder": 1}
"""The look of a level that is marked across the axes."""

BELOW: dict[str, Any] = {"loc": "outside lower left", "ncols": 2}
"""The place of a legend: below the axes, in columns."""


class Paper(NamedTuple):
    """The colours of a plot, as #rrggbb."""

    ground: str
    ink: str
    rule: str
    colours: tuple[str, ...]
    """Those of the curves, of LEVEL and of FRONT."""


def _hex(ink: Ink) -> str:
    return "#" + bytes(ink[:3]).hex()


SCREEN = Paper(
    _hex(GROUND),
    _hex(INK),
    _hex(RULE),
    (
        *map(_hex, (INK, ACCENT, WARNING, ERROR)),
        "#6ccc9a",
        "#cf9cf0",
        "#62cbe0",
        _hex(GREY),
        "#c8a078",
        _hex(FAINT),
        "#58585f",
    ),
)
"""The ground of the picture, with its inks."""

WHITE = Paper(
    "#ffffff",
    "#000000",
    "#e6e6e6",
    (
        "#000000",
        "#0072b2",
        "#009e73",
        "#d55e00",
        "#e69f00",
        "#cc79a7",
        "#56b4e9",
        "#595959",
        "#8c8c8c",
        "#737373",
        "#d9d9d9",
    ),
)
"""White paper, for print, with colours that all kinds of colour vision tell apart [M. Okabe, K. Ito, "Color Universal Design",
2008]."""


def style(paper: Paper) -> dict[Any, Any]:
    """The settings of matplotlib for a plot on this paper."""
    texts = ("text.color", "axes.labelcolor", "xtick.labelcolor", "ytick.labelcolor", "legend.labelcolor")
    return {
        "font.family": FAMILY,
        **dict.fromkeys(("font.size", "figure.titlesize", "axes.labelsize", "xtick.labelsize", "ytick.labelsize"), 8),
        **dict.fromkeys(("axes.linewidth", "grid.linewidth", "xtick.major.width", "ytick.major.width"), 0.6),
        **dict.fromkeys(("xtick.major.size", "ytick.major.size"), 2.5),
        **dict.fromkeys(("axes.spines.top", "axes.spines.right", "legend.frameon", "text.parse_math"), False),
        **dict.fromkeys(texts, paper.ink),
        **dict.fromkeys(("axes.edgecolor", "xtick.color", "ytick.color"), paper.colours[-2]),
        **dict.fromkeys(("figure.facecolor", "axes.facecolor", "savefig.facecolor"), paper.ground),
        "axes.axisbelow": True,
        "axes.prop_cycle": f"cycler('color', {list(paper.colours)})",
        "axes.unicode_minus": True,
        "grid.color": paper.rule,
        "figure.constrained_layout.use": True,
        "legend.handlelength": 3.6,
        "legend.columnspacing": 1.2,
        "legend.labelspacing": 0.3,
        "lines.linewidth": 1.2,
        "lines.markersize": 4,
        "svg.hashsalt": "shviewer",
        "svg.fonttype": "path",
    }


def add_faces() -> None:
    """Make the picture's face known to matplotlib."""
    from matplotlib.font_manager import fontManager

    logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)  # it warns where a face has one weight only
    known = {entry.fname for entry in fontManager.ttflist}
    for weight in (REGULAR, SEMIBOLD):
        path = str(resource_folder("assets") / "fonts" / f"Inter-{weight}.otf")
        if path not in known:
            fontManager.addfont(path)


LONGEST_NAME = 20


class Curve(NamedTuple):
    """A named curve of points (x, y), in the axes' units, drawn in one look."""

    name: str
    points: tuple[tuple[float, float], ...]
    look: int
    """The index of its colour, its marker and its dash; each list starts again at its end."""
    spread: tuple[tuple[float, float], ...] = ()
    """The quartiles of each y; empty if they are not known."""
    marked: tuple[int, ...] | None = None
    """The points that have a marker; None for all."""
    dash: int | None = None
    """The index of its dash, where curves of one colour are a family; None for `look`."""


def log_axes(figure: Figure, title: str, x: tuple[float, float], y: tuple[float, float], unit: str = " %") -> Axes:
    """Log-log axes with a light grid and plain numbers; the title says what the upright axis is."""
    axes = figure.add_subplot(xscale="log", yscale="log", xlim=x, ylim=y)
    figure.suptitle(title, x=0.02, horizontalalignment="left", fontfamily=HEAD_FAMILY)
    for axis, (low, high), after in ((axes.xaxis, x, ""), (axes.yaxis, y, unit)):
        ticks = nice_ticks(low, high)
        axis.set_ticks(ticks, [tick_text(tick, after) for tick in ticks])
        axis.set_ticks([], minor=True)
    axes.grid(True)
    return axes


def tick_text(value: float, after: str = "") -> str:
    """A number on an axis, as numbers are set in the picture."""
    text = plain(value)
    return typeset(f"{grouped(int(text)) if '.' not in text else text}{after}")


def draw_curves(axes: Axes, curves: Sequence[Curve]) -> None:
    for curve in curves:
        colour = f"C{curve.look % len(MARKERS)}"
        axes.plot(
            *zip(*curve.points, strict=True),
            label=shorten(curve.name),
            color=colour,
            marker=MARKERS[curve.look % len(MARKERS)],
            markevery=None if curve.marked is None else list(curve.marked),
            markeredgecolor=axes.get_facecolor(),
            markeredgewidth=0.4,
            linestyle=DASHES[(curve.look if curve.dash is None else curve.dash) % len(DASHES)],
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
    room = max((high / low) ** 0.06, 1.0005)
    return low / room, max(min(high * room, highest), high)
