"""Given coefficients: shown as their file holds them, or compared with the light that they should belong to."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from shviewer.analysis.cache import remember
from shviewer.analysis.comparing.stored import verdict_on_stored
from shviewer.analysis.comparing.suspecting import FITS, held_as, suspect
from shviewer.analysis.projections import BEST, project
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import load_light, subject
from shviewer.coefficients.diagnosis.search import EXPLAINED
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.programs import OURS
from shviewer.errors import LightError
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.quantities.encodings import BANDS
from shviewer.harmonics.quantities.names import RADIANCE
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.light import Light
from shviewer.lights.mistaken import mistaken
from shviewer.limits import MAX_BANDS, MAX_DIRECT_BANDS
from shviewer.words import all_of, brief_percent

FAINT = 1e-3
"""The error of a band is divided by no less than this share of the strongest band."""

LONGEST_NAME = 28
"""The most characters of a name in a caption."""

EXACT = 1e-6
"""A relative error below which numbers are the same, printed with six digits."""

ALL, MOST = 0.05, 0.5
"""A factor is all, or most, of an error, of which at most this share is left without it."""


def as_the_file_holds(recipe: Recipe, *, quantity: bool, bands: bool) -> tuple[Recipe, str]:
    """The recipe with the quantity and the bands of the coefficient file that it compares with or shows, and a message.

    quantity, bands: whether to follow the file. A compared file's bands are all that is shown; the message says if fewer.
    LightError if the light is bad.
    """
    compared, said = recipe.compare, ""
    held = (compared or subject(replace(recipe, quantity="radiance", split_sun=False)).whole).about
    if held.n_bands is None or held.quantity is None:
        return recipe, said
    if bands:
        recipe = replace(recipe, n_bands=min(held.n_bands, MAX_BANDS))
    elif compared and recipe.n_bands > held.n_bands:
        recipe, said = replace(recipe, n_bands=held.n_bands), compared.extent
    return replace(recipe, quantity=held.quantity) if quantity else recipe, said


def caption(recipe: Recipe) -> str:
    """The name of the coefficients shown, to stand before their number; "" for the light's own."""
    if recipe.compare is None:
        return ""
    name = recipe.compare.name
    return f"{name if len(name) <= LONGEST_NAME else f'{name[:11]}...{name[-14:]}'}: "


def verdict_of(recipe: Recipe) -> str:
    """The verdict on the coefficients that the recipe compares with; "" if with none. LightError if the light is bad."""
    return verdict(load_light(replace(recipe, quantity=RADIANCE)), recipe.compare) if recipe.compare else ""


@remember(most=4, doing="comparing conventions")
def verdict(light: Light, given: CoefficientLight) -> str:
    """One line on given coefficients of the radiance of a light: how well they agree with its own, or what explains that not.

    Both are compared as what the file holds, radiance or irradiance, whatever is shown.
    """
    if given.file is not None and given.stored is not None:
        return verdict_on_stored(
            project(light, BEST, MAX_DIRECT_BANDS).coefficients, given.file, given.name, partial(mistaken, light, BANDS)
        )
    exact = project(light, BEST, given.n_bands).coefficients
    wanted, held = held_as(exact, given.quantity), _numbers(given)
    norm, off = float(np.linalg.norm(wanted)), float(np.linalg.norm(wanted - held))
    if off <= FITS * norm:
        over = f"its {given.n_bands} bands" if given.n_bands > 1 else "its one band"
        error = brief_percent(max(off / norm if norm else 0.0, EXACT))
        return f"{given.name} agrees with the light's own to {error} over {over}{_factor(wanted, held)}"
    says = f"{given.name} is {brief_percent(off / norm) if norm else 'wholly'} off"
    if not held.any():
        return f"{says}: its numbers are all zero"
    file = given.file
    listed, named = (file.listed, file.convention) if file and file.listed else (Listed(given.given), OURS)
    try:
        found = suspect(listed, exact, named, partial(mistaken, light, given.n_bands))
    except LightError:  # of numbers that are no table
        found = None
    if found is None or found.error > EXPLAINED * min(1.0, off / norm if norm else np.inf):
        return f"{says}, which no usual mistake explains{_where(wanted, held)}"
    left = "not at all" if found.error < EXACT else brief_percent(found.error)
    paste = f": --convention {found.text}" if file and found.differs(named) else ""
    return f"{says}, but {left} if {found.conditions(named)}{paste}"


def agrees(said: str) -> bool:
    """Whether a verdict says that the coefficients agree."""
    return " agrees with the light's own " in said


def _numbers(given: CoefficientLight) -> Array:
    return given.given if given.file is None else given.file.coefficients


def _factor(wanted: Array, held: Array) -> str:
    """Words for the factor that is all or most of a small error; "" if none is."""
    norm, off = float((wanted**2).sum()), float(np.linalg.norm(wanted - held))
    factor = float((wanted * held).sum()) / norm if norm else 1.0
    left = float(np.linalg.norm(factor * wanted - held))
    if off <= 10 * EXACT * np.sqrt(norm) or left > MOST * off:
        return ""
    return f", {'all' if left <= ALL * off else 'most'} of it a factor of {factor:.5g}"


def _where(exact: Array, shown: Array) -> str:
    """The bands that disagree, measured by the same bands of the light's own; "" if it has only one band, or is black."""
    starts = np.arange(count_bands(exact)) ** 2
    own = np.sqrt(np.add.reduceat((exact**2).sum(axis=1), starts))
    off = np.sqrt(np.add.reduceat(((exact - shown) ** 2).sum(axis=1), starts))
    if len(own) == 1 or not own.any():
        return ""
    share = off / np.maximum(own, FAINT * own.max())
    worst = int(share.argmax())
    bad = np.flatnonzero(share > FITS)
    others = "most of all" if len(bad) == len(own) > 1 else f"{_bad_bands(bad, worst)}the others fit"
    return f": band {worst} is {brief_percent(share[worst])} off, {others}"


def _bad_bands(bad: NDArray[np.int64], worst: int) -> str:
    others = [str(band) for band in bad if band != worst]
    named = all_of([*others[:6], *(["more"] if len(others) > 6 else [])])
    return f"band{'s' if len(others) > 1 else ''} {named} by less, " if others else ""
