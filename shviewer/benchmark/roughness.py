"""The section of the report on roughness: what a number of bands serves, for every light."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from shviewer.analysis.recipe import Recipe
from shviewer.analysis.roughness import ROUGHNESS, TOLD_BANDS, Staircase, staircase
from shviewer.benchmark.measured_lights import TOLERANCES, MeasuredLight
from shviewer.benchmark.page.tables import bullet, table

TITLE = "What a number of bands serves"
KEY = "roughness"
"""The key in the report's `extra`: light -> tolerance -> the fewest bands for each roughness."""

EXPLAINED = """\
A surface reflects the light filtered by its own kernel (GGX, seen along its normal), which multiplies band l by a factor that
falls the sooner the rougher it is. So few bands serve rough surfaces and many a mirror: the fewest within a tolerance, against
roughness 0.1 to 1 (where it is shading). Next to 1 the counts may rise again, since a kernel's factor of band 4 is negative at
1 and zero on the way."""


def staircases(lights: Sequence[MeasuredLight]) -> dict[str, dict[float, Staircase]]:
    """The staircases of each light for each of TOLERANCES."""
    return {
        measured.name: {tolerance: staircase(Recipe(measured.light, tolerance=tolerance)) for tolerance in TOLERANCES}
        for measured in lights
    }


def as_extra(found: dict[str, dict[float, Staircase]]) -> dict[str, Any]:
    """The numbers, as JSON."""
    counts = {
        name: {f"{tolerance:g}": list(steps.counts) for tolerance, steps in steps_of.items()}
        for name, steps_of in found.items()
    }
    return {"roughness": list(ROUGHNESS), "fewest_bands": counts}


def as_markdown(found: dict[str, dict[float, Staircase]]) -> str:
    lines = [EXPLAINED, ""]
    for name, steps_of in found.items():
        steps = steps_of[0.05]
        lines.append(bullet(f"{name}: {steps.sentence(3)}, 9 serve {steps.words(9)}, 16 serve {steps.words(16)}."))
    tolerances = [f"within {100 * tolerance:g} %" for tolerance in TOLERANCES]
    rows = [
        (name, str(bands), *(steps.words(bands).removeprefix("roughness ") for steps in steps_of.values()))
        for name, steps_of in found.items()
        for bands in TOLD_BANDS
    ]
    return "\n".join([*lines, "", *table(("light", "bands", *tolerances), rows, left=5)])
