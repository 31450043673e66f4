"""Answers to keys that depend on the picture: the bands that its light needs, and the marks on it."""

from __future__ import annotations

import numpy as np

from shviewer.analysis.figures import Needs
from shviewer.viewer.control.actions import with_bands
from shviewer.viewer.control.placing import face
from shviewer.viewer.overlay.directions.marks import marks_of
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import State, changed
from shviewer.words import counted


def fit(state: State, picture: Picture) -> State:
    """Use as many bands as the tolerance needs; where none are enough, say what is the best there is."""
    found = picture.needs
    assert isinstance(found, Needs), "the picture is not complete"
    if found.shown is not None:
        fitted = with_bands(state, found.shown)
        words = f"{counted(found.shown, 'band')} {'is' if found.shown == 1 else 'are'} what {100 * found.tolerance:g} % needs"
        return changed(state, message=words) if fitted == state else fitted
    message = f"no band count is within {100 * found.tolerance:g} %: {found.best_words}"
    return changed(with_bands(state, found.best_bands), message=message)


def face_mark(state: State, picture: Picture, faced: int) -> tuple[State, int]:
    """Turn the spheres so that the next mark is in front, when so many were; return how many were then, too."""
    marks = marks_of(picture)
    if not marks:
        message = "nothing is marked: X marks what is negative, D shows the error and marks where it is largest"
        return changed(state, message=message), faced
    faces = [face(state, picture.light_from_world.T @ mark.direction) for mark in marks]
    if all(_alike(one, state) for one in faces):
        return changed(
            state, message="the only mark is in front" if len(marks) == 1 else "the marks are in front"
        ), faced
    return faces[faced % len(faces)], faced + 1


def _alike(one: State, other: State) -> bool:
    """Whether two states look the same way, but for rounding."""
    here, there = ((*(state.view.camera or ()), *state.view.map_centre, *state.view.pan) for state in (one, other))
    return len(here) == len(there) and bool(np.allclose(here, there, rtol=0, atol=1e-6))
