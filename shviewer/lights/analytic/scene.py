"""Scene files: lobe lights written in TOML.

    description = "A warm key light over a dim sky"

    [[lobe]]
    profile = "gaussian"        # "clamped-linear", "disc", "gaussian" or "constant"
    axis = [1, 0.5, 2]          # any length; or azimuth_degrees and elevation_degrees; none for a constant
    radiance = [8, 6, 4]        # linear RGB, or one number for grey; may be negative
    sharpness = 40              # clamped-linear: slope, offset; disc: half_angle_degrees

Every mistake is reported with the file, the key and what was expected.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from shviewer.errors import LightError, refused_as
from shviewer.files import naming, read_bytes
from shviewer.harmonics.basis import Array
from shviewer.harmonics.quadrature import directions_from_angles
from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc, Gaussian, Profile
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.limits import BRIGHTEST, DEFAULT_LIMITS, Limits
from shviewer.words import meant, one_line

PROFILES: dict[str, tuple[tuple[str, ...], Callable[..., Profile]]] = {
    "clamped-linear": (("slope", "offset"), ClampedLinear),
    "disc": (("half_angle_degrees",), lambda degrees: Disc(float(np.radians(degrees)))),
    "gaussian": (("sharpness",), Gaussian),
    "constant": ((), Constant),
}

AXIS_KEYS = ("axis", "azimuth_degrees", "elevation_degrees")

MAX_FILE_BYTES = 2**16
"""A KiB for each of the most lobes."""

MAX_DOTS = 200
"""The most dots in a line. The time and memory of Python's reader of TOML grow with the square of those in a key."""


def read_scene(path: Path, limits: Limits = DEFAULT_LIMITS) -> LobeLight:
    """The lobe light in a .toml file. LightError with file, key and rule for anything wrong with it."""
    with naming(str(path)):
        data = read_bytes(path, limits, MAX_FILE_BYTES, f"a scene file has at most {MAX_FILE_BYTES}")
        for number, line in enumerate(data.splitlines(), 1):
            if line.count(b".") > MAX_DOTS:
                raise LightError(f"line {number} has {line.count(b'.')} dots; a line of a scene has at most {MAX_DOTS}")
        try:
            document = tomllib.loads(data.decode())
        except UnicodeDecodeError as error:
            raise LightError(f"byte {error.start} is not UTF-8 text; a scene is a TOML file") from error
        except (ValueError, RecursionError) as error:  # tomllib lets errors of int() and of deep nesting through
            raise LightError(f"not valid TOML: {error}") from error
        _only("the file", document, ("description", "lobe"))
        description = document.get("description", "")
        if not isinstance(description, str):
            raise _wrong("description", description, "a text")
        tables = document.get("lobe", [])
        if not (isinstance(tables, list) and all(isinstance(table, dict) for table in tables) and tables):
            raise LightError("no lobe; a scene has one or more [[lobe]] tables")
        lobes = tuple(_lobe(f"lobe {number}", table) for number, table in enumerate(tables, 1))
    with refused_as(LightError, f"{path}: "):
        light = LobeLight(lobes, str(path), one_line(description))
    return replace(light, name=one_line(path.stem))  # errors name the file, all else the light


def _lobe(where: str, table: dict[str, Any]) -> Lobe:
    kind = table.get("profile")
    if not isinstance(kind, str) or kind not in PROFILES:
        raise _wrong(f"{where}: profile", kind, meant(kind if isinstance(kind, str) else "", PROFILES))
    parameters, make = PROFILES[kind]
    _only(where, table, ("profile", "radiance", *parameters, *(() if kind == "constant" else AXIS_KEYS)))
    numbers = [_number(f"{where}: {key}", table.get(key)) for key in parameters]
    with refused_as(LightError, f"{where}: "):
        profile = make(*numbers)
    axis = np.array([0.0, 0.0, 1.0]) if kind == "constant" else _axis(where, table)
    return Lobe(profile, axis, _radiance(f"{where}: radiance", table.get("radiance")))


def _axis(where: str, table: dict[str, Any]) -> Array:
    if "axis" in table:
        if "azimuth_degrees" in table or "elevation_degrees" in table:
            raise LightError(f"{where}: give axis or azimuth_degrees and elevation_degrees, not both")
        vector = _vector(f"{where}: axis", table["axis"])
        if not vector.any():
            raise _wrong(f"{where}: axis", table["axis"], "a vector that is not zero")
        return vector
    if "azimuth_degrees" not in table and "elevation_degrees" not in table:
        raise LightError(f"{where}: no axis; give axis = [x, y, z] or azimuth_degrees and elevation_degrees")
    azimuth, elevation = (
        np.radians(_number(f"{where}: {key}", table.get(key))) for key in ("azimuth_degrees", "elevation_degrees")
    )
    if abs(elevation) > np.pi / 2:
        raise _wrong(f"{where}: elevation_degrees", table["elevation_degrees"], "-90 to 90")
    return directions_from_angles(np.array(np.pi / 2 - elevation), np.array(azimuth))


def _radiance(key: str, value: Any) -> Array:
    colour = _vector(key, value if isinstance(value, list) else [value] * 3)
    if np.abs(colour).max() > BRIGHTEST:
        raise _wrong(key, value, f"at most {BRIGHTEST:g} in magnitude")
    return colour


def _vector(key: str, value: Any) -> Array:
    if not isinstance(value, list) or len(value) != 3:
        raise _wrong(key, value, "three numbers")
    return np.array([_number(key, component) for component in value])


def _number(key: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e300:
        raise _wrong(key, value, "a finite number")
    return float(value)


def _only(where: str, table: dict[str, Any], known: tuple[str, ...]) -> None:
    for key in table:
        if key not in known:
            advice = meant(key, known, f"known are {', '.join(known)}")
            raise LightError(f"{where}: unknown key {key!r}; {advice}")


def _wrong(key: str, value: Any, expected: str) -> LightError:
    found = "missing" if value is None else repr(value)
    advice = expected if expected.startswith(("did you", "it must")) else f"it must be {expected}"
    return LightError(f"{key} is {found}; {advice}")
