"""What can be done to a state: functions from one state to the next. keys.py says which key does which."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from shviewer.harmonics.basis import degree_order, index
from shviewer.lights.light import Light
from shviewer.limits import MAX_BANDS, MAX_DIRECT_BANDS
from shviewer.viewer.camera import turned_by_drag
from shviewer.viewer.error_scale import ERRORS
from shviewer.viewer.state import (
    LAYOUT_CHOICES,
    MAX_EXPOSURE,
    MAX_KEY_SAMPLES,
    METHODS,
    MIN_SAMPLES,
    QUANTITIES,
    WINDOWS,
    ZOOM_RANGE,
    ViewState,
)
from shviewer.viewer.tone import TONES

Action = Callable[[ViewState], ViewState]

SWEEP_BANDS = 10
"""Where a sweep ends that starts with one band in use."""


def more_bands(count: int) -> Action:
    return lambda state: with_bands(state, state.n_bands + count)


def with_bands(state: ViewState, n_bands: int) -> ViewState:
    """So many bands, as far as they can be shown; a basis function above them is left."""
    most = min(state.compare.n_bands, MAX_BANDS) if state.compare else MAX_BANDS
    if state.compare and n_bands > most:
        state = replace(state, message=state.compare.extent)
    n_bands = min(max(n_bands, 1), most)
    basis = state.basis if state.basis is not None and state.basis[0] < n_bands else None
    return replace(state, n_bands=n_bands, cursor=min(state.cursor, n_bands - 1), basis=basis, sweep_to=None)


def toggle_band(state: ViewState, band: int) -> ViewState:
    """Mute a band or take it back; one that is not in use only says so."""
    return replace(state, muted=state.muted ^ {band}) if band < state.n_bands else not_in_use(state, band)


def not_in_use(state: ViewState, band: int) -> ViewState:
    return replace(state, message=f"band {band} is above the {state.n_bands} in use: Up adds bands")


def solo_band(state: ViewState, band: int) -> ViewState:
    """Only this band; once more: all of them."""
    others = frozenset(range(MAX_BANDS)) - {band}
    if band >= state.n_bands:
        return not_in_use(state, band)
    return replace(state, muted=frozenset() if state.muted == others else others)


def move_cursor(step: int) -> Action:
    """Along the band bars; the first press only shows where the cursor is."""

    def action(state: ViewState) -> ViewState:
        moved = (state.cursor + step) % state.n_bands if state.cursor_visible else state.cursor
        return replace(state, cursor=moved, cursor_visible=True)

    return action


def toggle_cursor(state: ViewState) -> ViewState:
    return replace(toggle_band(state, state.cursor), cursor_visible=True)


def next_light(step: int) -> Action:
    return lambda state: replace(state, light_index=(state.light_index + step) % len(state.lights), layout_tried="")


def next_layout(state: ViewState) -> ViewState:
    """Through all layouts, for this image and those opened afterwards."""
    last = state.layout_tried or state.reading.layout
    layout = _after(last, LAYOUT_CHOICES)
    return replace(state, reading=replace(state.reading, layout=layout), layout_tried=layout)


def toggle_sanitizing(state: ViewState) -> ViewState:
    """Of this image and those opened afterwards."""
    return replace(state, reading=replace(state.reading, sanitize=not state.reading.sanitize))


def next_window(state: ViewState) -> ViewState:
    """Through all windows; deringing, which takes up to MAX_DIRECT_BANDS bands, is left out above them."""
    names = WINDOWS if state.n_bands <= MAX_DIRECT_BANDS else WINDOWS[:-1]
    at = names.index(state.window) if state.window in names else len(names) - 1
    return replace(state, window=names[(at + 1) % len(names)])


def next_quantity(state: ViewState) -> ViewState:
    return replace(state, quantity=_after(state.quantity, QUANTITIES))


def toggle_split(state: ViewState) -> ViewState:
    return replace(state, split_sun=not state.split_sun)


def next_method(state: ViewState) -> ViewState:
    if state.compare:
        return replace(state, message=f"the coefficients are those of {state.compare.name}, and no method's")
    return replace(state, method=_after(state.method, METHODS))


def scale_samples(factor: float) -> Action:
    def action(state: ViewState) -> ViewState:
        if state.method == "best":
            return replace(state, message="no samples are drawn in this light's best way: M changes the method")
        return replace(
            state, samples=int(min(max(state.samples * factor, MIN_SAMPLES), max(state.samples, MAX_KEY_SAMPLES)))
        )

    return action


def expose(step: float) -> Action:
    def action(state: ViewState) -> ViewState:
        return replace(state, exposure_offset=min(max(state.exposure_offset + step, -MAX_EXPOSURE), MAX_EXPOSURE))

    return action


def auto_exposure(state: ViewState) -> ViewState:
    return replace(state, exposure_stops=None, exposure_offset=0.0)


def next_tone(state: ViewState) -> ViewState:
    return replace(state, tone=_after(state.tone, TONES))


def next_error(state: ViewState) -> ViewState:
    return replace(state, error=_after(state.error, ERRORS))


def toggle_sheet(sheet: str) -> Action:
    """Show that sheet over the spheres instead of any other, or take it away."""
    return lambda state: replace(state, sheet="" if state.sheet == sheet else sheet)


def toggle_lobe_view(state: ViewState) -> ViewState:
    """Surfaces of the light and its reconstruction, or spheres again."""
    return replace(state, lobe_view=not state.lobe_view, basis=None)


def step_basis(step: int) -> Action:
    """Through the functions Y(l, m) of the bands in use, in the order of their coefficients, and none of them."""

    def action(state: ViewState) -> ViewState:
        count = state.n_bands**2
        at = count if state.basis is None else index(*state.basis)
        at = (at + step) % (count + 1)
        return replace(state, lobe_view=True, basis=None if at == count else degree_order(at))

    return action


def toggle_sweep(state: ViewState) -> ViewState:
    """Go through the band counts from 1 to the present one; where that is 1, to those that the bars show. Or stop."""
    if state.sweep_to is not None:
        return replace(state, sweep_to=None)
    to = state.n_bands if state.n_bands > 1 else SWEEP_BANDS
    return replace(with_bands(state, 1), sweep_to=to)


def step_sweep(state: ViewState) -> ViewState:
    """One band more; the last one ends the sweep."""
    if state.sweep_to is None:
        return state
    stepped = with_bands(replace(state, message=""), state.n_bands + 1)
    going_on = state.n_bands < stepped.n_bands < state.sweep_to
    return replace(stepped, sweep_to=state.sweep_to if going_on else None)


def reset(state: ViewState) -> ViewState:
    """Everything but the light and the window as it was at the start."""
    return ViewState(
        lights=state.lights,
        light_index=state.light_index,
        reading=state.reading,
        compare=state.compare,
        reloads=state.reloads,
        fullscreen=state.fullscreen,
        screenshots=state.screenshots,
        fits=state.fits,
        looks=state.looks,
        layout_tried=state.layout_tried,
        tolerance=state.tolerance,
        evaluate=state.evaluate,
    )


def reload(state: ViewState) -> ViewState:
    """Read the light's file anew and keep every other setting."""
    return replace(state, reloads=state.reloads + 1)


def escape(state: ViewState) -> ViewState:
    """Close the help, or else the sheet over the spheres, or else stop the sweep, or else close the window."""
    if state.help_visible:
        return replace(state, help_visible=False)
    if state.sheet:
        return replace(state, sheet="")
    return replace(state, closing=True) if state.sweep_to is None else replace(state, sweep_to=None)


def orbit(state: ViewState, right: float, up: float) -> ViewState:
    """Turn all spheres as if their front was dragged, in radii of a sphere."""
    azimuth, elevation = state.camera
    azimuth = (azimuth - right * 180 / math.pi) % 360
    elevation = min(max(elevation - up * 180 / math.pi, -90.0), 90.0)
    return replace(state, camera=(azimuth, elevation))


def rotate_light(state: ViewState, right: float, up: float) -> ViewState:
    """Turn the light as if the front of a sphere was dragged, in radii of a sphere."""
    return replace(state, light_rotation=turned_by_drag(state.light_rotation, state.camera, right, up))


def zoom(state: ViewState, steps: float) -> ViewState:
    low, high = ZOOM_RANGE
    return replace(state, zoom=min(max(state.zoom * 1.1**steps, low), high))


def open_light(state: ViewState, light: str | Light) -> ViewState:
    """Show `light`, adding it to those that Left and Right go through."""
    lights = state.lights if light in state.lights else (*state.lights, light)
    return replace(state, lights=lights, light_index=lights.index(light), layout_tried="", message="")


def _after(present: str, choices: tuple[str, ...]) -> str:
    """The choice after the present one; after the last comes the first."""
    return choices[(choices.index(present) + 1) % len(choices)]
