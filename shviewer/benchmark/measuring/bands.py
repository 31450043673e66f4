"""The section on bands: how many each light needs, to be looked at and to shade with, and which roughness some serve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from shviewer.analysis.figures import errors_of
from shviewer.analysis.projections import way_of
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.roughness import ROUGHNESS, staircase
from shviewer.analysis.subjects import load_light, subject
from shviewer.benchmark.measuring.measured_lights import MOST_BANDS, TOLERANCES, MeasuredLight
from shviewer.harmonics.metrics import smallest_band_count
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE

BANDS_KEY, ROUGHNESS_KEY = "bands", "roughness"
"""The keys in the report's `extra`."""

QUANTITIES = (RADIANCE, IRRADIANCE)
LEAVE = (3, 9, MOST_BANDS)
"""Numbers of bands whose error is told, too."""


def bands_needed(recipe: Recipe) -> dict[str, Any]:
    """Radiance or irradiance -> the fewest bands within each of TOLERANCES, None if none are, and what some LEAVE."""
    found = {}
    for quantity in QUANTITIES:
        errors = errors_of(load_light(replace(recipe, quantity=quantity)), way_of(recipe))
        within = {f"{tolerance:g}": smallest_band_count(errors, tolerance) for tolerance in TOLERANCES}
        leaves = {str(n): float(errors[n - 1]) for n in LEAVE if n <= len(errors)}
        found[quantity] = {"within": within, "leaves": leaves}
    return found


def bands_extra(lights: Sequence[MeasuredLight]) -> dict[str, Any]:
    """Light -> what the whole of it needs, and what the rest needs without its suns; null if it has none."""
    found = {}
    for measured in lights:
        whole = Recipe(measured.light)
        split = replace(whole, split_sun=True)
        rest = bands_needed(split) if subject(split).suns else None
        found[measured.name] = {"whole": bands_needed(whole), "rest": rest}
    return found


def roughness_extra(lights: Sequence[MeasuredLight]) -> dict[str, Any]:
    """Light -> tolerance -> the staircase: the fewest bands for the light itself, for shading, and for each roughness."""
    steps = {
        one.name: {f"{tolerance:g}": _kept(Recipe(one.light, tolerance=tolerance)) for tolerance in TOLERANCES}
        for one in lights
    }
    return {"roughness": list(ROUGHNESS), "fewest_bands": steps}


def _kept(recipe: Recipe) -> dict[str, Any]:
    found = staircase(recipe)
    names = ("mirror", "shading", "searched", "counts")
    return {name: getattr(found, name) for name in names}
