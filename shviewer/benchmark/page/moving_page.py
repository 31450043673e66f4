"""The section of the report on lights that move: the paper's last claim answered with figures, and the tables behind it."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence

from shviewer.benchmark.moving import BANDS, DEGREES, MOST, SUN_WIDTH, WAYS, Sampled, Stated
from shviewer.benchmark.page.tables import MOST_COLUMNS, bullet, percent, table
from shviewer.words import grouped

TITLE = "Lights that move"
FRESH, SAME, INDEPENDENT = WAYS

CLAIM = """\
The paper ends on the claim that projecting a light "reduces flicker and noise" when it moves. Here lights turn by
{degrees:g} degree a frame and are projected anew in each; errors are RMS over frames and the whole sphere, relative to the norm
of the light, *frame to frame* likewise. Formulas stand beside."""


def as_markdown(exact: Mapping[str, float | None], samples: Sequence[Sampled], stated: Sequence[Stated]) -> str:
    lines = [
        CLAIM.format(degrees=DEGREES),
        "",
        *textwrap.wrap(f"**{answer(samples, stated)}**", MOST_COLUMNS, break_on_hyphens=False),
        "",
    ]
    for name, flicker in exact.items():
        if flicker is not None:
            lines.append(
                bullet(f"{name}, projected in closed form, and turned back: it changes by {flicker:.0e} of its norm.")
            )
    counts = sorted({one.samples for one in samples})
    headings = ("light", "points", "a frame", "bands", "RMS", "frame to frame", "formula")
    rows = [
        (
            one.light,
            one.way,
            grouped(one.samples),
            str(one.n_bands),
            percent(one.rms),
            percent(one.flicker),
            percent(one.formula),
        )
        for one in samples
        if one.n_bands in (3, 5, MOST)
    ]
    if counts:
        lines += ["", *table(headings, rows, left=2)]
    lines += ["", "Noise of one standard deviation in each texel, and a sun that crosses texels:", ""]
    found = [
        (
            one.what,
            "irradiance" if one.n_bands is None else str(one.n_bands),
            percent(one.simulated),
            percent(one.formula),
        )
        for one in stated
    ]
    return "\n".join([*lines, *table(("what moves", "bands", "simulated", "formula"), found)])


def answer(samples: Sequence[Sampled], stated: Sequence[Stated]) -> str:
    """One paragraph that can be quoted, with the figures of this run."""
    left = {one.n_bands: one.simulated for one in stated if "exactly projected" in one.what}
    shaded = [one.simulated for one in stated if "irradiance over pi" in one.what]
    few = next(one for one in stated if "texels read" in one.what and one.n_bands == MOST)
    hops = next(one for one in stated if "hops" in one.what and one.n_bands == 3)
    parts = [
        "Half true. Projected exactly, n bands add no flicker to a light that turns (a projection shortens every difference),"
        f" and they keep n / sqrt(N) of the noise of N texels of equal area: of 64 x 32, {percent(left[3])} in 3 bands and"
        f" {percent(left[MOST])} in {MOST}."
    ]
    light = next(iter(dict.fromkeys(one.light for one in samples)), None)
    if light is not None:
        own = {(one.way, one.samples, one.n_bands): one for one in samples if one.light == light}
        counts = sorted(count for way, count, n in own if way == SAME and n == MOST)
        fresh, most, same = own[FRESH, counts[0], MOST], own[FRESH, counts[-1], MOST], own[SAME, counts[0], MOST]
        parts.append(
            "Projected from fresh samples in each frame, as the paper does, they flicker by about sqrt((n^2 - 1)/N), which the"
            f" light itself does not: {light} in {MOST} bands by {percent(fresh.flicker)} of its norm from frame to frame with"
            f" {counts[0]} jittered samples, and by {percent(most.flicker)} with {grouped(counts[-1])}. The same samples in"
            f" every frame flicker less, {percent(same.flicker)}, and leave a bias that crawls over the light."
        )
    parts.append(
        f"Below N = n^2 samples the picture is noisier than the noisy light: {MOST} bands from {few.what.split()[0]} texels"
        f" hold {percent(few.simulated)} of its noise. Irradiance is calm because it is a blur, not because it is SH: 3 bands"
        f" of it keep {percent(shaded[0])} of the noise, and all bands {percent(shaded[1])}. A sun that hops between"
        f" {SUN_WIDTH} columns moves 3 bands by {percent(hops.simulated)}; no number of bands mends one that is sampled at"
        " points."
    )
    return " ".join(parts)


def curves(samples: Sequence[Mapping[str, object]]) -> dict[str, list[tuple[float, float]]]:
    """For the plot: way and samples -> (bands, RMS in percent), of the first light."""
    found: dict[str, list[tuple[float, float]]] = {}
    for one in samples:
        if one["light"] == samples[0]["light"]:
            way = {FRESH: "fresh", SAME: "same", INDEPENDENT: "independent"}[str(one["way"])]
            found.setdefault(f"{way}, {one['samples']}", []).append(
                (float(str(one["n_bands"])), 100 * float(str(one["rms"])))
            )
    return {name: points for name, points in found.items() if len(points) == len(BANDS)}
