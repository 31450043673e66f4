"""Options that several modes of the command line have in common.

No mode is imported here, so that --help stays fast.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn, TypeAlias

from shviewer.analysis.options import Bands, Number, Option, Pair, Quantity, Share, Whole, WholeOr, options_of
from shviewer.analysis.recipe import Recipe
from shviewer.cli.options.values import (
    band_list,
    count,
    finite,
    positive,
    positive_count,
    quantity,
    tolerance,
    whole,
    whole_or_word,
)
from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
from shviewer.words import near, one_line

LIGHT_HELP = (
    "a built-in name (--list-lights), a .toml scene, an image (.hdr, .exr, file.exr:layer, .png, .jpg and others), "
    f"file.py:function, or coefficients ({', '.join(COEFFICIENT_SUFFIXES)})"
)

TEXTS = ("window", "error_range")
"""Options kept as text and parsed later: a window with its width, and a radiance or a share in percent."""

LARGE = ("samples",)
"""Counts that may be given as 1e6."""


Adding: TypeAlias = argparse._ActionsContainer
"""A parser, or a group of its options, which stand under a title in the help."""


class OneLineParser(argparse.ArgumentParser):
    """An argparse parser that reports a mistake in one line on stderr, without the usage, and names values that are missing."""

    def error(self, message: str) -> NoReturn:
        for action in self._actions:
            if action.metavar and message.startswith(f"argument {'/'.join(action.option_strings)}: expected "):
                values = (action.metavar,) if isinstance(action.metavar, str) else action.metavar
                message += f", as in {action.option_strings[0]} {' '.join(values)}"
        unknown = message.removeprefix("unrecognized arguments: ").partition(" ")[0].partition("=")[0]
        flags = [flag for action in self._actions for flag in action.option_strings if flag.startswith("--")]
        if unknown.startswith("--") and message.startswith("unrecognized") and (found := near(unknown, flags)):
            message += f"; did you mean {' or '.join(found)}?"
            self.exit(2, f"shviewer: {one_line(message)}\n")
        self.exit(2, f"shviewer: {one_line(message)}; see {self.prog} --help\n")


def add_view_options(parser: OneLineParser, *, several: bool = False) -> None:
    """Add LIGHT and every option that its picture depends on. several: more than one LIGHT, and folders of them."""
    if several:
        parser.add_argument(
            "lights",
            metavar="LIGHT",
            nargs="*",
            help=f"{LIGHT_HELP} (default green); or several, or folders, for Left and Right to go through",
        )
    else:
        parser.add_argument("light", metavar="LIGHT", nargs="?", help=f"{LIGHT_HELP} (default green)")
    parser.add_argument(
        "--like",
        metavar="PICTURE",
        type=Path,
        help="everything but the light as in a picture that shviewer saved; other options come on top of it",
    )
    parser.add_argument(
        "--as-image",
        action="store_true",
        help="take a picture that shviewer saved for an image, not for the light and the view that it shows",
    )
    add_numbers(parser)
    add_picture_options(parser)
    add_reading_options(parser)


def add_numbers(parser: OneLineParser) -> None:
    """Add the options that say which numbers are made of a light."""
    add_table(parser.add_argument_group("bands and projection"), Recipe)


def add_table(parser: Adding, holder: type) -> None:
    """Add the options that a dataclass holds. An option that is not given is None."""
    for row in options_of(holder).values():
        if row.flag:
            takes = {"action": "store_const", "const": row.const} if row.const is not None else _values(row)
            parser.add_argument(row.flag, dest=row.name, help=row.help.replace("%", "%%"), **takes)


def _values(row: Option) -> dict[str, Any]:
    """The arguments of `add_argument` about an option's values."""
    if row.name in TEXTS:
        return {"metavar": row.metavar}
    readers: dict[type, Callable[[str], object]] = {
        Whole: whole,
        Share: tolerance,
        WholeOr: whole_or_word,
        Number: finite,
        Bands: band_list,
        Quantity: quantity,
    }
    reader = count if row.name in LARGE else readers.get(type(row.kind), str)
    if isinstance(row.kind, Pair):
        return {"metavar": row.metavar, "nargs": 2, "type": whole if row.kind.whole else finite}
    return {"metavar": row.metavar, "type": reader}


def add_picture_options(parser: OneLineParser) -> None:
    """Add the options of a picture that no dataclass holds: coefficients to compare, a turn of the light, a size."""
    from shviewer.viewer.view import View  # modes that draw nothing load nothing of the viewer

    group = parser.add_argument_group("what is shown")
    group.add_argument(
        "--compare",
        metavar="FILE",
        help="show the coefficients in FILE instead of the light's own, and say how well they agree, or by which usual "
        "mistake they are off; finds out the convention of a bare list, if none is named",
    )
    add_table(group, View)
    add_turn(group)
    group.add_argument(
        "--anew",
        action="store_true",
        help="project the light as it stands when it is turned, so that samples do not turn with it",
    )
    group.add_argument(
        "--size", metavar=("W", "H"), nargs=2, type=whole, help="pixels (default 1280 640, or those of the picture)"
    )


def add_turn(parser: Adding) -> None:
    """Add the options that turn the light."""
    parser.add_argument(
        "--rotate-light",
        metavar=("AZIMUTH", "ELEVATION"),
        nargs=2,
        type=finite,
        help="turn the light so that its +x axis points there, degrees",
    )
    parser.add_argument(
        "--roll-light", metavar="DEGREES", type=finite, help="before that, turn the light about its +x axis"
    )


def add_reading_options(parser: OneLineParser, convention: str = "--convention") -> None:
    """Add the options that say how to read images, and coefficients that do not name their convention."""
    group = parser.add_argument_group("reading files")
    group.add_argument(
        convention,
        metavar="C",
        dest="input_convention",
        default="",
        help="convention of a bare list of coefficients, such as three, unity or shviewer,y-up,no-phase: the names and"
        " modifiers of project's --convention",
    )
    group.add_argument(
        "--sanitize",
        action="store_true",
        default=None,
        help="repair NaN, infinite and negative texels of an image instead of refusing or keeping them",
    )
    group.add_argument(
        "--layout",
        metavar="L",
        help="how an image covers the sphere: auto (default), lat-long, cube, angular or mirror-ball",
    )
    group.add_argument(
        "--max-side",
        metavar="N",
        type=positive_count,
        help="texels along a side that an image may have (default 32768)",
    )
    group.add_argument(
        "--max-megatexels",
        metavar="M",
        type=positive,
        help="texels that an image may have, in units of 1024 x 1024 (default 128)",
    )
    group.add_argument(
        "--max-file-mib", metavar="M", type=positive, help="size that an image's file may have, in MiB (default 512)"
    )
    group.add_argument(
        "--max-memory-mib",
        metavar="M",
        type=positive,
        help="memory that an image may take until it is drawn, in MiB (default half of what is available)",
    )


def add_jobs(parser: OneLineParser) -> None:
    """The number of processes for several lights."""
    parser.add_argument(
        "--jobs",
        metavar="N",
        type=positive_count,
        help="processes for several lights (default as many as there are cores and memory for, once it pays)",
    )


def add_force(parser: OneLineParser) -> None:
    """What `Replacing` asks for."""
    parser.add_argument("--force", action="store_true", help="replace a file even if shviewer did not write it")
