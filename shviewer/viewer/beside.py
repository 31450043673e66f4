"""A second reconstruction beside the first: what the same bands give without one of the choices that were made."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from shviewer.analysis.recipe import Recipe
from shviewer.analysis.reconstruction import Reconstruction, values_at
from shviewer.harmonics.basis import Array
from shviewer.viewer.drawn import Drawn
from shviewer.viewer.view import BESIDES
from shviewer.words import grouped


class Beside(NamedTuple):
    """The second reconstruction of a picture, and how it is drawn."""

    found: Reconstruction
    drawn: Drawn

    def values_at(self, directions: Array) -> Array:
        """Its radiance, without suns, in unit directions of the light (k, 3): (k, 3) float64."""
        return values_at(directions, self.found.coefficients, self.found.stored)


def recipe_beside(recipe: Recipe, beside: str) -> Recipe:
    """The recipe without a choice: "no-window", the other "method", or the light's "own" coefficients.

    It is the same recipe where that choice was not made.
    """
    if beside == "no-window":
        return replace(recipe, window="none", window_width=None)
    if beside == "own":
        return replace(recipe, compare=None)
    if recipe.compare is not None:
        return recipe
    return replace(recipe, method="jittered" if recipe.method == "best" else "best")


def besides_of(recipe: Recipe) -> Iterator[str]:
    """What can be shown beside the reconstruction of a recipe."""
    for beside in BESIDES[1:]:
        if recipe_beside(recipe, beside) != recipe:
            yield beside


def words_of(beside: str, second: Recipe) -> str:
    """What the second reconstruction is, as a caption."""
    if beside == "no-window":
        return "Without the window"
    if beside == "own":
        return "The light's own"
    return "Best method" if second.method == "best" else f"Jittered, {grouped(second.samples)} samples"
