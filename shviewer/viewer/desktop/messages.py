"""Messages of the window about a light and its file, in words that name the keys."""

from __future__ import annotations

from shviewer.analysis.recipe import Recipe
from shviewer.lights.find import split_light
from shviewer.lights.light import Light
from shviewer.lights.reading import Reading
from shviewer.viewer.message import Message, warning
from shviewer.viewer.state import describe_sanitizing


def with_keys(refusal: str, light: str | Light, reading: Reading) -> str:
    """A refusal of `light`, with the keys that do in the window what it recommends as an option of the command line.

    Where keys follow, the file is named without its folder, so that they are not cut off.
    """
    keys = []
    if "--sanitize" in refusal and not reading.sanitize:
        keys.append("Z repairs")
    if "--layout" in refusal:
        keys.append("L changes the layout")
    if not keys:
        return refusal
    path = split_light(light)[0] if isinstance(light, str) else None
    if path is not None and refusal.startswith(f"{path}: "):
        refusal = path.name + refusal.removeprefix(str(path))
    return f"{refusal}; {', '.join(keys)}"


def notes_of(light: Light) -> Message:
    """All notes of a light in one line, a warning; "" if there are none."""
    return warning(f"{light.name}: {'; '.join(light.notes)}" if light.notes else "")


def reading_news(before: Recipe, after: Recipe) -> str:
    """A message that says how files are read from now on; "" if that did not change."""
    if before.reading.layout != after.reading.layout:
        return f"layout {after.reading.layout}"
    if before.reading.sanitize != after.reading.sanitize:
        return f"bad values {describe_sanitizing(after)}"
    return ""
