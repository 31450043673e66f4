"""The command line. What a mode needs is imported in its branch: --help and --version load neither numpy nor OpenGL."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from shviewer import __version__
from shviewer.errors import OutputError, ShviewerError, UsageError

if TYPE_CHECKING:
    from shviewer.viewer.state import ViewState

EXIT_CODES = """exit codes:
  0    done
  1    --reference: the picture differs; --stability: a case failed
  2    bad arguments
  3    a light that is unknown, unreadable or damaged
  4    a file that could not be written
  5    no OpenGL 3.3, or no EGL
  6    a shader that does not compile
  130  interrupted"""

DEFAULT_BANDS = 5

LIGHT_HELP = "a built-in name (--list-lights), a .toml scene, a .hdr or .exr lat-long image, or file.py:function"


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code. argparse itself exits with 2 on arguments it cannot read."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    try:
        if arguments[:1] == ["screenshot"]:
            return _screenshot(screenshot_parser().parse_args(arguments[1:]))
        if arguments[:1] == ["report"]:
            return _report(report_parser().parse_args(arguments[1:]))
        return _view(view_parser().parse_args(arguments))
    except ShviewerError as error:
        print(f"shviewer: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        return 130


def view_parser() -> argparse.ArgumentParser:
    """shviewer [LIGHT]: the window."""
    parser = argparse.ArgumentParser(
        prog="shviewer",
        usage="shviewer [LIGHT] [options]\n"
        "       shviewer screenshot OUT [LIGHT] [options]\n"
        "       shviewer report --stability [-o DIR]",
        description="Show a light beside its spherical-harmonic reconstruction. Without a display, write the picture instead.",
        epilog=f"{EXIT_CODES}\n\nkeys and mouse: shviewer --list-keys\npictures without a window: shviewer screenshot --help",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    _add_view_options(parser)
    parser.add_argument("--verbose", action="store_true", help="one line on stderr per frame")
    parser.add_argument("--list-keys", action="store_true", help="print the table of keys and exit")
    parser.add_argument("--list-lights", action="store_true", help="print the built-in lights and exit")
    parser.add_argument("--version", action="version", version=f"shviewer {__version__}")
    return parser


def screenshot_parser() -> argparse.ArgumentParser:
    """shviewer screenshot OUT [LIGHT]: a picture without a window."""
    parser = argparse.ArgumentParser(
        prog="shviewer screenshot",
        description="Write the picture without a window or a display. The same arguments give the same bytes.",
        epilog=EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "out", metavar="OUT", type=Path, help="OUT.png: the picture; OUT.exr: linear float32 radiance of both spheres"
    )
    _add_view_options(parser)
    parser.add_argument("--no-overlay", action="store_true", help="the two spheres alone")
    parser.add_argument(
        "--timing", action="store_true", help="also say how long the projection took; then no two runs are equal"
    )
    parser.add_argument(
        "--reference",
        metavar="REF.png",
        type=Path,
        help="compare with a picture; exit 1 and write OUT-difference.png if it differs",
    )
    parser.add_argument(
        "--threshold",
        metavar="T",
        type=_share,
        default=0.001,
        help="share of the pixels, 0 to 1, that may differ from the reference by more than 2/255 (default 0.001)",
    )
    return parser


def report_parser() -> argparse.ArgumentParser:
    """shviewer report: measurements of the program itself."""
    parser = argparse.ArgumentParser(
        prog="shviewer report",
        description="Measure the program on this machine. --stability runs every hard numerical case against its known answer.",
        epilog=EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--stability", action="store_true", required=True, help="the hard cases; exit 1 if one fails")
    parser.add_argument(
        "-o", "--output", metavar="DIR", type=Path, help="also write stability.md and stability.json into this folder"
    )
    parser.add_argument("--no-shader", action="store_true", help="only the float64 columns; needs no OpenGL")
    return parser


def _add_view_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("light", metavar="LIGHT", nargs="?", default="green", help=f"{LIGHT_HELP} (default green)")
    parser.add_argument("--bands", metavar="N", type=int, help="number of bands, 1 to 128 (default 5)")
    parser.add_argument(
        "--tolerance",
        metavar="T",
        type=_tolerance,
        help="as many bands as keep the relative L2 error within T, such as 5%% or 0.05, instead of --bands",
    )
    parser.add_argument(
        "--for",
        metavar="WHAT",
        dest="quantity",
        default="radiance",
        help="radiance (default), or irradiance: what a white Lambertian surface receives",
    )
    parser.add_argument(
        "--window",
        metavar="W[:WIDTH]",
        default="none",
        help="none, hann, lanczos, gauss (WIDTH in bands, default N) or dering",
    )
    parser.add_argument(
        "--mute", metavar="L,L", type=_band_list, default=frozenset(), help="bands to leave out, such as 1,3"
    )
    parser.add_argument(
        "--method", metavar="M", default="best", help="best (of this light), jittered (the paper's) or gauss-legendre"
    )
    parser.add_argument(
        "--samples", metavar="K", type=int, default=10_000, help="of the sampled methods (default 10000)"
    )
    parser.add_argument("--seed", metavar="S", type=int, default=0, help="of the jittered samples (default 0)")
    parser.add_argument("--exposure", metavar="STOPS", type=_finite, help="fixed, instead of chosen from the light")
    parser.add_argument(
        "--camera", metavar=("AZIMUTH", "ELEVATION"), nargs=2, type=_finite, help="where the camera stands, degrees"
    )
    parser.add_argument(
        "--rotate-light",
        metavar=("AZIMUTH", "ELEVATION"),
        nargs=2,
        type=_finite,
        help="turn the light so that its +x axis points there, degrees",
    )
    parser.add_argument(
        "--zoom", metavar="Z", type=_finite, default=1.0, help="size of the spheres, 0.25 to 16 (default 1)"
    )
    parser.add_argument(
        "--size", metavar=("W", "H"), nargs=2, type=int, default=(1280, 640), help="pixels (default 1280 640)"
    )
    parser.add_argument(
        "--sanitize",
        action="store_true",
        help="repair NaN, infinite and negative texels of an image instead of refusing or keeping them",
    )


def _view(options: argparse.Namespace) -> int:
    if options.list_keys:
        from shviewer.viewer.state import key_table

        print(key_table())
        return 0
    if options.list_lights:
        from shviewer.lights.light import built_in_lights, find_light

        for name in built_in_lights():
            print(f"{name:<20}{find_light(name).description}")
        return 0
    from shviewer.viewer import window
    from shviewer.viewer.composition import compose
    from shviewer.viewer.picture import load_light, prepare
    from shviewer.viewer.screenshot import save_picture

    state = _state(options, all_lights=True)
    _print_notes(load_light(state).notes)
    try:
        window.run(state, tuple(options.size), verbose=options.verbose)
    except window.NoDisplayError as error:
        out = Path(f"shviewer-{window.file_stem(load_light(state).name)}.png")
        save_picture(prepare(state), compose(options.size[0], options.size[1], state.zoom), out)
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
    state = _state(options, all_lights=False)
    picture = prepare(state)
    _print_notes(picture.light.notes)
    composition = compose(options.size[0], options.size[1], state.zoom)
    pixels = save_picture(picture, composition, options.out, overlay=not options.no_overlay, timing=options.timing)
    if options.reference is None or pixels is None:
        return 0
    difference = options.out.with_name(f"{options.out.stem}-difference.png")
    verdict = compare_with_reference(pixels, options.reference, difference, options.threshold)
    if verdict:
        print(f"shviewer: {verdict}", file=sys.stderr)
    return 1 if verdict else 0


def _report(options: argparse.Namespace) -> int:
    from shviewer import stability
    from shviewer.viewer.picture_files import write_atomically

    progress = _Progress() if sys.stderr.isatty() else None
    outcomes = stability.run(progress=progress, shader=not options.no_shader)
    if progress:
        progress.clear()
    print(stability.as_text(outcomes))
    if options.output is not None:
        try:
            options.output.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(f"{options.output}: cannot be made a folder: {error.strerror}; choose another") from error
        write_atomically(options.output / "stability.md", stability.as_markdown(outcomes).encode())
        write_atomically(options.output / "stability.json", stability.as_json(outcomes).encode())
    return 0 if all(outcome.passed for outcome in outcomes) else 1


class _Progress:
    """The case at work, on one line of the terminal."""

    def __call__(self, name: str) -> None:
        print(f"\r\033[K{name}", end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        self("")


def _state(options: argparse.Namespace, *, all_lights: bool) -> ViewState:
    """The state that the options ask for. UsageError for one out of range; nothing is loaded yet."""
    from shviewer.lights.light import built_in_lights
    from shviewer.viewer.camera import IDENTITY, towards
    from shviewer.viewer.picture import check
    from shviewer.viewer.state import ViewState, open_light

    elevations = [angles[1] for angles in (options.camera, options.rotate_light) if angles]
    if any(abs(elevation) > 90 for elevation in elevations):
        raise UsageError(f"elevation {max(elevations, key=abs):g}: it must be -90 to 90 degrees")
    window, separator, width = options.window.partition(":")
    state = ViewState(
        lights=tuple(built_in_lights()) if all_lights else (options.light,),
        sanitize=options.sanitize,
        n_bands=DEFAULT_BANDS if options.bands is None else options.bands,
        muted=options.mute,
        quantity=options.quantity,
        window=window,
        window_width=_finite_width(width) if separator else None,
        method=options.method,
        samples=options.samples,
        seed=options.seed,
        exposure_stops=options.exposure,
        light_rotation=towards(*options.rotate_light) if options.rotate_light else IDENTITY,
        zoom=options.zoom,
    )
    if options.camera:
        state = replace(state, camera=(options.camera[0] % 360, options.camera[1]))
    if options.tolerance is not None:
        state = replace(state, tolerance=options.tolerance)
    check(state, tuple(options.size))
    state = open_light(state, options.light)
    return state if options.tolerance is None else _fitted(state, options)


def _fitted(state: ViewState, options: argparse.Namespace) -> ViewState:
    """As many bands as the tolerance needs, said on stderr; where none are enough, the best there is."""
    from shviewer.viewer.picture import estimate_from_samples, needs

    if options.bands is not None:
        raise UsageError(f"--bands {options.bands} and --tolerance {options.tolerance:g}: give one of them")
    found = needs(state)
    counts = {"radiance": found.radiance, "irradiance": found.irradiance}
    says = ", ".join(f"{name} {count or f'none up to {found.searched}'}" for name, count in counts.items())
    print(f"shviewer: bands within {100 * found.tolerance:g} %: {says}", file=sys.stderr)
    wanted = counts[state.quantity]
    if wanted is None:
        print(f"shviewer: the best is {100 * found.best:.3g} % with {found.best_bands} bands", file=sys.stderr)
    if state.method == "jittered":
        guess = estimate_from_samples(state)
        if guess.decided:
            says = f"{guess.likely} bands" if guess.likely else "no count up to 32"
        else:
            says = f"nothing sure: {guess.fewest or 'more than 32'} to {guess.most or 'more than 32'} bands; take more samples"
        print(f"shviewer: the samples alone say {says}", file=sys.stderr)
    return replace(state, n_bands=wanted or found.best_bands)


def _print_notes(notes: tuple[str, ...]) -> None:
    for note in notes:
        print(f"shviewer: note: {note}", file=sys.stderr)


def _band_list(text: str) -> frozenset[int]:
    try:
        return frozenset(int(part) for part in text.split(",") if part.strip())
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r}: bands are whole numbers separated by commas, such as 1,3"
        ) from None


def _finite(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a finite number")
    return value


def _tolerance(text: str) -> float:
    value = _finite(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    if not 0 < value < 1:
        raise argparse.ArgumentTypeError(f"{text!r}: a tolerance is between 0 and 1, such as 0.05 or 5%")
    return value


def _finite_width(text: str) -> float:
    try:
        return _finite(text)
    except argparse.ArgumentTypeError as error:
        raise UsageError(f"window width {error}") from error


def _share(text: str) -> float:
    value = _finite(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text!r}: a share is 0 to 1")
    return value
