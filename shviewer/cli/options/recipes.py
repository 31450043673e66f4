"""The recipe that the options of a command line ask for."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from shviewer.analysis.options import options_of
from shviewer.analysis.recipe import OF_SAMPLES, Recipe, idle, what_it_needs, window_of
from shviewer.cli.options.inputs import reading_from
from shviewer.errors import UsageError
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE, in_words
from shviewer.words import one_line

if TYPE_CHECKING:
    from shviewer.lights.light import Light

START = Recipe()


def chosen_of(options: argparse.Namespace, holder: type) -> dict[str, Any]:
    """The given options that belong to a dataclass, by the names of its fields."""
    given = {name: vars(options).get(name) for name in options_of(holder)}
    chosen = {name: value for name, value in given.items() if value is not None}
    return {name: tuple(value) if isinstance(value, list) else value for name, value in chosen.items()}


def recipe_from(options: argparse.Namespace, light: str | Light, start: Recipe = START) -> tuple[Recipe, str]:
    """The recipe that the options ask for, with LIGHT, and a message about it or "".

    start: the recipe that the options change. UsageError for an option out of range, before the light is read if that does
    not depend on it. With --bands, a tolerance only says what is enough.
    """
    from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
    from shviewer.lights.find import split_light

    recipe = _asked(options, light, start)
    compared, said = vars(options).get("compare"), ""
    if compared:
        from shviewer.analysis.comparing.compared_files import compared_with

        recipe, found = compared_with(recipe, compared)
        if not vars(options).get("like") and not (vars(options).get("lights") or vars(options).get("light")):
            found = "; ".join(
                [
                    f"no LIGHT is named, so that {compared} is compared with {light}: name its own",
                    *filter(None, [found]),
                ]
            )
        if found:
            print(f"shviewer: {found}", file=sys.stderr)
    listed = isinstance(light, str) and split_light(light)[0].suffix.lower() in COEFFICIENT_SUFFIXES
    if compared or (listed and start is START):
        from shviewer.analysis.comparing.comparison import as_the_file_holds

        any_bands = options.n_bands is None and options.tolerance is None
        recipe, said = as_the_file_holds(recipe, quantity=options.quantity is None, bands=any_bands)
    fits = options.tolerance is not None and options.n_bands is None
    several = len(vars(options).get("lights") or ()) > 1
    called = light if isinstance(light, str) else light.name
    return (_fitted(recipe, called if several else "") if fits else recipe), said


def _asked(options: argparse.Namespace, light: str | Light, start: Recipe) -> Recipe:
    """The recipe as the options say, before the light is read. UsageError for one out of range."""
    chosen = chosen_of(options, Recipe)
    if "window" in chosen:
        chosen |= window_of(chosen["window"])
    recipe = replace(start, light=light, reading=reading_from(options, start.reading), **chosen)
    recipe.check()
    return recipe


def check_for_any_light(options: argparse.Namespace) -> None:
    """UsageError for an option that is wrong, or has no effect, whatever the light is: once, and before any is read."""
    recipe = _asked(options, START.light, START)
    if options.n_bands is None:  # how many there are depends on the light
        recipe = replace(recipe, muted=frozenset())
    check_effects(options, recipe)


def check_effects(options: argparse.Namespace, recipe: Recipe, beside: str = "off") -> None:
    """UsageError for an option without any effect on what is written. beside: the second reconstruction in a picture."""
    sampled = OF_SAMPLES if beside == "method" else ()
    given = [name for name in chosen_of(options, Recipe) if name not in sampled]
    for name in idle(recipe, given):
        flags = {row.name: row.flag for row in options_of(Recipe).values()}
        value = getattr(recipe, name)
        shown = ",".join(map(str, sorted(value))) if isinstance(value, frozenset) else value
        raise UsageError(f"{flags[name]} {shown}: {what_it_needs(name, recipe, flags)}")


def _fitted(recipe: Recipe, name: str) -> Recipe:
    """The recipe with as many bands as the tolerance needs, or if none are enough, the best count; stderr says which.

    name: what the light is called there; "" if there is only one.
    """
    from shviewer.analysis.figures import estimate_from_samples, needs

    found = needs(recipe)
    counts = {RADIANCE: found.radiance, IRRADIANCE: found.irradiance, in_words(recipe.quantity): found.shown}
    says = ", ".join(f"{what} {count or f'none up to {found.searched}'}" for what, count in counts.items())
    called = f"shviewer: {one_line(name)}: " if name else "shviewer: "
    print(f"{called}bands within {100 * found.tolerance:g} %: {says}", file=sys.stderr)
    if found.shown is None:
        print(f"{called}{found.best_words}", file=sys.stderr)
    if recipe.method == "jittered":
        guess = estimate_from_samples(recipe)
        if guess.decided:
            says = f"{guess.likely} bands" if guess.likely else "no count up to 32"
        else:
            says = f"nothing sure: {guess.fewest or 'more than 32'} to {guess.most or 'more than 32'} bands; take more samples"
        print(f"{called}the samples alone say {says}", file=sys.stderr)
    return replace(recipe, n_bands=found.shown or found.best_bands)
