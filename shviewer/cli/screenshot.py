"""`shviewer screenshot OUT [LIGHT]`: the picture without a window."""

from __future__ import annotations

import argparse
import sys

from shviewer.cli.notes import print_notes, say_written
from shviewer.cli.options.inputs import check_out, replacing_of
from shviewer.cli.options.states import has_overlay, size_of, state_from
from shviewer.cli.status_line import speaking
from shviewer.errors import UsageError
from shviewer.viewer.composing.composition import frame_for
from shviewer.viewer.picture import prepare
from shviewer.viewer.saving.reference import compare_with_reference
from shviewer.viewer.saving.sphere_maps import write_sphere_map
from shviewer.viewer.screenshot import save_picture
from shviewer.viewer.state import describe_numbers


def run(options: argparse.Namespace) -> int:
    check_out(options, "screenshot", (".png", ".exr"))
    kind = options.out.suffix.lower()
    if options.reference and kind != ".png":
        raise UsageError(f"{options.out}: --reference compares PNG pictures; let OUT end in .png")
    if options.reference and options.reference.resolve() == options.out.resolve():
        raise UsageError(f"{options.out}: OUT and --reference are the same file; name another OUT")
    difference = options.out.with_name(f"{options.out.stem}-difference.png")
    replacing = replacing_of(options)
    replacing.check(options.out)
    if options.reference:
        replacing.check(difference)
    with speaking():
        state = state_from(options, all_lights=False)
    if state.view.lobe_view and kind == ".exr":
        raise UsageError(
            f"{options.out}: surfaces hold no radiance; let OUT end in .png, or leave out --lobes and --basis"
        )
    whole = state.view.whole_sphere and kind == ".exr"
    (width, height), overlay = size_of(options), has_overlay(options)
    if whole and width != 2 * height:
        raise UsageError(
            f"--size {width} {height}: a map is twice as wide as high; give --size {width} {width // 2} or leave it out"
        )
    with speaking():
        picture = prepare(state, written=overlay)
    pixels = None
    if whole:
        write_sphere_map(picture, width, options.out)
    else:
        composition = frame_for(state.view, width, height)
        pixels = save_picture(picture, composition, options.out, overlay=overlay, timing=options.timing)
    print_notes(state.recipe)
    say_written(options.out, f"{width} x {height}, {describe_numbers(state)}")
    if options.reference is None or pixels is None:
        return 0
    verdict = compare_with_reference(pixels, options.reference, difference, options.threshold)
    if verdict:
        print(f"shviewer: {verdict}", file=sys.stderr)
    return 1 if verdict else 0
