"""The inputs of a command: its lights, the picture that its options start from, and how images and lists are read."""

from __future__ import annotations

import argparse
import os
import shlex
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from shviewer.errors import LightError, UsageError, refused_as
from shviewer.outputs import Replacing, may_be_replaced
from shviewer.words import meant

if TYPE_CHECKING:
    from shviewer.lights.reading import Reading
    from shviewer.viewer.saving.restoring import Restored

LIGHT = "green"
"""The light that is shown if none is given."""


def lights_of(options: argparse.Namespace) -> list[str]:
    """The lights that are given, or the one that is shown without any."""
    given = vars(options)
    return given.get("lights") or [given.get("light") or LIGHT]


def lights_within(options: argparse.Namespace) -> list[str]:
    """What is given as LIGHT, folders replaced by the lights that they hold. LightError if they hold none."""
    from shviewer.lights.several import matching, several

    given = matching(lights_of(options))
    if not any(map(os.path.isdir, given)):
        return given
    found = several(given, code=True, bare=bool(options.input_convention))
    if not found.lights:
        lists = "" if options.input_convention else ", or the convention of bare lists"
        raise LightError("; ".join([f"{given[0]}: no light in it; name a file{lists}", *found.said[1:]]))
    for line in found.said:
        print(f"shviewer: note: {line}", file=sys.stderr)
    return list(found.lights)


def check_out(options: argparse.Namespace, mode: str, endings: Sequence[str]) -> None:
    """UsageError if OUT is no file of a kind that the command writes. It says the command if OUT and LIGHT changed places."""
    out, light = options.out, lights_of(options)[0]
    fits = out.suffix.lower() in endings
    if fits and (options.force or may_be_replaced(out)):
        return
    meant = out.with_suffix(endings[0]) if light == LIGHT and not fits else Path(light)
    if _names_light(out) and meant.suffix.lower() in endings and may_be_replaced(meant):
        raise UsageError(f"{out}: OUT comes before LIGHT: {shlex.join(['shviewer', mode, str(meant), str(out)])}")
    if not fits:
        such = f", such as {out.with_suffix(endings[0])}" if out.name else ""
        raise UsageError(f"{out}: OUT must end in {' or '.join(endings)}{such}")


def _names_light(path: Path) -> bool:
    from shviewer.lights.find import built_in_lights

    return path.is_file() or str(path) in built_in_lights()


def pictured_by(options: argparse.Namespace) -> Restored | None:
    """The picture that the options start from, named by --like or as LIGHT; None for another light. It is read once."""
    given = vars(options)
    if "pictured" not in given:
        options.pictured = _pictured(options) if "as_image" in given else None
    found: Restored | None = options.pictured
    return found


def _pictured(options: argparse.Namespace) -> Restored | None:
    from shviewer.lights.find import split_light
    from shviewer.viewer.saving.restoring import restored

    limits = reading_from(options).limits
    if options.like is None:
        path, part = split_light(lights_of(options)[0])
        return None if part or options.as_image else restored(path, limits)
    found = restored(options.like, limits, lights_of(options)[0])
    if found is None:
        raise UsageError(f"--like {options.like}: no picture that shviewer saved; name one, or leave out --like")
    return found


def replacing_of(options: argparse.Namespace) -> Replacing:
    """What the command may replace. Its inputs are its lights, coefficients to compare, and a reference."""
    from shviewer.lights.find import file_of, split_light

    others = [vars(options).get(name) for name in ("compare", "reference", "like")]
    inputs = [*(split_light(light)[0] for light in lights_of(options)), *(Path(other) for other in others if other)]
    if pictured := pictured_by(options):
        named = (pictured.state.recipe.light, pictured.state.recipe.compare)
        inputs += filter(None, (file_of(light) for light in named if light is not None))
    return Replacing(tuple(inputs), options.force)


def reading_from(options: argparse.Namespace, start: Reading | None = None) -> Reading:
    """The reading that the options ask for, on top of `start`. UsageError for an unknown layout or convention."""
    from shviewer.lights.reading import DEFAULT_READING, LAYOUT_CHOICES

    start = start or DEFAULT_READING
    if options.layout is not None and options.layout not in LAYOUT_CHOICES:
        raise UsageError(f"layout {options.layout!r}: {meant(options.layout, LAYOUT_CHOICES)}")
    chosen = {
        "side": options.max_side,
        "texels": _binary_millions(options.max_megatexels),
        "file_bytes": _binary_millions(options.max_file_mib),
        "memory_bytes": _binary_millions(options.max_memory_mib),
    }
    if options.input_convention:
        _check_convention(options, options.input_convention)
    for flag, what, value in (
        ("--sanitize", "it repairs", options.sanitize),
        ("--layout", "it is that of", options.layout),
    ):
        own = "quick" in vars(options) and not options.lights  # a report has images of its own
        if value and not own and not any(map(_may_be_image, lights_of(options))):
            shown = f" {value}" if isinstance(value, str) else ""
            raise UsageError(f"{flag}{shown}: {what} images, and {lights_of(options)[0]} is none; leave it out")
    named = {"sanitize": options.sanitize, "layout": options.layout, "convention": options.input_convention or None}
    limits = replace(start.limits, **_given(chosen))
    return replace(start, limits=limits, **_given(named))


def _may_be_image(light: str) -> bool:
    """Whether LIGHT is an image by its name, or a folder that may hold some."""
    from shviewer.lights.find import split_light
    from shviewer.lights.images.radiance_files import IMAGE_SUFFIXES

    path = split_light(light)[0]
    return path.suffix.lower() in IMAGE_SUFFIXES or not path.suffix


def _given(values: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if value is not None}


def _binary_millions(count: float | None) -> int | None:
    """A count in units of 2**20 as a whole number, at most 2**63, which any machine counts to."""
    return None if count is None else int(min(count, 2**43) * 2**20)


def _check_convention(options: argparse.Namespace, convention: str) -> None:
    """UsageError for a convention of bare lists that is unknown, or if no file is given that it could apply to."""
    from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
    from shviewer.coefficients.texts import parse_convention
    from shviewer.lights.find import split_light

    with refused_as(UsageError):
        parse_convention(convention)
    given, lights = vars(options), lights_of(options)
    if given.get("compare") or any(
        os.path.isdir(text) or split_light(text)[0].suffix.lower() in COEFFICIENT_SUFFIXES for text in lights
    ):
        return
    name = "--input-convention" if "convention" in given else "--convention"
    raise UsageError(
        f"{name} {convention}: it applies to a coefficient file, and {lights[0]} is none; name one as LIGHT"
        + ("" if name == "--input-convention" else " or with --compare")
    )
