"""`shviewer sweep OUT [LIGHT]`: an animation without a window."""

from __future__ import annotations

import argparse

from shviewer.cli.notes import print_notes, say_written
from shviewer.cli.options.inputs import check_out, replacing_of
from shviewer.cli.options.states import DEFAULT_SWEEP, has_overlay, size_of, state_from
from shviewer.cli.status_line import status_line
from shviewer.errors import UsageError
from shviewer.viewer.animation.animation import ENCODERS, band_sweep, save_animation, turntable
from shviewer.viewer.animation.metronome import SWEEP_SECONDS, TURN_FRAMES, TURN_SECONDS
from shviewer.viewer.animation.turning import light_turn
from shviewer.viewer.composing.composition import frame_for
from shviewer.viewer.state import describe_numbers


def run(options: argparse.Namespace) -> int:
    _check_sweep(options)
    check_out(options, "sweep", tuple(ENCODERS))
    state = state_from(options, all_lights=False)
    turns = options.turntable or options.turn_light
    frames = TURN_FRAMES if options.frames is None else options.frames
    seconds = options.seconds if options.seconds is not None else TURN_SECONDS if turns else SWEEP_SECONDS
    if options.turntable:
        animation = turntable(state, frames, seconds)
    elif options.turn_light:
        animation = light_turn(state, frames, seconds, fresh=options.seeds != "same")
    else:
        given = (options.first, options.last)
        first, last = (usual if n is None else n for n, usual in zip(given, DEFAULT_SWEEP, strict=True))
        animation = band_sweep(state, first, last, seconds)
    width, height = size_of(options)
    composition = frame_for(state.view, width, height)
    with status_line() as line:
        save_animation(
            animation,
            composition,
            options.out,
            overlay=has_overlay(options),
            progress=line.fraction if line else None,
            replacing=replacing_of(options),
        )
    print_notes(state.recipe)
    seconds, shown = sum(animation.milliseconds) / 1000, describe_numbers(animation.states[-1])
    if (first := animation.states[0].recipe.n_bands) != animation.states[-1].recipe.n_bands:
        shown = f"{first} to {shown}"
    say_written(options.out, f"{len(animation.states)} frames of {width} x {height}, {seconds:g} s, {shown}")
    return 0


def _check_sweep(options: argparse.Namespace) -> None:
    """UsageError for options that contradict each other."""
    if options.turntable and options.turn_light:
        raise UsageError("--turntable and --turn-light: one of them turns; leave out the other")
    if options.seeds and not options.turn_light:
        raise UsageError(f"--seeds {options.seeds}: it says how --turn-light draws its samples; give that, too")
    if options.turntable or options.turn_light:
        turning = "--turntable" if options.turntable else "--turn-light"
        for name, value in (("--from", options.first), ("--to", options.last)):
            if value is not None:
                raise UsageError(f"{name} {value} with {turning}: a turn has one number of bands; give --bands")
        return
    if options.basis is not None:
        raise UsageError(
            "--basis: a sweep shows what each number of bands makes of the light; give --turntable, or --lobes"
        )
    if options.encode:
        raise UsageError(f"--encode {options.encode}: a sweep goes through bands, which an encoding takes the place of")
    if options.frames is not None:
        raise UsageError(f"--frames {options.frames}: a sweep has one for each band count; give --from and --to")
    if options.n_bands is not None:
        raise UsageError(f"--bands {options.n_bands}: a sweep goes through them; give --from and --to, or --turntable")
    if options.tolerance is not None:
        raise UsageError(
            f"--tolerance {options.tolerance:g}: a sweep goes through all bands; give --from and --to, or --turntable"
        )
