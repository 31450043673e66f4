"""From a state to a Picture: plain arrays for the GPU and figures for the overlay. No OpenGL, so a test can look inside."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from shviewer.analysis.comparison import verdict
from shviewer.analysis.figures import Figures, Needs, error_grid, grid_rows, needs, reconstruct
from shviewer.analysis.projections import Projection, project, sampling_of
from shviewer.analysis.subjects import Subject, subject
from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import Light
from shviewer.lights.lobe import Lobe
from shviewer.lights.lobes import LobeLight
from shviewer.limits import MAX_BANDS, MAX_DIRECT_BANDS, check_radiance
from shviewer.viewer import camera
from shviewer.viewer.derived import error_scale, exposure_stops, reconstruction_map, surfaces
from shviewer.viewer.drawn import DirectSum, Drawn, SplineMap, Surfaces, map_size
from shviewer.viewer.error_scale import ErrorScale
from shviewer.viewer.state import ViewState
from shviewer.viewer.tone import steepest
from shviewer.viewer.view_limits import check


class Source(NamedTuple):
    """What the shader evaluates a light by: its lobes, or a map."""

    lobes: tuple[Lobe, ...]
    map: LatLongMap | None


@dataclass(frozen=True, eq=False)
class Picture:
    """What the GPU and the overlay need for one state."""

    state: ViewState
    subject: Subject
    """What is shown on the left, what is projected, and the suns that were split off."""
    original: Source
    compared: Source
    """What the error is of: the original, or what is left of it without its suns."""
    suns: tuple[Lobe, ...]
    """Drawn on top of the reconstruction."""
    coefficients: Array
    """Shown, (n_bands**2, 3): muted ones are zero."""
    drawn: Drawn
    """How the reconstruction is drawn."""
    world_from_view: Array
    light_from_world: Array
    exposure_stops: float
    error_scale: ErrorScale | None
    """Of the error, if it is shown."""
    projection: Projection
    figures: Figures
    needs: Needs
    needs_unsplit: Needs | None
    """What the light would need with its suns; None if none were split off."""
    verdict: str = ""
    """How well coefficients that are compared agree with the light's own, and if they do not, what is wrong with them."""

    @property
    def light(self) -> Light:
        """What the figures are of."""
        return self.subject.light

    def rest_at(self, directions: Array) -> Array:
        """What the coefficients give in unit directions of the light (k, 3), without suns: (k, 3) float64."""
        return np.asarray(evaluate_basis(directions, self.state.n_bands) @ self.coefficients)

    def suns_at(self, directions: Array) -> Array:
        """The suns that are drawn on top of it, (k, 3)."""
        return LobeLight(self.suns).radiance(directions) if self.suns else np.zeros((len(directions), 3))


def prepare(state: ViewState, *, by_map: bool = False) -> Picture:
    """Everything to be drawn and said. LightError if the light cannot be read, UsageError for a state out of range.

    by_map: draw the reconstruction from a map of it, although it could be summed per pixel.
    """
    check(state)
    shown = subject(state)
    light, whole = shown.light, shown.whole
    projected = MAX_DIRECT_BANDS if state.n_bands <= MAX_DIRECT_BANDS else MAX_BANDS
    check_radiance(error_grid(whole, grid_rows(1)).peak, light.name)
    projection = project(light, *sampling_of(state), projected)
    shape = state.n_bands, state.muted_shown, state.window, state.window_width
    coefficients, figures = reconstruct(light, projection, *shape)
    scale = None if state.error == "off" else error_scale(light, projection, shape, state.error)
    if scale is not None and state.error_range is not None:
        scale = replace(scale, end=state.error_range)
    stops = exposure_stops(state, whole)
    drawn: Drawn
    if state.lobe_view:
        drawn = Surfaces(surfaces(state, light, projection, shape))
    elif by_map or state.evaluate == "map" or state.n_bands > MAX_DIRECT_BANDS:
        size = map_size(state.n_bands, _height(figures, scale, 2.0**stops * steepest(state.tone)))
        drawn = SplineMap(reconstruction_map(light, projection, shape, size))
    else:
        drawn = DirectSum(coefficients)
    return Picture(
        state=state,
        subject=shown,
        original=Source(whole.lobes, whole.map),
        compared=Source(light.lobes, light.map),
        suns=_sun_lobes(shown, state.quantity),
        coefficients=coefficients,
        drawn=drawn,
        world_from_view=camera.world_from_view(*state.camera),
        light_from_world=camera.light_from_world(state.light_rotation),
        exposure_stops=stops,
        error_scale=scale,
        projection=projection,
        figures=figures,
        needs=needs(state),
        needs_unsplit=needs(replace(state, split_sun=False)) if shown.suns else None,
        verdict=verdict(light, state.compare) if state.compare else "",
    )


def _height(figures: Figures, scale: ErrorScale | None, exposure: float) -> float:
    """The reconstruction's largest magnitude, at most, over what is a full step of colour: white, or the end of the error's."""
    largest = figures.extremes.peak + figures.extremes.max_error
    if scale is None:
        return largest * exposure
    return largest * max(exposure, 1 / (scale.end * (scale.floor if scale.kind == "relative" else 1.0)))


def _sun_lobes(shown: Subject, quantity: str) -> tuple[Lobe, ...]:
    return tuple(sun.irradiance_lobe if quantity == "irradiance" else sun.lobe for sun in shown.suns)
