"""Actions: functions from a state, and perhaps a value, to the next state. keys.py binds them to keys."""

from __future__ import annotations

from dataclasses import replace

from shviewer.analysis.options import Choice, options_of
from shviewer.analysis.recipe import WINDOWS, Recipe, light_name
from shviewer.harmonics.basis import degree_order, index
from shviewer.harmonics.quantities.names import (
    ENCODED_BANDS,
    IRRADIANCE,
    LEAST_ROUGHNESS,
    MOST_ROUGHNESS,
    RADIANCE,
    glossy,
    roughness_of,
)
from shviewer.lights.find import is_image
from shviewer.lights.light import Light
from shviewer.lights.reading import LAYOUT_CHOICES
from shviewer.limits import MAX_BANDS, MAX_DIRECT_BANDS
from shviewer.viewer.beside import besides_of
from shviewer.viewer.control.commands import Command
from shviewer.viewer.state import State, changed, value_of
from shviewer.viewer.view import ERRORS, MAX_EXPOSURE, STOPPED, View

OPTIONS = options_of(Recipe, View)
MIN_SAMPLES, MAX_KEY_SAMPLES = 16, 1_000_000


def next_choice(state: State, name: str) -> State:
    """Give an option of recipe or view the choice after the present one; after the last comes the first."""
    kind = OPTIONS[name].kind
    assert isinstance(kind, Choice)
    return changed(state, **{name: _after(value_of(state, name), kind.choices)})


def next_encoding(state: State) -> State:
    """Show the next encoding of irradiance in place of bands; after the last come the three bands that shading needs."""
    if state.recipe.quantity != IRRADIANCE:
        return changed(state, message="encodings are of irradiance: I shows it")
    if given := state.recipe.compare:
        return compares(state, given, ": R shows the light's own")
    encoding = _after(state.view.encode, ("", *ENCODED_BANDS))
    return changed(with_bands(state, ENCODED_BANDS.get(encoding, 3)), encode=encoding)


def next_quantity(state: State) -> State:
    """Go from radiance to irradiance, to the glossy quantity shown last, and back; bands take the place of an encoding."""
    state = changed(state, encode="")
    match state.recipe.quantity:
        case "radiance":
            return changed(state, quantity=IRRADIANCE)
        case "irradiance":
            return changed(state, quantity=glossy(state.view.roughness))
        case shown:
            return changed(state, quantity=RADIANCE, roughness=roughness_of(shown))


def rougher(state: State, step: float) -> State:
    """Show a glossy quantity of more roughness, or of less; at first that shown last."""
    now = roughness_of(state.recipe.quantity)
    wanted = state.view.roughness if now is None else round(now / abs(step)) * abs(step) + step
    state = changed(state, encode="")
    roughness = round(min(max(wanted, LEAST_ROUGHNESS), MOST_ROUGHNESS), 6)
    return changed(state, quantity=glossy(roughness), roughness=roughness)


def next_third(state: State) -> State:
    """Show the next thing on the third sphere: each error, then each reconstruction that there is beside, then nothing."""
    shown = [{"error": error, "beside": "off"} for error in ERRORS]
    shown += [{"error": "off", "beside": beside} for beside in besides_of(state.recipe)]
    present = {"error": state.view.error, "beside": state.view.beside}
    at = shown.index(present) if present in shown else -1
    return changed(state, **shown[(at + 1) % len(shown)])


def toggle(state: State, name: str) -> State:
    """Make a field of recipe or view False if it is True, and True if it is False."""
    return changed(state, **{name: not value_of(state, name)})


def more_bands(state: State, count: int) -> State:
    return with_bands(state, state.recipe.n_bands + count)


def with_bands(state: State, n_bands: int) -> State:
    """Show `n_bands` bands, within what can be shown; a basis function above them is given up."""
    most = min(state.recipe.compare.n_bands, MAX_BANDS) if state.recipe.compare else MAX_BANDS
    if state.recipe.compare and n_bands > most:
        state = changed(state, message=state.recipe.compare.extent)
    n_bands = min(max(n_bands, 1), most)
    basis = state.view.basis if state.view.basis is not None and state.view.basis[0] < n_bands else None
    cursor = min(state.view.cursor, n_bands - 1)
    return changed(state, n_bands=n_bands, cursor=cursor, basis=basis, sweep_to=None, encode="")


def toggle_band(state: State, band: int) -> State:
    """Mute a band or unmute it; for a band that is not in use, only say so."""
    return changed(state, muted=state.recipe.muted ^ {band}) if band < state.recipe.n_bands else not_in_use(state, band)


def not_in_use(state: State, band: int) -> State:
    return changed(state, message=f"band {band} is above the {state.recipe.n_bands} in use: Up adds bands")


def solo_band(state: State, band: int) -> State:
    """Mute all bands but this one; a second time, unmute all."""
    others = frozenset(range(MAX_BANDS)) - {band}
    if band >= state.recipe.n_bands:
        return not_in_use(state, band)
    return changed(state, muted=frozenset() if state.recipe.muted == others else others)


def move_cursor(state: State, step: int) -> State:
    """Move the cursor along the band bars; the first press only shows where it is."""
    moved = (state.view.cursor + step) % state.recipe.n_bands if state.view.cursor_visible else state.view.cursor
    unseen = state.view.sheet or state.view.by_roughness or state.view.encode
    said = f"band {moved}: Enter mutes it or brings it back" if unseen else ""
    return changed(state, cursor=moved, cursor_visible=True, message=said)


def toggle_cursor(state: State) -> State:
    return changed(toggle_band(state, state.view.cursor), cursor_visible=True)


def next_light(state: State, step: int) -> State:
    """Show the light `step` places further in the list, which is a ring."""
    return show_light(state, state.lights[((state.place or 0) + step) % len(state.lights)])


def show_light(state: State, light: str | Light) -> State:
    """Show one of the lights."""
    return changed(state, light=light, entry=None, layout_tried="")


def open_light(state: State, light: str | Light) -> State:
    """Show `light`, adding it to those that Left and Right go through."""
    lights = state.lights if light in state.lights else (*state.lights, light)
    return changed(show_light(state, light), lights=lights, message="")


def next_layout(state: State) -> State:
    """Read images in the next layout: this one and those opened afterwards."""
    if not is_image(state.recipe.light):
        return _no_image(state, "layout")
    last = state.view.layout_tried or state.recipe.reading.layout
    layout = _after(last, LAYOUT_CHOICES)
    return changed(state, reading=replace(state.recipe.reading, layout=layout), layout_tried=layout)


def toggle_sanitizing(state: State) -> State:
    """Repair bad values or leave them: in this image and those opened afterwards."""
    if not is_image(state.recipe.light):
        return _no_image(state, "values to repair")
    return changed(state, reading=replace(state.recipe.reading, sanitize=not state.recipe.reading.sanitize))


def _no_image(state: State, what: str) -> State:
    return changed(state, message=f"{light_name(state.recipe.light)} is no image, and has no {what}")


def next_window(state: State) -> State:
    """Go to the next window; deringing, which takes at most MAX_DIRECT_BANDS bands, is left out above them."""
    names = WINDOWS if state.recipe.n_bands <= MAX_DIRECT_BANDS else WINDOWS[:-1]
    at = names.index(state.recipe.window) if state.recipe.window in names else len(names) - 1
    return changed(state, window=names[(at + 1) % len(names)])


def next_method(state: State) -> State:
    if given := state.recipe.compare:
        return compares(state, given, ", and no method's")
    return next_choice(state, "method")


def compares(state: State, given: Light, so: str) -> State:
    """Say that compared coefficients are shown, and what that means for a key."""
    return changed(state, message=f"the coefficients are those of {given.name}{so}")


def scale_samples(state: State, factor: float) -> State:
    last = state.recipe.samples
    if state.recipe.method == "best":
        return changed(state, message="no samples are drawn in this light's best way: M changes the method")
    return changed(state, samples=int(min(max(last * factor, MIN_SAMPLES), max(last, MAX_KEY_SAMPLES))))


def expose(state: State, step: float) -> State:
    return changed(state, exposure_offset=min(max(state.view.exposure_offset + step, -MAX_EXPOSURE), MAX_EXPOSURE))


def auto_exposure(state: State) -> State:
    return changed(state, exposure_stops=None, exposure_offset=0.0)


def toggle_by_roughness(state: State) -> State:
    """Plot bands against roughness in place of whatever is plotted, or the curve again."""
    return changed(state, by_roughness=bool(state.view.sheet) or not state.view.by_roughness, sheet="")


def toggle_plane(state: State) -> State:
    """Plot time against error in place of the curve, or the curve again."""
    return changed(state, sheet="" if state.view.sheet else "plane")


def toggle_lobe_view(state: State) -> State:
    """Surfaces of the light and its reconstruction, or spheres again."""
    return changed(state, lobe_view=not state.view.lobe_view, basis=None, whole_sphere=False)


def toggle_whole_sphere(state: State) -> State:
    """The whole sphere as maps, or spheres again."""
    return changed(state, whole_sphere=not state.view.whole_sphere, lobe_view=False, basis=None)


def step_basis(state: State, step: int) -> State:
    """Show the next function Y(l, m) of the bands in use, in the sequence of their coefficients; beyond the ends, none."""
    count = state.recipe.n_bands**2
    at = count if state.view.basis is None else index(*state.view.basis)
    at = (at + step) % (count + 1)
    return changed(state, lobe_view=True, whole_sphere=False, basis=None if at == count else degree_order(at))


def reset(state: State) -> State:
    """Go back to what the command line asked for, in everything but the light."""
    recipe, view = state.start
    return changed(state, recipe=replace(recipe, light=state.recipe.light), view=replace(view, message=""))


def turn_page(state: State, pages: int) -> State:
    """Go to another page of the help; before the first there is none."""
    return changed(state, help_page=max(state.view.help_page + pages, 0))


def escape(state: State) -> State | Command:
    """Close the help, or else what is in place of the curve, or else stop the sweep or the light, or else leave."""
    if state.view.help_visible:
        return changed(state, help_visible=False)
    if state.view.sheet:
        return changed(state, sheet="")
    playing = state.view.sweep_to is not None or state.view.turning
    return changed(state, **STOPPED) if playing else Command.LEAVE


def _after(present: str, choices: tuple[str, ...]) -> str:
    """The choice after the present one; after the last comes the first."""
    return choices[(choices.index(present) + 1) % len(choices)]
