"""From a state to a Picture: plain arrays for the GPU and figures for the overlay. No OpenGL, so a test can look inside."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from shviewer.analysis.comparing.comparison import verdict_of
from shviewer.analysis.figures import PENDING, Figures, Needs, Pending, Sums, figures_of, needs
from shviewer.analysis.projections import Projection, time_best
from shviewer.analysis.reconstruction import Reconstruction, values_at
from shviewer.analysis.subjects import Subject, has_suns, subject
from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.error_grid import Extremes
from shviewer.harmonics.quantities.encodings import Stored
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.light import Light
from shviewer.lights.suns.sun import points_of_suns
from shviewer.limits import MAX_BANDS, MAX_DIRECT_BANDS
from shviewer.progress import tell
from shviewer.viewer import camera
from shviewer.viewer.beside import Beside, recipe_beside
from shviewer.viewer.colour.error_scale import ErrorScale
from shviewer.viewer.colour.tone import steepest
from shviewer.viewer.derived import (
    Peak,
    camera_of,
    error_scale,
    exposure_stops,
    peak,
    reconstruction_shown,
    stands,
)
from shviewer.viewer.drawn import DirectSum, Drawn, Encoded, Source, SplineMap, Surfaces, source_of
from shviewer.viewer.splines import splines_of
from shviewer.viewer.state import FRONT, State, changed
from shviewer.viewer.surface import surfaces
from shviewer.viewer.view import LOOKED, POINTED, REMEMBERED, SPOKEN

LIVE = (*LOOKED, *POINTED, *SPOKEN, *REMEMBERED, "whole_sphere", "marks", "sweep_to", "turning", "trace")
"""Fields of the view on which nothing depends that takes time."""

EXPOSURE = ("exposure_stops", "exposure_offset")


@dataclass(frozen=True, eq=False)
class Picture:
    """Everything that the GPU and the overlay need for one state."""

    state: State
    subject: Subject
    """The light shown on the left, the light that is projected, and the suns that were split off."""
    original: Source
    compared: Source
    """The light that the error compares with: the original, or what is left of it without its suns."""
    suns: tuple[Lobe, ...]
    """Drawn on top of the reconstruction."""
    coefficients: Array
    """The coefficients shown, (n_bands**2, 3): those of muted bands are zero."""
    drawn: Drawn
    """How the reconstruction is drawn."""
    world_from_view: Array
    light_from_world: Array
    exposure_stops: float
    error_scale: ErrorScale | None
    """The scale of the error, if the error is shown."""
    beside: Beside | None
    """The second reconstruction, if there is one."""
    projection: Projection
    figures: Sums
    """The figures: `Figures`, all of them, once they are there."""
    needs: Needs | Pending = PENDING
    needs_unsplit: Needs | Pending | None = None
    """The bands that the light would need with its suns; None if none were split off."""
    sun_to_blame: bool = False
    """Whether no band count is enough for the radiance, and the light has a sun that can be taken apart."""
    peak: Peak | None = None
    """Where the original is far brighter than elsewhere."""
    verdict: str = ""
    """How well the compared coefficients agree with the light's own, and if they do not, what is wrong with them."""

    @property
    def extremes(self) -> Extremes | Pending:
        return self.figures.extremes if isinstance(self.figures, Figures) else PENDING

    @property
    def complete(self) -> bool:
        """Whether all figures are there."""
        return isinstance(self.figures, Figures) and isinstance(self.needs, Needs)

    @property
    def stored(self) -> Stored | None:
        """The numbers of the encoding that is shown; None where the coefficients are summed."""
        return self.projection.stored_as(self.figures.factors)

    @property
    def light(self) -> Light:
        """The light that the figures are computed for."""
        return self.subject.light

    def suits(self, by_map: bool) -> bool:
        """Whether the reconstruction is drawn as asked for, where there is a choice: from a map, or summed per pixel."""
        state = self.state
        given = state.view.evaluate != "auto" or state.recipe.n_bands > MAX_DIRECT_BANDS
        return given or not isinstance(self.drawn, DirectSum if by_map else SplineMap)

    def seen(self, state: State) -> Picture:
        """The same picture with the live parts and the exposure of another state: at once, whatever the light is."""
        last, view = self.state.view, state.view
        live = {name: getattr(view, name) for name in (*LIVE, *EXPOSURE)}
        if state.recipe.turn != self.state.recipe.turn or stands(last):  # it is seen where it was projected
            live["light_rotation"] = last.light_rotation
        stops = self.exposure_stops + view.exposure_offset - last.exposure_offset
        if view.exposure_stops is not None:
            stops = view.exposure_stops + view.exposure_offset
        return replace(
            self,
            state=changed(self.state, **live),
            world_from_view=camera.world_from_view(*camera_of(view, self.subject.whole)),
            light_from_world=camera.light_from_world(live["light_rotation"]),
            exposure_stops=stops,
        )

    def placed(self, state: State) -> State:
        """The state, with the camera where this picture's light has it, if the state does not say where."""
        return changed(state, camera=camera_of(state.view, self.subject.whole))

    def rest_at(self, directions: Array) -> Array:
        """Radiance of the coefficients, without suns, in unit directions of the light (k, 3): (k, 3) float64."""
        return values_at(directions, self.coefficients, self.stored)

    def suns_at(self, directions: Array) -> Array:
        """Radiance of the suns that are drawn on top of it, (k, 3)."""
        return LobeLight(self.suns).radiance(directions) if self.suns else np.zeros((len(directions), 3))


def still(state: State) -> State:
    """The state without its live parts: pictures of states with equal still parts differ in what takes no time."""
    live = {name: getattr(FRONT, name) for name in LIVE}
    if stands(state.view):
        del live["light_rotation"]
    return changed(state, **live)


def prepare(state: State, *, by_map: bool = False, written: bool = True) -> Picture:
    """Make the picture of a state. LightError if the light cannot be read, UsageError for a state out of range.

    by_map: draw the reconstruction from a map of it, although it could be summed per pixel. written: whether its figures are
    written over it; if not, those that no pixel depends on stay pending.
    """
    ahead = MAX_BANDS if written and state.view.sheet != "plane" else 0  # the plane tells what the bands in use took
    picture = first_picture(state, by_map=by_map, ahead=ahead)
    if written:
        return completed(picture)
    return picture if picture.error_scale is None else with_figures(picture)


def stages(state: State, *, by_map: bool = False) -> Iterator[Picture]:
    """Yield pictures of a state, each with more figures; the last one is complete. Raises what `prepare` raises."""
    picture = first_picture(state, by_map=by_map)
    yield picture
    picture = with_figures(picture)
    yield picture
    yield completed(picture)


def completed(picture: Picture) -> Picture:
    """The picture with all figures."""
    picture, recipe = with_figures(picture), picture.state.recipe
    if isinstance(picture.needs, Needs):
        return picture
    if picture.state.view.sheet == "plane":
        time_best(picture.light, picture.projection.n_bands)
    unsplit = needs(replace(recipe, split_sun=False)) if picture.subject.suns else None
    found = needs(recipe)
    sun_to_blame = found.radiance is None and recipe.compare is None and has_suns(recipe)
    return replace(picture, needs=found, needs_unsplit=unsplit, sun_to_blame=sun_to_blame, verdict=verdict_of(recipe))


def with_figures(picture: Picture) -> Picture:
    """The picture with the figures that are searched for, but without `needs`."""
    if isinstance(picture.figures, Figures):
        return picture
    figures = figures_of(picture.light, picture.projection, picture.state.recipe.shown)
    picture = replace(picture, figures=figures)
    return replace(picture, error_scale=_scale(picture.state, picture.light, picture.projection, figures.extremes))


def first_picture(state: State, *, by_map: bool = False, ahead: int = 0) -> Picture:
    """The picture of a state with what can be drawn at once: what takes a search is pending. Raises what `prepare` raises.

    ahead: as in `reconstruction_of`.
    """
    state.check()
    recipe, view = state.recipe, state.view
    shown = subject(recipe)
    tell("projecting")
    for part in (shown.whole, shown.light):
        _ = part.map  # first, so that whoever looks at the light in a few directions takes them from it
    found = reconstruction_shown(recipe, view, ahead)
    light, whole, projection = found.subject.light, found.subject.whole, found.projection
    scale = _scale(state, light, projection)
    stops = exposure_stops(view, whole)
    other = None
    if view.beside != "off":
        other = reconstruction_shown(recipe_beside(recipe, view.beside), view)

    def drawn_as(one: Reconstruction) -> Drawn:
        if view.lobe_view:
            return Surfaces(surfaces(view, light, projection, recipe.shown, other))
        if one.stored is not None and view.evaluate != "map":
            return Encoded(one.stored)
        if by_map or view.evaluate == "map" or recipe.n_bands > MAX_DIRECT_BANDS:
            return SplineMap(splines_of(one, 2.0**stops * steepest(view.tone), scale))
        return DirectSum(one.coefficients)

    drawn = drawn_as(found)
    return Picture(
        state=state,
        subject=found.subject,
        original=source_of(whole),
        compared=source_of(light),
        suns=_sun_lobes(found.subject, recipe.quantity),
        coefficients=found.coefficients,
        drawn=drawn,
        world_from_view=camera.world_from_view(*camera_of(view, whole)),
        light_from_world=camera.light_from_world(view.light_rotation),
        exposure_stops=stops,
        error_scale=scale,
        beside=Beside(other, drawn if view.lobe_view else drawn_as(other)) if other is not None else None,
        projection=projection,
        figures=found.sums,
        peak=peak(whole),
        needs_unsplit=PENDING if found.subject.suns else None,
    )


def error_end(state: State) -> float:
    """The end of the error's colours in the picture of a state, up to what the search for the largest error adds."""
    found = reconstruction_shown(state.recipe, state.view)
    scale = _scale(state, found.subject.light, found.projection)
    assert scale is not None, "the state shows no error"
    return scale.end


def _scale(state: State, light: Light, projection: Projection, found: Extremes | None = None) -> ErrorScale | None:
    """The scale of the error, if it is shown; found: as in `error_scale`."""
    if state.view.error == "off":
        return None
    scale = error_scale(light, projection, state.recipe.shown, state.view.error, found)
    return scale if state.view.error_range is None else replace(scale, end=state.view.error_range)


def _sun_lobes(shown: Subject, quantity: str) -> tuple[Lobe, ...]:
    points = points_of_suns(len(shown.suns))
    return tuple(lobe for sun in shown.suns for lobe in sun.lobes(quantity, points))
