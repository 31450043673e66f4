"""--compare FILE: coefficients to be compared with the light's own."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import ceil, sqrt
from pathlib import Path

from shviewer.analysis.comparing.recognised import Recognised, recognise
from shviewer.analysis.projections import BEST, project
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import load_light
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.reading import interpreted, read_numbers
from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
from shviewer.errors import LightError
from shviewer.files import naming, version_of
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import built_in_lights, read_from
from shviewer.lights.images.radiance_files import IMAGE_SUFFIXES
from shviewer.lights.mistaken import mistaken
from shviewer.limits import MAX_BANDS
from shviewer.words import one_line


def compared_with(recipe: Recipe, text: str, option: str = "--compare") -> tuple[Recipe, str]:
    """The recipe with the coefficients in the file `text` to compare, and a line on what was assumed and found out, or "".

    A bare list without a named convention is read in the convention that fits the recipe's light, or else the nearest.
    LightError if the file is bad or no coefficient file. option: the name of the option in messages.
    """
    file = Path(text)
    if file.suffix.lower() not in COEFFICIENT_SUFFIXES:
        raise LightError(
            f"{text} is {_kind(text)}; {option} takes coefficients ({', '.join(COEFFICIENT_SUFFIXES)}): shviewer project "
            "makes them of a light"
        )
    version = version_of(file)
    with naming(text):
        listed = read_numbers(file, recipe.reading.limits)
        if listed.stamp or listed.implied or recipe.reading.convention:
            read, found = interpreted(listed, recipe.reading.convention, overrule=True), None
        else:
            found = _recognised(recipe, listed)
            read = found.file
    name = one_line(file.name)
    light = read_from(CoefficientLight.of_file(read, name), file, version)
    said = [] if found and found.fits else [f"{name}: {note}" for note in read.notes]  # what fits was guessed rightly
    found_out = [f"{name} does not name its convention: {found.said}"] if found else []
    return replace(recipe, compare=light), "; ".join([*said, *found_out])


def _recognised(recipe: Recipe, listed: Listed) -> Recognised:
    """The convention in which the numbers fit the radiance of the light that is projected."""
    light = load_light(replace(recipe, quantity="radiance"))
    most = min(MAX_BANDS, max(1, ceil(sqrt(listed.numbers.size))))  # the bands of a grey list; others have fewer
    return recognise(listed, project(light, BEST, most).coefficients, partial(mistaken, light, most))


def _kind(text: str) -> str:
    if text in built_in_lights():
        return "a built-in light"
    if Path(text).suffix.lower() in IMAGE_SUFFIXES:
        return "an image"
    return "a scene" if Path(text).suffix.lower() == ".toml" else "no coefficient file"
