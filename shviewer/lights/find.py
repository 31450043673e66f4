"""From the text LIGHT of a command line to the light and the file that it is read from."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar
from weakref import WeakKeyDictionary

from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
from shviewer.errors import LightError
from shviewer.files import FileVersion, version_of
from shviewer.lights.images.radiance_files import IMAGE_SUFFIXES
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.resources import resource_folder
from shviewer.words import meant

if TYPE_CHECKING:  # each kind of light is imported when one is found
    from shviewer.lights.light import Light

SomeLight = TypeVar("SomeLight", bound="Light")


def built_in_lights() -> dict[str, Path]:
    """Name -> file of every light in assets/: the scenes first, the paper's default first of all."""
    scenes = sorted(resource_folder("assets").glob("scenes/*.toml"), key=lambda path: (path.stem != "green", path.stem))
    maps = sorted(path for path in resource_folder("assets").glob("environments/*") if path.suffix in IMAGE_SUFFIXES)
    return {path.stem: path for path in [*scenes, *maps]}


def split_light(text: str) -> tuple[Path, str]:
    """The file that LIGHT names, and the layer of "file.exr:layer" or the function of "file.py:function", or "".

    A built-in name comes first, then whatever has that very name, a link that leads nowhere too: a name that a folder holds
    is never taken for code to run.
    """
    path = built_in_lights().get(text) or Path(text)
    file, _, part = text.rpartition(":")
    if part and file.lower().endswith((".exr", ".py")) and not os.path.lexists(path):
        return Path(file), part
    return path, ""


def is_code(text: str) -> bool:
    """Whether LIGHT names a function in a Python file, which is run to find it."""
    path, part = split_light(text)
    return bool(part) and path.suffix.lower() == ".py"


def is_image(light: str | Light) -> bool:
    """Whether a light is an image, or LIGHT names what may be one: then a layout and repairs have a meaning."""
    if isinstance(light, str):
        return split_light(light)[0].suffix.lower() in (*IMAGE_SUFFIXES, ".npy")
    return light.source.about.layout is not None


def file_version(text: str) -> FileVersion | None:
    """The present version of the file of the light that `text` names; None where there is no file."""
    return version_of(split_light(text)[0])


_FILES: WeakKeyDictionary[Light, tuple[Path, FileVersion | None]] = WeakKeyDictionary()


def file_of(light: str | Light) -> Path | None:
    """The file that a light is read from, or that the text of a command line names; None for a light that has none."""
    return split_light(light)[0] if isinstance(light, str) else _FILES.get(light.source, (None, None))[0]


def version_of_light(light: Light) -> FileVersion | None:
    """The version that the light's file had when it was read; None if it has none."""
    return _FILES.get(light.source, (None, None))[1]


def read_from(light: SomeLight, path: Path, version: FileVersion | None = None) -> SomeLight:
    """The light, which from now on is known to come from that file. version: the file's before it was read."""
    _FILES[light] = Path(os.path.abspath(path)), version
    return light


def find_light(text: str, reading: Reading = DEFAULT_READING) -> Light:
    """The light that `text` names: a built-in, a scene, an image, coefficients, a "file.exr:layer" or a "file.py:function".

    `reading` says how to read an image, and the convention of numbers that do not name theirs.
    LightError if there is no such light or its file is bad.
    """
    path, part = split_light(text)
    version = version_of(path)  # asked first: a change during the reading is a later version
    return read_from(_read(text, path, part, reading), path, version)


def _read(text: str, path: Path, part: str, reading: Reading) -> Light:
    suffix = path.suffix.lower()
    if suffix == ".toml":
        from shviewer.lights.analytic.scene import read_scene

        return read_scene(path, reading.limits)
    if suffix in IMAGE_SUFFIXES or (suffix == ".npy" and _holds_image(path, reading)):
        from shviewer.lights.environment import EnvironmentLight

        return EnvironmentLight.read(path, reading, part)
    if suffix in COEFFICIENT_SUFFIXES:
        from shviewer.lights.coefficient_light import CoefficientLight

        return CoefficientLight.read(path, reading)
    if part:
        from shviewer.lights.function import load_function

        return load_function(path, part, reading.limits)
    raise LightError(_unknown(text))


def _holds_image(path: Path, reading: Reading) -> bool:
    from shviewer.lights.images.others.arrays import holds_image

    return holds_image(path, reading.limits)


def _what_it_is(text: str) -> str:
    """The reason why the file or directory `text` is no light, and the remedy; "" if nothing has that name."""
    path = Path(text)
    if not os.path.exists(path):
        return _what_the_colon_is(text)
    if path.is_dir():
        return "a directory; name one file in it"
    if path.suffix == ".py":
        return f"a Python file; name a function in it, such as {path.name}:light"
    known = (".toml", *IMAGE_SUFFIXES, *COEFFICIENT_SUFFIXES)
    return f"a file must end in {', '.join(known[:-1])} or {known[-1]}: convert it"


def _what_the_colon_is(text: str) -> str:
    """The fault of the part after the last colon; "" if there is no colon, or no file of a known kind before it."""
    file, _, part = text.rpartition(":")
    suffix = Path(file).suffix.lower()
    if suffix == ".exr" and not part:
        return "no layer is named after ':'; name one or leave out the ':'"
    if suffix == ".py" and not part:
        return f"no function is named after ':'; name one, such as {Path(file).name}:light"
    if suffix in (*IMAGE_SUFFIXES, ".toml"):
        return f"only .exr files have layers; leave out :{part}"
    return ""


def _neighbours(text: str) -> list[str]:
    """The files of the folder in which `text` would be one, as it would name them."""
    folder = os.path.dirname(text)
    try:
        return [os.path.join(folder, name) for name in os.listdir(folder or ".")]
    except (OSError, ValueError):
        return []


def _unknown(text: str) -> str:
    names = list(built_in_lights())
    offer = meant(text, [*names, *_neighbours(text)], f"there is: {', '.join(names)}")
    return f"unknown light {text!r}: {_what_it_is(text) or offer}"
