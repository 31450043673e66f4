"""The state: everything a frame depends on, and its description in words. actions.py has the steps between states."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import Any

from shviewer.analysis.recipe import Recipe, check_encoding
from shviewer.errors import UsageError
from shviewer.lights.light import Light
from shviewer.limits import MAX_DIRECT_BANDS
from shviewer.viewer.composing.composition import MAX_SIDE, MIN_SIDE
from shviewer.viewer.view import View
from shviewer.words import counted

IN_RECIPE = frozenset(part.name for part in fields(Recipe))
IN_VIEW = frozenset(part.name for part in fields(View))


RANGED = ("error", "encode")
"""Fields of the view that the range of the error depends on, beside the recipe."""

START, FRONT = Recipe(), View()


@dataclass(frozen=True)
class State:
    """A recipe, a view, and the lights that Left and Right go through. Equal states give equal pixels."""

    recipe: Recipe = START
    view: View = FRONT
    lights: tuple[str | Light, ...] = ("green",)
    start: tuple[Recipe, View] = field(default=(START, FRONT), compare=False)
    """What the command line or an opened picture asked for, to which R goes back. No pixel depends on it."""

    entry: str | Light | None = field(default=None, compare=False)
    """The one of `lights` that is shown, where that is a picture, and so not the light of the recipe."""

    @property
    def place(self) -> int | None:
        """The place in `lights` of the light that is shown; None if it is not among them."""
        shown = self.recipe.light if self.entry is None else self.entry
        return self.lights.index(shown) if shown in self.lights else None

    @property
    def bands_ahead(self) -> int:
        """The bands that bars and axes need room for: those in use, or during a sweep those at its end."""
        return max(self.recipe.n_bands, self.view.sweep_to or 0)

    def check(self, size: tuple[int, int] = (MIN_SIDE, MIN_SIDE)) -> None:
        """UsageError unless state and size (width, height) are within the limits of the viewer."""
        self.recipe.check()
        self.view.check()
        n_bands, basis = self.recipe.n_bands, self.view.basis
        if self.view.whole_sphere and self.view.lobe_view:
            raise UsageError("--map with --lobes or --basis: surfaces have no map; leave one out")
        if self.view.evaluate == "direct" and n_bands > MAX_DIRECT_BANDS:
            raise UsageError(f"{n_bands} bands: at most {MAX_DIRECT_BANDS} are summed directly; map or auto take more")
        if encoding := self.view.encode:
            check_encoding(self.recipe, encoding)
        if basis is not None and not abs(basis[1]) <= basis[0] < n_bands:
            raise UsageError(f"basis function {basis} of {n_bands} bands: l must be 0 to {n_bands - 1}, m -l to l")
        if not all(MIN_SIDE <= side <= MAX_SIDE for side in size):
            raise UsageError(f"size {size[0]} x {size[1]}: each side must be {MIN_SIDE} to {MAX_SIDE} pixels")


def value_of(state: State, name: str) -> Any:
    """The value of a field of recipe or view."""
    return getattr(state.recipe if name in IN_RECIPE else state.view, name)


def changed(state: State, **values: Any) -> State:
    """The state with other values for fields of its recipe or its view. TypeError for a name that neither has.

    What is known of another recipe goes, unless it is among the values: changes of a turn, and a range that was held.
    """
    recipe = {name: values.pop(name) for name in IN_RECIPE & values.keys()}
    view = {name: values.pop(name) for name in IN_VIEW & values.keys()}
    if recipe:
        before, state = state.recipe, replace(state, recipe=replace(state.recipe, **recipe))
        if (state.view.trace or state.view.range_held) and state.recipe != before:
            view = {"trace": (), **released(state.view)} | view
    elif any(view.get(name, getattr(state.view, name)) != getattr(state.view, name) for name in RANGED):
        view = released(state.view) | view
    if view:
        state = replace(state, view=replace(state.view, **view))
    return replace(state, **values) if values else state


def released(view: View) -> dict[str, Any]:
    """The fields of the view that let a range of the error go, if one is held."""
    return {"error_range": None, "range_held": False} if view.range_held else {}


def started(state: State) -> State:
    """The state as one to which R goes back: without what only keys show."""
    shown = {
        name: getattr(FRONT, name)
        for name in ("help_visible", "sweep_to", "turning", "trace", "message", "layout_tried")
    }
    return replace(state, start=(state.recipe, replace(state.view, **shown)))


def state_of(*lights: str | Light, **values: Any) -> State:
    """The state at the start with these lights, showing `light` or else the first; other values as in `changed`."""
    lights = lights or (values.get("light", Recipe.light),)
    return changed(State(lights=lights), **{"light": lights[0], **values})


def describe_numbers(state: State) -> str:
    """ "5 bands", or "encoding zh3" """
    return f"encoding {state.view.encode}" if state.view.encode else counted(state.recipe.n_bands, "band")


def describe_muted(recipe: Recipe) -> str:
    """ "muted 1, 3-5", "only band 2", or "" """
    bands = recipe.muted_shown
    if not bands:
        return ""
    if len(bands) == recipe.n_bands - 1 and recipe.n_bands > 2:
        return f"only band {next(band for band in range(recipe.n_bands) if band not in bands)}"
    runs: list[list[int]] = []
    for band in bands:
        if runs and band == runs[-1][-1] + 1:
            runs[-1].append(band)
        else:
            runs.append([band])
    return "muted " + ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)


def describe_window(recipe: Recipe) -> str:
    """ "Hann window", "Hann window of 6", "deringed", or "" """
    if recipe.window in ("none", "dering"):
        return "deringed" if recipe.window == "dering" else ""
    width = f" of {recipe.window_width:g}" if recipe.window_width else ""
    return f"{recipe.window.capitalize()} window{width}"


def describe_sanitizing(recipe: Recipe) -> str:
    return "repaired" if recipe.reading.sanitize else "as they are"


def describe_exposure(view: View) -> str:
    base = "auto" if view.exposure_stops is None else f"{view.exposure_stops:+g}"
    return base if not view.exposure_offset else f"{base} {view.exposure_offset:+g}"


def describe_camera(view: View) -> str:
    """ "30, 10 deg", or "at the light" """
    return "at the light" if view.camera is None else "{:z.0f}, {:z.0f} deg".format(*view.camera)


def describe_basis(view: View) -> str:
    """ "Y(2,-1)", or "" """
    return "" if view.basis is None else "Y({},{})".format(*view.basis)
