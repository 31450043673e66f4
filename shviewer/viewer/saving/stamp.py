"""The stamp of a picture: everything that made it, and its figures, as one JSON text; and the state read back from it.

Schema 1: `state` holds every field of recipe and view, by its name. Older stamps have no schema and no `state`; they are
read as far as they go. Keys are added and never change their meaning.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import asdict, fields
from typing import Any

from shviewer.analysis.options import Flag, Kind, Number, Whole, taken, whole
from shviewer.analysis.recipe import Recipe
from shviewer.errors import UsageError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import is_code
from shviewer.lights.light import Light
from shviewer.lights.reading import LAYOUT_CHOICES, Reading
from shviewer.lights.suns.sun import Sun
from shviewer.limits import MAX_BANDS, Limits
from shviewer.version import __version__
from shviewer.viewer.camera import Quaternion
from shviewer.viewer.colour_maps import map_of
from shviewer.viewer.composition import Composition
from shviewer.viewer.drawn import DirectSum, SplineMap, Surfaces
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import State
from shviewer.viewer.view import MAX_EXPOSURE, View

SCHEMA = 1

EVALUATED = {DirectSum: "direct", SplineMap: "map", Surfaces: "surfaces"}
"""The word in a stamp for each way to draw the reconstruction."""

NOT_SEEN = ("layout_tried",)
"""Fields of the view that no pixel depends on."""

BESIDE: dict[str, Kind] = {
    "exposure_offset": Number(-MAX_EXPOSURE, MAX_EXPOSURE, f"it must be -{MAX_EXPOSURE:g} to {MAX_EXPOSURE:g} stops"),
    "cursor": Whole(0, MAX_BANDS - 1, "cursor {}", f"bands are counted from 0 to {MAX_BANDS - 1}"),
    "cursor_visible": Flag(),
    "help_visible": Flag(),
    "sweep_to": Whole(1, MAX_BANDS, "a sweep to {} bands", f"the viewer shows 1 to {MAX_BANDS}"),
}
"""Fields of the view that are no options, and their kinds."""

LIMITS = ("side", "texels", "file_bytes")
"""The limits that a stamp tells: that of memory is for the machine to say."""

BEFORE_SCHEMAS: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "bands": ("n_bands", int),
    "muted": ("muted", frozenset),
    "quantity": ("quantity", str),
    "split_sun": ("split_sun", bool),
    "window": ("window", str),
    "window_width": ("window_width", float),
    "method": ("method", str),
    "samples_asked": ("samples", int),
    "seed": ("seed", int),
    "exposure_stops": ("exposure_stops", float),
    "tone": ("tone", str),
    "error": ("error", lambda error: error["kind"]),
    "marks": ("marks", bool),
    "sheet": ("sheet", str),
    "lobe_view": ("lobe_view", bool),
    "basis": ("basis", tuple),
    "camera_degrees": ("camera", tuple),
    "zoom": ("zoom", float),
}
"""Keys of a stamp without a schema: the field that each of them tells, and how."""


def metadata(picture: Picture, composition: Composition, opengl: str, *, overlay: bool = True) -> str:
    """Everything that made the picture, as one JSON text; equal arguments give equal text."""
    state, figures, projection = picture.state, picture.figures, picture.projection
    extremes, scale = figures.extremes, picture.error_scale
    description: dict[str, Any] = {
        "schema": SCHEMA,
        "version": __version__,
        "state": _recorded(state),
        "light": picture.light.name,
        "light_argument": state.recipe.light if isinstance(state.recipe.light, str) else None,
        "light_notes": list(picture.light.notes),
        "bands": state.recipe.n_bands,
        "muted": list(state.recipe.muted_shown),
        "quantity": state.recipe.quantity,
        "compare": state.recipe.compare
        and {"name": state.recipe.compare.name, "convention": state.recipe.compare.convention},
        "verdict": picture.verdict,
        "split_sun": state.recipe.split_sun,
        "suns": [_described(sun) for sun in picture.subject.suns],
        "window": state.recipe.window,
        "window_width": state.recipe.window_width,
        "factors": list(figures.factors),
        "method": state.recipe.method,
        "method_words": projection.method,
        "samples_asked": None if state.recipe.method == "best" else state.recipe.samples,
        "samples": projection.evaluations,
        "seed": state.recipe.seed if state.recipe.method == "jittered" else None,
        "sanitize": state.recipe.reading.sanitize,
        "layout": state.recipe.reading.layout,
        "exposure_stops": picture.exposure_stops,
        "tone": state.view.tone,
        "error": None
        if scale is None
        else {
            "kind": scale.kind,
            "range": scale.end,
            "floor": scale.floor if scale.kind == "relative" else None,
            "largest": scale.largest,
            "largest_direction_in_light": scale.direction.tolist(),
            "colour_map": map_of(scale.kind),
        },
        "overlay": overlay,
        "marks": state.view.marks,
        "sheet": state.view.sheet,
        "lobe_view": state.view.lobe_view,
        "basis": state.view.basis,
        "evaluated": EVALUATED[type(picture.drawn)],
        "size": [composition.width, composition.height],
        "camera_degrees": list(state.view.camera),
        "zoom": state.view.zoom,
        "world_from_view": picture.world_from_view.tolist(),
        "light_from_world": picture.light_from_world.tolist(),
        "spheres": {
            name: {"centre": [sphere.x, sphere.y], "radius": sphere.radius, "clip": list(sphere.clip)}
            for name, sphere in zip(("original", "reconstruction", "error"), composition.spheres, strict=False)
        },
        "opengl": opengl,
        "figures": {
            **{name: asdict(channel) for name, channel in figures.channels.items()},
            "relative_l2": figures.relative_l2,
            "relative_l2_floor": figures.floor,
            "irradiance_relative_l2": figures.irradiance_relative_l2,
            "max_error": extremes.max_error,
            "max_error_bound": extremes.max_error_bound,
            "max_error_direction_in_light": list(extremes.max_error_direction),
            "minimum": extremes.minimum,
            "minimum_bound": extremes.minimum_bound,
            "minimum_direction_in_light": list(extremes.minimum_direction),
            "negative_area": extremes.negative_area,
            "negative_energy": extremes.negative_energy,
            "peak": extremes.peak,
            "energy_share": list(figures.energy_share),
            "bands_needed": asdict(picture.needs),
            "bands_needed_unsplit": asdict(picture.needs_unsplit) if picture.needs_unsplit else None,
        },
    }
    return json.dumps(_finite(description), allow_nan=False)


def _described(sun: Sun) -> dict[str, Any]:
    return {
        "direction_in_light": sun.axis.tolist(),
        "half_angle_degrees": math.degrees(sun.half_angle),
        "solid_angle": sun.solid_angle,
        "radiance": sun.radiance.tolist(),
        "irradiance": sun.irradiance.tolist(),
    }


def _finite(value: Any) -> Any:
    """The value with null for infinity, which JSON has not: an infinite PSNR means no error at all."""
    if isinstance(value, dict):
        return {key: _finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def state_of_stamp(text: str, light: str | Light | None = None, compare: CoefficientLight | None = None) -> State:
    """The state that a stamp tells. `light` and `compare` give what no text can hold: a light object and coefficients.

    UsageError for a text that is no stamp, one of a later schema, or a value out of range.
    """
    try:
        said = json.loads(text)
        if said.get("schema", 0) > SCHEMA:
            raise UsageError(f"a picture of schema {said['schema']}: this version reads {SCHEMA}; update shviewer")
        recipe, view = _told(said["state"]) if "state" in said else _told_before_schemas(said)
        given = (said["state"]["recipe"] if "state" in said else said).get("compare")
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


def _recorded(state: State) -> dict[str, Any]:
    """Every field of recipe and view, as JSON."""
    recipe = {part.name: getattr(state.recipe, part.name) for part in fields(Recipe)}
    view = {part.name: getattr(state.view, part.name) for part in fields(View) if part.name not in NOT_SEEN}
    given, reading = state.recipe.compare, state.recipe.reading
    recipe |= {
        "light": state.recipe.light if isinstance(state.recipe.light, str) else None,
        "muted": sorted(state.recipe.muted),
        "compare": given and {"name": given.name, "convention": given.convention},
        "reading": {
            "sanitize": reading.sanitize,
            "layout": reading.layout,
            "convention": reading.convention,
            "limits": {name: getattr(reading.limits, name) for name in LIMITS},
        },
    }
    return {"recipe": recipe, "view": view}


def _told(said: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """The values of recipe and view; fields that a later version may have added are left out."""
    recipe = {part.name: said["recipe"][part.name] for part in fields(Recipe) if part.name in said["recipe"]}
    view = {part.name: said["view"][part.name] for part in fields(View) if part.name in said["view"]}
    recipe |= taken(recipe, Recipe) | {"reading": _told_reading(recipe["reading"])}
    view |= taken(view, View) | {"light_rotation": _told_rotation(view["light_rotation"])}
    for name, kind in BESIDE.items():
        if view[name] is not None or name != "sweep_to":
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


def _told_before_schemas(said: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    told = {name: make(said[key]) for key, (name, make) in BEFORE_SCHEMAS.items() if said.get(key) is not None}
    recipe, view = taken(told, Recipe), taken(told, View)
    reading = Reading(sanitize=bool(said.get("sanitize", False)), layout=str(said.get("layout", "auto")))
    light = said.get("light_argument")
    if not isinstance(light, str | None) or reading.layout not in LAYOUT_CHOICES:
        raise ValueError("a light or a layout that there is not")
    return {"light": light, "reading": reading, **recipe}, view
