"""`shviewer [LIGHT]`: the window, or its picture where there is no display."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from shviewer.cli.from_options import state_from

if TYPE_CHECKING:
    from shviewer.viewer.picture import Picture
    from shviewer.viewer.state import State


def run(options: argparse.Namespace) -> int:
    if options.list_keys:
        from shviewer.viewer.keys import key_table

        print(key_table())
        return 0
    if options.print_completion:
        from shviewer.cli.completion import completion

        print(completion(options.print_completion), end="")
        return 0
    if options.list_lights:
        from shviewer.lights.find import built_in_lights, find_light

        for name in built_in_lights():
            print(f"{name:<20}{find_light(name).description}")
        return 0
    from shviewer.analysis.subjects import subject
    from shviewer.outputs import file_stem
    from shviewer.viewer.composition import compose
    from shviewer.viewer.desktop import window
    from shviewer.viewer.desktop.glfw_window import NoDisplayError
    from shviewer.viewer.desktop.task import Task
    from shviewer.viewer.picture import completed
    from shviewer.viewer.saving.picture_files import write_numbered
    from shviewer.viewer.screenshot import save_picture

    state = state_from(options, all_lights=True)
    first = Task(lambda: [_announced(state)])
    try:
        window.run(first, options.size, verbose=options.verbose, watch=options.watch, as_image=options.as_image)
    except NoDisplayError as error:
        stem = f"shviewer-{file_stem(subject(state.recipe).light.name)}"
        composition = compose(options.size[0], options.size[1], state.view.zoom, n_spheres=state.view.n_spheres)
        picture = completed(first.result())
        out = write_numbered(stem, lambda out: save_picture(picture, composition, out, exclusive=True), first=0)
        print(f"shviewer: {error}; wrote {out} instead", file=sys.stderr)
    return 0


def _announced(state: State) -> Picture:
    """The picture of a state, its figures pending; the notes on its light are printed."""
    from shviewer.cli.notes import print_notes
    from shviewer.viewer.picture import first_picture

    picture = first_picture(state)
    print_notes(state.recipe)
    return picture
