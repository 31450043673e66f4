"""Several lights at once: files, and the lights in folders."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from glob import glob
from pathlib import Path
from typing import NamedTuple

from shviewer.coefficients.stamp import SCHEMA_KEY
from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
from shviewer.files import opened
from shviewer.lights.find import is_code, split_light
from shviewer.lights.images.radiance_files import IMAGE_SUFFIXES
from shviewer.words import one_line

_LOOK = 2**16  # bytes at the beginning of a file that may be something else


class Several(NamedTuple):
    """Lights in the order in which they were named, each once, and a line on each thing that was left out."""

    lights: tuple[str, ...]
    said: tuple[str, ...]


def several(texts: Iterable[str], *, most: int | None = None, code: bool = False, bare: bool = False) -> Several:
    """The lights that texts name, and those in the folders that they name; none of these files is read to its end.

    Of a folder: images, scenes, and coefficients with our stamp, by name, no hidden ones and none of folders within; if
    there are some, that is said. most: how many are taken. code: whether a function in a Python file may be one. bare:
    whether coefficients without a stamp are.
    """
    lights: list[str] = []
    said: list[str] = []
    for text in texts:
        if not code and (is_code(text) or text.endswith(".py")):
            said.append(one_line(f"{text}: code runs only when the command line names it"))
        elif os.path.isdir(split_light(text)[0]):
            held = list(_lights_in(Path(text), bare))
            lights += held
            if not held:
                said.append(one_line(f"{text}: a folder without a light"))
            if within := [folder for folder in _folders_in(Path(text)) if any(_lights_in(folder, bare))]:
                more = f", and {len(within) - 1} more," if len(within) > 1 else ""
                verb = "have" if more else "has"
                said.append(one_line(f"{within[0]}{more} {verb} lights, too: name such a folder to have them"))
        else:
            lights.append(text)
    found = list(dict.fromkeys(lights))
    if most is not None and len(found) > most:
        said.append(f"the first {most} of {len(found)} files are opened")
    return Several(tuple(found[:most]), tuple(said))


def matching(texts: Iterable[str]) -> list[str]:
    """The texts; in place of patterns such as *.hdr, which not every shell replaces, what they match, if there is anything."""
    found: list[str] = []
    for text in texts:
        pattern = any(sign in text for sign in "*?[") and not os.path.lexists(split_light(text)[0])
        found += (sorted(glob(text), key=_natural) if pattern else []) or [text]
    return found


def _lights_in(folder: Path, bare: bool) -> Iterator[str]:
    return (str(path) for path in _seen_in(folder) if path.is_file() and _is_light(path, bare))


def _folders_in(folder: Path) -> Iterator[Path]:
    return (path for path in _seen_in(folder) if path.is_dir())


def _seen_in(folder: Path) -> list[Path]:
    """What is in a folder, by name, but for what is hidden; nothing if it cannot be read."""
    try:
        names = sorted(os.listdir(folder), key=_natural)
    except OSError:
        return []
    return [folder / name for name in names if not name.startswith(".")]


def _is_light(path: Path, bare: bool) -> bool:
    suffix = path.suffix.lower()
    if suffix in IMAGE_SUFFIXES or (bare and suffix in COEFFICIENT_SUFFIXES):
        return True
    mark = b"[[lobe]]" if suffix == ".toml" else SCHEMA_KEY.encode() if suffix in COEFFICIENT_SUFFIXES else None
    if mark is None:
        return False
    try:
        with opened(path) as file:
            head = file.read(_LOOK)
    except OSError:
        return False
    return mark in head or mark.decode().encode("utf-32-le") in head  # as an NPZ has it


def _natural(name: str) -> list[tuple[str, int]]:
    """A key by which sky-2 comes before sky-10."""
    return [(text.casefold(), int(digits or 0)) for text, digits in re.findall(r"(\D*)(\d*)", name)]
