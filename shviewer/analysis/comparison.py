"""Given coefficients: shown as their file holds them, or compared with the light that they should belong to."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from shviewer.analysis.cache import remember
from shviewer.analysis.projections import BEST, project
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import subject
from shviewer.coefficients.finding import FITS
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.coefficients.suspects import usual_suspects
from shviewer.errors import LightError
from shviewer.harmonics.basis import Array, count_bands
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.light import Light
from shviewer.limits import MAX_BANDS
from shviewer.words import brief_percent

BAD = FITS
"""Given coefficients that are off by more than this share of the light's own, in the same bands, are examined."""

FAINT = 1e-3
"""The error of a band is divided by no less than this share of the strongest band."""

LONGEST_NAME = 28
"""The most characters of a name in a caption."""

EXACT = 1e-6
"""Numbers that are off by less are the same, printed with six digits."""

EXPLAINED = 0.25
"""A suspected mistake is named if the error without it is at most this, and at most this share of the error with it."""


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


@remember(most=4, doing="comparing conventions")
def verdict(light: Light, given: CoefficientLight) -> str:
    """One line on given coefficients: how well they agree with the light's own, or which usual mistake explains that not."""
    exact = project(light, *BEST, given.n_bands).coefficients
    shown = project(light, given, 0, 0, given.n_bands).coefficients
    norm, off = float(np.linalg.norm(exact)), float(np.linalg.norm(exact - shown))
    if off <= BAD * norm:
        over = f"its {given.n_bands} bands" if given.n_bands > 1 else "its one band"
        error = brief_percent(max(off / norm if norm else 0.0, EXACT))
        return f"{given.name} agrees with the light's own to {error} over {over}"
    says = f"{given.name} is {brief_percent(off / norm) if norm else 'wholly'} off"
    if not shown.any():
        return f"{says}: its numbers are all zero"
    best = usual_suspects(exact, shown, _readings(light, given))[0]
    if not best.changes or best.error > EXPLAINED * min(1.0, off / norm if norm else 0.0):
        return f"{says}, which no usual mistake explains{_where(exact, shown)}"
    left = "not at all" if best.error < EXACT else brief_percent(best.error)
    return f"{says}, but {left} if its numbers are {best.words}"


def agrees(said: str) -> bool:
    """Whether a verdict says that the coefficients agree."""
    return " agrees with the light's own " in said


def _where(exact: Array, shown: Array) -> str:
    """The bands that disagree, measured by the same bands of the light's own; "" if it has only one band, or is black."""
    starts = np.arange(count_bands(exact)) ** 2
    own = np.sqrt(np.add.reduceat((exact**2).sum(axis=1), starts))
    off = np.sqrt(np.add.reduceat(((exact - shown) ** 2).sum(axis=1), starts))
    if len(own) == 1 or not own.any():
        return ""
    share = off / np.maximum(own, FAINT * own.max())
    worst = int(share.argmax())
    bad = np.flatnonzero(share > BAD)
    others = "the others fit" if len(bad) == 1 else "most of all" if len(bad) == len(own) else _bad_bands(bad, worst)
    return f": band {worst} is {brief_percent(share[worst])} off, {others}"


def _bad_bands(bad: NDArray[np.int64], worst: int) -> str:
    others = [str(band) for band in bad if band != worst]
    return f"{', '.join(others[:6])}{' and more' if len(others) > 6 else ''} less, the others fit"


def _readings(light: Light, given: CoefficientLight) -> dict[tuple[str, ...], Array]:
    """Words for other conventions and layouts -> the coefficients, of the quantity shown, if the numbers were meant so."""
    numbers = given.given if given.file is None else given.file.numbers
    own = OURS if given.file is None else replace(given.file.convention, quantity=None)
    layouts: dict[tuple[str, ...], NDArray[np.generic]] = {(): numbers}
    if given.n_bands > 1:
        layouts[("listed channel by channel",)] = numbers.reshape(3, -1).T
        layouts[("listed row by row",)] = numbers.T.reshape(-1, 3)
    found: dict[tuple[str, ...], Array] = {}
    for convention in CONVENTIONS.values() if given.file else (OURS,):
        if (convention.most_bands or MAX_BANDS) < given.n_bands or np.iscomplexobj(numbers) != convention.complex:
            continue
        same = replace(convention, quantity=None) == own
        if same and given.file:
            convention = given.file.convention
        for layout, table in layouts.items():
            if same and not layout:
                continue
            words = (*layout, *(() if same else (f"in the convention of {convention.name}",)))
            with suppress(ValueError, LightError):  # complex numbers of no real function, or more than can be shown
                radiance = CoefficientLight.of_numbers(table, convention).given
                found[words] = light.from_source(radiance)
    return found
