"""Things derived from a light for drawing, each computed once: exposure, camera, peak, scale of the error."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shviewer.analysis.cache import remember
from shviewer.analysis.figures import error_grid, grid_rows, sums
from shviewer.analysis.projections import BEST, Projection, project
from shviewer.analysis.recipe import Recipe, Shown
from shviewer.analysis.reconstruction import Reconstruction, reconstruction_of
from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.climbing import DISPLAY_ROUNDS, climb
from shviewer.harmonics.extremes.error_grid import Extremes
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quadrature import directions_from_angles
from shviewer.harmonics.quantities.names import CUBES
from shviewer.harmonics.synthesis import Synthesis
from shviewer.lights.light import Light
from shviewer.limits import DIMMEST
from shviewer.viewer import camera
from shviewer.viewer.colour.error_scale import NOISE, ErrorScale, automatic_range, error_values
from shviewer.viewer.colour.tone import exposed_for
from shviewer.viewer.view import TONES, View

WHITE_PERCENTILE = 0.99
"""Automatic exposure puts this share of the sphere below WHITE_LEVEL."""

WHITE_LEVEL = 0.8
"""The linear level at which that percentile is shown: the brightest hundredth still stands out above it."""

DARK = 0.01
"""A light whose percentile is at most this share of its mean is dark but for a point; then white is the mean of the brightest
hundredth, so that its bands are seen, too. Beside a sun that is ten million times brighter, a sky is still above."""

FACING, ASIDE = (0.0, 12.0), (-45.0, 22.0)
"""Degrees to the left of the light's mean direction, and elevation, of the camera that faces a map, and one that sees the sides
of lobes and surfaces."""

LEVEL = 0.012
"""Light whose mean direction is less horizontal than this comes from no side."""

PEAK = 20.0
"""How many times brighter than the mean of its light a peak has to be to be marked."""


def exposure_stops(view: View, light: Light) -> float:
    """The exposure in use: fixed by the state, or such that 99 % of the original stays just below white."""
    base = _automatic_exposure(light, view.tone) if view.exposure_stops is None else view.exposure_stops
    return base + view.exposure_offset


def camera_of(view: View, light: Light) -> tuple[float, float]:
    """Azimuth and elevation of the camera, degrees: that of the view, or else one that faces the light as it is turned."""
    if view.camera is not None:
        return view.camera
    aside, elevation = ASIDE if view.lobe_view or light.source.lobes else FACING
    x, y, _ = camera.light_from_world(view.light_rotation).T @ _mean_direction(light.source)
    azimuth = float(np.degrees(np.arctan2(y, x))) + aside if np.hypot(x, y) >= LEVEL else 0.0
    return azimuth % 360, elevation


@remember(most=1)
def _low_bands(light: Light) -> Array:
    """The coefficients of bands 0 and 1, (4, 3): the mean of a light, and its mean direction."""
    return light.coefficients(2)


def _mean_direction(light: Light) -> Array:
    """The mean of the directions (3,), each weighted with its share of the luminance; 0 if there is none.

    Bands 0 and 1 are constant and linear, so their coefficients are those integrals, but for a factor.
    """
    total, along_y, along_z, along_x = _low_bands(light) @ LUMINANCE
    return np.array([-along_x, -along_y, along_z]) / (np.sqrt(3) * total) if total > 0 else np.zeros(3)


def reconstruction_shown(recipe: Recipe, view: View, ahead: int = 0) -> Reconstruction:
    """What a view shows of a recipe, through its encoding. ahead, and raises: as in `reconstruction_of`."""
    return reconstruction_of(recipe, ahead, view.encode, turn_of_cube(view))


def turn_of_cube(view: View) -> tuple[float, ...] | None:
    """The rotation of the light, row by row, where a cube is shown, which stands in the world; else None."""
    if not stands(view):
        return None
    return tuple(camera.light_from_world(view.light_rotation).T.ravel().tolist())


def stands(view: View) -> bool:
    """Whether what is shown stands in the world while the light turns."""
    return view.encode in CUBES


class Peak(NamedTuple):
    """Where a light is brightest: a direction (3,) in its frame, and its largest channel there."""

    direction: Array
    radiance: float


@remember(most=1)
def peak(light: Light) -> Peak | None:
    """The peak of a light, if it is more than PEAK times as bright as the light is on average: such as a sun."""
    grid = error_grid(light, grid_rows(1))
    values, places = grid.original.max(axis=1), light.landmarks()
    row, column = divmod(int(values.argmax()), len(grid.phi))
    found = Peak(directions_from_angles(grid.theta[[row]], grid.phi[[column]])[0], float(values[row, column]))
    if len(places):
        marked = light.radiance(places).max(axis=1)
        best = int(marked.argmax())
        found = max(found, Peak(places[best], float(marked[best])), key=lambda peak: peak.radiance)
    mean = float(_low_bands(light)[0].mean()) / (2 * np.sqrt(np.pi))
    return found if found.radiance > PEAK * abs(mean) else None


@remember(most=16)
def error_scale(
    light: Light, projection: Projection, shown: Shown, kind: str, found: Extremes | None = None
) -> ErrorScale:
    """The scale of the error, from the grid of the figures. The largest relative error is no figure: it is searched for here.

    The floor of the relative error is the light's mean. found: the extremes; None, as long as they are searched for: then the
    largest error is that on the grid.
    """
    coefficients, figures = sums(light, projection, shown)
    exact = project(light, BEST, projection.n_bands).coefficients
    floor = max(float(np.abs(exact[0]).mean()) / (2 * np.sqrt(np.pi)), DIMMEST)
    grid, synthesis = error_grid(light, grid_rows(shown.n_bands)), Synthesis(coefficients)
    values = synthesis.on_rows(grid.theta, len(grid.phi))
    original, reconstruction = (part.transpose(0, 2, 1).reshape(-1, 3) for part in (grid.original, values))
    errors = error_values(kind, original, reconstruction, floor)

    def error_at(directions: Array) -> Array:
        return error_values(kind, light.radiance(directions), synthesis.in_directions(directions), floor)

    row, column = divmod(int(np.abs(errors).argmax()), len(grid.phi))
    start = directions_from_angles(grid.theta[[row]], grid.phi[[column]])
    direction = start[0] if found is None else np.array(found.max_error_direction)
    if kind == "relative" and found is not None:
        direction = climb(error_at, start, np.pi / len(grid.theta), DISPLAY_ROUNDS)[1][0]
    largest = float(error_at(direction[None])[0])
    noise = NOISE * figures.peak / (floor if kind == "relative" else 1.0)
    end = automatic_range(kind, errors, np.repeat(grid.row_share, len(grid.phi)), abs(largest), noise)
    return ErrorScale(kind, floor, largest, direction, max(end, DIMMEST), noise)


@remember(most=len(TONES))
def _automatic_exposure(light: Light, tone: str) -> float:
    grid = error_grid(light, grid_rows(1))
    brightest = grid.original.max(axis=1)
    order = np.argsort(brightest, axis=None)
    share = np.broadcast_to(grid.row_share[:, None], brightest.shape)
    position = min(int(np.searchsorted(np.cumsum(share.ravel()[order]), WHITE_PERCENTILE)), len(order) - 1)
    level = float(brightest.ravel()[order[position]])
    mean = max(float(_low_bands(light)[0].max()), 0.0) / (2 * np.sqrt(np.pi))
    if level <= DARK * mean:
        level = min(grid.peak, mean / (1 - WHITE_PERCENTILE)) or grid.peak
    return float(np.log2(exposed_for(WHITE_LEVEL, tone) / level)) if level > 0 else 0.0
