"""What keys and clicks changed, step by step, to be undone and done again.

A step has two states, before and after it, and undoing it gives back the fields in which they differ: what a drag of the mouse
has placed elsewhere since then stays there. What only plays, speaks or points is no step.
"""

from __future__ import annotations

from dataclasses import fields, replace
from typing import NamedTuple

from shviewer.viewer.state import IN_RECIPE, State, changed, value_of
from shviewer.viewer.view import LOOKED, PLAYED, POINTED, SPOKEN, STOPPED, View

MOST = 100
"""The most steps that are kept."""

PLACED = frozenset((*LOOKED, "turn"))
"""Fields that the mouse and time change, too, and only what a key makes of them is a step."""

STEPS = [part.name for part in fields(View) if part.compare and part.name not in (*POINTED, *PLAYED, *SPOKEN)]


class _Step(NamedTuple):
    before: State
    after: State


class History:
    """The steps up to a state, and those that were undone."""

    def __init__(self, state: State) -> None:
        self._known = state
        self._done: list[_Step] = []
        self._undone: list[_Step] = []

    def note(self, state: State, *, by_key: bool) -> None:
        """Take a state for a step, if it is one. by_key: whether a key made it, and not the mouse, time or a task."""
        if _differ(self._known, state, placed=by_key):
            self._done = [*self._done, _Step(self._known, state)][-MOST:]
            self._undone.clear()
        self._known = state

    def undo(self, state: State) -> State | None:
        """The state before the last step; None if there is none."""
        self.note(state, by_key=False)
        if not self._done:
            return None
        self._undone.append(self._done.pop())
        before, after = self._undone[-1]
        return self._moved(state, after, before)

    def redo(self, state: State) -> State | None:
        """The state after the step that was undone last; None if there is none."""
        self.note(state, by_key=False)
        if not self._undone:
            return None
        self._done.append(self._undone.pop())
        return self._moved(state, *self._done[-1])

    def back(self, state: State) -> None:
        """Take a state that is shown again, as what was asked for since could not be: steps away from it were none."""
        kept = [number for number, step in enumerate(self._done, 1) if not _differ(step.after, state, placed=False)]
        if kept or (self._done and not _differ(self._done[0].before, state, placed=False)):
            del self._done[kept[-1] if kept else 0 :]
        self._undone.clear()
        self._known = state

    def _moved(self, state: State, here: State, there: State) -> State:
        values = {name: value_of(there, name) for name in _differ(here, there, placed=True)}
        stopped = changed(state, **STOPPED, trace=(), message="", **values)
        self._known = replace(stopped, lights=there.lights, entry=there.entry)
        return self._known


def _differ(one: State, other: State, *, placed: bool) -> list[str]:
    """The fields of recipe and view in which two states differ, but for those that make no step."""
    if one is other:
        return []
    names = (name for name in (*sorted(IN_RECIPE), *STEPS) if placed or name not in PLACED)
    return [name for name in names if value_of(one, name) != value_of(other, name)]
