"""A picture is a session: the state that it was saved from, with the light found again where it is.

Nothing that a picture names is run, waited for, or fetched from another machine.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from shviewer.analysis.comparing.compared_files import compared_with
from shviewer.analysis.options import is_number
from shviewer.analysis.recipe import Recipe, light_name
from shviewer.errors import LightError, ShviewerError, UsageError
from shviewer.harmonics.basis import count_bands
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import built_in_lights, is_code, split_light
from shviewer.lights.reading import Reading
from shviewer.limits import DEFAULT_LIMITS, MAX_BANDS, Limits
from shviewer.viewer.composing.composition import MAX_SIDE, MIN_SIDE
from shviewer.viewer.saving.file_marks import has_mark
from shviewer.viewer.saving.stamp import LIMITS
from shviewer.viewer.saving.stamp_reading import state_of_stamp
from shviewer.viewer.saving.stamps_in_files import stamp_in
from shviewer.viewer.state import State, changed
from shviewer.viewer.view import MAX_EXPOSURE
from shviewer.words import one_line

AS_IMAGE = "--as-image opens it as an image"


class Restored(NamedTuple):
    """What a picture says of itself."""

    state: State
    size: tuple[int, int] | None
    """Its width and height in pixels; None if it does not say."""
    overlay: bool
    said: str
    """What became of its light and of what it compares with; "" if they are what they were."""


class _File(NamedTuple):
    """A file that a picture names, as LIGHT names it; None where there is none."""

    text: str | None
    said: str = ""


def restored(path: Path, limits: Limits = DEFAULT_LIMITS, light: str | None = None) -> Restored | None:
    """The state of a picture that this program saved; None for any other file.

    limits: no higher ones are taken from the picture. light: to be shown in place of the picture's own.
    LightError for a stamp that is damaged, or asks for what this version cannot do.
    """
    try:
        text = stamp_in(path)
        if text is None:
            return None
        said = _read(text)
        if path.suffix.lower() == ".exr" and said.get("spheres") == {}:
            return None  # the radiance of a whole sphere is a light
        return _restored(text, said, path, limits, light)
    except ShviewerError as error:
        raise LightError(f"{path}: {error}; {AS_IMAGE}") from error


def is_session(path: Path) -> bool:
    """Whether a file is more than an image: a picture that this program saved, in whatever state it is."""
    try:
        return restored(path) is not None
    except ShviewerError:
        return True


def _read(text: str) -> dict[str, Any]:
    try:
        said = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise UsageError(f"its stamp is damaged ({error})") from None
    if not isinstance(said, dict):
        raise UsageError("its stamp is damaged: it is no object")
    return said


def _restored(text: str, said: dict[str, Any], path: Path, limits: Limits, light: str | None) -> Restored:
    compares = isinstance(_names(said).get("compare"), dict)
    found, held = _File(light) if light else _light(said, path), _coefficients(said)
    if found.text is None and held is None:
        raise UsageError(f"{found.said}; it keeps no coefficients that could be shown in its place")
    stand_in = CoefficientLight(np.zeros((MAX_BANDS**2, 3))) if compares else None
    state = state_of_stamp(text, found.text or held, stand_in)
    news = [found.said]
    state = changed(state, reading=_within(state.recipe.reading, limits), compare=None)
    if compares and found.text is not None:
        state, told = _comparing(state, said, path)
        news.append(told)
    elif found.text is None:
        state = changed(state, split_sun=False, suns=Recipe.suns, method=Recipe.method, **_exposure(said))
        news.append("the coefficients that the picture kept are shown in its place")
    return Restored(state, _size(said), said.get("overlay") is not False, "; ".join(filter(None, news)))


def _names(said: dict[str, Any]) -> dict[str, Any]:
    """The part of a stamp that names the light and what it is compared with; empty where there is none."""
    state = said.get("state")
    recipe = state.get("recipe") if isinstance(state, dict) else None
    return recipe if isinstance(recipe, dict) else {}


def _file(said: dict[str, Any], name: str) -> dict[str, Any]:
    """What a stamp says of one of its files; empty if nothing."""
    files = said.get("files")
    file = files.get(name) if isinstance(files, dict) else None
    return file if isinstance(file, dict) else {}


def _within(own: Reading, limits: Limits) -> Reading:
    """The reading with its own limits where they are lower than `limits`; no pipe is waited for."""
    least = {name: min(getattr(own.limits, name), getattr(limits, name)) for name in LIMITS}
    return replace(own, limits=replace(limits, pipe_seconds=0, **least))


def _light(said: dict[str, Any], path: Path) -> _File:
    """The light of the picture: a text to find it by, or why there is none."""
    text = _names(said).get("light")
    if not isinstance(text, str):
        return _File(None, f"{one_line(str(said.get('light')), 60)} was an object of Python")
    if is_code(text):
        shown = one_line(text, 120)
        return _File(None, f"{shown} is code, and no picture runs code: shviewer {shown} --like {path.name} does")
    return _found(text, _file(said, "light"), path)


def _found(text: str, mark: dict[str, Any], path: Path) -> _File:
    """A file that a picture names: beside the picture, then in the present folder, rather one with the same bytes."""
    name = one_line(light_name(text), 60)
    if text in built_in_lights():
        here = [text]
    else:
        here = [place for place in _places(text, path.parent) if os.path.isfile(split_light(place)[0])]
    if not here:
        return _File(None, f"{name} is gone: it is neither beside {path.name} nor where it was")
    same = here[:1] if "sha256" not in mark else [place for place in here if has_mark(split_light(place)[0], mark)]
    return _File(same[0]) if same else _File(here[0], f"{name} is no longer the file that it was")


def _places(text: str, folder: Path) -> Iterator[str]:
    """The places where a file may be, none of them on another machine or code."""
    if text.startswith(("\\\\", "//")):
        return
    places = [text, str(folder / light_name(text))] if os.path.isabs(text) else [str(folder / text), text]
    yield from (place for place in dict.fromkeys(places) if not is_code(place))


def _comparing(state: State, said: dict[str, Any], path: Path) -> tuple[State, str]:
    """The state with the coefficients that the picture compares: those of their file, or else those that it kept."""
    mark = _file(said, "compare")
    text = mark.get("path")
    found = _found(text, mark, path) if isinstance(text, str) else _File(None)
    if found.text is not None:
        given = compared_with(state.recipe, found.text)[0].compare
    elif (held := _coefficients(said)) is not None:
        kept = _names(said)["compare"]
        given = replace(held, name=one_line(str(kept.get("name")), 60))
        found = _File(None, f"{given.name} is gone: what the picture kept of it is compared")
    else:
        raise UsageError("the coefficients that it compares are gone")
    assert given is not None
    return changed(state, compare=given, n_bands=min(state.recipe.n_bands, given.n_bands)), found.said


def _coefficients(said: dict[str, Any]) -> CoefficientLight | None:
    """The light of the coefficients that the picture keeps; None if it keeps none. UsageError if they are damaged."""
    rows = said.get("coefficients")
    if rows is None:
        return None
    try:
        if not all(is_number(value) for row in rows for value in row):
            raise ValueError("not numbers")
        numbers = np.array(rows, dtype=np.float64)
        if numbers.ndim != 2 or numbers.shape[1] != 3 or count_bands(numbers) > MAX_BANDS:
            raise ValueError(f"an array of {numbers.shape}")
        return CoefficientLight(numbers, f"{one_line(str(said.get('light')), 60)} (kept coefficients)")
    except (ValueError, TypeError, ArithmeticError, LightError) as error:
        raise UsageError(f"the coefficients in its stamp are damaged ({error})") from None


def _exposure(said: dict[str, Any]) -> dict[str, float]:
    """The exposure of the picture, which was perhaps chosen from the light that is gone."""
    stops = said.get("exposure_stops")
    if not isinstance(stops, int | float) or not abs(stops) <= MAX_EXPOSURE:
        return {}
    return {"exposure_stops": float(stops), "exposure_offset": 0.0}


def _size(said: dict[str, Any]) -> tuple[int, int] | None:
    match said.get("size"):
        case [int(width), int(height)] if all(MIN_SIDE <= side <= MAX_SIDE for side in (width, height)):
            return width, height
    return None
