"""The origin and the errors of written coefficients: the keys of the stamp that follow from the recipe."""

from __future__ import annotations

import numpy as np

from shviewer.analysis.figures import Sums
from shviewer.analysis.projections import Projection
from shviewer.analysis.recipe import Recipe, light_name
from shviewer.analysis.subjects import Subject
from shviewer.coefficients.stamp import Value
from shviewer.harmonics.extremes.error_grid import Lows
from shviewer.words import counted

ERRORS = (
    "relative-l2",
    "left-out",
    "added",
    "minimum",
    "minimum-bound",
    "negative-area",
    "irradiance-relative-l2",
)
"""Keys of the stamp that hold error figures."""


def origin_of(
    recipe: Recipe, shown: Subject, projection: Projection, sums: Sums, lows: Lows, shading: float
) -> dict[str, Value]:
    """The keys and their values. shading: the error of the irradiance."""
    about: dict[str, Value] = {
        **_light(recipe, shown),
        "window": _window(recipe),
        "muted": " ".join(map(str, recipe.muted_shown)) or "none",
        "method": projection.method,
        "samples": projection.evaluations,
        "seed": recipe.seed if recipe.method == "jittered" else None,
        **_errors(sums, lows, shading),
    }
    return {key: value for key, value in about.items() if value is not None and value != ""}


def _light(recipe: Recipe, shown: Subject) -> dict[str, Value]:
    light, suns = shown.light, shown.suns
    without = f"; {counted(len(suns), 'sun')} left out" if suns else ""
    return {
        "light": _one_line(light_name(recipe.light)),
        "light-is": _one_line(light.description + without),
        "light-notes": _one_line("; ".join(light.notes)),
    }


def _window(recipe: Recipe) -> str:
    if recipe.window in ("none", "dering"):
        return recipe.window
    return f"{recipe.window} of {recipe.window_width or recipe.n_bands:g} bands"


def _errors(sums: Sums, lows: Lows, shading: float) -> dict[str, Value]:
    """The figures of the stamp. shading: the error of the irradiance."""
    whole = sums.channels["all"]
    values = (
        whole.relative_l2,
        whole.left_out,
        whole.added,
        lows.minimum,
        lows.minimum_bound,
        lows.negative_area,
        shading,
    )
    found = zip(ERRORS, values, strict=True)
    return {key: float(value) for key, value in found if np.isfinite(value)}


def _one_line(text: str) -> str:
    """A text made fit for a comment: without line breaks and `*/`, which could end it."""
    printable = "".join(character if character.isprintable() else " " for character in text)
    return " ".join(printable.replace("*/", "* /").split()).rstrip("\\ ")  # a backslash would continue the comment
