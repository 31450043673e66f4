"""Opening a light in the window: a picture that this program saved is the state that it was saved from."""

from __future__ import annotations

from dataclasses import replace

from shviewer.lights.find import built_in_lights, split_light
from shviewer.viewer.message import WARNING, Message
from shviewer.viewer.saving.restoring import restored
from shviewer.viewer.state import State, changed, started

MOST_DROPPED = 100


def opened(state: State, *, as_image: bool) -> State:
    """The state of a light that was just chosen. LightError for a picture whose stamp cannot be read.

    as_image: whether pictures are images.
    """
    light = state.recipe.light
    if as_image or not isinstance(light, str) or light in built_in_lights():
        return state
    path, part = split_light(light)
    picture = None if part else restored(path, state.recipe.reading.limits)
    if picture is None:
        return state
    shown = replace(picture.state, lights=state.lights, entry=light)
    words = "; ".join(filter(None, (state.view.message, picture.said or picture.state.view.message)))
    message = Message(words, WARNING if picture.said else "")
    reading = replace(shown.recipe.reading, isolated=True)
    return started(changed(shown, reading=reading, sweep_to=None, message=message))


def skipped(names: list[str], reason: str) -> str:
    """The message about lights that could not be opened and are gone over."""
    return f"skipped {reason}" if len(names) == 1 else f"skipped {', '.join(names)}; the last: {reason}"
