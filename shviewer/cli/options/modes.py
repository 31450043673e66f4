"""The modes of the command line and their help. No mode is imported here, so that --help stays fast."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import NamedTuple

from shviewer.cli.options.groups import (
    FORCE,
    JOBS,
    LIGHT,
    LIGHT_HELP,
    NUMBERS,
    PICTURE,
    TURN,
    reading,
)
from shviewer.cli.options.parsers import Argument, Group, OneLineParser, Paragraphs, row
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


class Mode(NamedTuple):
    """A mode of the command line. Its code is the function `run` in the file of its name."""

    usage: str
    description: str
    options: tuple[Argument | Group, ...]
    epilog: str = ""
    """What the help ends with, after the exit codes."""


TABLE = {
    "view": Mode(
        "[LIGHT ...] [options]",
        "Show a light beside its spherical-harmonic reconstruction. Without a display, write the picture instead.",
        (
            row(
                "LIGHT",
                f"{LIGHT_HELP} (default green); or several, or folders, for Left and Right to go through",
                dest="lights",
                nargs="*",
            ),
            *PICTURE,
            row(
                "--last-size",
                "open at the size that the window had when it was last closed with this option; --size goes before",
            ),
            row("--watch", "read the light's file again whenever it changes"),
            row("--verbose", "one line on stderr per frame"),
            row("--list-keys", "print the table of keys and exit"),
            row(
                "--list-factors WHAT",
                "print what irradiance or glossy:R multiplies each band of the radiance by, of 32 bands or of --bands N, and"
                " exit",
                quantity,
            ),
            row("--list-lights", "print the built-in lights and exit"),
            row(
                "--print-completion SHELL",
                "print what bash, zsh or fish needs to complete this command line, and exit",
                choices=("bash", "zsh", "fish"),
            ),
            row(
                "--version",
                "show program's version number and exit",
                action="version",
                version=f"shviewer {__version__}",
            ),
        ),
        "\n\nkeys and mouse: shviewer --list-keys\npictures without a window: shviewer screenshot --help"
        "\nanimations: shviewer sweep --help"
        "\nwhat a light is, in figures: shviewer info --help"
        "\nits coefficients as a file: shviewer project --help"
        "\nthe guide, a page for each question: shviewer help TOPIC",
    ),
    "screenshot": Mode(
        "OUT [LIGHT] [options]",
        "Write the picture without a window or a display. The same arguments give the same bytes.",
        (
            row("OUT", "OUT.png: the picture; OUT.exr: linear float32 radiance of the spheres", Path),
            LIGHT,
            *PICTURE,
            row("--no-overlay", "the spheres alone"),
            row("--timing", "also say how long the projection took; then no two runs are equal"),
            row(
                "--reference REF.png",
                "compare with a picture; exit 1 and write OUT-difference.png if it differs",
                Path,
            ),
            row(
                "--threshold T",
                "share of the pixels, 0 to 1, that may differ from the reference by more than 2/255 (default 0.001)",
                share,
                default=0.001,
            ),
            FORCE,
        ),
    ),
    "sweep": Mode(
        "OUT [LIGHT] [--from N] [--to N] [options]",
        "Write an animation: more and more bands, or the camera (--turntable) or the light (--turn-light) going round. "
        "Every frame is the screenshot of its state.",
        (
            row("OUT", "OUT.webp: lossless; OUT.gif: one palette of 255 colours for all frames", Path),
            row("--from N", "bands of the first frame (default 1)", whole, dest="first"),
            row("--to N", "bands of the last frame (default 16)", whole, dest="last"),
            row("--turntable", "turn the camera once round instead, with --bands N bands"),
            row(
                "--turn-light",
                "turn the light once round instead, projected anew in each frame by --method and --samples, and say what"
                " flickers",
            ),
            row(
                "--seeds RULE",
                "jittered samples of --turn-light: fresh in each frame (default) or the same",
                choices=("fresh", "same"),
            ),
            row("--frames K", "frames of --turntable and --turn-light, 2 to 720 (default 72)", whole),
            row(
                "--seconds S",
                "time of a frame, 0.02 to 60 (default 0.7, the last band three times as long; --turntable 0.08)",
                finite,
            ),
            row("--no-overlay", "the spheres alone"),
            LIGHT,
            *PICTURE,
            FORCE,
        ),
    ),
    "info": Mode(
        "LIGHT [LIGHT ...] [options]",
        "Say what each LIGHT is: its file, size and range, its mean and peak, the energy of its bands, and how many"
        " bands it needs. The figures are the window's.",
        (
            row("LIGHT", LIGHT_HELP, dest="lights", nargs="+"),
            row("--json", "the same as a JSON array, one object per LIGHT"),
            reading(),
            JOBS,
        ),
        "\n\nA light that cannot be read does not stop the others; the exit code is that of the first.",
    ),
    "project": Mode(
        "[LIGHT ...] -o FILE [options]",
        "Write the coefficients of LIGHT, with the convention stamped on them. Several lights go into a folder.",
        (
            LIGHT._replace(names=("lights",), keywords=LIGHT.keywords | {"nargs": "*"}),
            row(
                "-o --output FILE",
                "FILE.json, .csv, .npz, .h, .glsl, .hlsl, .js or .cs; - is stdout; a folder if there are several lights",
                required=True,
            ),
            row("--format F", "json, csv, npz, h, glsl, hlsl, js or cs, where FILE does not say it"),
            row(
                "--convention C",
                "convention to write: shviewer (default), filament, three, unity, unreal, babylon, playcanvas, cesium, gltf,"
                " godot, 3dgs, directxmath, ambix, fuma, sphericart, scipy, e3nn, shtools, spharpy, mitsuba, or webxr, arcore"
                " or arkit with -phase or -no-phase after it; after commas what differs, such as shviewer,no-phase,4pi",
                default="shviewer",
            ),
            row(
                "--axes A",
                "y-up or z-up (right-handed), y-up-left or z-up-left, or which of our axes x, y and z are, such as +x+z-y",
            ),
            row(
                "--encode NAME",
                "in place of bands what engines store of the irradiance, with the formula that decodes it: one of those of a"
                " picture's --encode",
            ),
            row("--no-phase", "a basis without the Condon-Shortley phase (-1)^m"),
            NUMBERS,
            *TURN,
            reading("--input-convention"),
            JOBS,
            FORCE,
        ),
        "\n\nOf several lights those that can be projected are written, whatever becomes of the others.",
    ),
    "report": Mode(
        "[LIGHT ...] [-o DIR] [options]",
        "Measure speed against error on this machine and write report.html, report.md, report.json, report.csv and plots. "
        "Without LIGHT: built-in scenes and two environment maps.",
        (
            row("LIGHT", LIGHT_HELP, dest="lights", nargs="*"),
            row("-o --output DIR", "the folder to write (default shviewer-report)", Path),
            row("--quick", "two lights and few sizes, within 15 s"),
            row(
                "--budget SECONDS",
                "time for measuring (default 120), smallest first; what it does not reach is not measured",
                finite,
            ),
            row("--methods M,M", "only these ways to project, and the best way of each light"),
            row("--seed S", "seed of all random samples (default 0)", whole, default=0),
            row("--against OLD.json", "say what is faster, slower, better or worse than in that report", Path),
            row("--peers", "also ducc0, shtns, pyshtools, sphericart and SciPy, if installed"),
            row("--moving", "also lights that turn, projected anew in every frame: what flickers, within 60 s"),
            row("--stability", "also the hard cases; exit 1 if one fails"),
            row("--no-shader", "nothing is drawn; needs no OpenGL"),
            FORCE,
            reading(),
        ),
        "\n\nWith --stability alone only the hard cases are run and printed (about 15 s). Plots need "
        "matplotlib:\npip install 'shviewer[report]'.",
    ),
}


def _parser(mode: str) -> OneLineParser:
    programs = {name: "shviewer" if name == "view" else f"shviewer {name}" for name in TABLE}
    usages = {name: f"{programs[name]} {one.usage}" for name, one in TABLE.items()}
    usage = "\n       ".join([*usages.values(), "shviewer help [TOPIC]"]) if mode == "view" else usages[mode]
    _, description, options, epilog = TABLE[mode]
    parser = OneLineParser(programs[mode], usage, description, epilog=EXIT_CODES + epilog, formatter_class=Paragraphs)
    parser.add(options)
    return parser


PARSERS = {mode: partial(_parser, mode) for mode in TABLE}
"""Mode -> what makes its parser."""

MODES = tuple(mode for mode in PARSERS if mode != "view")
"""The words that a command line may begin with."""
