"""The first answer of the page, how many bands each light needs; and what a number of bands serves."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from shviewer.analysis.roughness import TOLD_BANDS, Staircase
from shviewer.benchmark.measuring.bands import BANDS_KEY, LEAVE, QUANTITIES, ROUGHNESS_KEY
from shviewer.benchmark.measuring.measured_lights import MOST_BANDS
from shviewer.benchmark.page.advice import known
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.tables import ABSENT, MOST_COLUMNS, bullet, error, table
from shviewer.words import all_of, counted

BANDS_STEM, ROUGHNESS_STEM = "error-bands", "roughness-bands"
"""The file stems of the plots in the two sections."""

ASKED = "0.05"
"""The tolerance of the answer in one sentence."""

NEEDED = """\
The fewest bands with which a light is *seen* within a tolerance, and with which it *shades* within it. Seen: the radiance
is compared with the light's own, ||light - its first n bands|| / ||light|| over the sphere. Shades: the irradiance is
compared with the light's own irradiance, likewise over all normals. n bands are n^2 coefficients a channel. *Sun apart*:
its suns are drawn as lights of their own (`--split-sun`), and what is left of the light is compared with what is left of
it. All exact."""

SERVES = """\
A surface reflects the light filtered by its own kernel (GGX, seen along its normal), which multiplies band l by a factor
that falls the sooner the rougher it is. So few bands serve rough surfaces and many a mirror. What the bands make is
compared with what the surface makes of the whole light, relative L2 over all normals: the fewest bands within a tolerance,
against roughness 0.1 to 1. Next to 1 the counts may rise again, since a kernel's factor of band 4 is negative at 1 and zero
on the way."""


def needed_lines(page: Page) -> list[str]:
    """The answer, the table and the plot."""
    found = page.report.extra.get(BANDS_KEY)
    if not found:
        return []
    leave = "*3 leave* and its neighbours: the error of the light as seen, with so many bands."
    picture = page.picture(BANDS_STEM, "Relative L2 error of the first 1, 2, 3, ... bands of each light")
    answer = textwrap.fill(f"**{_answer(found)}**", MOST_COLUMNS, break_on_hyphens=False)
    return [answer, "", NEEDED, "", *needed_table(found), "", leave, "", *picture]


def needed_table(found: Mapping[str, Any]) -> list[str]:
    """A row per light, and one more for what is left of it without its suns. found: the report's `extra` on bands."""
    tolerances = list(next(iter(found.values()))["whole"][QUANTITIES[0]]["within"])
    within = [
        f"{seen} within {100 * float(tolerance):g} %" if number == 0 else f"{100 * float(tolerance):g} %"
        for seen in ("seen", "shades")
        for number, tolerance in enumerate(tolerances)
    ]
    leave = [f"{n} leave" for n in LEAVE]
    rows = [_needed_row(name, needs) for name, needs in _with_and_without_suns(found)]
    return table(("light", *within, *leave), rows)


def _answer(found: Mapping[str, Any]) -> str:
    """The counts for ASKED in one sentence."""
    seen, shades = (
        {name: needs["whole"][what]["within"][ASKED] for name, needs in found.items()} for what in QUANTITIES
    )
    lights = "all of these lights" if len(found) > 1 else next(iter(found))
    most = max(known(count, math.inf) for count in shades.values())
    shading = (
        f"{counted(int(most), 'band')} shade"
        if most < math.inf
        else f"more than {MOST_BANDS} bands are needed to shade"
    )
    counts: dict[str, list[str]] = {}
    for name, count in sorted(seen.items(), key=lambda light: known(light[1], math.inf)):
        counts.setdefault(f"more than {MOST_BANDS}" if count is None else str(count), []).append(name)
    parts = [f"{count} for {all_of(names)}" for count, names in counts.items()]
    return f"Within {100 * float(ASKED):g} %: {shading} with {lights}; to be seen it takes {all_of(parts)}."


def _with_and_without_suns(found: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    for name, needs in found.items():
        yield name, needs["whole"]
        if needs["rest"] is not None:
            yield f"{name}, sun apart", needs["rest"]


def _needed_row(name: str, needs: Mapping[str, Any]) -> list[str]:
    counts = [count for quantity in QUANTITIES for count in needs[quantity]["within"].values()]
    left = [needs[QUANTITIES[0]]["leaves"].get(str(n)) for n in LEAVE]
    return [name, *(f"> {MOST_BANDS}" if count is None else str(count) for count in counts), *map(error, left)]


def staircases_of(found: Mapping[str, Any]) -> dict[str, dict[float, Staircase]]:
    """The staircases of each light and tolerance, from a report's `extra`."""
    return {
        name: {
            float(tolerance): Staircase(float(tolerance), **(steps | {"counts": tuple(steps["counts"])}))
            for tolerance, steps in steps_of.items()
        }
        for name, steps_of in found["fewest_bands"].items()
    }


def serves_lines(page: Page) -> list[str]:
    """A sentence per light, the plot, and a table of light, bands and tolerances."""
    found = page.report.extra.get(ROUGHNESS_KEY)
    if not found:
        return []
    steps_of = staircases_of(found)
    picture = page.picture(ROUGHNESS_STEM, "Fewest bands within 5 % against roughness, for each light")
    return [SERVES, "", *map(_served, steps_of, steps_of.values()), "", *picture, *_serves_table(steps_of)]


def _served(name: str, steps_of: Mapping[float, Staircase]) -> str:
    steps = steps_of[0.05]
    return bullet(f"{name}: {steps.sentence(3)}, 9 serve {steps.words(9)}, 16 serve {steps.words(16)}.")


def _serves_table(found: Mapping[str, Mapping[float, Staircase]]) -> Sequence[str]:
    tolerances = [f"roughness within {100 * tolerance:g} %" for tolerance in next(iter(found.values()), {})]
    rows = [
        (name, str(bands), *(steps.words(bands).removeprefix("roughness ") for steps in steps_of.values()))
        for name, steps_of in found.items()
        for bands in TOLD_BANDS
    ]
    return table(("light", "bands", *tolerances), rows, left=2 + len(tolerances)) if rows else [ABSENT]
