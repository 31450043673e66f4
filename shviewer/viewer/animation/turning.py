"""A light that turns once round and is projected anew in every frame, with what changes from frame to frame.

The samples stand still in the world, so that they move over the light: fresh ones in each frame, or the same in all.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial

import numpy as np

from shviewer.analysis.reconstruction import reconstruction_of
from shviewer.errors import UsageError
from shviewer.harmonics.basis import Array
from shviewer.viewer.animation.animation import MAX_FRAMES, Animation, checked, in_milliseconds, with_one_range
from shviewer.viewer.camera import about_axis, compose, light_from_world
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.state import State, changed

SHOWN = 48
"""The most changes that the line under the curve goes back."""


@dataclass(eq=False)
class _Turn:
    """The states of a turn, and the changes from frame to frame as far as they are known."""

    states: tuple[State, ...]
    changes: list[float] = field(default_factory=list)
    last: Array | None = None

    def picture(self, number: int) -> Picture:
        """The picture of a frame, with the changes up to it."""
        while len(self.changes) < number or self.last is None:
            self._step()
        state = self.states[number]
        return prepare(state, turn=turn_of(state), trace=tuple(self.changes[max(0, number - SHOWN) : number]))

    def _step(self) -> None:
        """One more frame: how far its coefficients, turned back, are from those before, over the norm of the light."""
        state = self.states[0 if self.last is None else len(self.changes) + 1]
        found = reconstruction_of(state.recipe, turn=turn_of(state))
        if self.last is not None:
            norm = float(np.sqrt(np.trace(found.subject.light.products())))
            change = float(np.linalg.norm(found.coefficients - self.last))
            self.changes.append(change / norm if norm else 0.0)
        self.last = found.coefficients


def turn_of(state: State) -> tuple[float, ...]:
    """The matrix from world directions to those of the light, its rows one after another."""
    return tuple(light_from_world(state.view.light_rotation).ravel().tolist())


def light_turn(state: State, frames: int, seconds: float, *, fresh: bool) -> Animation:
    """The light once round about the vertical in equal steps. UsageError for a number of frames out of range.

    fresh: whether the jittered samples of each frame have a seed of their own.
    """
    if not 2 <= frames <= MAX_FRAMES:
        raise UsageError(f"--frames {frames}: a turn has 2 to {MAX_FRAMES}")
    if state.recipe.compare is not None:
        raise UsageError("--turn-light projects the light in every frame; leave out --compare")
    (state,) = with_one_range([state])
    states = tuple(
        changed(
            state,
            light_rotation=compose(about_axis((0, 0, 1), 360 * k / frames), state.view.light_rotation),
            seed=state.recipe.seed + (k if fresh else 0),
        )
        for k in range(frames)
    )
    about: dict[str, object] = {"kind": "turning light", "seeds": "fresh" if fresh else "same"}
    turn = _Turn(states)
    return checked(list(states), [in_milliseconds(seconds)] * frames, state, about, partial(_Turn.picture, turn))
