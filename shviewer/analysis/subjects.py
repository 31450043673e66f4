"""The light that a recipe shows, the part of it that is projected, and its file. A light named by text is read once."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, replace
from pathlib import Path

from shviewer.analysis.cache import MEMORY, remember
from shviewer.analysis.recipe import Recipe
from shviewer.errors import LightError
from shviewer.files import FileVersion
from shviewer.harmonics.quantities.names import RADIANCE
from shviewer.lights.find import built_in_lights, file_version, find_light
from shviewer.lights.light import Light, Split
from shviewer.lights.suns.sun import Sun
from shviewer.progress import tell


@dataclass(frozen=True, eq=False)
class Subject:
    """The light shown as the original (`whole`) and the one projected (`light`): the same, unless suns are split off."""

    whole: Light
    light: Light
    """The light that is projected and that the figures are computed for."""
    suns: tuple[Sun, ...] = ()
    refusal: str = ""
    """Why nothing was split off although it was asked for."""


def subject(recipe: Recipe) -> Subject:
    """The subject of a recipe: the quantity of its light that the recipe names."""
    light = read_once(recipe)
    found = Subject(light, light)
    if recipe.split_sun:
        split = _split(light, recipe.suns)
        found = replace(found, refusal=split) if isinstance(split, str) else Subject(light, split.rest, split.suns)
    if recipe.quantity == RADIANCE:
        return found
    whole, projected = (through(part, recipe.quantity) for part in (found.whole, found.light))
    return replace(found, whole=whole, light=projected)


def has_suns(recipe: Recipe) -> bool:
    """Whether suns can be taken out of the light, which are not; of a large image it takes a look at every texel."""
    return not recipe.split_sun and bool(subject(replace(recipe, quantity=RADIANCE, split_sun=True)).suns)


def load_light(recipe: Recipe) -> Light:
    """The light that is projected."""
    return subject(recipe).light


def read_once(recipe: Recipe) -> Light:
    """The light that the recipe names, read if it was not yet. LightError if it cannot be."""
    return recipe.light if not isinstance(recipe.light, str) else MEMORY.named(_name(recipe)) or read_again(recipe)


def read_again(recipe: Recipe) -> Light:
    """The light that the recipe names, read anew. After a LightError the light read before stays.

    A light that is not named by a text is returned unchanged.
    """
    if not isinstance(recipe.light, str):
        return recipe.light
    read = file_version(recipe.light)  # asked first: a change during the reading is a later version
    tell(f"reading {Path(recipe.light).name}")
    safe = recipe.light in built_in_lights()
    light = find_light(recipe.light, replace(recipe.reading, isolated=False) if safe else recipe.reading)
    MEMORY.name(_name(recipe), light)
    MEMORY.results(light, file_version)[None] = read
    return light


def keep_light(recipe: Recipe, light: Light) -> None:
    """Let the recipe's text go on meaning `light`, whatever its file holds by now."""
    if isinstance(recipe.light, str):
        MEMORY.name(_name(recipe), light)


def version_read(recipe: Recipe) -> FileVersion | None:
    """The version that the file of the recipe's light had when it was read; None if that is not known."""
    light = MEMORY.named(_name(recipe))
    found: FileVersion | None = MEMORY.results(light, file_version).get(None) if light is not None else None
    return found


def _name(recipe: Recipe) -> Hashable:
    return recipe.light, recipe.reading


@remember(most=1, doing="looking for suns")
def _split(light: Light, wanted: int | str) -> Split | str:
    """The light and its suns apart, or the reason why nothing can be split off."""
    try:
        split = light.split_suns(wanted)
    except LightError as error:
        return str(error)
    MEMORY.belongs(split.rest, light)
    return split


@remember(most=24, doing="convolving the light")
def through(light: Light, quantity: str) -> Light:
    """Another quantity of a light, remembered with it; itself, if it is that."""
    return light.through(quantity)
