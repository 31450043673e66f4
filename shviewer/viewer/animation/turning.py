"""A light that turns and is projected anew in every frame, in the window and in files, with what changes from frame to frame.

The samples stand still in the world, so that they move over the light: fresh ones in each frame, or the same in all. A change
is how far the coefficients, turned back, are from those before, over the norm of the light.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from shviewer.analysis.recipe import Recipe
from shviewer.errors import UsageError
from shviewer.harmonics.basis import Array
from shviewer.lights.light import Light
from shviewer.viewer.animation.animation import MAX_FRAMES, Animation, checked, in_milliseconds, with_one_range
from shviewer.viewer.animation.metronome import TURN_STEP
from shviewer.viewer.camera import Quaternion, about_axis, compose, turn_of
from shviewer.viewer.derived import reconstruction_shown
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.state import State, changed

SHOWN = 48
"""The most changes that the line under the curve goes back."""


def step_turn(state: State) -> State:
    """The next frame of a light that turns in the window."""
    rotation = compose(about_axis((0, 0, 1), TURN_STEP), state.view.light_rotation)
    return _standing(state, rotation, state.recipe.seed + (state.view.turning == "fresh"))


def _standing(state: State, rotation: Quaternion, seed: int) -> State:
    """The state with its light projected where `rotation` has it; changes that are known stay, and so does the range."""
    kept = {name: getattr(state.view, name) for name in ("trace", "error_range", "range_held")}
    return changed(state, light_rotation=rotation, turn=turn_of(rotation), seed=seed, **kept)


def only_turned(one: Recipe, other: Recipe) -> bool:
    """Whether recipes differ in how their light is turned, if at all, and perhaps in the seed."""
    return one == other or replace(one, turn=other.turn, seed=other.seed) == other


def is_next(one: Recipe, other: Recipe) -> bool:
    """Whether the other recipe is that of a next frame."""
    return one.turn is not None and one.turn != other.turn and only_turned(one, other)


def followed(state: State, light: Light, before: Array, after: Array) -> State:
    """The state with the change from coefficients of one frame to those of the next."""
    norm = float(np.sqrt(np.trace(light.products())))
    change = float(np.linalg.norm(after - before)) / norm if norm else 0.0
    return changed(state, trace=(*state.view.trace, change)[-SHOWN:])


@dataclass(eq=False)
class _Turn:
    """The states of a turn, with the changes as far as they are known."""

    states: list[State]
    known: int = 0
    last: Array | None = None

    def picture(self, number: int) -> Picture:
        """The picture of a frame, with the changes up to it."""
        while self.known < number or self.last is None:
            at = 0 if self.last is None else self.known + 1
            found = reconstruction_shown(self.states[at].recipe, self.states[at].view)
            if self.last is not None:
                state = changed(self.states[at], trace=self.states[self.known].view.trace)
                self.states[at] = followed(state, found.subject.light, self.last, found.coefficients)
            self.known, self.last = at, found.coefficients
        return prepare(self.states[number])


def light_turn(state: State, frames: int, seconds: float, *, fresh: bool) -> Animation:
    """The light once round about the vertical in equal steps. UsageError for a number of frames out of range.

    fresh: whether the jittered samples of each frame have a seed of their own.
    """
    if not 2 <= frames <= MAX_FRAMES:
        raise UsageError(f"--frames {frames}: a turn has 2 to {MAX_FRAMES}")
    if state.recipe.compare is not None:
        raise UsageError("--turn-light projects the light in every frame; leave out --compare")
    (state,) = with_one_range([state])
    state = prepare(state).placed(changed(state, turning="", trace=()))
    states = [
        _standing(
            state,
            compose(about_axis((0, 0, 1), 360 * k / frames), state.view.light_rotation),
            state.recipe.seed + (k if fresh else 0),
        )
        for k in range(frames)
    ]
    about: dict[str, object] = {"kind": "turning light", "seeds": "fresh" if fresh else "same"}
    turn = _Turn(list(states))
    return checked(states, [in_milliseconds(seconds)] * frames, state, about, partial(_Turn.picture, turn))
