"""Coefficients in JSON: lists of rows, objects of channels or of names, and the files of three.js, glTF and Babylon.js.

three.js    `LightProbe.toJSON` [src/lights/LightProbe.js]: an object of type LightProbe with 27 numbers `sh` and an intensity,
            which its renderer multiplies them by; `JSON.stringify` of a SphericalHarmonics3 has `isSphericalHarmonics3`.
glTF        `EXT_lights_image_based`, 9 rows `irradianceCoefficients`. Neither text nor schema states sign, scale or axes, and
            its readers differ. Babylon.js [loaders, EXT_lights_image_based] takes irradiance, orthonormal with phase, and
            divides by pi; in its default scene the light is not mirrored if written in the axes -y+z+x.
Babylon.js  an object with `l00`, `l1_1`, `l10`, `l11`, `l2_2` ... of vectors, an underscore for the minus.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.lists.cilm import rows_of_cilm
from shviewer.coefficients.lists.names import are_places, channel_order, places_of
from shviewer.coefficients.numbers import MAX_NUMBERS, Listed, arranged
from shviewer.errors import LightError
from shviewer.limits import MAX_BANDS

THREE, GLTF = "three", "shviewer,irradiance,-y+z+x"


def read_structure(found: object) -> Listed:
    """The coefficients in a JSON value without a stamp. LightError if there are none, or several."""
    probes = [one for one in _objects(found) if _is_probe(one) or "irradianceCoefficients" in one]
    if len(probes) > 1:
        raise LightError(f"{len(probes)} lights with coefficients in it; keep one of them")
    if probes:
        return _three(probes[0]) if _is_probe(probes[0]) else _gltf(probes[0])
    if not isinstance(found, dict):
        return rows_of_cilm(_array(found)) if _depth(found) > 2 else arranged(rows_of_numbers(found))
    if "coefficients" in found:
        listed = arranged(rows_of_numbers(found["coefficients"]))
        if found.get("isSphericalHarmonics3") is not True:
            return listed
        return replace(listed, notes=(), implied=THREE, implied_by="a SphericalHarmonics3 of three.js: taken as three")
    if (channels := _by_channel(found)) is not None:
        return arranged(rows_of_numbers(channels))
    rows = {key: value for key, value in found.items() if isinstance(value, list | dict)}
    if len(rows) > 1 and (place := places_of(list(rows))) is not None:
        found_rows = arranged(rows_of_numbers(list(rows.values()))[np.argsort(place)])
        return replace(found_rows, placed=are_places(list(rows)))
    raise LightError(
        'a JSON object without "coefficients"; it holds rows of red, green and blue there, or is that of three.js or glTF'
    )


def rows_of_numbers(found: object) -> NDArray[np.float64]:
    """A JSON list of numbers (k,), or of rows of numbers or objects of channels (k, j). LightError for anything else."""
    rows = found if isinstance(found, list) else []
    if len(rows) > MAX_NUMBERS:
        raise LightError(f"{len(rows)} rows or numbers: at most {MAX_BANDS} bands, {MAX_NUMBERS} numbers, are read")
    rows = [_by_channel(row) if isinstance(row, dict) else row for row in rows]
    if any(type(value) is bool for row in rows for value in (row if isinstance(row, list) else [row])):
        raise LightError("true or false among the coefficients; they are numbers")
    try:
        numbers = np.array(rows)
    except (ValueError, OverflowError):  # rows of different lengths
        numbers = np.array([])
    if numbers.ndim not in (1, 2) or not numbers.size or numbers.dtype.kind not in "fiu":
        raise LightError("coefficients must be rows of three numbers each, or one list of numbers")
    return numbers.astype(np.float64)


def _depth(found: object) -> int:
    """How many lists the first number is within."""
    return 1 + _depth(found[0]) if isinstance(found, list) and found else 0


def _array(found: object) -> NDArray[Any]:
    try:
        return np.array(found, dtype=np.float64)
    except (ValueError, OverflowError, TypeError):
        raise LightError(
            "lists of different lengths, or of something else than numbers; rows are equally long"
        ) from None


def _by_channel(found: Mapping[str, Any]) -> list[Any] | None:
    """What an object of channels, {"r": ..., "g": ..., "b": ...}, holds of each; None for any other object."""
    named = [key for key in found if key != "_isDirty"]  # of Babylon's vectors
    order = channel_order(named)
    return [found[named[place]] for place in order] if order and len(order) == len(named) else None


def _objects(found: object) -> Iterator[dict[str, Any]]:
    """Every object within a JSON value."""
    left = [found]
    while left:
        one = left.pop()
        if isinstance(one, dict):
            yield one
        if isinstance(one, dict | list):
            left += one.values() if isinstance(one, dict) else one


def _is_probe(found: Mapping[str, Any]) -> bool:
    return found.get("type") == "LightProbe" and "sh" in found


def _three(probe: Mapping[str, Any]) -> Listed:
    try:
        intensity = float(probe.get("intensity", 1))
    except (TypeError, ValueError, OverflowError):
        raise LightError("its intensity is no number; correct it") from None
    notes = (f"multiplied by its intensity, {intensity:g}",) if intensity != 1 else ()
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused later
        numbers = rows_of_numbers(probe["sh"]) * intensity
    return Listed(numbers, notes=notes, implied=THREE, implied_by="a LightProbe of three.js: taken as three")


def _gltf(light: Mapping[str, Any]) -> Listed:
    usual: dict[str, Any] = {"intensity": 1, "rotation": [0, 0, 0, 1]}
    unused = [name for name, value in usual.items() if light.get(name, value) != value]
    notes = (f"its {' and '.join(unused)} {'are' if len(unused) > 1 else 'is'} not applied",) if unused else ()
    why = f"glTF does not say what irradianceCoefficients are: taken as Babylon.js reads them, {GLTF}"
    return Listed(rows_of_numbers(light["irradianceCoefficients"]), notes=notes, implied=GLTF, implied_by=why)
