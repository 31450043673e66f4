"""The reconstruction of a recipe: coefficients and figures, made by one call for all that write, print or draw them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from shviewer.analysis.figures import Figures, Sums, error_grid, figures_of, grid_rows, sums
from shviewer.analysis.projections import BEST, Projection, encoded, project, turned_exactly, way_of
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import Subject, subject
from shviewer.harmonics.basis import Array, count_bands, evaluate_basis
from shviewer.limits import check_radiance

if TYPE_CHECKING:
    from shviewer.harmonics.quantities.encodings import Stored


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """The coefficients (n_bands**2, 3) of a light as they are shown: muted bands are zero and the window is applied."""

    recipe: Recipe
    subject: Subject
    """The light, the part of it that is projected, and the suns that were split off."""
    projection: Projection
    coefficients: Array
    sums: Sums
    """The figures that need no search."""

    @property
    def stored(self) -> Stored | None:
        """The numbers of the encoding that is shown; None where the coefficients are summed."""
        return self.projection.stored_as(self.sums.factors)

    @cached_property
    def figures(self) -> Figures:
        """All figures; searched for when they are asked for."""
        return figures_of(self.subject.light, self.projection, self.recipe.shown)


def values_at(directions: Array, coefficients: Array, stored: Stored | None) -> Array:
    """The radiance of what is shown in unit directions of the light (k, 3): (k, 3) float64."""
    if stored is not None:
        return stored.irradiance(directions)
    return np.asarray(evaluate_basis(directions, count_bands(coefficients)) @ coefficients)


def reconstruction_of(
    recipe: Recipe, ahead: int = 0, encoding: str = "", turn: tuple[float, ...] | None = None
) -> Reconstruction:
    """Make the reconstruction. LightError for a light that cannot be read or shown, UsageError for a recipe out of range.

    encoding: one of ENCODINGS, through which an irradiance goes; turn: as in `encoded`.
    ahead: the number of bands that will be asked for later: an image, which keeps its coefficients, is projected only once.
    """
    recipe.check()
    found = subject(recipe)
    if ahead > recipe.projected_bands and found.light.about.size is not None:
        project(found.light, BEST, ahead)
    way = way_of(recipe)
    if recipe.turn is not None and way == BEST:
        projection = turned_exactly(found.light, recipe.turn, recipe.projected_bands)
    else:
        projection = project(found.light, way, recipe.projected_bands)
    if encoding:
        projection = encoded(found.light, projection, encoding, turn)
    named = recipe.light if isinstance(recipe.light, str) else found.light.name
    check_radiance(error_grid(found.whole, grid_rows(1)).peak, named)
    return Reconstruction(recipe, found, projection, *sums(found.light, projection, recipe.shown))
