"""The state that the stamp of a picture tells, read back. Nothing but a UsageError comes out of a stamp that is none."""

from __future__ import annotations

import json
import math
from dataclasses import fields
from typing import Any

from shviewer.analysis.options import Choice, Flag, Kind, Whole, is_number, taken, whole
from shviewer.analysis.recipe import Recipe
from shviewer.errors import UsageError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import is_code
from shviewer.lights.light import Light
from shviewer.lights.reading import LAYOUT_CHOICES, Reading
from shviewer.limits import MAX_BANDS, Limits
from shviewer.viewer.camera import Quaternion, turn_of
from shviewer.viewer.saving.stamp import LIMITS, SCHEMA
from shviewer.viewer.state import State
from shviewer.viewer.view import SEEDS, SHEETS, View

BESIDE: dict[str, Kind] = {
    "cursor": Whole(0, MAX_BANDS - 1, "cursor {}", f"bands are counted from 0 to {MAX_BANDS - 1}"),
    "cursor_visible": Flag(),
    "help_visible": Flag(),
    "range_held": Flag(),
    "help_page": Whole(0, 99, "page {} of the help", "pages are counted from 0"),
    "sheet": Choice(SHEETS),
    "turning": Choice(("", *SEEDS)),
    "sweep_to": Whole(1, MAX_BANDS, "a sweep to {} bands", f"the viewer shows 1 to {MAX_BANDS}"),
}
"""Fields of the view that are no options, and their kinds."""


def state_of_stamp(text: str, light: str | Light | None = None, compare: CoefficientLight | None = None) -> State:
    """The state that a stamp tells. `light` and `compare` give what no text can hold: a light object and coefficients.

    UsageError for a text that is no stamp, one of a later schema, or a value out of range.
    """
    try:
        said = json.loads(text)
        if said["schema"] > SCHEMA:
            raise UsageError(f"a picture of schema {said['schema']}: this version reads {SCHEMA}; update shviewer")
        recipe, view = _told(said["state"])
        given = said["state"]["recipe"].get("compare")
        compared = str(given["name"]) if given else ""
    except (ArithmeticError, ValueError, TypeError, LookupError, AttributeError, RecursionError) as error:
        raise UsageError(f"no stamp of a picture ({error}): save the picture again") from error
    name = recipe.pop("light", None)
    if light is None and name is None:
        raise UsageError("the picture is of a light that has no text to name it: give the light")
    if light is None and is_code(name):
        raise UsageError(f"the picture is of {name}, which is code, and no picture runs code: give the light")
    if compared and compare is None:
        raise UsageError(f"the picture compares with {compared}: give those coefficients")
    if compare is not None and recipe.get("n_bands", 1) > compare.n_bands:
        raise UsageError(f"{recipe['n_bands']} bands: {compare.extent}; give the coefficients of the picture")
    shown = light or name or Recipe.light
    state = State(Recipe(light=shown, compare=compare, **recipe), View(**view), (shown,))
    state.check()
    return state


def _told(said: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """The values of recipe and view; fields that a later version may have added are left out."""
    recipe = {part.name: said["recipe"][part.name] for part in fields(Recipe) if part.name in said["recipe"]}
    view = {part.name: said["view"][part.name] for part in fields(View) if part.name in said["view"]}
    recipe |= taken(recipe, Recipe) | {"reading": _told_reading(recipe["reading"])}
    view |= taken(view, View) | {"light_rotation": _told_rotation(view["light_rotation"])}
    if recipe.get("turn") is not None:
        recipe["turn"] = turn_of(view["light_rotation"])
    view["trace"] = tuple(map(_change, view.get("trace", ())))
    for name, kind in BESIDE.items():
        if name in view and (view[name] is not None or name != "sweep_to"):
            view[name] = kind.taken(name, view[name])
            kind.check(name, view[name])
    if not isinstance(view["message"], str) or not isinstance(recipe["light"], str | None):
        raise ValueError("light and message are texts")
    recipe.pop("compare")
    return recipe, view


def _told_reading(said: dict[str, Any]) -> Reading:
    limits = Limits(**{name: whole(said["limits"][name], name) for name in LIMITS})
    if (
        said["layout"] not in LAYOUT_CHOICES
        or not isinstance(said["convention"], str)
        or min(getattr(limits, name) for name in LIMITS) < 1
    ):
        raise ValueError("a reading that there is not")
    return Reading(Flag().taken("sanitize", said["sanitize"]), said["layout"], limits, said["convention"])


def _told_rotation(said: list[Any]) -> Quaternion:
    x, y, z, w = map(float, said)
    if not abs(math.hypot(x, y, z, w) - 1) < 1e-6:
        raise ValueError(f"a light rotation of length {math.hypot(x, y, z, w):g}")
    return x, y, z, w


def _change(said: Any) -> float:
    """A finite number from 0 up. ValueError for anything else."""
    if not (is_number(said) and said >= 0):
        raise ValueError(f"a share of {said!r}")
    return float(said)
