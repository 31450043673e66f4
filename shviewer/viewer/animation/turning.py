"""A light that turns and is projected anew in every frame, in the window and in files, with what changes from frame to frame.

The samples stand still in the world, so that they move over the light: fresh ones in each frame, or the same in all. A change
is how far the coefficients, turned back, are from those before, over the norm of the light.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from shviewer.analysis.recipe import Recipe
from shviewer.errors import UsageError
from shviewer.harmonics.basis import Array
from shviewer.lights.light import Light
from shviewer.viewer.animation.animation import MAX_FRAMES, Animation, in_milliseconds, with_one_range
from shviewer.viewer.control.playing import turned
from shviewer.viewer.derived import reconstruction_shown
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.state import State, changed

SHOWN = 48
"""The most changes that the line under the curve goes back."""


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
class LightTurn(Animation):
    """A turn of the light, in whose frames the changes are seen up to them."""

    traced: list[State] = field(default_factory=list)
    """The states with their changes, as far as they are known."""
    last: Array = field(default_factory=lambda: np.zeros((0, 3)))
    """The coefficients of the last of them."""

    def picture(self, number: int, *, written: bool = True) -> Picture:
        while len(self.traced) <= number:
            state = self.states[len(self.traced)]
            found = reconstruction_shown(state.recipe, state.view)
            if self.traced:
                state = changed(state, trace=self.traced[-1].view.trace)
                state = followed(state, found.subject.light, self.last, found.coefficients)
            self.traced.append(state)
            self.last = found.coefficients
        return prepare(self.traced[number], written=written)


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
    seed = state.recipe.seed
    states = tuple(turned(state, 360 * k / frames, seed + (k if fresh else 0)) for k in range(frames))
    about: dict[str, object] = {"kind": "turning light", "seeds": "fresh" if fresh else "same"}
    return LightTurn(states, (in_milliseconds(seconds),) * frames, state, about)
