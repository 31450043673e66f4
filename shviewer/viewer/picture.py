"""From a state to a Picture: plain arrays for the GPU and figures for the overlay. No OpenGL, so a test can look inside."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError, UsageError
from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.extremes import DISPLAY_ROUNDS, at_directions, climb
from shviewer.harmonics.quadrature import MAX_SAMPLES, directions_from_angles
from shviewer.harmonics.synthesis import Synthesis
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import Light
from shviewer.lights.lobes import Lobe, LobeLight
from shviewer.viewer import camera
from shviewer.viewer.analysis import (
    BEST,
    Figures,
    Needs,
    Projection,
    Subject,
    error_grid,
    grid_rows,
    needs,
    project,
    reconstruct,
    sampling_of,
    subject,
)
from shviewer.viewer.comparison import suspicion
from shviewer.viewer.composition import MAX_SIDE, MIN_SIDE
from shviewer.viewer.error_view import ERRORS, ErrorScale, automatic_range, error_values
from shviewer.viewer.layout import MAX_DIRECT_BANDS, MAX_SHOWN_BANDS, map_size
from shviewer.viewer.memory import remember
from shviewer.viewer.state import EVALUATIONS, MAX_EXPOSURE, METHODS, QUANTITIES, WINDOWS, ZOOM_RANGE, ViewState
from shviewer.viewer.surface import (
    LIGHT_ROWS,
    Surface,
    basis_surface,
    common_scale,
    rows_for,
    sample_light,
    sample_reconstruction,
    surface,
)
from shviewer.viewer.tone import TONES, exposed_for

DIMMEST, BRIGHTEST = 1e-30, 1e30
"""The largest radiance of a light that can be drawn: beyond, sums and products would leave float32."""

WHITE_PERCENTILE = 0.99
"""Automatic exposure puts this share of the sphere below WHITE_LEVEL."""

WHITE_LEVEL = 0.8
"""What is shown of it, linear: the brightest hundredth still stands out above it."""

LEAST_ERROR_RANGE = 1e-30
"""So that float32 can divide by it."""


SURFACE_RADIUS = 222.0
"""Pixels at zoom 1 for which surfaces are made fine enough: those of the 1280 x 640 design."""

Shape = tuple[int, tuple[int, ...], str, float | None]
"""What of a projection is shown: bands, those muted, the window and its width."""


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
    reconstruction_map: NDArray[np.float32] | None
    """Spline coefficients (rows, columns, 4) of the reconstruction, drawn in place of the direct sum."""
    world_from_view: Array
    light_from_world: Array
    exposure_stops: float
    error_scale: ErrorScale | None
    """Of the error, if it is shown."""
    surfaces: tuple[Surface, ...]
    """In place of the spheres, as many as there are; none unless the lobe view is shown."""
    projection: Projection
    figures: Figures
    needs: Needs
    needs_unsplit: Needs | None
    """What the light would need with its suns; None if none were split off."""
    suspicion: str = ""
    """What is wrong with coefficients that are compared and do not fit."""

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
    projected = MAX_DIRECT_BANDS if state.n_bands <= MAX_DIRECT_BANDS else MAX_SHOWN_BANDS
    projection = project(light, *sampling_of(state), projected)
    peak = error_grid(whole, grid_rows(1)).peak
    if not (peak == 0 or DIMMEST <= peak <= BRIGHTEST):
        raise LightError(
            f"{light.name}: its largest radiance is {peak:.3g}; float32 shows {DIMMEST:g} to {BRIGHTEST:g}: scale the light"
        )
    shape = state.n_bands, state.muted_shown, state.window, state.window_width
    coefficients, figures = reconstruct(light, projection, *shape)
    scale = None if state.error == "off" else _error_scale(light, projection, *shape, state.error)
    if scale is not None and state.error_range is not None:
        scale = replace(scale, end=state.error_range)
    by_map = by_map or state.n_bands > MAX_DIRECT_BANDS or state.evaluate == "map"
    return Picture(
        state=state,
        subject=shown,
        original=_source(whole),
        compared=_source(light),
        suns=_sun_lobes(shown, state.quantity),
        coefficients=coefficients,
        reconstruction_map=_reconstruction_map(light, projection, *shape) if by_map else None,
        world_from_view=camera.world_from_view(*state.camera),
        light_from_world=camera.light_from_world(state.light_rotation),
        exposure_stops=exposure_stops(state, whole),
        error_scale=scale,
        surfaces=_surfaces(state, light, projection, shape) if state.lobe_view else (),
        projection=projection,
        figures=figures,
        needs=needs(state),
        needs_unsplit=needs(replace(state, split_sun=False)) if shown.suns else None,
        suspicion=suspicion(light, state.compare) if state.compare else "",
    )


def _source(light: Light) -> Source:
    return Source(light.lobes if isinstance(light, LobeLight) else (), light.radiance_map())


def _surfaces(state: ViewState, light: Light, projection: Projection, shape: Shape) -> tuple[Surface, ...]:
    """Of the light, its reconstruction or a basis function in place of it, and their difference."""
    radius = SURFACE_RADIUS * state.zoom
    original, reconstruction, error = _compared_surfaces(
        light, projection, *shape, max(LIGHT_ROWS, rows_for(state.n_bands, radius))
    )
    if state.basis is not None:
        l, m = state.basis
        reconstruction = basis_surface(l, m, rows_for(l + 1, radius))
    return (original, reconstruction, error)[: state.n_spheres]


def _sun_lobes(shown: Subject, quantity: str) -> tuple[Lobe, ...]:
    return tuple(sun.irradiance_lobe if quantity == "irradiance" else sun.lobe for sun in shown.suns)


def check(state: ViewState, size: tuple[int, int] = (MIN_SIDE, MIN_SIDE)) -> None:
    """UsageError unless state and size (width, height) are within the limits of the viewer."""
    if not 1 <= state.n_bands <= MAX_SHOWN_BANDS:
        raise UsageError(f"{state.n_bands} bands: the viewer shows 1 to {MAX_SHOWN_BANDS}")
    for band in sorted(state.muted):
        if not 0 <= band < MAX_SHOWN_BANDS:
            raise UsageError(f"muted band {band}: bands are counted from 0 to {MAX_SHOWN_BANDS - 1}")
    if state.method not in METHODS:
        raise UsageError(f"method {state.method!r}: it must be one of {', '.join(METHODS)}")
    if state.quantity not in QUANTITIES:
        raise UsageError(f"quantity {state.quantity!r}: it must be one of {', '.join(QUANTITIES)}")
    if state.window not in WINDOWS:
        raise UsageError(f"window {state.window!r}: it must be one of {', '.join(WINDOWS)}")
    if state.window_width is not None and not 0 < state.window_width < float("inf"):
        raise UsageError(f"window width {state.window_width:g}: it must be positive and finite, in bands")
    if not 0 < state.tolerance < 1:
        raise UsageError(f"tolerance {state.tolerance:g}: it must be between 0 and 1, such as 0.05 or 5%")
    if not 1 <= state.samples <= MAX_SAMPLES:
        raise UsageError(f"{state.samples} samples: there must be 1 to {MAX_SAMPLES}")
    if state.seed < 0:
        raise UsageError(f"seed {state.seed}: it must not be negative")
    if state.exposure_stops is not None and abs(state.exposure_stops) > MAX_EXPOSURE:
        raise UsageError(f"exposure {state.exposure_stops:g}: it must be -{MAX_EXPOSURE:g} to {MAX_EXPOSURE:g} stops")
    if state.tone not in TONES:
        raise UsageError(f"tone {state.tone!r}: it must be one of {', '.join(TONES)}")
    if state.error not in ERRORS:
        raise UsageError(f"error {state.error!r}: it must be one of {', '.join(ERRORS)}")
    if state.error_range is not None and not LEAST_ERROR_RANGE <= state.error_range <= BRIGHTEST:
        raise UsageError(f"error range {state.error_range:g}: it must be {LEAST_ERROR_RANGE:g} to {BRIGHTEST:g}")
    if state.evaluate not in EVALUATIONS:
        raise UsageError(f"evaluate {state.evaluate!r}: it must be one of {', '.join(EVALUATIONS)}")
    if state.evaluate == "direct" and state.n_bands > MAX_DIRECT_BANDS:
        raise UsageError(
            f"{state.n_bands} bands: at most {MAX_DIRECT_BANDS} are summed directly; map or auto take more"
        )
    if state.basis is not None and not abs(state.basis[1]) <= state.basis[0] < state.n_bands:
        raise UsageError(f"basis function {state.basis}: l must be 0 to {state.n_bands - 1}, m -l to l")
    if not ZOOM_RANGE[0] <= state.zoom <= ZOOM_RANGE[1]:
        raise UsageError(f"zoom {state.zoom:g}: it must be {ZOOM_RANGE[0]:g} to {ZOOM_RANGE[1]:g}")
    if not all(MIN_SIDE <= side <= MAX_SIDE for side in size):
        raise UsageError(f"size {size[0]} x {size[1]}: each side must be {MIN_SIDE} to {MAX_SIDE} pixels")


def exposure_stops(state: ViewState, light: Light) -> float:
    """The exposure in use: fixed by the state, or such that 99 % of the original stays just below white."""
    base = _automatic_exposure(light, state.tone) if state.exposure_stops is None else state.exposure_stops
    return base + state.exposure_offset


@remember(most=2)
def _reconstruction_map(
    light: Light, projection: Projection, n_bands: int, muted: tuple[int, ...], window_name: str, width: float | None
) -> NDArray[np.float32]:
    shown, _ = reconstruct(light, projection, n_bands, muted, window_name, width)
    return Synthesis(shown).spline_map(*map_size(n_bands))


@remember(most=4)
def _compared_surfaces(
    light: Light,
    projection: Projection,
    n_bands: int,
    muted: tuple[int, ...],
    window_name: str,
    width: float | None,
    rows: int,
) -> tuple[Surface, Surface, Surface]:
    shown, _ = reconstruct(light, projection, n_bands, muted, window_name, width)
    original, reconstruction = sample_light(light, rows), sample_reconstruction(shown, rows)
    scale = common_scale(original, reconstruction)
    values = original, reconstruction, reconstruction - original
    return surface(values[0], scale), surface(values[1], scale), surface(values[2], scale)


@remember(most=16)
def _error_scale(
    light: Light,
    projection: Projection,
    n_bands: int,
    muted: tuple[int, ...],
    window_name: str,
    width: float | None,
    kind: str,
) -> ErrorScale:
    """From the grid on which the figures are found; the largest relative error, which is no figure, is climbed to there.

    The floor of the relative error is the light's mean.
    """
    shown, figures = reconstruct(light, projection, n_bands, muted, window_name, width)
    exact = project(light, *BEST, projection.n_bands).coefficients
    floor = max(float(np.abs(exact[0]).mean()) / (2 * np.sqrt(np.pi)), LEAST_ERROR_RANGE)
    grid, synthesis = error_grid(light, grid_rows(n_bands)), Synthesis(shown)
    values = synthesis.on_rows(grid.theta, len(grid.phi))
    original, reconstruction = (part.transpose(0, 2, 1).reshape(-1, 3) for part in (grid.original, values))
    errors = error_values(kind, original, reconstruction, floor)

    def error_at(directions: Array) -> Array:
        return error_values(kind, light.radiance(directions), at_directions(synthesis, directions), floor)

    direction = np.array(figures.extremes.max_error_direction)
    if kind == "relative":
        row, column = divmod(int(errors.argmax()), len(grid.phi))
        start = directions_from_angles(grid.theta[[row]], grid.phi[[column]])
        direction = climb(error_at, start, np.pi / len(grid.theta), DISPLAY_ROUNDS)[1][0]
    largest = float(error_at(direction[None])[0])
    end = automatic_range(kind, errors, np.repeat(grid.row_share, len(grid.phi)), abs(largest))
    return ErrorScale(kind, floor, largest, direction, max(end, LEAST_ERROR_RANGE))


@remember(most=len(TONES))
def _automatic_exposure(light: Light, tone: str) -> float:
    grid = error_grid(light, grid_rows(1))
    brightest = grid.original.max(axis=1)
    order = np.argsort(brightest, axis=None)
    share = np.cumsum(np.broadcast_to(grid.row_share[:, None], brightest.shape).ravel()[order])
    position = min(int(np.searchsorted(share, WHITE_PERCENTILE)), len(order) - 1)
    level = float(brightest.ravel()[order[position]])
    if level <= 0:
        level = grid.peak
    return float(np.log2(exposed_for(WHITE_LEVEL, tone) / level)) if level > 0 else 0.0
