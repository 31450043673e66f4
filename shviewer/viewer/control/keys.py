"""The one table of keys: it drives the program and makes the help sheet, `--list-keys` and the key list of the guide.

Keys are names ("PageUp", "Shift+3"), so nothing here needs a window; desktop/glfw_window.py gives GLFW's keys these names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple, TypeVar

from shviewer.analysis.recipe import light_name
from shviewer.harmonics.quantities.names import in_words
from shviewer.limits import MAX_DIRECT_BANDS
from shviewer.viewer.control import actions as do
from shviewer.viewer.control.commands import Command
from shviewer.viewer.control.idle import as_it_was, not_there
from shviewer.viewer.control.placing import face_light
from shviewer.viewer.control.playing import toggle_sweep, turn_light
from shviewer.viewer.state import (
    State,
    changed,
    describe_basis,
    describe_camera,
    describe_exposure,
    describe_muted,
    describe_sanitizing,
    value_of,
)
from shviewer.words import grouped

ROUGHER = 0.05
"""A step of roughness."""

T = TypeVar("T")


class Binding(NamedTuple):
    """One row of the key table: its label, what each of its keys does, and its present value."""

    label: str
    help: str
    actions: Mapping[str, Command | Callable[[State], State | Command]]
    value: Callable[[State], str] = lambda state: ""


def _each(action: Callable[[State, T], State], values: Mapping[str, T]) -> dict[str, Callable[[State], State]]:
    """What keys do that share an action: each gives it a value of its own."""

    def with_value(value: T) -> Callable[[State], State]:
        return lambda state: action(state, value)

    return {key: with_value(value) for key, value in values.items()}


def _switch(
    key: str, help: str, name: str, words: tuple[str, str], action: Callable[[State], State] | None = None
) -> Binding:
    """The row of a key that turns something off and on, with a word for each. name: the field of recipe or view."""
    turn = action or partial(do.toggle, name=name)
    return Binding(key, help, {key: turn}, lambda state: words[bool(value_of(state, name))])


BINDINGS: dict[str, tuple[Binding, ...]] = {
    "Bands": (
        Binding(
            "Up / Down / + / -",
            "one band more, one fewer",
            _each(do.more_bands, {"Up": 1, "+": 1, "Down": -1, "-": -1}),
            lambda s: str(s.recipe.n_bands),
        ),
        Binding(
            "PageUp / PageDown", "four bands more, four fewer", _each(do.more_bands, {"PageUp": 4, "PageDown": -4})
        ),
        Binding("Home / End", "1 band, 32 bands", _each(do.with_bands, {"Home": 1, "End": MAX_DIRECT_BANDS})),
        Binding(
            "0-9",
            "mute or unmute that band",
            _each(do.toggle_band, {f"{band}": band for band in range(10)}),
            lambda s: describe_muted(s.recipe) or "none muted",
        ),
        Binding(
            "Shift+0-9",
            "that band alone; again: all",
            _each(do.solo_band, {f"Shift+{band}": band for band in range(10)}),
        ),
        Binding(
            ", / .",
            "cursor to the band before, after",
            _each(do.move_cursor, {",": -1, ".": 1}),
            lambda s: f"band {s.view.cursor}",
        ),
        Binding("Enter / click", "mute or unmute the band there", {"Enter": do.toggle_cursor}),
        Binding("T", "as many as the tolerance needs", {"T": Command.FIT}, lambda s: f"{100 * s.recipe.tolerance:g} %"),
        Binding("W", "window against ringing", {"W": do.next_window}, lambda s: s.recipe.window),
        Binding("A", "all bands on", {"A": partial(changed, muted=frozenset())}),
        Binding(
            "Space",
            "sweep from 1 band, stop",
            {"Space": toggle_sweep},
            lambda s: "" if s.view.sweep_to is None else f"to {s.view.sweep_to}",
        ),
    ),
    "Light": (
        Binding(
            "Left / Right",
            "light before, after",
            _each(do.next_light, {"Left": -1, "Right": 1}),
            lambda s: light_name(s.recipe.light),
        ),
        Binding("I", "radiance, irradiance or glossy", {"I": do.next_quantity}, lambda s: in_words(s.recipe.quantity)),
        Binding("K / Shift+K", "rougher, smoother surface", _each(do.rougher, {"K": ROUGHER, "Shift+K": -ROUGHER})),
        Binding("C", "irradiance as engines store it", {"C": do.next_encoding}, lambda s: s.view.encode or "bands"),
        _switch("J", "bands against roughness", "by_roughness", ("hidden", "shown"), do.toggle_by_roughness),
        _switch("U", "sun as a disc of its own", "split_sun", ("whole", "split")),
        Binding("M", "projection method", {"M": do.next_method}, lambda s: s.recipe.method),
        Binding(
            "S / Shift+S",
            "samples x 4, / 4",
            _each(do.scale_samples, {"S": 4, "Shift+S": 0.25}),
            lambda s: grouped(s.recipe.samples),
        ),
        Binding("Ctrl+R / F5", "read its file again", {"Ctrl+R": Command.RELOAD, "F5": Command.RELOAD}),
        Binding("L", "next layout of an image", {"L": do.next_layout}, lambda s: s.recipe.reading.layout),
        Binding("Z", "repair bad values or not", {"Z": do.toggle_sanitizing}, lambda s: describe_sanitizing(s.recipe)),
        Binding(
            "Q / Shift+Q",
            "turn it, fresh or same samples",
            _each(turn_light, {"Q": "fresh", "Shift+Q": "same"}),
            lambda s: s.view.turning or "still",
        ),
        Binding("right drag", "turn the light; Shift+drag, too", {}),
        Binding("drop files", "open them", {}),
    ),
    "Error": (
        Binding(
            "D",
            "third sphere: error, other ways",
            {"D": do.next_third},
            lambda s: s.view.error if s.view.beside == "off" else s.view.beside,
        ),
        _switch("X", "mark minimum, largest error", "marks", ("not marked", "marked")),
        Binding("Y", "look at the next mark", {"Y": Command.FACE_MARK}),
        _switch("B", "time against error so far", "sheet", ("hidden", "shown"), do.toggle_plane),
        Binding("mouse over", "values in that direction", {}),
    ),
    "Picture": (
        Binding(
            "E / Shift+E",
            "half a stop brighter, darker",
            _each(do.expose, {"E": 0.5, "Shift+E": -0.5}),
            lambda s: describe_exposure(s.view),
        ),
        Binding("N", "exposure from the light", {"N": do.auto_exposure}),
        Binding("O", "tone curve", _each(do.next_choice, {"O": "tone"}), lambda s: s.view.tone),
        _switch("V", "surfaces: radius shows magnitude", "lobe_view", ("spheres", "surfaces"), do.toggle_lobe_view),
        _switch("G", "the whole sphere as a map", "whole_sphere", ("spheres", "map"), do.toggle_whole_sphere),
        Binding(
            "Tab / Shift+Tab",
            "basis function after, before",
            _each(do.step_basis, {"Tab": 1, "Shift+Tab": -1}),
            lambda s: describe_basis(s.view) or "none",
        ),
        Binding("drag", "turn the spheres", {}, lambda s: describe_camera(s.view)),
        Binding("double click", "face that point", {}),
        Binding("scroll", "zoom, about the mouse", {}, lambda s: f"{s.view.zoom:.2f} ×"),
        Binding("middle drag", "move the spheres", {}),
        Binding("F", "face the light", {"F": face_light}),
        Binding("R", "all but the light as at the start", {"R": do.reset}),
    ),
    "Program": (
        Binding("P / Ctrl+S", "save this picture", {"P": Command.SAVE, "Ctrl+S": Command.SAVE}),
        Binding("Ctrl+C", "copy the command of this picture", {"Ctrl+C": Command.COPY}),
        Binding("Ctrl+Shift+C", "copy the coefficients", {"Ctrl+Shift+C": Command.COPY_COEFFICIENTS}),
        Binding("Ctrl+E", "write the coefficients", {"Ctrl+E": Command.EXPORT}),
        Binding("Ctrl+V", "open the file whose path is copied", dict.fromkeys(("Ctrl+V", "Ctrl+O"), Command.PASTE)),
        Binding(
            "Ctrl+Z / Ctrl+Y",
            "undo, do again",
            {"Ctrl+Z": Command.UNDO, "Ctrl+Y": Command.REDO, "Ctrl+Shift+Z": Command.REDO},
        ),
        Binding("F11", "full screen", {"F11": Command.FULL_SCREEN}),
        Binding("H / ? / F1", "this help", _each(do.toggle, dict.fromkeys(("H", "?", "F1"), "help_visible"))),
        Binding("Esc", "stop, close, leave full screen, quit", {"Esc": do.escape}),
        Binding("Ctrl+Q / Ctrl+W", "quit", dict.fromkeys(("Ctrl+Q", "Ctrl+W"), Command.CLOSE)),
    ),
}
"""The rows of each group."""

SYMBOLS = frozenset("+-,.?")
"""Keys that are bound by what they type, wherever a layout has it."""

ACTIONS = {key: action for rows in BINDINGS.values() for binding in rows for key, action in binding.actions.items()}


HELP_PAGES = {"PageDown": 1, "PageUp": -1}
"""What these keys do while the help is shown: they turn its pages."""


def press(state: State, key: str) -> State | Command:
    """The state after `key`, or what the key asks the session for; a key without a binding changes nothing.

    Any bound key takes a message away, and says why it changes nothing else.
    """
    if state.view.help_visible and key in HELP_PAGES:
        return do.turn_page(state, HELP_PAGES[key])
    action, asked = ACTIONS.get(key), changed(state, message="")
    if action is None:
        return state
    if isinstance(action, Command):
        return action
    if words := not_there(asked, key):
        return changed(asked, message=words)
    done = action(asked)
    return changed(asked, message=as_it_was(asked, key)) if done == asked else done


def key_table() -> str:
    """One line per row of the table, grouped: the text of `--list-keys` and of the guide."""
    return "\n\n".join(
        "\n".join([group, *(f"  {row.label:<20}{row.help}" for row in rows)]) for group, rows in BINDINGS.items()
    )
