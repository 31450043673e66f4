"""The command line. What a mode needs is imported in its branch: --help and --version load neither numpy nor OpenGL.

numpy's matrix products get one thread, unless the environment says otherwise: ours are too small for more, and threads that
wait for each other on a busy machine take ten times as long.
"""

from __future__ import annotations

import argparse
import difflib
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from shviewer.errors import LightError, ShviewerError, UsageError
from shviewer.from_options import reading_from, state_from
from shviewer.options import (
    DEFAULT_BANDS,
    DEFAULT_SWEEP,
    info_parser,
    project_parser,
    report_parser,
    screenshot_parser,
    sweep_parser,
    view_parser,
)
from shviewer.status_line import status_line

if TYPE_CHECKING:
    from shviewer.viewer.state import ViewState
    from shviewer.viewer.subjects import Subject


THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code. argparse itself exits with 2 on arguments it cannot read."""
    for name in THREADS:
        os.environ.setdefault(name, "1")
    arguments = list(sys.argv[1:] if argv is None else argv)
    try:
        arguments = _meant(arguments)
        if arguments[:1] == ["screenshot"]:
            return _screenshot(screenshot_parser().parse_intermixed_args(arguments[1:]))
        if arguments[:1] == ["sweep"]:
            return _sweep(sweep_parser().parse_intermixed_args(arguments[1:]))
        if arguments[:1] == ["project"]:
            return _project(project_parser().parse_args(arguments[1:]))
        if arguments[:1] == ["report"]:
            return _report(report_parser().parse_args(arguments[1:]))
        if arguments[:1] == ["info"]:
            return _info(info_parser().parse_args(arguments[1:]))
        return _view(view_parser().parse_args(arguments))
    except ShviewerError as error:
        print(f"shviewer: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # nobody reads on, as in `shviewer --list-lights | head -1`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


MODES = ("screenshot", "sweep", "info", "project", "report")


def _meant(arguments: list[str]) -> list[str]:
    """The arguments; "help" is --help. UsageError for a first one that is nearly a mode, and no file."""
    first = arguments[0] if arguments else ""
    if first == "help":
        return ["--help", *arguments[1:]]
    near = difflib.get_close_matches(first, MODES, n=1, cutoff=0.75)
    if near and first not in MODES and not Path(first).exists():
        raise UsageError(f"{first!r} is neither a mode nor a light; did you mean shviewer {near[0]}?")
    return arguments


def _view(options: argparse.Namespace) -> int:
    if options.list_keys:
        from shviewer.viewer.keys import key_table

        print(key_table())
        return 0
    if options.list_lights:
        from shviewer.lights.light import built_in_lights, find_light

        for name in built_in_lights():
            print(f"{name:<20}{find_light(name).description}")
        return 0
    from shviewer.viewer import window
    from shviewer.viewer.composition import compose
    from shviewer.viewer.glfw_window import NoDisplayError
    from shviewer.viewer.picture import prepare
    from shviewer.viewer.picture_files import file_stem
    from shviewer.viewer.screenshot import save_picture
    from shviewer.viewer.subjects import subject

    state = state_from(options, all_lights=True)
    _print_notes(subject(state))
    _print_verdict(state)
    try:
        window.run(state, tuple(options.size), verbose=options.verbose, watch=options.watch)
    except NoDisplayError as error:
        out = Path(f"shviewer-{file_stem(subject(state).light.name)}.png")
        save_picture(
            prepare(state), compose(options.size[0], options.size[1], state.zoom, n_spheres=state.n_spheres), out
        )
        print(f"shviewer: {error}; wrote {out} instead", file=sys.stderr)
    return 0


def _screenshot(options: argparse.Namespace) -> int:
    from shviewer.viewer.composition import compose
    from shviewer.viewer.picture import prepare
    from shviewer.viewer.picture_files import compare_with_reference
    from shviewer.viewer.screenshot import save_picture

    if options.out.suffix.lower() not in (".png", ".exr"):
        raise UsageError(f"{options.out}: OUT must end in .png or .exr")
    if options.reference and options.out.suffix.lower() != ".png":
        raise UsageError(f"{options.out}: --reference compares PNG pictures; let OUT end in .png")
    if options.reference and options.reference.resolve() == options.out.resolve():
        raise UsageError(f"{options.out}: OUT and --reference are the same file; name another OUT")
    state = state_from(options, all_lights=False)
    if state.lobe_view and options.out.suffix.lower() == ".exr":
        raise UsageError(
            f"{options.out}: surfaces hold no radiance; let OUT end in .png, or leave out --lobes and --basis"
        )
    picture = prepare(state)
    composition = compose(options.size[0], options.size[1], state.zoom, n_spheres=state.n_spheres)
    pixels = save_picture(picture, composition, options.out, overlay=not options.no_overlay, timing=options.timing)
    _print_notes(picture.subject)
    _print_verdict(state)
    if options.reference is None or pixels is None:
        return 0
    difference = options.out.with_name(f"{options.out.stem}-difference.png")
    verdict = compare_with_reference(pixels, options.reference, difference, options.threshold)
    if verdict:
        print(f"shviewer: {verdict}", file=sys.stderr)
    return 1 if verdict else 0


def _sweep(options: argparse.Namespace) -> int:
    _check_sweep(options)
    from shviewer.viewer.animation import ENCODERS, TURN_FRAMES, TURN_SECONDS, band_sweep, save_animation, turntable
    from shviewer.viewer.composition import compose
    from shviewer.viewer.playing import SWEEP_SECONDS

    if options.out.suffix.lower() not in ENCODERS:
        raise UsageError(f"{options.out}: OUT must end in {' or '.join(ENCODERS)}")
    state = state_from(options, all_lights=False)
    if options.turntable:
        frames = TURN_FRAMES if options.frames is None else options.frames
        animation = turntable(state, frames, TURN_SECONDS if options.seconds is None else options.seconds)
    else:
        first = DEFAULT_SWEEP[0] if options.first is None else options.first
        last = DEFAULT_SWEEP[1] if options.last is None else options.last
        animation = band_sweep(state, first, last, SWEEP_SECONDS if options.seconds is None else options.seconds)
    composition = compose(options.size[0], options.size[1], state.zoom, n_spheres=state.n_spheres)
    with status_line() as line:
        picture = save_animation(
            animation,
            composition,
            options.out,
            overlay=not options.no_overlay,
            progress=line.fraction if line else None,
        )
    _print_notes(picture.subject)
    _print_verdict(state)
    return 0


def _check_sweep(options: argparse.Namespace) -> None:
    """UsageError for options that contradict each other."""
    if options.turntable:
        for name, value in (("--from", options.first), ("--to", options.last)):
            if value is not None:
                raise UsageError(f"{name} {value} with --turntable: a turn has one number of bands; give --bands")
        return
    if options.basis is not None:
        raise UsageError(
            "--basis: a sweep shows what each number of bands makes of the light; give --turntable, or --lobes"
        )
    if options.frames is not None:
        raise UsageError(f"--frames {options.frames}: a sweep has one for each band count; give --from and --to")
    if options.bands is not None:
        raise UsageError(f"--bands {options.bands}: a sweep goes through them; give --from and --to, or --turntable")
    if options.tolerance is not None:
        raise UsageError(
            f"--tolerance {options.tolerance:g}: a sweep goes through all bands; give --from and --to, or --turntable"
        )


def _info(options: argparse.Namespace) -> int:
    """Every light that can be read is described; the exit code is that of the first that cannot."""
    from shviewer.viewer.information import as_json_object, as_text, describe

    reading = reading_from(options)
    exit_code = 0
    objects: list[dict[str, object]] = []
    for number, text in enumerate(options.lights):
        refused: str | None = None
        try:
            found = describe(text, reading)
        except ShviewerError as error:
            refused, code = str(error), error.exit_code
            objects.append({"light_argument": text, "error": refused})
        else:
            refused, code = found.refused, LightError.exit_code
            objects.append(as_json_object(found))
            if not options.json:
                print(("\n" if number else "") + as_text(found), flush=True)
        if refused is not None:
            print(f"shviewer: {refused}", file=sys.stderr)
            exit_code = exit_code or code
    if options.json:
        print(json.dumps(objects, indent=2, allow_nan=False))
    return exit_code


def _project(options: argparse.Namespace) -> int:
    from shviewer.exchange.command import check_tolerance, project_lights, wanted_convention

    convention = wanted_convention(options.convention, options.axes, options.no_phase, options.quantity)
    if convention.quantity:
        options.quantity = convention.quantity.removesuffix("-over-pi")
    if options.bands is None and options.tolerance is None and convention.most_bands:
        options.bands = min(DEFAULT_BANDS, convention.most_bands)

    def state_of(light: str) -> ViewState:
        state = state_from(argparse.Namespace(**{**vars(options), "light": light}), all_lights=False)
        if options.tolerance is not None:
            check_tolerance(state, convention)
        return state

    lights = options.lights or ["green"]
    with status_line() as line:
        show = line.show if line else None
        return project_lights(lights, options.output, options.format, convention, state_of, show)


def _report(options: argparse.Namespace) -> int:
    if options.stability and not (
        options.lights or options.output or options.quick or options.peers or options.against
    ):
        return _stability(options)
    from shviewer.report.options import DEFAULT_BUDGET, Options
    from shviewer.report.run import write_report

    wanted = Options(
        budget=DEFAULT_BUDGET if options.budget is None else options.budget,
        quick=options.quick,
        against=options.against,
        stability=options.stability,
        peers=options.peers,
        seed=options.seed,
        methods=tuple(options.methods.split(",")) if options.methods else (),
        reading=reading_from(options),
        shader=not options.no_shader,
    )
    with status_line() as line:
        summary = write_report(
            options.lights,
            options.output or Path("shviewer-report"),
            wanted,
            progress=line.fraction if line else None,
        )
    print(summary.text)
    print(f"wrote {summary.rows} rows: {', '.join(str(summary.folder / name) for name in summary.files)}")
    return 1 if summary.stability_failed else 0


def _stability(options: argparse.Namespace) -> int:
    from shviewer import stability

    with status_line() as line:
        outcomes = stability.run(progress=line.show if line else None, shader=not options.no_shader)
    print(stability.as_text(outcomes))
    return 0 if all(outcome.passed for outcome in outcomes) else 1


def _print_notes(subject: Subject) -> None:
    for note in subject.light.notes:
        print(f"shviewer: note: {subject.light.name}: {note}", file=sys.stderr)
    if subject.refusal:
        print(f"shviewer: note: {subject.refusal}", file=sys.stderr)


def _print_verdict(state: ViewState) -> None:
    """How well coefficients that are compared agree, or by which usual mistake they are off."""
    from shviewer.viewer.comparison import verdict
    from shviewer.viewer.subjects import load_light

    if state.compare:
        print(f"shviewer: {verdict(load_light(state), state.compare)}", file=sys.stderr)
