"""Which light a state shows, which of it is projected, and which file it came from. A light named by text is read once."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, replace

from shviewer.analysis.cache import MEMORY, remember
from shviewer.errors import LightError
from shviewer.files import FileVersion
from shviewer.lights.find import built_in_lights, file_version, find_light
from shviewer.lights.light import Light, Split
from shviewer.lights.suns.sun import Sun
from shviewer.viewer.state import ViewState


@dataclass(frozen=True, eq=False)
class Subject:
    """What is shown as the original, and what is projected: the same, unless suns are split off."""

    whole: Light
    light: Light
    """What the figures are of."""
    suns: tuple[Sun, ...] = ()
    refusal: str = ""
    """Why nothing was split off although it was asked for."""


def subject(state: ViewState) -> Subject:
    """Of the state's light, or of its irradiance; a light named by text is read once."""
    light = state.light
    if isinstance(light, str):
        light = MEMORY.named(_name(state)) or read_again(state)
    found = Subject(light, light)
    if state.split_sun:
        split = _split(light)
        found = replace(found, refusal=split) if isinstance(split, str) else Subject(light, split.rest, split.suns)
    if state.quantity == "irradiance":
        return replace(found, whole=irradiance_of(found.whole), light=irradiance_of(found.light))
    return found


def load_light(state: ViewState) -> Light:
    """The light that is projected."""
    return subject(state).light


def read_again(state: ViewState) -> Light:
    """The light that the state names, read anew. LightError leaves what was known of it as it was.

    A light that is not named by a text is what it is.
    """
    if not isinstance(state.light, str):
        return state.light
    read = file_version(state.light)  # before: what is written during the reading is a later change
    safe = state.light in built_in_lights()
    light = find_light(state.light, replace(state.reading, isolated=False) if safe else state.reading)
    MEMORY.name(_name(state), light)
    MEMORY.results(light, file_version)[None] = read
    return light


def keep_light(state: ViewState, light: Light) -> None:
    """Let the state's text go on meaning `light`, whatever its file holds by now."""
    if isinstance(state.light, str):
        MEMORY.name(_name(state), light)


def version_read(state: ViewState) -> FileVersion | None:
    """The version that the file of the state's light had when it was read; None if that is not known."""
    light = MEMORY.named(_name(state))
    found: FileVersion | None = MEMORY.results(light, file_version).get(None) if light is not None else None
    return found


def _name(state: ViewState) -> Hashable:
    return state.light, state.reading


@remember(most=1)
def _split(light: Light) -> Split | str:
    """The light and its suns apart, or why it has none."""
    try:
        split = light.split_suns()
    except LightError as error:
        return str(error)
    MEMORY.belongs(split.rest, light)
    return split


@remember(most=4)
def irradiance_of(light: Light) -> Light:
    """Asked of the whole and of its rest, and of the irradiance of each, which is its own."""
    return light.irradiance()
