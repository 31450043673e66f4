"""The one table of keys: it drives the program and makes the help sheet, `--list-keys` and the key list of the guide.

Keys are names ("PageUp", "Shift+3"), so nothing here needs a window; desktop/glfw_window.py gives GLFW's keys these names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from shviewer.analysis.recipe import light_name
from shviewer.limits import MAX_DIRECT_BANDS
from shviewer.viewer.actions import (
    EXPOSURE_STEP,
    Action,
    Command,
    auto_exposure,
    escape,
    expose,
    more_bands,
    move_cursor,
    next_error,
    next_layout,
    next_light,
    next_method,
    next_quantity,
    next_tone,
    next_window,
    reset,
    scale_samples,
    solo_band,
    step_basis,
    toggle_band,
    toggle_cursor,
    toggle_lobe_view,
    toggle_sanitizing,
    toggle_sheet,
    toggle_split,
    toggle_sweep,
    with_bands,
)
from shviewer.viewer.state import State, changed, describe_basis, describe_exposure, describe_muted, describe_sanitizing
from shviewer.viewer.view import CAMERA_HOME


class Binding(NamedTuple):
    """One row of the key table: its label, what each of its keys does, and its present value."""

    label: str
    group: str
    help: str
    actions: Mapping[str, Action | Command | Callable[[State], State | Command]]
    value: Callable[[State], str] = lambda state: ""


DIGITS = tuple("0123456789")
BANDS, LIGHT, ERROR, PICTURE, PROGRAM = "Bands", "Light", "Error", "Picture", "Program"

BINDINGS = (
    Binding(
        "Up / Down",
        BANDS,
        "one band more, one fewer",
        {"Up": more_bands(1), "Down": more_bands(-1)},
        lambda s: f"{s.recipe.n_bands}",
    ),
    Binding(
        "PageUp / PageDown", BANDS, "four bands more, four fewer", {"PageUp": more_bands(4), "PageDown": more_bands(-4)}
    ),
    Binding(
        "Home / End",
        BANDS,
        "1 band, 32 bands",
        {"Home": lambda s: with_bands(s, 1), "End": lambda s: with_bands(s, MAX_DIRECT_BANDS)},
    ),
    Binding(
        "0-9",
        BANDS,
        "mute or unmute that band",
        {digit: lambda s, band=int(digit): toggle_band(s, band) for digit in DIGITS},  # type: ignore[misc]
        lambda s: describe_muted(s.recipe) or "none muted",
    ),
    Binding(
        "Shift+0-9",
        BANDS,
        "that band alone; again: all",
        {f"Shift+{digit}": lambda s, band=int(digit): solo_band(s, band) for digit in DIGITS},  # type: ignore[misc]
    ),
    Binding(
        ", / .",
        BANDS,
        "cursor to the band before, after",
        {",": move_cursor(-1), ".": move_cursor(1)},
        lambda s: f"band {s.view.cursor}",
    ),
    Binding("Enter / click", BANDS, "mute or unmute the band there", {"Enter": toggle_cursor}),
    Binding(
        "T",
        BANDS,
        "as many as the tolerance needs",
        {"T": Command.FIT},
        lambda s: f"{100 * s.recipe.tolerance:g} %",
    ),
    Binding("W", BANDS, "window against ringing", {"W": next_window}, lambda s: s.recipe.window),
    Binding("A", BANDS, "all bands on", {"A": lambda s: changed(s, muted=frozenset())}),
    Binding(
        "Space",
        BANDS,
        "sweep from 1 band, stop",
        {"Space": toggle_sweep},
        lambda s: "" if s.view.sweep_to is None else f"to {s.view.sweep_to}",
    ),
    Binding(
        "Left / Right",
        LIGHT,
        "light before, after",
        {"Left": next_light(-1), "Right": next_light(1)},
        lambda s: light_name(s.recipe.light),
    ),
    Binding("I", LIGHT, "radiance or irradiance", {"I": next_quantity}, lambda s: s.recipe.quantity),
    Binding(
        "U",
        LIGHT,
        "sun as a disc of its own",
        {"U": toggle_split},
        lambda s: "split" if s.recipe.split_sun else "whole",
    ),
    Binding("M", LIGHT, "projection method", {"M": next_method}, lambda s: s.recipe.method),
    Binding(
        "S / Shift+S",
        LIGHT,
        "samples x 4, / 4",
        {"S": scale_samples(4), "Shift+S": scale_samples(0.25)},
        lambda s: f"{s.recipe.samples}",
    ),
    Binding("Ctrl+R / F5", LIGHT, "read its file again", dict.fromkeys(("Ctrl+R", "F5"), Command.RELOAD)),
    Binding("L", LIGHT, "next layout of an image", {"L": next_layout}, lambda s: s.recipe.reading.layout),
    Binding("Z", LIGHT, "repair bad values or not", {"Z": toggle_sanitizing}, lambda s: describe_sanitizing(s.recipe)),
    Binding("Shift+drag", LIGHT, "turn the light", {}),
    Binding("drop a file", LIGHT, "open it", {}),
    Binding("D", ERROR, "third sphere: the error", {"D": next_error}, lambda s: s.view.error),
    Binding(
        "X",
        ERROR,
        "mark minimum, largest error",
        {"X": lambda s: changed(s, marks=not s.view.marks)},
        lambda s: "marked" if s.view.marks else "not marked",
    ),
    Binding("Y", ERROR, "look at the next mark", {"Y": Command.FACE_MARK}),
    Binding(
        "G",
        ERROR,
        "error against bands",
        {"G": toggle_sheet("convergence")},
        lambda s: "shown" if s.view.sheet == "convergence" else "hidden",
    ),
    Binding(
        "B",
        ERROR,
        "time against error so far",
        {"B": toggle_sheet("plane")},
        lambda s: "shown" if s.view.sheet == "plane" else "hidden",
    ),
    Binding("mouse over", ERROR, "values in that direction", {}),
    Binding(
        "E / Shift+E",
        PICTURE,
        "half a stop brighter, darker",
        {"E": expose(EXPOSURE_STEP), "Shift+E": expose(-EXPOSURE_STEP)},
        lambda s: describe_exposure(s.view),
    ),
    Binding("N", PICTURE, "exposure from the light", {"N": auto_exposure}),
    Binding("O", PICTURE, "tone curve", {"O": next_tone}, lambda s: s.view.tone),
    Binding(
        "V",
        PICTURE,
        "surfaces: radius is magnitude",
        {"V": toggle_lobe_view},
        lambda s: "surfaces" if s.view.lobe_view else "spheres",
    ),
    Binding(
        "Tab / Shift+Tab",
        PICTURE,
        "basis function after, before",
        {"Tab": step_basis(1), "Shift+Tab": step_basis(-1)},
        lambda s: describe_basis(s.view) or "none",
    ),
    Binding("drag", PICTURE, "turn the spheres", {}, lambda s: f"{s.view.camera[0]:z.0f}, {s.view.camera[1]:z.0f} deg"),
    Binding("scroll", PICTURE, "zoom", {}, lambda s: f"{s.view.zoom:.2f} x"),
    Binding("F", PICTURE, "camera back", {"F": lambda s: changed(s, camera=CAMERA_HOME, zoom=1.0)}),
    Binding("R", PICTURE, "reset all but the light", {"R": reset}),
    Binding(
        "P / Ctrl+S",
        PROGRAM,
        "save this picture",
        dict.fromkeys(("P", "Ctrl+S"), Command.SAVE),
    ),
    Binding("F11", PROGRAM, "full screen", {"F11": Command.FULL_SCREEN}),
    Binding(
        "H / ?",
        PROGRAM,
        "this help",
        dict.fromkeys(("H", "?"), lambda s: changed(s, help_visible=not s.view.help_visible)),
    ),
    Binding("Esc", PROGRAM, "close what is open, then quit", {"Esc": escape}),
)

ACTIONS = {key: action for binding in BINDINGS for key, action in binding.actions.items()}


def press(state: State, key: str) -> State | Command:
    """The state after `key`, or what the key asks the session for; a key without a binding changes nothing.

    Any bound key takes a message away.
    """
    action = ACTIONS.get(key)
    if action is None:
        return state
    return action if isinstance(action, Command) else action(changed(state, message=""))


def key_table() -> str:
    """One line per row of the table, grouped: the text of `--list-keys` and of the guide."""
    lines: list[str] = []
    group = ""
    for binding in BINDINGS:
        if binding.group != group:
            group = binding.group
            lines += ([""] if lines else []) + [group]
        lines.append(f"  {binding.label:<20}{binding.help}")
    return "\n".join(lines)
