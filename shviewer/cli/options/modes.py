"""The modes of the command line and their help. No mode is imported here, so that --help stays fast."""

from __future__ import annotations

import argparse
from pathlib import Path

from shviewer.cli.options.groups import (
    LIGHT_HELP,
    OneLineParser,
    add_force,
    add_jobs,
    add_numbers,
    add_reading_options,
    add_turn,
    add_view_options,
)
from shviewer.cli.options.values import finite, quantity, share, whole
from shviewer.version import __version__

EXIT_CODES = """exit codes:
  0    done
  1    --reference differs, --stability or one of project's lights fails
  2    bad arguments
  3    a light that is unknown, unreadable or damaged
  4    a file that could not be written
  5    no OpenGL 3.3, or no EGL
  6    a shader that does not compile
  130  interrupted (129 and 143: ended by SIGHUP or SIGTERM)"""


USAGES = {
    "view": "shviewer [LIGHT ...] [options]",
    "screenshot": "shviewer screenshot OUT [LIGHT] [options]",
    "sweep": "shviewer sweep OUT [LIGHT] [--from N] [--to N] [options]",
    "info": "shviewer info LIGHT [LIGHT ...] [options]",
    "project": "shviewer project [LIGHT ...] -o FILE [options]",
    "report": "shviewer report [LIGHT ...] [-o DIR] [options]",
    "help": "shviewer help [TOPIC]",
}


class _Paragraphs(argparse.HelpFormatter):
    """Keeps the lines of a text, and breaks those that are too long for the terminal."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        fill = super()._fill_text
        return "\n".join(line if len(line) <= width else fill(line, width, indent) for line in text.splitlines())


def _parser(mode: str, description: str, epilog: str = "") -> OneLineParser:
    """The parser of a mode, whose help ends with the exit codes and the epilog."""
    program = "shviewer" if mode == "view" else f"shviewer {mode}"
    usage = "\n       ".join(USAGES.values()) if mode == "view" else USAGES[mode]
    return OneLineParser(program, usage, description, epilog=EXIT_CODES + epilog, formatter_class=_Paragraphs)


def view_parser() -> OneLineParser:
    """shviewer [LIGHT]: the window."""
    parser = _parser(
        "view",
        "Show a light beside its spherical-harmonic reconstruction. Without a display, write the picture instead.",
        "\n\nkeys and mouse: shviewer --list-keys\npictures without a window: shviewer screenshot --help"
        "\nanimations: shviewer sweep --help"
        "\nwhat a light is, in figures: shviewer info --help"
        "\nits coefficients as a file: shviewer project --help"
        "\nthe guide, a page for each question: shviewer help TOPIC",
    )
    add_view_options(parser, several=True)
    parser.add_argument(
        "--last-size",
        action="store_true",
        help="open at the size that the window had when it was last closed with this option; --size goes before",
    )
    parser.add_argument("--watch", action="store_true", help="read the light's file again whenever it changes")
    parser.add_argument("--verbose", action="store_true", help="one line on stderr per frame")
    parser.add_argument("--list-keys", action="store_true", help="print the table of keys and exit")
    parser.add_argument(
        "--list-factors",
        metavar="WHAT",
        type=quantity,
        help="print what irradiance or glossy:R multiplies each band of the radiance by, of 32 bands or of --bands N, and exit",
    )
    parser.add_argument("--list-lights", action="store_true", help="print the built-in lights and exit")
    parser.add_argument(
        "--print-completion",
        metavar="SHELL",
        choices=("bash", "zsh", "fish"),
        help="print what bash, zsh or fish needs to complete this command line, and exit",
    )
    parser.add_argument("--version", action="version", version=f"shviewer {__version__}")
    return parser


def screenshot_parser() -> OneLineParser:
    """shviewer screenshot OUT [LIGHT]: a picture without a window."""
    parser = _parser(
        "screenshot",
        "Write the picture without a window or a display. The same arguments give the same bytes.",
    )
    parser.add_argument(
        "out", metavar="OUT", type=Path, help="OUT.png: the picture; OUT.exr: linear float32 radiance of the spheres"
    )
    add_view_options(parser)
    parser.add_argument("--no-overlay", action="store_true", help="the spheres alone")
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
        type=share,
        default=0.001,
        help="share of the pixels, 0 to 1, that may differ from the reference by more than 2/255 (default 0.001)",
    )
    add_force(parser)
    return parser


def sweep_parser() -> OneLineParser:
    """shviewer sweep OUT [LIGHT]: an animation without a window."""
    parser = _parser(
        "sweep",
        "Write an animation: more and more bands, or the camera (--turntable) or the light (--turn-light) going round. "
        "Every frame is the screenshot of its state.",
    )
    parser.add_argument(
        "out", metavar="OUT", type=Path, help="OUT.webp: lossless; OUT.gif: one palette of 255 colours for all frames"
    )
    parser.add_argument("--from", metavar="N", dest="first", type=whole, help="bands of the first frame (default 1)")
    parser.add_argument("--to", metavar="N", dest="last", type=whole, help="bands of the last frame (default 16)")
    parser.add_argument(
        "--turntable", action="store_true", help="turn the camera once round instead, with --bands N bands"
    )
    parser.add_argument(
        "--turn-light",
        action="store_true",
        help="turn the light once round instead, projected anew in each frame by --method and --samples, and say what flickers",
    )
    parser.add_argument(
        "--seeds",
        metavar="RULE",
        choices=("fresh", "same"),
        help="jittered samples of --turn-light: fresh in each frame (default) or the same",
    )
    parser.add_argument(
        "--frames", metavar="K", type=whole, help="frames of --turntable and --turn-light, 2 to 720 (default 72)"
    )
    parser.add_argument(
        "--seconds",
        metavar="S",
        type=finite,
        help="time of a frame, 0.02 to 60 (default 0.7, the last band three times as long; --turntable 0.08)",
    )
    parser.add_argument("--no-overlay", action="store_true", help="the spheres alone")
    add_view_options(parser)
    add_force(parser)
    return parser


def info_parser() -> OneLineParser:
    """shviewer info LIGHT [LIGHT ...]: lights in figures."""
    parser = _parser(
        "info",
        "Say what each LIGHT is: its file, size and range, its mean and peak, the energy of its bands, and how many"
        " bands it needs. The figures are the window's.",
        "\n\nA light that cannot be read does not stop the others; the exit code is that of the first.",
    )
    parser.add_argument("lights", metavar="LIGHT", nargs="+", help=LIGHT_HELP)
    parser.add_argument("--json", action="store_true", help="the same as a JSON array, one object per LIGHT")
    add_reading_options(parser)
    add_jobs(parser)
    return parser


def project_parser() -> OneLineParser:
    """shviewer project [LIGHT ...] -o FILE: coefficients as a file."""
    parser = _parser(
        "project",
        "Write the coefficients of LIGHT, with the convention stamped on them. Several lights go into a folder.",
        "\n\nOf several lights those that can be projected are written, whatever becomes of the others.",
    )
    parser.add_argument("lights", metavar="LIGHT", nargs="*", help=f"{LIGHT_HELP} (default green)")
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        required=True,
        help="FILE.json, .csv, .npz, .h, .glsl, .hlsl, .js or .cs; - is stdout; a folder if there are several lights",
    )
    parser.add_argument(
        "--format", metavar="F", help="json, csv, npz, h, glsl, hlsl, js or cs, where FILE does not say it"
    )
    parser.add_argument(
        "--convention",
        metavar="C",
        default="shviewer",
        help="convention to write: shviewer (default), filament, three, unity, unreal, babylon, playcanvas, cesium, gltf,"
        " godot, 3dgs, directxmath, ambix, fuma, sphericart, scipy, e3nn, shtools, spharpy, mitsuba, or webxr, arcore or arkit"
        " with -phase or -no-phase after it; after commas what differs, such as shviewer,no-phase,4pi",
    )
    parser.add_argument(
        "--axes",
        metavar="A",
        help="y-up or z-up (right-handed), y-up-left or z-up-left, or which of our axes x, y and z are, such as +x+z-y",
    )
    parser.add_argument(
        "--encode",
        metavar="NAME",
        help="in place of bands what engines store of the irradiance, with the formula that decodes it: those of a picture's"
        " --encode, zh3-solved, ambient-cube or ambient-cube-fitted",
    )
    parser.add_argument("--no-phase", action="store_true", help="a basis without the Condon-Shortley phase (-1)^m")
    add_numbers(parser)
    add_turn(parser)
    add_reading_options(parser, convention="--input-convention")
    add_jobs(parser)
    add_force(parser)
    return parser


def report_parser() -> OneLineParser:
    """shviewer report [LIGHT ...]: speed against error, measured on this machine."""
    parser = _parser(
        "report",
        "Measure speed against error on this machine and write report.html, report.md, report.json, report.csv and plots. "
        "Without LIGHT: built-in scenes and two environment maps.",
        "\n\nWith --stability alone only the hard cases are run and printed (about 15 s). Plots need "
        "matplotlib:\npip install 'shviewer[report]'.",
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
        help="time for measuring (default 120), smallest first; what it does not reach is not measured",
    )
    parser.add_argument("--methods", metavar="M,M", help="only these ways to project, and the best way of each light")
    parser.add_argument("--seed", metavar="S", type=whole, default=0, help="seed of all random samples (default 0)")
    parser.add_argument(
        "--against",
        metavar="OLD.json",
        type=Path,
        help="say what is faster, slower, better or worse than in that report",
    )
    parser.add_argument(
        "--peers", action="store_true", help="also ducc0, shtns, pyshtools, sphericart and SciPy, if installed"
    )
    parser.add_argument(
        "--moving",
        action="store_true",
        help="also lights that turn, projected anew in every frame: what flickers, within 60 s",
    )
    parser.add_argument("--stability", action="store_true", help="also the hard cases; exit 1 if one fails")
    parser.add_argument("--no-shader", action="store_true", help="nothing is drawn; needs no OpenGL")
    add_force(parser)
    add_reading_options(parser)
    return parser


PARSERS = {
    "view": view_parser,
    "screenshot": screenshot_parser,
    "sweep": sweep_parser,
    "info": info_parser,
    "project": project_parser,
    "report": report_parser,
}
"""Mode -> its parser. The mode's code is the function `run` in the file of its name."""

MODES = tuple(mode for mode in PARSERS if mode != "view")
"""The words that a command line may begin with."""
