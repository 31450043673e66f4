"""The options of the command line and their help. No mode is imported here, so that --help stays fast."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import NoReturn

from shviewer import __version__

EXIT_CODES = """exit codes:
  0    done
  1    --reference: the picture differs; --stability: a case failed; project: one of several lights failed
  2    bad arguments
  3    a light that is unknown, unreadable or damaged
  4    a file that could not be written
  5    no OpenGL 3.3, or no EGL
  6    a shader that does not compile
  130  interrupted"""

DEFAULT_BANDS = 5
DEFAULT_SWEEP = (1, 16)

LIGHT_HELP = (
    "a built-in name (--list-lights), a .toml scene, an image (.hdr, .exr, file.exr:layer, .png or .jpg), "
    "file.py:function, or coefficients (.json, .csv, .txt, .npz, .h, .glsl)"
)


class OneLineParser(argparse.ArgumentParser):
    """argparse, but a mistake is one line on stderr and not the usage, too."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"shviewer: {' '.join(message.split())}; see {self.prog} --help\n")


def view_parser() -> OneLineParser:
    """shviewer [LIGHT]: the window."""
    parser = OneLineParser(
        prog="shviewer",
        usage="shviewer [LIGHT] [options]\n"
        "       shviewer screenshot OUT [LIGHT] [options]\n"
        "       shviewer sweep OUT [LIGHT] [--from N] [--to N] [options]\n"
        "       shviewer info LIGHT [LIGHT ...] [options]\n"
        "       shviewer project [LIGHT ...] -o FILE [options]\n"
        "       shviewer report [LIGHT ...] [-o DIR] [options]",
        description="Show a light beside its spherical-harmonic reconstruction. Without a display, write the picture instead.",
        epilog=f"{EXIT_CODES}\n\nkeys and mouse: shviewer --list-keys\npictures without a window: shviewer screenshot --help"
        "\nanimations: shviewer sweep --help"
        "\nwhat a light is, in figures: shviewer info --help"
        "\nits coefficients as a file: shviewer project --help",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    _add_view_options(parser)
    _add_compare_option(parser)
    parser.add_argument("--watch", action="store_true", help="read the light's file again whenever it changes")
    parser.add_argument("--verbose", action="store_true", help="one line on stderr per frame")
    parser.add_argument("--list-keys", action="store_true", help="print the table of keys and exit")
    parser.add_argument("--list-lights", action="store_true", help="print the built-in lights and exit")
    parser.add_argument("--version", action="version", version=f"shviewer {__version__}")
    return parser


def screenshot_parser() -> OneLineParser:
    """shviewer screenshot OUT [LIGHT]: a picture without a window."""
    parser = OneLineParser(
        prog="shviewer screenshot",
        description="Write the picture without a window or a display. The same arguments give the same bytes.",
        epilog=EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "out", metavar="OUT", type=Path, help="OUT.png: the picture; OUT.exr: linear float32 radiance of both spheres"
    )
    _add_view_options(parser)
    _add_compare_option(parser)
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


def sweep_parser() -> OneLineParser:
    """shviewer sweep OUT [LIGHT]: an animation without a window."""
    parser = OneLineParser(
        prog="shviewer sweep",
        description="Write an animation of more and more bands, or with --turntable of the camera going round. Every frame is "
        "the screenshot of its state.",
        epilog=EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "out", metavar="OUT", type=Path, help="OUT.webp: lossless; OUT.gif: one palette of 255 colours for all frames"
    )
    parser.add_argument("--from", metavar="N", dest="first", type=int, help="bands of the first frame (default 1)")
    parser.add_argument("--to", metavar="N", dest="last", type=int, help="bands of the last frame (default 16)")
    parser.add_argument(
        "--turntable", action="store_true", help="turn the camera once round instead, with --bands N bands"
    )
    parser.add_argument("--frames", metavar="K", type=int, help="of --turntable, 2 to 720 (default 72)")
    parser.add_argument(
        "--seconds",
        metavar="S",
        type=finite,
        help="that a frame is shown, 0.02 to 60 (default 0.7, the last band three times as long; --turntable 0.08)",
    )
    parser.add_argument("--no-overlay", action="store_true", help="the two spheres alone")
    _add_view_options(parser)
    return parser


def info_parser() -> OneLineParser:
    """shviewer info LIGHT [LIGHT ...]: what lights are, in figures."""
    parser = OneLineParser(
        prog="shviewer info",
        description="Say what each LIGHT is: its file, size and range, its mean and peak, the energy of its bands, and how many"
        " bands it needs. The figures are the window's.",
        epilog=f"{EXIT_CODES}\n\nA light that cannot be read does not stop the others; the exit code is that of the first.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("lights", metavar="LIGHT", nargs="+", help=LIGHT_HELP)
    parser.add_argument("--json", action="store_true", help="the same as a JSON array, one object per LIGHT")
    _add_reading_options(parser)
    return parser


PROJECT_OPTIONS = frozenset(
    ("--bands", "--tolerance", "--for", "--split-sun", "--window", "--mute", "--method", "--samples", "--seed")
)
"""What `project` has in common with the window."""


def project_parser() -> OneLineParser:
    """shviewer project [LIGHT ...] -o FILE: coefficients as a file."""
    parser = OneLineParser(
        prog="shviewer project",
        description="Write the coefficients of LIGHT, with the convention stamped on them. Several lights go into a folder.",
        epilog=f"{EXIT_CODES}\n\nOf several lights those that can be projected are written, whatever becomes of the others.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("lights", metavar="LIGHT", nargs="*", help=f"{LIGHT_HELP} (default green)")
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        required=True,
        help="FILE.json, .csv, .npz, .h or .glsl; - is stdout; a folder if there are several lights",
    )
    parser.add_argument("--format", metavar="F", help="json, csv, npz, h or glsl, where FILE does not say it")
    parser.add_argument(
        "--convention",
        metavar="C",
        default="shviewer",
        help="whose: shviewer (default), filament, three, unity, unreal, ambix, sphericart or scipy; after commas what differs,"
        " such as shviewer,no-phase,4pi",
    )
    parser.add_argument(
        "--axes",
        metavar="A",
        help="y-up or z-up (right-handed), y-up-left or z-up-left, or which of our axes x, y and z are, such as +x+z-y",
    )
    parser.add_argument("--no-phase", action="store_true", help="a basis without the Condon-Shortley phase (-1)^m")
    donor = OneLineParser(add_help=False)
    _add_view_options(donor)
    for action in donor._actions:
        if PROJECT_OPTIONS.intersection(action.option_strings):
            parser._add_action(action)
    _add_reading_options(parser, convention="--input-convention")
    parser.set_defaults(compare=None, camera=None, rotate_light=None, zoom=1.0, exposure=None, size=(1280, 640))
    return parser


def report_parser() -> OneLineParser:
    """shviewer report [LIGHT ...]: speed against error, measured on this machine."""
    parser = OneLineParser(
        prog="shviewer report",
        description="Measure speed against error on this machine and write report.md, report.json, report.csv and plots. "
        "Without LIGHT: built-in scenes and two environment maps.",
        epilog=f"{EXIT_CODES}\n\nWith --stability alone only the hard cases are run and printed (about 15 s). Plots need "
        "matplotlib:\npip install 'shviewer[report]'.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("lights", metavar="LIGHT", nargs="*", help=LIGHT_HELP)
    parser.add_argument(
        "-o", "--output", metavar="DIR", type=Path, help="the folder to write (default shviewer-report)"
    )
    parser.add_argument("--quick", action="store_true", help="two lights and few sizes, within 15 s")
    parser.add_argument(
        "--budget",
        metavar="SECONDS",
        type=finite,
        help="of measuring (default 120); repeats, then sizes are trimmed to it",
    )
    parser.add_argument("--methods", metavar="M,M", help="only these ways to project, and the best way of each light")
    parser.add_argument("--seed", metavar="S", type=int, default=0, help="of all random samples (default 0)")
    parser.add_argument(
        "--against",
        metavar="OLD.json",
        type=Path,
        help="say what is faster, slower, better or worse than in that report",
    )
    parser.add_argument(
        "--peers", action="store_true", help="also ducc0, shtns, pyshtools, sphericart and SciPy, if installed"
    )
    parser.add_argument("--stability", action="store_true", help="also the hard cases; exit 1 if one fails")
    parser.add_argument("--no-shader", action="store_true", help="nothing is drawn; needs no OpenGL")
    _add_reading_options(parser)
    return parser


def _add_compare_option(parser: OneLineParser) -> None:
    parser.add_argument(
        "--compare",
        metavar="FILE",
        help="show the coefficients in FILE instead of the light's own, and say by which usual mistake they are off",
    )


def _add_view_options(parser: OneLineParser) -> None:
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
        help="radiance (default), or irradiance: what a white Lambertian surface receives",
    )
    parser.add_argument(
        "--split-sun", action="store_true", help="take suns out of the light as discs of their own and project the rest"
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
        "--samples", metavar="K", type=_count, default=10_000, help="of the sampled methods (default 10000)"
    )
    parser.add_argument("--seed", metavar="S", type=int, default=0, help="of the jittered samples (default 0)")
    parser.add_argument("--exposure", metavar="STOPS", type=finite, help="fixed, instead of chosen from the light")
    parser.add_argument("--tone", metavar="T", default="none", help="curve after exposure: none, reinhard, aces or log")
    parser.add_argument(
        "--error",
        metavar="E",
        default="off",
        help="a third sphere, reconstruction minus original: off (default), signed, absolute or relative",
    )
    parser.add_argument(
        "--error-range",
        metavar="R",
        type=_error_range,
        help="where its colours end: a radiance, or for the relative error such as 20%%; chosen from the light unless given",
    )
    parser.add_argument("--no-marks", action="store_true", help="do not mark the minimum and the largest error")
    parser.add_argument(
        "--lobes", action="store_true", help="surfaces in place of spheres: radius is magnitude, colour is sign"
    )
    parser.add_argument(
        "--basis", metavar=("L", "M"), nargs=2, type=int, help="the surface of one basis function Y(l, m) on the right"
    )
    parser.add_argument("--convergence", action="store_true", help="plot the error against the number of bands")
    parser.add_argument(
        "--evaluate",
        metavar="E",
        default="auto",
        help="sum the bands per pixel (direct), draw from a map, or auto (default): by the time that a frame takes",
    )
    parser.add_argument(
        "--camera", metavar=("AZIMUTH", "ELEVATION"), nargs=2, type=finite, help="where the camera stands, degrees"
    )
    parser.add_argument(
        "--rotate-light",
        metavar=("AZIMUTH", "ELEVATION"),
        nargs=2,
        type=finite,
        help="turn the light so that its +x axis points there, degrees",
    )
    parser.add_argument(
        "--zoom", metavar="Z", type=finite, default=1.0, help="size of the spheres, 0.25 to 16 (default 1)"
    )
    parser.add_argument(
        "--size", metavar=("W", "H"), nargs=2, type=int, default=(1280, 640), help="pixels (default 1280 640)"
    )
    _add_reading_options(parser)


def _add_reading_options(parser: OneLineParser, convention: str = "--convention") -> None:
    """How an image is read, and coefficients that do not say their convention."""
    parser.add_argument(
        convention,
        metavar="C",
        dest="input_convention",
        default="",
        help="of a bare list of coefficients: shviewer, filament, three, unity, unreal, ambix, sphericart or scipy",
    )
    parser.add_argument(
        "--sanitize",
        action="store_true",
        help="repair NaN, infinite and negative texels of an image instead of refusing or keeping them",
    )
    parser.add_argument(
        "--layout",
        metavar="L",
        default="auto",
        help="how an image covers the sphere: auto (default), lat-long, cube, angular or mirror-ball",
    )
    parser.add_argument(
        "--max-side",
        metavar="N",
        type=_positive_count,
        help="texels along a side that an image may have (default 32768)",
    )
    parser.add_argument(
        "--max-megatexels",
        metavar="M",
        type=_positive,
        help="texels that an image may have, in units of 1024 x 1024 (default 128)",
    )
    parser.add_argument(
        "--max-file-mib", metavar="M", type=_positive, help="size that an image's file may have, in MiB (default 512)"
    )


def _band_list(text: str) -> frozenset[int]:
    try:
        return frozenset(int(part) for part in text.split(",") if part.strip())
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r}: bands are whole numbers separated by commas, such as 1,3"
        ) from None


def _count(text: str) -> int:
    value = finite(text)  # 1e6 is a count, too
    if value != int(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number")
    return int(value)


def _positive_count(text: str) -> int:
    return int(_positive(str(_count(text))))


def _positive(text: str) -> float:
    value = finite(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not positive")
    return value


def finite(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a finite number")
    return value


def _error_range(text: str) -> float:
    value = finite(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text!r}: an error range is positive, such as 0.5 or 20%")
    return value


def _tolerance(text: str) -> float:
    value = finite(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    if not 0 < value < 1:
        hint = f"did you mean {text}%?" if 1 <= value < 100 and not text.endswith("%") else "such as 0.05 or 5%"
        raise argparse.ArgumentTypeError(f"{text!r}: a tolerance is between 0 and 1; {hint}")
    return value


def _share(text: str) -> float:
    value = finite(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text!r}: a share is 0 to 1")
    return value
