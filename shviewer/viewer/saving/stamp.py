"""The stamp of a picture: everything that made it, and its figures, as one JSON text. stamp_reading.py reads it.

Schema 1: `state` holds every field of recipe and view, by its name. Keys are added and never change their meaning.
"""

from __future__ import annotations

import json
import math
import os
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from shviewer.analysis.figures import Figures, Needs, Pending
from shviewer.analysis.projections import project, way_of
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.reconstruction import Reconstruction
from shviewer.harmonics.basis import Array
from shviewer.lights.find import file_of, version_of_light
from shviewer.lights.light import Light
from shviewer.lights.suns.sun import Sun
from shviewer.limits import MAX_DIRECT_BANDS
from shviewer.version import __version__
from shviewer.viewer.colour.colour_maps import map_of
from shviewer.viewer.colour.error_scale import ErrorScale
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.drawn import DirectSum, Encoded, SplineMap, Surfaces
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.file_marks import mark_of
from shviewer.viewer.state import State
from shviewer.viewer.view import REMEMBERED, View

SCHEMA = 1

EVALUATED = {DirectSum: "direct", Encoded: "formula", SplineMap: "map", Surfaces: "surfaces"}
"""The word in a stamp for each way to draw the reconstruction."""

LIMITS = ("side", "texels", "file_bytes")
"""The limits that a stamp tells: that of memory is for the machine to say."""

DIGITS = 9
"""Significant digits of the coefficients in a stamp: those of float32."""


def metadata(picture: Picture, composition: Composition, opengl: str, *, overlay: bool = True) -> str:
    """Everything that made the picture, and the figures that are there, as one JSON text; equal arguments give equal text."""
    state, figures, projection = picture.state, picture.figures, picture.projection
    recipe, view = state.recipe, state.view
    scale, beside = picture.error_scale, picture.beside
    panes = "original", "reconstruction", "error" if beside is None else "beside"
    description: dict[str, Any] = {
        "schema": SCHEMA,
        "version": __version__,
        "state": _recorded(state),
        "light": picture.light.name,
        "light_argument": recipe.light if isinstance(recipe.light, str) else None,
        "light_notes": list(picture.light.notes),
        "files": _files(picture),
        "bands": recipe.n_bands,
        "muted": list(recipe.muted_shown),
        "quantity": recipe.quantity,
        "compare": _compared(recipe),
        "verdict": picture.verdict,
        "split_sun": recipe.split_sun,
        "suns": [_described(sun) for sun in picture.subject.suns],
        "window": recipe.window,
        "window_width": recipe.window_width,
        "factors": list(figures.factors),
        "method": recipe.method,
        "method_words": projection.method,
        "samples_asked": None if recipe.method == "best" else recipe.samples,
        "samples": projection.evaluations,
        "seed": recipe.seed if recipe.method == "jittered" else None,
        "sanitize": recipe.reading.sanitize,
        "layout": recipe.reading.layout,
        "exposure_stops": picture.exposure_stops,
        "tone": view.tone,
        "error": None if scale is None else _error(scale),
        "beside": None if beside is None else _beside(view.beside, beside.found),
        "overlay": overlay,
        "marks": view.marks,
        "sheet": view.sheet,
        "lobe_view": view.lobe_view,
        "basis": view.basis,
        "encoding": picture.stored and {"name": picture.stored.name, "numbers": _rounded(picture.stored.numbers)},
        "evaluated": EVALUATED[type(picture.drawn)],
        "size": [composition.width, composition.height],
        "camera_degrees": picture.placed(state).view.camera,
        "zoom": view.zoom,
        "world_from_view": picture.world_from_view.tolist(),
        "light_from_world": picture.light_from_world.tolist(),
        "spheres": {
            name: {"centre": [sphere.x, sphere.y], "radius": sphere.radius, "clip": list(sphere.clip)}
            for name, sphere in zip(panes, composition.spheres, strict=False)
        },
        "maps": {
            name: {"zero": [pane.x, pane.y], "width": pane.width, "clip": list(pane.clip)}
            for name, pane in zip(panes, composition.maps, strict=False)
        },
        "opengl": opengl,
        "figures": {
            **{name: asdict(channel) for name, channel in figures.channels.items()},
            "relative_l2": figures.relative_l2,
            "relative_l2_floor": figures.floor,
            **_searched(picture),
            "peak": figures.peak,
            "energy_share": list(figures.energy_share),
            "bands_needed": _answers(picture.needs),
            "bands_needed_unsplit": _answers(picture.needs_unsplit),
        },
    }
    description["coefficients"] = _coefficients(picture)  # last, since they may be many
    return json.dumps(_finite(description), allow_nan=False)


def _error(scale: ErrorScale) -> dict[str, Any]:
    return {
        "kind": scale.kind,
        "range": scale.end,
        "floor": scale.floor if scale.kind == "relative" else None,
        "largest": scale.largest,
        "largest_direction_in_light": scale.direction.tolist(),
        "colour_map": map_of(scale.kind),
    }


def _beside(kind: str, second: Reconstruction) -> dict[str, Any]:
    return {"kind": kind, "method_words": second.projection.method, "relative_l2": second.sums.relative_l2}


def _compared(recipe: Recipe) -> dict[str, Any] | None:
    given = recipe.compare
    return None if given is None else {"name": given.name, "convention": given.convention}


def _files(picture: Picture) -> dict[str, Any]:
    """The marks of the files that the picture was made of, and where the compared one was found."""
    files, compare = {}, picture.state.recipe.compare
    for name, light in (("light", picture.subject.whole), ("compare", compare)):
        mark = _mark(light) if light is not None else None
        if mark is not None:
            files[name] = mark
    if compare is not None and (path := file_of(compare)) is not None:
        files["compare"] = {"path": _as_given(path), **files.get("compare", {})}
    return files


def _mark(light: Light) -> dict[str, Any] | None:
    path = file_of(light)
    return None if path is None else mark_of(path, version_of_light(light))


def _as_given(path: Path) -> str:
    """A path as it is named in the present folder: one below it without the folders above."""
    below = os.path.relpath(path) if path.drive == Path.cwd().drive else ".."
    return str(path) if below.startswith("..") else below


def _coefficients(picture: Picture) -> list[list[float]]:
    """What is left of the picture where its light is gone: its bands of the radiance, none muted, without the window.

    Of more than MAX_DIRECT_BANDS bands, the first.
    """
    recipe = picture.state.recipe
    radiance = project(picture.light.source, way_of(recipe), recipe.projected_bands)
    return _rounded(radiance.coefficients[: min(recipe.n_bands, MAX_DIRECT_BANDS) ** 2])


def _rounded(rows: Array) -> list[list[float]]:
    return [[float(f"{value:.{DIGITS}g}") for value in row] for row in rows.tolist()]


def _searched(picture: Picture) -> dict[str, Any]:
    """The figures that are searched for; nothing if they are not there."""
    figures = picture.figures
    if not isinstance(figures, Figures):
        return {}
    extremes = figures.extremes
    return {
        "irradiance_relative_l2": figures.irradiance_relative_l2,
        "max_error": extremes.max_error,
        "max_error_bound": extremes.max_error_bound,
        "max_error_direction_in_light": list(extremes.max_error_direction),
        "minimum": extremes.minimum,
        "minimum_bound": extremes.minimum_bound,
        "minimum_direction_in_light": list(extremes.minimum_direction),
        "negative_area": extremes.negative_area,
        "negative_energy": extremes.negative_energy,
    }


def _answers(needs: Needs | Pending | None) -> dict[str, Any] | None:
    return asdict(needs) if isinstance(needs, Needs) else None


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


def _recorded(state: State) -> dict[str, Any]:
    """Every field of recipe and view, as JSON."""
    recipe = {part.name: getattr(state.recipe, part.name) for part in fields(Recipe)}
    view = {part.name: getattr(state.view, part.name) for part in fields(View) if part.name not in REMEMBERED}
    reading = state.recipe.reading
    recipe |= {
        "light": state.recipe.light if isinstance(state.recipe.light, str) else None,
        "muted": sorted(state.recipe.muted),
        "compare": _compared(state.recipe),
        "reading": {
            "sanitize": reading.sanitize,
            "layout": reading.layout,
            "convention": reading.convention,
            "limits": {name: getattr(reading.limits, name) for name in LIMITS},
        },
    }
    return {"recipe": recipe, "view": view}
