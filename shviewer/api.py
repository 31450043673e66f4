"""The functions of `import shviewer`. A function with the name of a command does what the command does.

A light is what `find_light` takes: a text that the command line would take for LIGHT, a path, a function of directions, an
array, or a Light. `options` are those of the window, by their names in State; OPTIONS_HELP lists them.

They raise ShviewerError, with one line that says what to do, if an argument is out of range or a light is bad.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shviewer.analysis.options import options_of, taken, whole
from shviewer.analysis.recipe import OF_SAMPLES, Recipe, idle, what_it_needs, window_of
from shviewer.errors import UsageError, refused_as
from shviewer.harmonics import basis, synthesis
from shviewer.harmonics.basis import Array
from shviewer.harmonics.quantities.names import ENCODED_BANDS, IRRADIANCE
from shviewer.words import meant

if TYPE_CHECKING:  # each function imports what it needs: mathematics alone loads no light, and a projection no OpenGL
    from shviewer.analysis.information import Information
    from shviewer.analysis.projected import Projected
    from shviewer.benchmark.run import Summary
    from shviewer.lights.light import Light

LightLike: TypeAlias = "str | os.PathLike[str] | Light | Callable[[Any], ArrayLike] | NDArray[np.generic]"

_Function = TypeVar("_Function", bound=Callable[..., Any])


NAMED_ELSEWHERE = {"n_bands": "bands"}
"""Options that the functions take as an argument of another name, which is given."""


def with_options(*holders: type) -> Callable[[_Function], _Function]:
    """Decorator: list the options of these dataclasses, which the function takes, at the end of its docstring."""

    def decorate(function: _Function) -> _Function:
        table = options_of(*holders)
        here = {row.flag: NAMED_ELSEWHERE.get(row.name, row.name) for row in table.values() if row.flag}
        flag = re.compile("|".join(sorted(map(re.escape, here), key=len, reverse=True)))
        rows = [(row.name, flag.sub(lambda found: here[found[0]], row.help)) for row in table.values()]
        rows = [(name, words) for name, words in rows if name not in NAMED_ELSEWHERE]
        rows.append(("compare", "other coefficients in place of the light's own: a path, an array or a light of them"))
        lines = [f"        {name:<16}{words}" for name, words in rows]
        function.__doc__ = "\n".join([f"{function.__doc__}options:", *lines, ""])
        return function

    return decorate


def reconstruct(coefficients: ArrayLike, directions: ArrayLike) -> Array:
    """The radiance with coefficients (n**2, 3) of harmonics/basis.py in directions (..., 3) of any length: (..., 3) float64.

    ShviewerError if the rows are not n**2 of three numbers, or for a direction that is zero or not finite.
    """
    try:
        if hasattr(coefficients, "coefficients"):
            raise UsageError(f"{type(coefficients).__name__} holds more than numbers: give its .coefficients")
        if np.iscomplexobj(coefficients):
            raise UsageError(
                "complex coefficients: those of real functions are real; of a file, convention='scipy' has it read"
            )
        numbers = np.asarray(coefficients, dtype=np.float64)
        if numbers.ndim != 2 or numbers.shape[1] != 3:
            raise UsageError(f"coefficients of shape {numbers.shape}: they are (n**2, 3), rows of red, green and blue")
        return synthesis.reconstruct(numbers, directions)
    except (ValueError, TypeError) as error:
        raise UsageError(str(error)) from error


def evaluate_basis(directions: ArrayLike, n_bands: int) -> Array:
    """Every Y(l, m) of the first `n_bands` bands in directions (..., 3) of any length: (..., n_bands**2), float64.

    The convention is in harmonics/basis.py. ShviewerError for bad directions or too many bands.
    """
    try:
        return basis.evaluate_basis(directions, whole(n_bands, "n_bands"))
    except (ValueError, TypeError) as error:
        raise UsageError(str(error)) from error


def find_light(what: LightLike, *, convention: str = "", sanitize: bool = False, layout: str = "auto") -> Light:
    """Find or make the light that `what` names, describes or holds.

    A text or a path is read as on the command line. A function takes unit directions (k, 3) and returns radiance (k, 3), or
    (k,) for grey, linear RGB. An array (n**2, 3) holds coefficients in our convention, or in the one that is named, and then
    of any shape that a file may have; an array (height, width, 3) is a lat-long image of linear radiance with +z on top and
    +x in the middle.
    convention: that of coefficients that do not name one, such as "three". sanitize: repair bad values of an image.
    layout: how an image covers the sphere: "auto", "lat-long", "cube", "angular" or "mirror-ball".
    LightError if there is no such light or its file is bad, UsageError for what is no light and for an option out of range.
    """
    from shviewer.lights import find
    from shviewer.lights.function import FunctionLight
    from shviewer.lights.reading import DEFAULT_READING, Reading

    _check_reading(convention, layout)
    reading = Reading(sanitize=sanitize, layout=layout, convention=convention)
    if isinstance(what, str | os.PathLike):
        return find.find_light(os.fspath(what), reading)
    if isinstance(what, np.ndarray):
        from shviewer.lights.arrays import light_of_array

        return light_of_array(what, reading)
    if reading != DEFAULT_READING:
        given = {"convention": convention, "sanitize": sanitize, "layout": "" if layout == "auto" else layout}
        name = next(name for name, value in given.items() if value)
        raise UsageError(f"{name} {given[name]!r}: it is for files and arrays; leave it out")
    if hasattr(what, "integrand"):
        return cast("Light", what)
    if callable(what):
        return FunctionLight(what, getattr(what, "__name__", "function"))
    raise UsageError(f"a light of type {type(what).__name__}: give a name, a path, a function, an array or a Light")


def _check_reading(convention: str, layout: str) -> None:
    from shviewer.coefficients.texts import parse_convention
    from shviewer.lights.reading import LAYOUT_CHOICES

    if layout not in LAYOUT_CHOICES:
        raise UsageError(f"layout {layout!r}: {meant(str(layout), LAYOUT_CHOICES)}")
    with refused_as(UsageError):
        parse_convention(convention or "shviewer")


def recipe_of(light: LightLike, bands: int | None, options: dict[str, Any], *others: type) -> Recipe:
    """The recipe with these options; those of the dataclasses `others` are left out. UsageError for an unknown option."""
    from shviewer.analysis.comparing.comparison import as_the_file_holds

    table = options_of(Recipe, *others)
    known = [name for name in table if name not in NAMED_ELSEWHERE] + ["compare"]
    if unknown := sorted(set(options) - set(known)):
        name, flags = unknown[0], {row.flag: row.name for row in table.values()}
        here = NAMED_ELSEWHERE.get(name) or flags.get(f"--{name.replace('_', '-')}", "")
        raise UsageError(f"option {name!r}: {f'it is called {here} here' if here else meant(name, known)}")
    if isinstance(window := options.get("window"), str) and ":" in window:
        if options.get("window_width") is not None:
            raise UsageError(f"window {window!r} and window_width {options['window_width']!r}: give one width")
        options = options | window_of(window)
    count = None if bands is None else whole(bands, "bands")
    found = find_light(light)
    if count is None:
        count = found.about.n_bands or Recipe.n_bands
    recipe = Recipe(found, n_bands=count, **taken(options, Recipe))
    recipe.check()
    if (given := options.get("compare")) is not None:
        recipe = _comparing(recipe, given)
        any_bands = bands is None and "tolerance" not in options
        recipe, _ = as_the_file_holds(recipe, quantity="quantity" not in options, bands=any_bands)
    if bands is None and "tolerance" in options:
        recipe = _fitted(recipe)
    sampled = OF_SAMPLES if options.get("beside") == "method" else ()
    for name in idle(recipe, (name for name in options if name not in sampled)):
        missing = what_it_needs(name, recipe, {row: row for row in options_of(Recipe)})
        raise UsageError(f"{name} {options[name]!r}: {missing}")
    return recipe


def _fitted(recipe: Recipe) -> Recipe:
    """The recipe with as many bands as its tolerance needs, or with a warning, those that come nearest."""
    from shviewer.analysis.figures import needs

    found = needs(recipe)
    if found.shown is None:
        warnings.warn(
            f"no count up to {found.searched} is within {100 * found.tolerance:g} %: {found.best_words}", stacklevel=4
        )
    return replace(recipe, n_bands=found.shown or found.best_bands)


def _comparing(recipe: Recipe, given: LightLike) -> Recipe:
    from shviewer.analysis.comparing.compared_files import compared_with
    from shviewer.lights.coefficient_light import CoefficientLight

    if isinstance(given, str | os.PathLike):
        return compared_with(recipe, os.fspath(given), "compare=")[0]
    light = find_light(given)
    if not isinstance(light, CoefficientLight):
        raise UsageError(f"compare {light.name!r}: it must be coefficients, a file or an array (n**2, 3) of them")
    return replace(recipe, compare=light)


@with_options(Recipe)
def project(light: LightLike, bands: int | None = None, *, encode: str = "", **options: Any) -> Projected:
    """The first `bands` bands of a light, 1 to 128, with their error figures; by default 5, or all of a coefficient file.

    With `tolerance`, such as 0.05 or "5%", and no `bands` as many as keep the relative L2 error within it.
    encode: in place of bands what engines store of the irradiance, such as "zh3", with its formula where it is saved.

    `Projected.coefficients` is (bands**2, 3) float64 in the convention of harmonics/basis.py, row l(l+1) + m; `save` writes a
    file and `numbers` converts, both for other programs, too. ShviewerError for a mistake that a caller can put right;
    a warning where `split_sun` finds no sun.

    """
    from shviewer.analysis.projected import project_recipe
    from shviewer.analysis.subjects import subject

    if bands is not None and "tolerance" in options:
        raise UsageError(f"bands {bands} and tolerance {options['tolerance']}: give one of them")
    if encode:
        if encode not in ENCODED_BANDS:
            raise UsageError(f"encode {encode!r}: {meant(str(encode), ENCODED_BANDS)}")
        if bands is not None or "tolerance" in options:
            raise UsageError(f"encode {encode}: it takes the place of bands; leave out bands and tolerance")
        bands, options = ENCODED_BANDS[encode], {"quantity": IRRADIANCE} | options
    recipe = recipe_of(light, bands, options)
    found = project_recipe(recipe, encode)
    if refusal := subject(recipe).refusal:
        warnings.warn(refusal, stacklevel=2)
    return found


def info(light: LightLike, *, convention: str = "", sanitize: bool = False, layout: str = "auto") -> Information:
    """What `shviewer info --json` says of a light, as an object with the same names.

    convention, sanitize, layout: as in `find_light`. An image that is refused for its values is described as `sanitize`
    repairs it, with the reason in `refused`. LightError for any other bad light.
    """
    from shviewer.analysis.information import describe
    from shviewer.lights.reading import Reading

    if not isinstance(light, str | os.PathLike):
        return describe(find_light(light, convention=convention, sanitize=sanitize, layout=layout), Reading())
    _check_reading(convention, layout)
    return describe(os.fspath(light), Reading(sanitize=sanitize, layout=layout, convention=convention))


def report(
    of: LightLike | Iterable[LightLike] = (),
    folder: str | os.PathLike[str] = "shviewer-report",
    *,
    quick: bool = False,
    budget: float | None = None,
    force: bool = False,
) -> Summary:
    """Measure speed against error on this machine and write report.html, .md, .json, .csv and plots into `folder`.

    of: a light or several; none for the built-in choice. budget: seconds of measuring, 120 unless given; quick: 15 s in all.
    force: replace files there even if shviewer did not write them. Returns the names of the files, the number of rows measured
    and the sentences of advice. LightError for a bad light, OutputError if nothing can be written there.
    """
    from shviewer.benchmark.options import Options
    from shviewer.benchmark.run import write_report

    several = isinstance(of, Iterable) and not isinstance(of, str | os.PathLike | np.ndarray)
    given = cast(Iterable[LightLike], of) if several else [cast(LightLike, of)]
    chosen = [os.fspath(one) if isinstance(one, str | os.PathLike) else find_light(one) for one in given]
    wanted = Options(budget=budget, quick=quick, force=force, command="shviewer.report(...)")
    return write_report(chosen, Path(folder), wanted)
