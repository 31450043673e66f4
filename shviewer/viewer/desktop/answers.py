"""Answers to keys that depend on the picture: the bands that its light needs, and the marks on it."""

from __future__ import annotations

from shviewer.analysis.figures import Needs
from shviewer.viewer.actions import with_bands
from shviewer.viewer.overlay.directions.marks import marks_of
from shviewer.viewer.picture import Picture
from shviewer.viewer.placing import face
from shviewer.viewer.state import State, changed


def fit(state: State, picture: Picture) -> State:
    """Use as many bands as the tolerance needs; where none are enough, say what is the best there is."""
    found = picture.needs
    assert isinstance(found, Needs), "the picture is not complete"
    if found.shown is not None:
        return with_bands(state, found.shown)
    message = f"no band count is within {100 * found.tolerance:g} %: {found.best_words}"
    return changed(with_bands(state, found.best_bands), message=message)


def face_mark(state: State, picture: Picture, faced: int) -> tuple[State, int]:
    """Turn the spheres so that the next mark is in front, when so many were; return how many were then, too."""
    marks = marks_of(picture)
    if not marks:
        message = "nothing is marked: X marks what is negative, D shows the error and marks where it is largest"
        return changed(state, message=message), faced
    return face(state, picture.light_from_world.T @ marks[faced % len(marks)].direction), faced + 1
