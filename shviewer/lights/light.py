"""What every light can do, and how the text LIGHT of a command line becomes one."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Protocol

from shviewer.errors import LightError
from shviewer.harmonics.basis import Array
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.radiance_files import DEFAULT_READING, Reading
from shviewer.resources import resource_folder

IMAGE_SUFFIXES = (".hdr", ".pic", ".rgbe", ".exr", ".png", ".jpg", ".jpeg")
COEFFICIENT_SUFFIXES = (".json", ".csv", ".txt", ".h", ".glsl", ".npz", ".npy")


class Light(Protocol):
    """A function on the sphere with values in linear RGB; it may be negative."""

    @property
    def name(self) -> str:
        """What the user calls it: a built-in name, a file's stem or a function's name."""

    @property
    def description(self) -> str:
        """A few words under the name."""

    @property
    def notes(self) -> tuple[str, ...]:
        """Warnings worth a line each, such as negative texels."""

    @property
    def best_method(self) -> str:
        """How `coefficients` computes, in words: "closed form", "exact texel integrals", ..."""

    def radiance(self, directions: Array) -> Array:
        """Unit directions (k, 3) -> radiance (k, 3), float64."""

    def integrand(self, directions: Array) -> Array:
        """What `coefficients` are integrals of: the radiance, or for an image its texels as areas, not interpolated."""

    def coefficients(self, n_bands: int) -> Array:
        """(n_bands**2, 3) by the best way this light knows."""

    @property
    def unit(self) -> float:
        """What is squared is divided by this first: 1, or a power of two where squares would leave float64."""

    def products(self) -> Array:
        """Integrals of f_i f_j / unit^2 over the channels, (3, 3), by the same quadrature as `coefficients`."""

    def accuracy(self) -> float:
        """How far a relative L2 error of this light may be off for want of quadrature points; 0 where it is exact."""

    def landmarks(self) -> Array:
        """Directions (j, 3) of features that a grid might step over, such as the axis of a sun."""

    def __hash__(self) -> int:
        """By identity: what is computed for a light is remembered."""

    def radiance_map(self) -> LatLongMap | None:
        """What the GPU samples; None for lobes, which the shader evaluates itself."""


def built_in_lights() -> dict[str, Path]:
    """Name -> file of every light in assets/: the scenes first, the paper's default first of all."""
    scenes = sorted(resource_folder("assets").glob("scenes/*.toml"), key=lambda path: (path.stem != "green", path.stem))
    maps = sorted(path for path in resource_folder("assets").glob("environments/*") if path.suffix in IMAGE_SUFFIXES)
    return {path.stem: path for path in [*scenes, *maps]}


def split_light(text: str) -> tuple[Path, str]:
    """The file that a LIGHT names, and what in it: the layer of "file.exr:layer", the function of "file.py:function", or "".

    A built-in name comes first, then a file of that very name.
    """
    path = built_in_lights().get(text) or Path(text)
    file, _, part = text.rpartition(":")
    if part and file.lower().endswith((".exr", ".py")) and not _exists(path):
        return Path(file), part
    return path, ""


def find_light(text: str, reading: Reading = DEFAULT_READING) -> Light:
    """The light that `text` names: a built-in, a scene, an image, coefficients, a "file.exr:layer" or a "file.py:function".

    `reading` says how an image is read, and which convention numbers have that do not say it.
    LightError if there is no such light or its file is bad.
    """
    from shviewer.lights.environment import EnvironmentLight
    from shviewer.lights.function import load_function
    from shviewer.lights.scene import read_scene

    path, part = split_light(text)
    if path.suffix.lower() == ".toml":
        return read_scene(path)
    if path.suffix.lower() in IMAGE_SUFFIXES:
        return EnvironmentLight.read(path, reading, part)
    if path.suffix.lower() in COEFFICIENT_SUFFIXES:
        from shviewer.lights.coefficients.light import CoefficientLight

        return CoefficientLight.read(path, reading)
    if part:
        return load_function(path, part)
    raise LightError(_unknown(text))


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # too long for a file name, or with a zero byte
        return False


def _what_it_is(text: str) -> str:
    """What a path is that cannot be a light, and what to do; "" if there is nothing of that name."""
    path = Path(text)
    if not _exists(path):
        return _what_the_colon_is(text)
    if path.is_dir():
        return "a directory; name one file in it"
    if path.suffix == ".py":
        return f"a Python file; name a function in it, such as {path.name}:light"
    known = (".toml", *IMAGE_SUFFIXES, *COEFFICIENT_SUFFIXES)
    return f"a file must end in {', '.join(known[:-1])} or {known[-1]}: convert it"


def _what_the_colon_is(text: str) -> str:
    """What is wrong with the part after a file's last colon; "" if there is none, or no file of a known kind before it."""
    file, _, part = text.rpartition(":")
    suffix = Path(file).suffix.lower()
    if suffix == ".exr" and not part:
        return "no layer is named after ':'; name one or leave out the ':'"
    if suffix == ".py" and not part:
        return f"no function is named after ':'; name one, such as {Path(file).name}:light"
    if suffix in (*IMAGE_SUFFIXES, ".toml"):
        return f"only .exr files have layers; leave out :{part}"
    return ""


def _unknown(text: str) -> str:
    names = list(built_in_lights())
    near = difflib.get_close_matches(text, names, n=3, cutoff=0.5)
    offer = f"did you mean {' or '.join(near)}?" if near else f"there is: {', '.join(names)}"
    return f"unknown light {text!r}: {_what_it_is(text) or offer}"
