"""The curves and the primaries of an ICC profile, from its own tags.

Read are profiles of RGB with three curves and a matrix, and of grey with one curve: those that monitors, cameras and
raw converters use. Profiles of tables (A2B0 alone) and of other colours are refused by name.

The matrix leads to the connection space, XYZ adapted to D50. Whatever white its columns add up to becomes that of Rec.
709, so that white stays (1, 1, 1), in profiles of old writers too, whose columns are not adapted.

Source
    [ICC] ICC.1:2022, 7.2 (header), 8.3 and 8.4 (tags), 10.6 (curv), 10.18 (para), 10.15 (mluc), 10.3 (cicp)
"""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.chromaticities import rec709_from_columns
from shviewer.lights.images.display.colour import Colour, Curve, from_cicp, linear_from_srgb, power, power_name
from shviewer.words import one_line

_HEADER = 128  # bytes
_MOST_TAGS = 256
_SAME_LIGHT = 1e-3  # of a curve that is that of sRGB, written as a table; gamma 2.2 is 3.6e-3 away
_SAME_MATRIX = 5e-3  # the same space by two writers; Display P3 is 0.2 away
_PARAMETERS = {0: "g", 1: "gab", 2: "gabc", 3: "gabcd", 4: "gabcdef"}  # of a para curve, by its type


def colour_of_profile(profile: bytes) -> Colour:
    """The colour that an ICC profile describes; sRGB without a note if it is that, or if there is none.

    A profile that is not read is a note. LightError for one of HDR.
    """
    if not profile:
        return Colour()
    try:
        tags = _tags(profile)
    except LightError as reason:
        return Colour(notes=(f"its colour profile (ICC) is ignored ({reason}), sRGB assumed",))
    shown = f"its colour profile (ICC {_name(tags)!r})"
    if (cicp := tags.get(b"cicp", b"")[8:10]) and len(cicp) == 2 and cicp[1] in (16, 18):
        return from_cicp(*cicp)
    try:
        curves, matrix = _curves_and_matrix(profile[16:20], tags)
        steps = np.linspace(0.0, 1.0, 1025)
        light = [curve(steps) for curve in curves]
        if not all(values[-1] > values[0] for values in light):
            raise LightError("its curve does not rise")
    except LightError as reason:
        return Colour(notes=(f"{shown} is ignored ({reason}), sRGB assumed",))
    if all(np.abs(values - linear_from_srgb(steps)).max() < _SAME_LIGHT for values in light):
        curves, curve_name = (linear_from_srgb,), "sRGB"
    else:
        curve_name = _power_of(steps, light) or "ICC curve"
    if matrix is not None and np.abs(matrix - np.eye(3)).max() < _SAME_MATRIX:
        matrix = None
    if curve_name == "sRGB" and matrix is None:
        return Colour()
    primaries = "of Rec. 709" if matrix is None else "converted to Rec. 709"
    return Colour(curves, curve_name, matrix, (f"{shown} is honoured: {curve_name}, primaries {primaries}",))


def _power_of(steps: NDArray[np.float64], light: list[NDArray[np.float64]]) -> str:
    """The name of a curve that is a plain power, the same in all channels; else ""."""
    middle = len(steps) // 2
    if not 0.0 < light[0][middle] < 1.0:
        return ""
    exponent = float(np.round(np.log(light[0][middle]) / np.log(steps[middle]), 2))
    if any(np.abs(values - steps**exponent).max() > _SAME_LIGHT for values in light):
        return ""
    return power_name(exponent)


def _tags(profile: bytes) -> dict[bytes, bytes]:
    """Signature -> content of each tag. LightError if this is no profile."""
    if len(profile) < _HEADER + 4 or profile[36:40] != b"acsp":
        raise LightError("it is no profile")
    count = int.from_bytes(profile[_HEADER : _HEADER + 4], "big")
    if count > _MOST_TAGS or len(profile) < _HEADER + 4 + 12 * count:
        raise LightError("it is cut short")
    tags: dict[bytes, bytes] = {}
    for signature, start, size in struct.iter_unpack(">4sII", profile[_HEADER + 4 : _HEADER + 4 + 12 * count]):
        if start + size > len(profile):
            raise LightError("it is cut short")
        tags[signature] = profile[start : start + size]
    return tags


def _name(tags: dict[bytes, bytes]) -> str:
    """What the profile calls itself, on one line."""
    tag = tags.get(b"desc", b"")
    if tag.startswith(b"mluc") and len(tag) >= 28:
        size, start = struct.unpack_from(">II", tag, 20)
        text = tag[start : start + size].decode("utf-16-be", "replace")
    else:
        text = tag[12 : 12 + int.from_bytes(tag[8:12], "big")].decode("latin-1")
    return one_line(text.rstrip("\0"), 60)


def _curves_and_matrix(
    colours: bytes, tags: dict[bytes, bytes]
) -> tuple[tuple[Curve, ...], NDArray[np.float64] | None]:
    if colours == b"GRAY" and b"kTRC" in tags:
        return (_curve(tags[b"kTRC"]),), None
    if colours != b"RGB ":
        raise LightError("it is not for RGB or grey")
    if not all(letter + b"TRC" in tags and letter + b"XYZ" in tags for letter in (b"r", b"g", b"b")):
        raise LightError("it has no curves and matrix")
    columns = [_xyz(tags[letter + b"XYZ"]) for letter in (b"r", b"g", b"b")]
    curves = tuple(_curve(tags[letter + b"TRC"]) for letter in (b"r", b"g", b"b"))
    return curves, rec709_from_columns(np.transpose(columns))


def _xyz(tag: bytes) -> list[float]:
    if not tag.startswith(b"XYZ ") or len(tag) < 20:
        raise LightError("its matrix is damaged")
    return [number / 65536 for number in struct.unpack_from(">3i", tag, 8)]


def _curve(tag: bytes) -> Curve:
    """The curve of a `curv` or `para` tag, from 0 to 1. LightError for any other."""
    kind, size = tag[:4], len(tag)
    if kind == b"curv" and size >= 12:
        count = int.from_bytes(tag[8:12], "big")
        if size < 12 + 2 * count:
            raise LightError("its curve is cut short")
        values = np.frombuffer(tag, ">u2", count, 12).astype(np.float64)
        if count == 0:
            return power(1.0)
        if count == 1:
            return power(float(values[0]) / 256)
        return lambda encoded: np.interp(encoded, np.linspace(0.0, 1.0, count), values / 65535)
    names = _PARAMETERS.get(int.from_bytes(tag[8:10], "big"), "") if kind == b"para" else ""
    if not names or size < 12 + 4 * len(names):
        raise LightError("its curve is of no kind that is read")
    numbers = struct.unpack_from(f">{len(names)}i", tag, 12)
    return _parametric({name: number / 65536 for name, number in zip(names, numbers, strict=True)})


def _parametric(p: dict[str, float]) -> Curve:
    """(a x + b) ** g + e from x = d on, below it c x + f, in the range of light [ICC, table 68]."""
    a, b, g = p.get("a", 1.0), p.get("b", 0.0), p["g"]
    if "d" in p:
        start, slope, above, below = p["d"], p["c"], p.get("e", 0.0), p.get("f", 0.0)
    else:
        start, slope = (-b / a if a else 0.0), 0.0
        above = below = p.get("c", 0.0)

    def curve(encoded: NDArray[np.float64]) -> NDArray[np.float64]:
        with np.errstate(all="ignore"):  # what is infinite becomes 1
            upper = np.maximum(a * encoded + b, 0.0) ** g + above
        light: NDArray[np.float64] = np.clip(np.where(encoded >= start, upper, slope * encoded + below), 0.0, 1.0)
        return light

    return curve
