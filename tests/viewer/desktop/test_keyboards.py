"""Keys on other keyboards than the American: letters by what they type, or by their place where no Latin ones are."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from functools import cache

import pytest
from helpers import unavailable
from viewer.desktop.desktop import PATIENCE, missing_programs, virtual_display

SCRIPT = """
import glfw, json, os, subprocess, sys, time
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.state import state_of

typed = json.loads(sys.argv[1])
pressed, downs = [], []
with window.open_window((320, 160)) as handle:
    shown = window_of(handle, state_of())
    shown.press = pressed.append
    on_key = shown._on_key

    def hear(window, code, scancode, action, modifiers):
        on_key(window, code, scancode, action, modifiers)
        if action == glfw.RELEASE:
            downs.append(code)

    glfw.set_key_callback(handle, hear)
    name = subprocess.run(["xdotool", "search", "--sync", "--pid", str(os.getpid())], capture_output=True, text=True).stdout
    subprocess.run(["xdotool", "windowfocus", name.split()[0]], check=True)
    for layout, keys in typed.items():
        subprocess.run(["setxkbmap", *layout.split()], check=True)
        found = {}
        for key in keys:
            pressed.clear(), downs.clear()
            subprocess.run(["xdotool", "key", key], check=True)
            end = time.monotonic() + 60
            wanted = key.count("+") + 1
            while len(downs) < wanted and time.monotonic() < end:
                glfw.wait_events_timeout(0.05)
            glfw.poll_events()
            found[key] = [one for one in pressed if one in window.ACTIONS]
        print(json.dumps([layout, found]))
"""

PLACES = {
    "Q": "24", "W": "25", "E": "26", "R": "27", "T": "28", "Y": "29", "U": "30", "I": "31", "O": "32", "P": "33",
    "A": "38", "S": "39", "D": "40", "F": "41", "G": "42", "H": "43",
    "Z": "52", "X": "53", "C": "54", "V": "55", "B": "56", "N": "57", "M": "58",
}  # fmt: skip
"""Keycodes of the keys that have these letters on an American keyboard."""

BOUND = "QWTYUIOPASDFGHZXVBNMER"
"""Letters that do something."""


def letters(change: dict[str, str] | None = None) -> dict[str, list[str]]:
    """Keycode -> the key of the table that is pressed; change: by the American letter, where a layout has another one."""
    change = change or {}
    return {PLACES[place]: [change.get(place, place)] for place in BOUND if change.get(place, place) in BOUND}


LAYOUTS: dict[str, dict[str, list[str]]] = {
    "us": {**letters(), "21": [], "shift+21": ["+"], "20": ["-"], "59": [","], "60": ["."], "shift+61": ["?"], "10": ["1"]},
    "de": {**letters({"Y": "Z", "Z": "Y"}), "35": ["+"], "61": ["-"], "shift+20": ["?"], "47": [], "11": ["2"]},
    "fr": {**letters({"A": "Q", "Q": "A", "Z": "W", "W": "Z", "M": ","}), "47": ["M"], "10": ["1"], "shift+10": ["Shift+1"],
           "shift+21": ["+"], "15": ["6"], "shift+59": ["."], "82": ["-"], "86": ["+"]},
    "ru": {**letters(), "16": ["7"], "shift+16": ["Shift+7"], "61": ["."],
           "ctrl+54": ["Ctrl+C"], "ctrl+shift+54": ["Ctrl+Shift+C"],
           "ctrl+24": ["Ctrl+Q"], "59": [], "shift+21": ["+"], "20": ["-"]},
    "gr": {**letters(), "ctrl+25": ["Ctrl+W"], "ctrl+39": ["Ctrl+S"], "59": [","], "60": ["."]},
    "us,ru -option grp:toggle": {"25": ["W"]},
}  # fmt: skip
"""Arguments of setxkbmap: keycodes, with modifiers, and what they do."""


@cache
def found_on() -> dict[str, dict[str, list[str]]]:
    """What each key did on each layout: one window on a screen of its own hears them all."""
    typed = {layout: list(keys) for layout, keys in LAYOUTS.items()}
    with virtual_display() as display:
        environment = {**os.environ, "DISPLAY": display, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT, json.dumps(typed)],
            env=environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=2 * PATIENCE,
        )
    assert done.returncode == 0, done.stderr
    return dict(json.loads(line) for line in done.stdout.splitlines())


@pytest.fixture(scope="module", autouse=True)
def keyboards() -> None:
    missing = missing_programs() + [name for name in ("setxkbmap", "xkbcomp") if shutil.which(name) is None]
    if missing:
        unavailable(f"tests of keyboards need {' and '.join(missing)} (apt-get install -y xvfb xdotool x11-xkb-utils)")


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_key_does_what_its_letter_says_or_its_place_where_there_are_no_latin_letters(layout: str) -> None:
    assert found_on()[layout] == LAYOUTS[layout]
