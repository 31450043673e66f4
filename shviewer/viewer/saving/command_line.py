"""The command line that makes the picture of a state: what Ctrl+C copies."""

from __future__ import annotations

import os
import shlex
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from shviewer.analysis.options import Option, options_of
from shviewer.analysis.recipe import OF_SAMPLES, Recipe, idle
from shviewer.errors import UsageError
from shviewer.lights.find import built_in_lights, file_of, split_light
from shviewer.lights.light import Light
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.outputs import file_stem
from shviewer.viewer.camera import IDENTITY, Quaternion, azimuth_elevation_roll
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.restoring import is_session
from shviewer.viewer.state import State

MEBI = 2**20


def command_line(picture: Picture, size: tuple[int, int]) -> str:
    """The command, quoted for the shell of this system. UsageError for a light that no text can name."""
    out = f"shviewer-{file_stem(picture.light.name)}.png"
    words = ["shviewer", "screenshot", out, *arguments_of(picture.state, size)]
    return subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)


def arguments_of(state: State, size: tuple[int, int]) -> list[str]:
    """LIGHT and the options of a state, but for what only keys show: help, cursor, the time-error plane, what plays.

    Files are named by their whole path, so that the command can be given anywhere.
    """
    recipe, view = state.recipe, state.view
    words = [*_light(recipe.light), "--bands", str(recipe.n_bands)]
    if recipe.light not in built_in_lights() or recipe.compare or recipe.quantity != Recipe.quantity:
        words += ["--for", recipe.quantity]  # of coefficients, it would be that of their file
    if recipe.compare is not None:
        words += ["--compare", _path(recipe.compare)]
    sampled = OF_SAMPLES if view.beside == "method" else ()
    without = [name for name in idle(recipe, options_of(Recipe)) if name not in (*sampled, "muted")]
    for holder in (recipe, view):
        for row in options_of(type(holder)).values():
            if row.name not in ("n_bands", "quantity", *without) and row.flag:
                value = frozenset(recipe.muted_shown) if row.name == "muted" else getattr(holder, row.name)
                words += _option(row, value, recipe)
    words += [*_reading(recipe.reading), *_turn(view.light_rotation)]
    if recipe.turn is not None:
        words.append("--anew")
    words += ["--size", *map(str, size)]
    return words


def _option(row: Option, value: Any, recipe: Recipe) -> Iterator[str]:
    """An option, if it is not as it would be without it. Numbers are written in full, and never with an exponent."""
    if value == row.default:
        return
    if row.const is not None:
        yield from [row.flag] if value == row.const else []
    elif isinstance(value, tuple):
        yield from (row.flag, *map(_number, value))
    elif row.name == "window":
        yield f"{row.flag}={value}" + (f":{_number(recipe.window_width)}" if recipe.window_width else "")
    elif isinstance(value, frozenset):
        yield f"{row.flag}={','.join(map(str, sorted(value)))}"
    else:
        yield f"{row.flag}={value if isinstance(value, str) else _number(value)}"


def _number(value: float) -> str:
    """With a point, so that argparse takes no negative number for an option."""
    return str(value) if isinstance(value, int) else np.format_float_positional(value, trim="0")


def _light(light: str | Light) -> list[str]:
    if not isinstance(light, str):
        raise UsageError(f"{light.name} is an object of Python, which no command line can name: P saves the picture")
    if light in built_in_lights():
        return [light]
    path, part = split_light(light)
    words = [os.path.abspath(path) + (f":{part}" if part else "")]
    return [*words, "--as-image"] if not part and is_session(path) else words


def _path(light: Light) -> str:
    path: Path | None = file_of(light)
    if path is None:
        raise UsageError(
            f"{light.name}, which is compared, is no file that a command line can name: P saves the picture"
        )
    return str(path)


def _reading(reading: Reading) -> Iterator[str]:
    own, usual = reading.limits, DEFAULT_READING.limits
    if reading.sanitize:
        yield "--sanitize"
    for flag, value, default in (
        ("--layout", reading.layout, DEFAULT_READING.layout),
        ("--convention", reading.convention, ""),
        ("--max-side", own.side, usual.side),
        ("--max-megatexels", own.texels / MEBI, usual.texels / MEBI),
        ("--max-file-mib", own.file_bytes / MEBI, usual.file_bytes / MEBI),
    ):
        if value != default:
            yield f"{flag}={value if isinstance(value, str) else _number(value)}"


def _turn(rotation: Quaternion) -> Iterator[str]:
    if rotation != IDENTITY:
        azimuth, elevation, roll = azimuth_elevation_roll(rotation)
        yield from ("--rotate-light", _number(azimuth), _number(elevation), f"--roll-light={_number(roll)}")
