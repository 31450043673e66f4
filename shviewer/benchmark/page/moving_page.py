"""The section of the report on lights that move: the paper's last claim answered with figures, and the tables behind it."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence

from shviewer.benchmark.measuring.moving import BANDS, DEGREES, MOST, SECTION, WAYS, SamplingError
from shviewer.benchmark.measuring.moving_texels import SUN_WIDTH, Stated
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.tables import MOST_COLUMNS, bullet, error, table
from shviewer.words import grouped, short_count

FRESH, SAME, INDEPENDENT = WAYS
BRIEFLY = {FRESH: "jittered anew", SAME: "jittered once", INDEPENDENT: "independent"}
"""The ways to sample a frame, for tables and legends."""

CLAIM = """\
The paper ends on the claim that projecting a light "reduces flicker and noise" when it moves. Here lights turn by
{degrees:g} degree a frame and are projected anew in each. *RMS*: how far n bands of samples are from the exact n bands,
over all frames and the whole sphere, relative to the norm of the light; *frame to frame*: how far they are from those of
the frame before, likewise, both turned back to where the light began. *Formula*: the RMS of independent samples, sqrt((n^2
- kappa)/N). Points are jittered anew in each frame, jittered once and the same in every frame, or independent and new in
each frame."""

NOISE_AND_SUNS = """\
### noise and suns

Noise of one standard deviation in each texel, and a sun that crosses texels; what is left
in so many bands, simulated and by the formula:
"""

STEM = "moving-bands"
"""The file stem of the section's plot."""

SHOWN = (3, MOST)
"""The numbers of bands in the tables."""


def lines(page: Page) -> list[str]:
    """The answer, a plot, a table per light of what is sampled, and one of what is simulated beside its formula."""
    found = page.report.extra.get(SECTION)
    if not found:
        return []
    samples, stated = [SamplingError(**one) for one in found["sampled"]], [Stated(**one) for one in found["stated"]]
    said = textwrap.fill(f"**{answer(samples, stated)}**", MOST_COLUMNS, break_on_hyphens=False)
    exact = [
        bullet(f"{name}, projected in closed form, and turned back: it changes by {flicker:.0e} of its norm.")
        for name, flicker in found["turned_exactly"].items()
        if flicker is not None
    ]
    picture = page.picture(STEM, "RMS error of a turning light against bands, for each way to sample its frames")
    tables = [line for name in dict.fromkeys(one.light for one in samples) for line in _sampled_table(name, samples)]
    simulated = [
        (one.what, "all" if one.n_bands is None else str(one.n_bands), error(one.simulated), error(one.formula))
        for one in stated
    ]
    noise = table(("what moves", "bands", "simulated", "formula"), simulated)
    claim = CLAIM.format(degrees=DEGREES)
    return [claim, "", said, "", *exact, "", *picture, *tables, NOISE_AND_SUNS, *noise]


def _sampled_table(name: str, samples: Sequence[SamplingError]) -> list[str]:
    """The error and the flicker of one light that turns, for each way to sample its frames."""
    own = {(one.way, one.samples, one.n_bands): one for one in samples if one.light == name}
    rows = []
    for way, count in dict.fromkeys((way, count) for way, count, _ in own):
        figures = [own[way, count, n] for n in SHOWN]
        cells = [error(value) for one in figures for value in (one.rms, one.flicker, one.formula)]
        rows.append((BRIEFLY[way], grouped(count), *cells))
    headings = [heading for n in SHOWN for heading in (f"{n} bands: RMS", "frame to frame", "formula")]
    return [f"### {name}, turning", "", *table(("points of a frame", "number", *headings), rows), ""]


def answer(samples: Sequence[SamplingError], stated: Sequence[Stated]) -> str:
    """One paragraph that can be quoted, with the figures of this run."""
    left = {one.n_bands: one.simulated for one in stated if "exactly projected" in one.what}
    shaded = [one.simulated for one in stated if "irradiance over pi" in one.what]
    few = next(one for one in stated if "texels read" in one.what and one.n_bands == MOST)
    hops = next(one for one in stated if "hops" in one.what and one.n_bands == 3)
    parts = [
        "Half true. Projected exactly, n bands add no flicker to a light that turns (a projection shortens every difference),"
        f" and they keep n / sqrt(N) of the noise of N texels of equal area: of 64 x 32, {error(left[3])} in 3 bands and"
        f" {error(left[MOST])} in {MOST}."
    ]
    light = next(iter(dict.fromkeys(one.light for one in samples)), None)
    if light is not None:
        own = {(one.way, one.samples, one.n_bands): one for one in samples if one.light == light}
        counts = sorted(count for way, count, n in own if way == SAME and n == MOST)
        fresh, most, same = own[FRESH, counts[0], MOST], own[FRESH, counts[-1], MOST], own[SAME, counts[0], MOST]
        parts.append(
            "Projected from fresh samples in each frame, as the paper does, they flicker by about sqrt((n^2 - 1)/N), which the"
            f" light itself does not: {light} in {MOST} bands by {error(fresh.flicker)} of its norm from frame to frame with"
            f" {counts[0]} jittered samples, and by {error(most.flicker)} with {grouped(counts[-1])}. The same samples in"
            f" every frame flicker less, {error(same.flicker)}, and leave a bias that crawls over the light."
        )
    parts.append(
        f"Below N = n^2 samples the picture is noisier than the noisy light: {MOST} bands from {few.what.split()[0]} texels"
        f" hold {error(few.simulated)} of its noise. Irradiance is calm because it is a blur, not because it is SH: 3 bands"
        f" of it keep {error(shaded[0])} of the noise, and all bands {error(shaded[1])}. A sun that hops between"
        f" {SUN_WIDTH} columns moves 3 bands by {error(hops.simulated)}; no number of bands mends one that is sampled at"
        " points."
    )
    return " ".join(parts)


def curves(samples: Sequence[Mapping[str, object]]) -> dict[str, list[tuple[float, float]]]:
    """For the plot: way and samples -> (bands, RMS in percent), of the first light."""
    found: dict[str, list[tuple[float, float]]] = {}
    for one in samples:
        if one["light"] == samples[0]["light"]:
            way = BRIEFLY[str(one["way"])]
            found.setdefault(f"{way}, {short_count(int(str(one['samples'])))}", []).append(
                (float(str(one["n_bands"])), 100 * float(str(one["rms"])))
            )
    return {name: points for name, points in found.items() if len(points) == len(BANDS)}
