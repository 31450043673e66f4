"""What a state may ask of the viewer."""

from __future__ import annotations

from shviewer.errors import UsageError
from shviewer.harmonics.quadrature import MAX_SAMPLES
from shviewer.limits import BRIGHTEST, DIMMEST, MAX_BANDS, MAX_DIRECT_BANDS
from shviewer.viewer.composition import MAX_SIDE, MIN_SIDE
from shviewer.viewer.error_scale import ERRORS
from shviewer.viewer.state import (
    EVALUATIONS,
    MAX_EXPOSURE,
    METHODS,
    QUANTITIES,
    SHEETS,
    WINDOWS,
    ZOOM_RANGE,
    ViewState,
)
from shviewer.viewer.tone import TONES


def check(state: ViewState, size: tuple[int, int] = (MIN_SIDE, MIN_SIDE)) -> None:
    """UsageError unless state and size (width, height) are within the limits of the viewer."""
    if not 1 <= state.n_bands <= MAX_BANDS:
        raise UsageError(f"{state.n_bands} bands: the viewer shows 1 to {MAX_BANDS}")
    for band in sorted(state.muted):
        if not 0 <= band < MAX_BANDS:
            raise UsageError(f"muted band {band}: bands are counted from 0 to {MAX_BANDS - 1}")
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
    if state.error_range is not None and not DIMMEST <= state.error_range <= BRIGHTEST:
        raise UsageError(f"error range {state.error_range:g}: it must be {DIMMEST:g} to {BRIGHTEST:g}")
    if state.sheet not in SHEETS:
        raise UsageError(f"sheet {state.sheet!r}: it must be one of {', '.join(filter(None, SHEETS))}, or empty")
    if state.evaluate not in EVALUATIONS:
        raise UsageError(f"evaluate {state.evaluate!r}: it must be one of {', '.join(EVALUATIONS)}")
    if state.evaluate == "direct" and state.n_bands > MAX_DIRECT_BANDS:
        raise UsageError(
            f"{state.n_bands} bands: at most {MAX_DIRECT_BANDS} are summed directly; map or auto take more"
        )
    if state.basis is not None and not abs(state.basis[1]) <= state.basis[0] < state.n_bands:
        raise UsageError(
            f"basis function {state.basis} of {state.n_bands} bands: l must be 0 to {state.n_bands - 1}, m -l to l"
        )
    if not ZOOM_RANGE[0] <= state.zoom <= ZOOM_RANGE[1]:
        raise UsageError(f"zoom {state.zoom:g}: it must be {ZOOM_RANGE[0]:g} to {ZOOM_RANGE[1]:g}")
    if not all(MIN_SIDE <= side <= MAX_SIDE for side in size):
        raise UsageError(f"size {size[0]} x {size[1]}: each side must be {MIN_SIDE} to {MAX_SIDE} pixels")
