"""How far below zero the picture in another program goes, and what each remedy makes of that and costs."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from shviewer.analysis.figures import error_grid, grid_rows, irradiance_error
from shviewer.analysis.projected import Projected
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.reconstruction import reconstruction_of
from shviewer.analysis.subjects import has_suns, subject, through
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.parts.quantities import whole
from shviewer.coefficients.programs import SHADED_WITH
from shviewer.errors import UsageError
from shviewer.harmonics.basis import Array
from shviewer.harmonics.deringing import MAX_DERINGED_BANDS
from shviewer.harmonics.extremes.error_grid import ErrorGrid
from shviewer.harmonics.quantities.names import IRRADIANCE, in_words, roughness_of
from shviewer.words import counted, percent

SEARCHED_TEXELS = 2**23
"""The most texels of an image that is searched for suns only to name them here: more take a second, and their memory again."""

ROUNDING = 1e-6
"""A minimum below zero by no more than this share of the largest coefficient counts as zero."""


OWN = 0.01
"""Where the light itself is negative: the share by which a minimum may be lower and still count as the light's own."""


class _Shown(NamedTuple):
    """What a program shows of a recipe."""

    minimum: float
    negative: bool
    """Whether it is below zero, and below the light itself, by more than rounding."""
    error: float
    """The relative L2 error."""


def below_zero(recipe: Recipe, convention: Convention) -> str:
    """One line on how far below zero what the convention's program shows is, and on the remedies; "" if no farther than the
    light itself.
    """
    shows = IRRADIANCE if convention.name in SHADED_WITH else whole(convention.quantity or recipe.quantity)
    shown = _shown(recipe, shows)
    if not shown.negative:
        return ""
    what = f"what {in_words(shows)} reflects" if roughness_of(shows) is not None else f"the {shows}"
    says = f"{what} of its {counted(recipe.n_bands, 'band')} goes to {shown.minimum:.3g}, {percent(shown.error)} off"
    remedies = []
    large = math.prod(subject(recipe).light.about.size or ()) > SEARCHED_TEXELS
    if not large and has_suns(recipe):
        remedies.append(("--split-sun", replace(recipe, split_sun=True)))
    if recipe.window != "dering" and recipe.n_bands <= MAX_DERINGED_BANDS:
        remedies.append(("--window dering", replace(recipe, window="dering", window_width=None)))
    for flag, changed in remedies:
        try:
            found = _shown(changed, shows)
        except UsageError:  # nothing to dering: its mean is not above zero
            continue
        if found.minimum > shown.minimum:
            rest = "the rest " if changed.split_sun != recipe.split_sun else ""
            to = f"to {found.minimum:.3g}" if found.negative else "not below 0"
            says += f"; with {flag} {to}, {rest}{percent(found.error)} off"
    return says + "; if it has a sun, --split-sun takes that out" * (large and not recipe.split_sun)


def encoded_below_zero(projected: Projected, recipe: Recipe) -> str:
    """The same line for an encoding of irradiance: for the minimum that its formula shows, or that of its bands."""
    assert projected.stored is not None
    stored, lowest = projected.stored, projected.lows.minimum
    if not stored.encoding.turns:
        lowest = float(stored.numbers.min())
    grid = error_grid(subject(recipe).light, grid_rows(projected.n_bands))
    if stored.encoding.formula == "geomerics" or not _below(lowest, grid, stored.numbers):
        return ""
    return (
        f"the irradiance that {stored.name} decodes to goes to {lowest:.3g}, {percent(projected.sums.relative_l2)} off; "
        "that of geomerics and l2-deringed does not"
    )


def _shown(recipe: Recipe, quantity: str) -> _Shown:
    """The recipe's numbers as a program shows them that makes `quantity` of them."""
    found = reconstruction_of(recipe)
    light, coefficients, error = found.subject.light, found.coefficients, found.sums.relative_l2
    if quantity != recipe.quantity:  # the irradiance of radiance
        error = irradiance_error(light, found.projection, recipe.shown)
        light = through(light, quantity)
        coefficients = light.from_source(coefficients)
    grid = error_grid(light, grid_rows(recipe.n_bands))
    minimum = grid.lows(coefficients).minimum
    return _Shown(minimum, _below(minimum, grid, coefficients), error)


def _below(minimum: float, grid: ErrorGrid, numbers: Array) -> bool:
    """Whether it is below zero, and below the light itself on its grid, by more than the rounding of numbers."""
    own = min(0.0, float(grid.original.min()))
    return minimum < (1 + OWN) * own - ROUNDING * float(np.abs(numbers).max())
