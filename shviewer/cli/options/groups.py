"""Options that several modes of the command line have in common.

No mode is imported here, so that --help stays fast.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from shviewer.analysis.options import BandSet, Number, Option, Pair, Quantity, Share, Whole, WholeOr, options_of
from shviewer.analysis.recipe import Recipe
from shviewer.cli.options.parsers import Argument, Group, row
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

LIGHT_HELP = (
    "a built-in name (--list-lights), a .toml scene, an image (.hdr, .exr, file.exr:layer, .png, .jpg and others), "
    f"file.py:function, or coefficients ({', '.join(COEFFICIENT_SUFFIXES)})"
)

TEXTS = ("window", "error_range")
"""Options kept as text and parsed later: a window with its width, and a radiance or a share in percent."""

LARGE = ("samples",)
"""Counts that may be given as 1e6."""

READERS: dict[type, Callable[[str], object]] = {
    Whole: whole,
    Share: tolerance,
    WholeOr: whole_or_word,
    Number: finite,
    BandSet: band_list,
    Quantity: quantity,
}
"""How the values of each kind of option are read; others are texts."""


def rows_of(holder: type) -> list[Argument]:
    """The options that a dataclass holds. An option that is not given is None."""
    return [_row(option) for option in options_of(holder).values() if option.called]


def _row(option: Option) -> Argument:
    help_line = option.help.replace("%", "%%")
    if option.const is not None:
        return row(option.called, help_line, dest=option.name, action="store_const", const=option.const)
    read = count if option.name in LARGE else READERS.get(type(option.kind))
    if isinstance(option.kind, Pair):
        read = whole if option.kind.whole else finite
    return row(option.called, help_line, None if option.name in TEXTS else read, dest=option.name)


LIGHT = row("LIGHT", f"{LIGHT_HELP} (default green)", nargs="?")

NUMBERS = Group("bands and projection", partial(rows_of, Recipe))
"""Which numbers are made of a light."""

TURN = (
    row("--rotate-light AZIMUTH ELEVATION", "turn the light so that its +x axis points there, degrees", finite),
    row("--roll-light DEGREES", "before that, turn the light about its +x axis", finite),
)

FORCE = row("--force", "replace a file even if shviewer did not write it")

JOBS = row(
    "--jobs N",
    "processes for several lights (default as many as there are cores and memory for, once it pays)",
    positive_count,
)


def _shown() -> tuple[Argument, ...]:
    from shviewer.viewer.view import View  # modes that draw nothing load nothing of the viewer

    compare = (
        "show the coefficients in FILE instead of the light's own, and say how well they agree, or by which usual "
        "mistake they are off; finds out the convention of a bare list, if none is named"
    )
    anew = "project the light as it stands when it is turned, so that samples do not turn with it"
    size = row("--size W H", "pixels (default 1280 640, or those of the picture)", whole)
    return row("--compare FILE", compare), *rows_of(View), *TURN, row("--anew", anew), size


def reading(convention: str = "--convention") -> Group:
    """How to read images, and coefficients that do not name their convention, which is called `convention`."""
    bare = (
        "convention of a bare list of coefficients, such as three, unity or shviewer,y-up,no-phase: the names and"
        " modifiers of project's --convention"
    )
    repair = "repair NaN, infinite and negative texels of an image instead of refusing or keeping them"
    memory = "memory that an image may take until it is drawn, in MiB (default half of what is available)"
    rows = (
        row(f"{convention} C", bare, dest="input_convention", default=""),
        row("--sanitize", repair, default=None),
        row("--layout L", "how an image covers the sphere: auto (default), lat-long, cube, angular or mirror-ball"),
        row("--max-side N", "texels along a side that an image may have (default 32768)", positive_count),
        row("--max-megatexels M", "texels that an image may have, in units of 1024 x 1024 (default 128)", positive),
        row("--max-file-mib M", "size that an image's file may have, in MiB (default 512)", positive),
        row("--max-memory-mib M", memory, positive),
    )
    return Group("reading files", lambda: rows)


PICTURE = (
    row(
        "--like PICTURE",
        "everything but the light as in a picture that shviewer saved; other options come on top of it",
        Path,
    ),
    row("--as-image", "take a picture that shviewer saved for an image, not for the light and the view that it shows"),
    NUMBERS,
    Group("what is shown", _shown),
    reading(),
)
"""Every option that the picture of a light depends on."""
