"""Messages of the window about a light and its file, in words that name the keys."""

from __future__ import annotations

from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import Subject
from shviewer.lights.find import split_light
from shviewer.lights.light import Light
from shviewer.lights.reading import Reading
from shviewer.viewer.message import Message, warning
from shviewer.viewer.state import describe_sanitizing


def with_keys(refusal: str, light: str | Light, shown: Reading) -> str:
    """A refusal of `light`, with the keys that do in the window what it recommends as an option of the command line.

    Where keys stand, the file is named without its folder, so that they are not cut off. shown: how the picture was read
    that stays.
    """
    said = refusal.replace("choose another --layout", "press L for another layout")
    said = said.replace("--sanitize repairs them", "they stay repaired" if shown.sanitize else "Z repairs them")
    path = split_light(light)[0] if isinstance(light, str) else None
    if said != refusal and path is not None and said.startswith(f"{path}: "):
        said = path.name + said.removeprefix(str(path))
    return said


def notes_of(light: Light) -> Message:
    """All notes of a light in one line, a warning; "" if there are none."""
    return warning(f"{light.name}: {'; '.join(light.notes)}" if light.notes else "")


def why_whole(subject: Subject) -> Message:
    """Why a light has no sun apart that should have one, without the rule; "" where that is not so."""
    return warning(subject.refusal.partition(";")[0])


def reading_news(before: Recipe, after: Recipe, light: Light) -> str:
    """A message that says how files are read from now on, and whether that is anything to `light`; "" if nothing changed."""
    if before.reading.layout != after.reading.layout:
        return f"layout {after.reading.layout}"
    if before.reading.sanitize != after.reading.sanitize:
        return f"bad values {describe_sanitizing(after)}{'' if light.notes else ': there are none'}"
    return ""
