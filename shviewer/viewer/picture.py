"""From a state to a Picture: plain arrays for the GPU and figures for the overlay. No OpenGL, so a test can look inside."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shviewer.errors import LightError, UsageError
from shviewer.harmonics.basis import Array
from shviewer.harmonics.quadrature import MAX_SAMPLES
from shviewer.harmonics.synthesis import Synthesis
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import Light
from shviewer.lights.lobes import Lobe, LobeLight
from shviewer.viewer import camera
from shviewer.viewer.analysis import (
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
from shviewer.viewer.layout import MAX_DIRECT_BANDS, MAX_SHOWN_BANDS
from shviewer.viewer.memory import remember
from shviewer.viewer.state import MAX_EXPOSURE, METHODS, QUANTITIES, WINDOWS, ZOOM_RANGE, ViewState

DIMMEST, BRIGHTEST = 1e-30, 1e30
"""The largest radiance of a light that can be drawn: beyond, sums and products would leave float32."""

WHITE_PERCENTILE = 0.99
"""Automatic exposure puts this share of the sphere below WHITE_LEVEL."""

WHITE_LEVEL = 0.8
"""Linear; the brightest hundredth still stands out above it."""

MAP_SIZE = (1025, 2048)
"""Rows and columns of the reconstruction's map: interpolated by cubics it is good to 1.5e-10 n^3 of the peak."""


@dataclass(frozen=True, eq=False)
class Picture:
    """What the GPU and the overlay need for one state."""

    state: ViewState
    subject: Subject
    """What is shown on the left, what is projected, and the suns that were split off."""
    lobes: tuple[Lobe, ...]
    """Of the original."""
    added_lobes: tuple[Lobe, ...]
    """The suns, drawn on top of the reconstruction."""
    original_map: LatLongMap | None
    coefficients: Array
    """Shown, (n_bands**2, 3): muted ones are zero."""
    reconstruction_map: LatLongMap | None
    """In place of the direct sum above MAX_DIRECT_BANDS."""
    world_from_view: Array
    light_from_world: Array
    exposure_stops: float
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


def prepare(state: ViewState) -> Picture:
    """Everything to be drawn and said. LightError if the light cannot be read, UsageError for a state out of range."""
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
    return Picture(
        state=state,
        subject=shown,
        lobes=whole.lobes if isinstance(whole, LobeLight) else (),
        added_lobes=_sun_lobes(shown, state.quantity),
        original_map=whole.radiance_map(),
        coefficients=coefficients,
        reconstruction_map=None
        if state.n_bands <= MAX_DIRECT_BANDS
        else _reconstruction_map(light, projection, *shape),
        world_from_view=camera.world_from_view(*state.camera),
        light_from_world=camera.light_from_world(state.light_rotation),
        exposure_stops=exposure_stops(state, whole),
        projection=projection,
        figures=figures,
        needs=needs(state),
        needs_unsplit=needs(replace(state, split_sun=False)) if shown.suns else None,
        suspicion=suspicion(light, state.compare) if state.compare else "",
    )


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
    if not ZOOM_RANGE[0] <= state.zoom <= ZOOM_RANGE[1]:
        raise UsageError(f"zoom {state.zoom:g}: it must be {ZOOM_RANGE[0]:g} to {ZOOM_RANGE[1]:g}")
    if not all(MIN_SIDE <= side <= MAX_SIDE for side in size):
        raise UsageError(f"size {size[0]} x {size[1]}: each side must be {MIN_SIDE} to {MAX_SIDE} pixels")


def exposure_stops(state: ViewState, light: Light) -> float:
    """The exposure in use: fixed by the state, or such that 99 % of the original stays just below white."""
    base = _automatic_exposure(light) if state.exposure_stops is None else state.exposure_stops
    return base + state.exposure_offset


@remember(most=2)
def _reconstruction_map(
    light: Light, projection: Projection, n_bands: int, muted: tuple[int, ...], window_name: str, width: float | None
) -> LatLongMap:
    shown, _ = reconstruct(light, projection, n_bands, muted, window_name, width)
    rows, columns = MAP_SIZE
    return LatLongMap(Synthesis(shown).pole_to_pole(rows, columns), rows_on_poles=True)


@remember(most=2)
def _automatic_exposure(light: Light) -> float:
    grid = error_grid(light, grid_rows(1))
    brightest = grid.original.max(axis=1)
    order = np.argsort(brightest, axis=None)
    share = np.cumsum(np.broadcast_to(grid.row_share[:, None], brightest.shape).ravel()[order])
    position = min(int(np.searchsorted(share, WHITE_PERCENTILE)), len(order) - 1)
    level = float(brightest.ravel()[order[position]])
    if level <= 0:
        level = grid.peak
    return float(np.log2(WHITE_LEVEL / level)) if level > 0 else 0.0
