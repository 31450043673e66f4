"""Actions that begin, step and end what plays in the window: a sweep of bands, or a light that turns."""

from __future__ import annotations

from shviewer.viewer.animation.metronome import TURN_STEP
from shviewer.viewer.camera import about_axis, compose, turn_of
from shviewer.viewer.control.actions import compares, with_bands
from shviewer.viewer.state import State, changed

SWEEP_BANDS = 10
"""The last band count of a sweep that starts with one band in use."""


def toggle_sweep(state: State) -> State:
    """Start a sweep from 1 band to the present count, or to SWEEP_BANDS where that is 1; or stop the sweep that plays."""
    if state.view.sweep_to is not None:
        return changed(state, sweep_to=None)
    state = changed(state, turning="")
    to = state.recipe.n_bands if state.recipe.n_bands > 1 else SWEEP_BANDS
    return changed(with_bands(state, 1), sweep_to=to)


def step_sweep(state: State) -> State:
    """One band more; the last one ends the sweep."""
    if state.view.sweep_to is None:
        return state
    stepped = with_bands(changed(state, message=""), state.recipe.n_bands + 1)
    view, going_on = state.view, state.recipe.n_bands < stepped.recipe.n_bands < state.view.sweep_to
    to = view.sweep_to if going_on else None
    return changed(stepped, sweep_to=to, error_range=view.error_range, range_held=view.range_held)


def turn_light(state: State, seeds: str) -> State:
    """Let the light turn, projected anew in every frame, with samples by one of SEEDS; or stop it if it does so."""
    if state.view.turning == seeds:
        return changed(state, turning="")
    if given := state.recipe.compare:
        return compares(state, given, ": no light is projected")
    turn = turn_of(state.view.light_rotation)
    return changed(state, turn=turn, turning=seeds, trace=(), sweep_to=None)


def step_turn(state: State) -> State:
    """The next frame of a light that turns."""
    return turned(state, TURN_STEP, state.recipe.seed + (state.view.turning == "fresh"))


def turned(state: State, degrees: float, seed: int) -> State:
    """The state with its light turned further about the vertical and projected there; what is known of changes stays."""
    kept = {name: getattr(state.view, name) for name in ("trace", "error_range", "range_held")}
    rotation = compose(about_axis((0, 0, 1), degrees), state.view.light_rotation)
    return changed(state, light_rotation=rotation, turn=turn_of(rotation), seed=seed, **kept)


def wants_range(state: State) -> bool:
    """Whether the state is a frame of what plays in the window, and has yet to be given the range of all its frames."""
    view = state.view
    plays = view.sweep_to is not None or bool(view.turning)
    return plays and view.error != "off" and view.error_range is None
