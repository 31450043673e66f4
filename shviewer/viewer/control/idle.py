"""What is said where a key changes nothing: none does nothing without a word."""

from __future__ import annotations

from collections.abc import Callable

from shviewer.limits import MAX_BANDS
from shviewer.viewer.state import State
from shviewer.words import counted, grouped

OF_SPHERES = {"E": "exposure", "Shift+E": "exposure", "N": "exposure", "O": "tone curve", "X": "marks"}
"""Keys for what surfaces do not have."""


def not_there(state: State, key: str) -> str:
    """Why what a key changes is not there to be changed; "" if it is."""
    if state.view.lobe_view and key in OF_SPHERES:
        return f"surfaces have no {OF_SPHERES[key]}: V shows spheres"
    return ""


def as_it_was(state: State, key: str) -> str:
    """Why a key has left a state as it was; "" for a key that never does."""
    return _SAID[key](state) if key in _SAID else ""


def _bands(state: State) -> str:
    n_bands = state.recipe.n_bands
    if n_bands in (1, MAX_BANDS):
        return f"{counted(n_bands, 'band')} {'is the fewest' if n_bands == 1 else 'are the most'}"
    return f"{n_bands} bands are in use"


def _samples(state: State) -> str:
    samples = state.recipe.samples
    return f"{grouped(samples)} samples are the {'fewest' if samples < 1000 else 'most'}"


def _roughness(state: State) -> str:
    roughness = state.view.roughness
    return f"roughness {roughness:g} is the {'least' if roughness < 0.5 else 'most'}"


_SAID: dict[str, Callable[[State], str]] = {
    **dict.fromkeys(("Up", "Down", "+", "-", "PageUp", "PageDown", "Home", "End"), _bands),
    **dict.fromkeys((f"Shift+{band}" for band in range(10)), lambda state: "there is no other band"),
    **dict.fromkeys(("Left", "Right"), lambda state: "no other light is open: drop files on the window"),
    **dict.fromkeys(("K", "Shift+K"), _roughness),
    **dict.fromkeys(("S", "Shift+S"), _samples),
    **dict.fromkeys(("E", "Shift+E"), lambda state: "the exposure goes no further"),
    "A": lambda state: "no band is muted",
    "N": lambda state: "the exposure is that of the light",
    "F": lambda state: "the light is faced",
    "R": lambda state: "all is as at the start",
}
