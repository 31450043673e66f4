"""The state that the options of a command line ask for, and its view."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from shviewer.analysis.recipe import Recipe
from shviewer.cli.options.inputs import lights_of, pictured_by
from shviewer.cli.options.recipes import START, check_effects, chosen_of, recipe_from
from shviewer.cli.options.values import number_of
from shviewer.errors import UsageError
from shviewer.harmonics.quantities.names import ENCODED_BANDS, IRRADIANCE
from shviewer.words import one_line

if TYPE_CHECKING:
    from shviewer.viewer.state import State
    from shviewer.viewer.view import View

DEFAULT_SIZE = (1280, 640)
DEFAULT_SWEEP = (1, 16)

BESIDE_NEEDS = {
    "no-window": "there is no window to do without; give --window, too",
    "method": "coefficients that are compared are no method's; leave out --compare",
    "own": "the light's own coefficients are shown already; give --compare, too",
}
"""What must be given for a second reconstruction to differ from the first."""


def size_of(options: argparse.Namespace) -> tuple[int, int]:
    """Width and height, pixels: those that the options say, or those of the picture that they start from."""
    pictured = pictured_by(options)
    width, height = options.size or (pictured and pictured.size) or DEFAULT_SIZE
    return width, height


def has_overlay(options: argparse.Namespace) -> bool:
    """Whether anything is written on the picture: not with --no-overlay, or where the options start from one without."""
    pictured = pictured_by(options)
    return not options.no_overlay and (pictured is None or pictured.overlay)


def state_from(options: argparse.Namespace, *, all_lights: bool) -> State:
    """The state that the options ask for, on top of that of a picture. UsageError for an option out of range."""
    from shviewer.lights.find import built_in_lights
    from shviewer.viewer.beside import recipe_beside
    from shviewer.viewer.camera import turn_of
    from shviewer.viewer.control.actions import open_light
    from shviewer.viewer.message import warning
    from shviewer.viewer.state import State, changed, released

    pictured = pictured_by(options)
    start = pictured.state if pictured else State()
    entry = lights_of(options)[0]
    light = start.recipe.light if pictured else entry
    view, counted_bands = _view_from(options, start.view), not (options.n_bands is None and options.tolerance is None)
    if options.encode and counted_bands:
        raise UsageError(f"--encode {options.encode}: it takes the place of bands; leave out --bands and --tolerance")
    if options.encode and options.quantity is None:
        options.quantity = IRRADIANCE
    encoding = "" if counted_bands or (options.quantity and not options.encode) else view.encode
    view = replace(view, encode="")
    asked = start.recipe.n_bands if options.n_bands is None else options.n_bands
    State(Recipe(n_bands=asked), view).check(size_of(options))
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
    if options.anew or state.recipe.turn is not None:
        state = changed(state, turn=turn_of(state.view.light_rotation))
    if state.recipe != start.recipe:
        state = changed(state, trace=(), **released(state.view))
    if not all_lights:  # in a window a key may give it its effect
        check_effects(options, replace(state.recipe, n_bands=_most_bands(options, state)), state.view.beside)
    return changed(state, sweep_to=None, turning="") if all_lights else state  # a window does not play on


def _most_bands(options: argparse.Namespace, state: State) -> int:
    """The bands of a state, or those with which a sweep of them ends."""
    given = vars(options)
    sweeps = "last" in given and not (given["turntable"] or given["turn_light"])
    return (given["last"] or DEFAULT_SWEEP[1]) if sweeps else state.recipe.n_bands


def _view_from(options: argparse.Namespace, start: View) -> View:
    """The view that the options ask for, but for a basis function, which is checked as soon as its bands are known."""
    from shviewer.viewer.camera import rolled_towards
    from shviewer.viewer.state import released
    from shviewer.viewer.view import View

    chosen: dict[str, Any] = {"basis": None} | chosen_of(options, View)
    if options.error_range is not None:
        chosen["error_range"] = _error_range(options.error_range, options.error or start.error)
        chosen["range_held"] = False
    elif options.error not in (None, start.error):
        chosen |= released(start)
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
    return number_of(text.removesuffix("%"), "error range") / (100 if share else 1)
