"""The options of a command line made into a reading, a recipe and a state."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from shviewer.analysis.options import options_of
from shviewer.analysis.recipe import Recipe
from shviewer.cli.option_groups import finite
from shviewer.errors import UsageError
from shviewer.harmonics.quantities.names import ENCODED_BANDS, IRRADIANCE, RADIANCE, in_words
from shviewer.outputs import Replacing
from shviewer.words import one_line

if TYPE_CHECKING:
    from shviewer.lights.light import Light
    from shviewer.lights.reading import Reading
    from shviewer.viewer.saving.restoring import Restored
    from shviewer.viewer.state import State
    from shviewer.viewer.view import View

DEFAULT_SIZE = (1280, 640)

BESIDE_NEEDS = {
    "no-window": "there is no window to do without; give --window, too",
    "method": "coefficients that are compared are no method's; leave out --compare",
    "own": "the light's own coefficients are shown already; give --compare, too",
}
"""What must be given for a second reconstruction to differ from the first."""


def chosen_of(options: argparse.Namespace, holder: type) -> dict[str, Any]:
    """The given options that belong to a dataclass, by the names of its fields."""
    given = vars(options)
    chosen = _given({name: given.get(name) for name in options_of(holder)})
    return {name: tuple(value) if isinstance(value, list) else value for name, value in chosen.items()}


START = Recipe()


def recipe_from(options: argparse.Namespace, light: str | Light, start: Recipe = START) -> tuple[Recipe, str]:
    """The recipe that the options ask for, with LIGHT, and a message about it or "".

    start: what the options come on top of. UsageError for an option out of range, before the light is read if that does
    not depend on it. With --bands, a tolerance only says what is enough.
    """
    from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
    from shviewer.lights.find import split_light

    chosen = chosen_of(options, Recipe)
    if "window" in chosen:
        window, separator, width = chosen["window"].partition(":")
        if separator and window in ("none", "dering"):
            raise UsageError(f"window {options.window!r}: {window} has no width; hann, lanczos and gauss have one")
        chosen |= {"window": window, "window_width": _finite(width, "window width") if separator else None}
    recipe = replace(start, light=light, reading=reading_from(options, start.reading), **chosen)
    recipe.check()
    if "suns" in chosen and not recipe.split_sun:
        raise UsageError(f"--suns {recipe.suns}: it says what --split-sun takes; give that, too")
    compared, said = vars(options).get("compare"), ""
    if compared:
        from shviewer.analysis.compared_files import compared_with

        recipe, found = compared_with(recipe, compared)
        if found:
            print(f"shviewer: {found}", file=sys.stderr)
    listed = isinstance(light, str) and split_light(light)[0].suffix.lower() in COEFFICIENT_SUFFIXES
    if compared or (listed and start is START):
        from shviewer.analysis.comparison import as_the_file_holds

        any_bands = options.n_bands is None and options.tolerance is None
        recipe, said = as_the_file_holds(recipe, quantity=options.quantity is None, bands=any_bands)
    fits = options.tolerance is not None and options.n_bands is None
    return (_fitted(recipe) if fits else recipe), said


def replacing_of(options: argparse.Namespace) -> Replacing:
    """What the command may replace. Its inputs are its lights, coefficients to compare, and a reference."""
    from shviewer.lights.find import file_of, split_light

    others = [vars(options).get(name) for name in ("compare", "reference", "like")]
    inputs = [*(split_light(light)[0] for light in lights_of(options)), *(Path(other) for other in others if other)]
    if pictured := pictured_by(options):
        named = (pictured.state.recipe.light, pictured.state.recipe.compare)
        inputs += filter(None, (file_of(light) for light in named if light is not None))
    return Replacing(tuple(inputs), options.force)


def lights_of(options: argparse.Namespace) -> list[str]:
    """What is given as LIGHT, or what stands for it."""
    given = vars(options)
    return given.get("lights") or [given.get("light", "green")]


def pictured_by(options: argparse.Namespace) -> Restored | None:
    """What the options come on top of: the picture named by --like, or by LIGHT; None for another light. Read once."""
    given = vars(options)
    if "pictured" not in given:
        options.pictured = _pictured(options) if "as_image" in given else None
    found: Restored | None = options.pictured
    return found


def _pictured(options: argparse.Namespace) -> Restored | None:
    from shviewer.lights.find import split_light
    from shviewer.viewer.saving.restoring import restored

    limits = reading_from(options).limits
    if options.like is None:
        path, part = split_light(lights_of(options)[0])
        return None if part or options.as_image else restored(path, limits)
    found = restored(options.like, limits, lights_of(options)[0])
    if found is None:
        raise UsageError(f"--like {options.like}: no picture that shviewer saved; name one, or leave out --like")
    return found


def state_from(options: argparse.Namespace, *, all_lights: bool) -> State:
    """The state that the options ask for, on top of that of a picture. UsageError for an option out of range.

    Size and overlay, which are no part of a state, are those of the picture from now on, unless the options say them.
    """
    from shviewer.lights.find import built_in_lights
    from shviewer.viewer.actions import open_light
    from shviewer.viewer.beside import recipe_beside
    from shviewer.viewer.message import warning
    from shviewer.viewer.state import State, changed

    pictured = pictured_by(options)
    start = pictured.state if pictured else State()
    entry = lights_of(options)[0]
    light = start.recipe.light if pictured else entry
    options.size = tuple(options.size or (pictured and pictured.size) or DEFAULT_SIZE)
    options.no_overlay = vars(options).get("no_overlay") or (pictured is not None and not pictured.overlay)
    view, counted_bands = _view_from(options, start.view), not (options.n_bands is None and options.tolerance is None)
    if options.encode and counted_bands:
        raise UsageError(f"--encode {options.encode}: it takes the place of bands; leave out --bands and --tolerance")
    encoding = "" if counted_bands or (options.quantity and not options.encode) else view.encode
    view = replace(view, encode="")
    asked = start.recipe.n_bands if options.n_bands is None else options.n_bands
    State(Recipe(n_bands=asked), view).check(options.size)
    recipe, said = recipe_from(options, light, start.recipe if pictured else START)
    if options.beside in BESIDE_NEEDS and recipe_beside(recipe, options.beside) == recipe:
        raise UsageError(f"--beside {options.beside}: {BESIDE_NEEDS[options.beside]}")
    lights = tuple(built_in_lights()) if all_lights else (light,)
    state = replace(open_light(State(recipe, view, lights), entry if all_lights else light), recipe=recipe)
    state = replace(state, entry=entry if pictured and all_lights else None)
    state = changed(
        state, message=said or view.message, basis=tuple(options.basis) if options.basis else start.view.basis
    )
    if encoding:
        n_bands = ENCODED_BANDS.get(encoding, state.recipe.n_bands)
        state = changed(state, n_bands=n_bands, encode=encoding)
    state.check()
    if pictured and pictured.said:
        print(one_line(f"shviewer: note: {options.like or entry}: {pictured.said}"), file=sys.stderr)
        state = changed(state, message=warning(pictured.said)) if all_lights else state
    return changed(state, sweep_to=None) if all_lights else state  # a window shows the picture, and does not play on


def _view_from(options: argparse.Namespace, start: View) -> View:
    """The view that the options ask for, but for a basis function, which is checked as soon as its bands are known."""
    from shviewer.viewer.camera import rolled_towards
    from shviewer.viewer.view import View

    chosen: dict[str, Any] = {"basis": None} | chosen_of(options, View)
    if options.error_range is not None:
        chosen["error_range"] = _error_range(options.error_range, options.error or start.error)
    if options.camera:
        chosen["camera"] = options.camera[0] % 360, _elevation(options.camera[1])
    if options.map_centre:
        azimuth, elevation = options.map_centre
        chosen["map_centre"] = (azimuth + 180) % 360 - 180, _elevation(elevation)
    if options.basis:
        chosen |= {"basis": None, "lobe_view": True}
    third = [name for name in ("error", "beside") if vars(options)[name] not in (None, "off")]
    if len(third) == 1:  # in place of what a picture showed there
        chosen["beside" if third[0] == "error" else "error"] = "off"
    if options.exposure_stops is not None:
        chosen = {"exposure_offset": 0.0} | chosen
    if angles := turn_from(options):
        chosen["light_rotation"] = rolled_towards(*angles)
    return replace(start, **chosen)


def turn_from(options: argparse.Namespace) -> tuple[float, float, float] | None:
    """Azimuth, elevation and roll, degrees, by which the options turn the light; None if they do not."""
    if options.rotate_light is None and options.roll_light is None:
        return None
    azimuth, elevation = options.rotate_light or (0.0, 0.0)
    return azimuth, _elevation(elevation), options.roll_light or 0.0


def _elevation(degrees: float) -> float:
    if abs(degrees) > 90:
        raise UsageError(f"elevation {degrees:g}: it must be -90 to 90 degrees")
    return degrees


def _error_range(text: str, error: str) -> float:
    """The error range: a radiance, or for the relative error a share of 1, which may be given in percent."""
    share = text.endswith("%")
    if share and error != "relative":
        raise UsageError(f"error range {text}: a share is for --error relative; give a radiance, such as 0.5")
    return _finite(text.removesuffix("%"), "error range") / (100 if share else 1)


def _finite(text: str, what: str) -> float:
    """The number. UsageError, which says what it should be, if it is none."""
    try:
        return finite(text)
    except argparse.ArgumentTypeError as error:
        raise UsageError(f"{what} {error}") from error


def _fitted(recipe: Recipe) -> Recipe:
    """The recipe with as many bands as the tolerance needs, or if none are enough, the best count; stderr says which."""
    from shviewer.analysis.figures import estimate_from_samples, needs

    found = needs(recipe)
    counts = {RADIANCE: found.radiance, IRRADIANCE: found.irradiance, in_words(recipe.quantity): found.shown}
    says = ", ".join(f"{name} {count or f'none up to {found.searched}'}" for name, count in counts.items())
    print(f"shviewer: bands within {100 * found.tolerance:g} %: {says}", file=sys.stderr)
    if found.shown is None:
        print(f"shviewer: the best is {100 * found.best:.3g} % with {found.best_bands} bands", file=sys.stderr)
    if recipe.method == "jittered":
        guess = estimate_from_samples(recipe)
        if guess.decided:
            says = f"{guess.likely} bands" if guess.likely else "no count up to 32"
        else:
            says = f"nothing sure: {guess.fewest or 'more than 32'} to {guess.most or 'more than 32'} bands; take more samples"
        print(f"shviewer: the samples alone say {says}", file=sys.stderr)
    return replace(recipe, n_bands=found.shown or found.best_bands)


def reading_from(options: argparse.Namespace, start: Reading | None = None) -> Reading:
    """The reading that the options ask for, on top of `start`. UsageError for an unknown layout or convention."""
    from shviewer.lights.reading import DEFAULT_READING, LAYOUT_CHOICES

    start = start or DEFAULT_READING
    if options.layout is not None and options.layout not in LAYOUT_CHOICES:
        raise UsageError(f"layout {options.layout!r}: it must be one of {', '.join(LAYOUT_CHOICES)}")
    chosen = {
        "side": options.max_side,
        "texels": _binary_millions(options.max_megatexels),
        "file_bytes": _binary_millions(options.max_file_mib),
        "memory_bytes": _binary_millions(options.max_memory_mib),
    }
    if options.input_convention:
        _check_convention(options, options.input_convention)
    named = {"sanitize": options.sanitize, "layout": options.layout, "convention": options.input_convention or None}
    limits = replace(start.limits, **_given(chosen))
    return replace(start, limits=limits, **_given(named))


def _given(values: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if value is not None}


def _binary_millions(count: float | None) -> int | None:
    """A count in units of 2**20 as a whole number, at most 2**63, which any machine counts to."""
    return None if count is None else int(min(count, 2**43) * 2**20)


def _check_convention(options: argparse.Namespace, convention: str) -> None:
    """UsageError for a convention of bare lists that is unknown, or if no file is given that it could apply to."""
    from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
    from shviewer.coefficients.texts import parse_convention
    from shviewer.lights.find import split_light

    try:
        parse_convention(convention)
    except ValueError as error:
        raise UsageError(str(error)) from error
    given, lights = vars(options), lights_of(options)
    if given.get("compare") or any(split_light(text)[0].suffix.lower() in COEFFICIENT_SUFFIXES for text in lights):
        return
    name = "--input-convention" if "convention" in given else "--convention"
    raise UsageError(
        f"{name} {convention}: it applies to a coefficient file, and {lights[0]} is none; name one as LIGHT"
        + ("" if name == "--input-convention" else " or with --compare")
    )
