"""--compare FILE: coefficients to be compared with the light's own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from shviewer.errors import LightError
from shviewer.lights.coefficients.light import CoefficientLight
from shviewer.lights.light import COEFFICIENT_SUFFIXES, IMAGE_SUFFIXES, built_in_lights
from shviewer.viewer.state import ViewState


def compared_with(state: ViewState, text: str) -> ViewState:
    """The state, comparing with the coefficients in the file `text`. LightError if it is bad or no coefficient file."""
    file = Path(text)
    if file.suffix.lower() not in COEFFICIENT_SUFFIXES:
        raise LightError(
            f"{text} is {_kind(text)}; --compare takes coefficients ({', '.join(COEFFICIENT_SUFFIXES)}): shviewer project "
            "makes them of a light"
        )
    return replace(state, compare=replace(CoefficientLight.read(file, state.reading), name=file.name))


def _kind(text: str) -> str:
    if text in built_in_lights():
        return "a built-in light"
    if Path(text).suffix.lower() in IMAGE_SUFFIXES:
        return "an image"
    return "a scene" if Path(text).suffix.lower() == ".toml" else "no coefficient file"
