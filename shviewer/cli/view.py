"""`shviewer [LIGHT ...]`: the window, or its picture where there is no display."""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import replace
from typing import TYPE_CHECKING

from shviewer.cli.options.inputs import lights_of, lights_within
from shviewer.cli.options.modes import MODES
from shviewer.cli.options.states import size_of, state_from
from shviewer.errors import LightError, UsageError

if TYPE_CHECKING:
    from shviewer.viewer.picture import Picture
    from shviewer.viewer.state import State


def run(options: argparse.Namespace) -> int:
    if options.list_keys:
        from shviewer.viewer.control.keys import key_table

        print(key_table())
        return 0
    if options.print_completion:
        from shviewer.cli.options.completion import completion

        print(completion(options.print_completion), end="")
        return 0
    if options.list_factors:
        print_factors(options.list_factors, options.n_bands)
        return 0
    if options.list_lights:
        from shviewer.lights.find import built_in_lights, find_light

        for name in built_in_lights():
            print(f"{name:<20}{find_light(name).description}")
        return 0
    from shviewer.outputs import file_stem
    from shviewer.viewer.composing.composition import frame_for
    from shviewer.viewer.desktop import window
    from shviewer.viewer.desktop.behind.task import Task
    from shviewer.viewer.desktop.glfw_window import NoDisplayError
    from shviewer.viewer.desktop.last_size import keep_size, last_size
    from shviewer.viewer.desktop.showing import Settings
    from shviewer.viewer.picture import completed
    from shviewer.viewer.saving.picture_files import write_numbered
    from shviewer.viewer.screenshot import save_picture

    if options.last_size:
        options.size = options.size or last_size()
    state, others = _opened(options)
    first = Task(lambda: [_announced(state, others, options.as_image)])
    try:
        closed = window.run(first, size_of(options), Settings(options.verbose, options.watch, options.as_image))
        if options.last_size and closed is not None:
            keep_size(closed)
    except NoDisplayError as error:
        picture = completed(first.result())
        stem = f"shviewer-{file_stem(picture.light.name)}"
        composition = frame_for(picture.state.view, *size_of(options))
        out = write_numbered(stem, lambda out: save_picture(picture, composition, out, exclusive=True), first=0)
        print(f"shviewer: {error}; wrote {out} instead", file=sys.stderr)
    return 0


def print_factors(quantity: str, n_bands: int | None) -> None:
    """Print as CSV what a quantity multiplies each band of the radiance by. UsageError for one that there is not."""
    from shviewer.analysis.recipe import Recipe
    from shviewer.harmonics.quantities.kernels import kernel_of
    from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS
    from shviewer.limits import MAX_DIRECT_BANDS

    Recipe(quantity=quantity).check()
    n_bands = MAX_DIRECT_BANDS if n_bands is None else n_bands
    if not 1 <= n_bands <= MAX_SEPARABLE_BANDS:
        raise UsageError(f"{n_bands} bands: --list-factors knows those of 1 to {MAX_SEPARABLE_BANDS}")
    print("l,factor")
    for l, factor in enumerate(kernel_of(quantity).factors(n_bands).tolist()):
        print(f"{l},{factor + 0.0!r}")


def _opened(options: argparse.Namespace) -> tuple[State, list[str]]:
    """The state of the first light that can be opened, and those to go on to if it turns out that it cannot."""
    given = lights_of(options)
    for mode in MODES:
        if mode in given and not os.path.exists(mode):
            raise UsageError(f"{mode!r} is a mode, and comes first: shviewer {mode}, then options and what it reads")
    lights = list(dict.fromkeys(lights_within(options)))
    if lights == given and len(given) == 1:
        return state_from(options, all_lights=True), []
    bad: list[str] = []
    for light in lights:
        options.lights = [light]
        vars(options).pop("pictured", None)
        try:
            state = state_from(options, all_lights=True)
        except LightError as error:
            bad.append(light)
            if len(bad) == len(lights):
                raise
            print(f"shviewer: {error}; skipped", file=sys.stderr)
            continue
        left = tuple(one for one in lights if one not in bad)
        return replace(state, lights=left), list(left[1:])
    raise AssertionError


def _announced(state: State, others: list[str], as_image: bool) -> Picture:
    """The picture of a state, its figures pending, or of the first of the others; the notes on its light are printed."""
    from shviewer.cli.notes import print_notes
    from shviewer.viewer.control.actions import show_light
    from shviewer.viewer.desktop.behind.opening import opened
    from shviewer.viewer.picture import first_picture

    while True:
        try:
            picture = first_picture(opened(state, as_image=as_image) if state.entry is None else state)
            break
        except LightError as error:
            if not others:
                raise
            print(f"shviewer: {error}; skipped", file=sys.stderr)
            left = tuple(light for number, light in enumerate(state.lights) if number != state.place)
            state = replace(show_light(state, others.pop(0)), lights=left)
    print_notes(picture.state.recipe)
    return picture
