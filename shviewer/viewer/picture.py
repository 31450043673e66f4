"""From a state to a Picture: plain arrays for the GPU and figures for the overlay. No OpenGL, so a test can look inside.

What is expensive is remembered: a light is read once, projected once per method to at least MAX_DIRECT_BANDS bands, and
sampled once for its error figures. A band key then costs a sum of what is there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from time import perf_counter

import numpy as np

from shviewer.errors import UsageError
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.deringing import MAX_DERINGED_BANDS, dering
from shviewer.harmonics.extremes import ErrorGrid, Extremes
from shviewer.harmonics.filters import per_coefficient, window
from shviewer.harmonics.metrics import (
    PARSEVAL_FLOOR,
    ChannelFigures,
    SampleEstimate,
    band_power,
    band_weights,
    channel_figures,
    errors_by_band_count,
    smallest_band_count,
    split_half_estimate,
)
from shviewer.harmonics.projection import Synthesis, project_product, project_samples
from shviewer.harmonics.quadrature import MAX_SAMPLES, gauss_legendre, jittered
from shviewer.lights.irradiance import IrradianceLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import Light, find_light
from shviewer.lights.lobes import Lobe, LobeLight
from shviewer.viewer import camera
from shviewer.viewer.composition import MAX_SIDE, MIN_SIDE
from shviewer.viewer.layout import MAX_DIRECT_BANDS, MAX_SHOWN_BANDS
from shviewer.viewer.state import MAX_EXPOSURE, METHODS, QUANTITIES, WINDOWS, ZOOM_RANGE, ViewState

BEST = ("best", 0, 0)
HALF_SEED = 2**31
"""Added to the seed for the second, independent set of samples."""

WHITE_PERCENTILE = 0.99
"""Automatic exposure puts this share of the sphere below WHITE_LEVEL."""

WHITE_LEVEL = 0.8
"""Linear; the brightest hundredth still stands out above it."""

MAP_SIZE = (1025, 2048)
"""Rows and columns of the reconstruction's map: interpolated by cubics it is good to 1.5e-10 n^3 of the peak."""


@dataclass(frozen=True, eq=False)
class Projection:
    """Coefficients (n**2, 3) of all bands computed, by which method, from how many evaluations, in what time."""

    coefficients: Array
    method: str
    evaluations: int | None
    milliseconds: float

    @property
    def n_bands(self) -> int:
        return count_bands(self.coefficients)


@dataclass(frozen=True)
class Needs:
    """How many bands are within a tolerance, for the radiance and for the irradiance of a light; None if no count is."""

    tolerance: float
    radiance: int | None
    irradiance: int | None
    best: float
    """The relative L2 error, of the quantity shown, with as many bands as are best."""
    best_bands: int
    searched: int
    """Up to how many bands the quantity shown was searched: fewer for samples, which are rarely good for more."""


@dataclass(frozen=True)
class Figures:
    """What the overlay and the metadata say. Radiance is linear."""

    channels: dict[str, ChannelFigures]
    """Of "all" channels together, "red", "green", "blue" and "luminance"."""
    floor: float
    """Relative L2 errors below this cannot be told from rounding, or from a quadrature's own error."""
    extremes: Extremes
    energy_share: tuple[float, ...]
    """Energy of each band over that of the light; as many bands as were projected exactly."""
    factors: tuple[float, ...]
    """What each band in use is multiplied with: the window, 0 if muted."""

    @property
    def relative_l2(self) -> float:
        return self.channels["all"].relative_l2


@dataclass(frozen=True, eq=False)
class Picture:
    """What the GPU and the overlay need for one state."""

    state: ViewState
    light: Light
    """What is shown on the left: the state's light, or its irradiance."""
    lobes: tuple[Lobe, ...]
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


def prepare(state: ViewState) -> Picture:
    """Everything to be drawn and said. LightError if the light cannot be read, UsageError for a state out of range."""
    check(state)
    light = load_light(state)
    projected = MAX_DIRECT_BANDS if state.n_bands <= MAX_DIRECT_BANDS else MAX_SHOWN_BANDS
    projection = _project(light, *_sampling(state), projected)
    shape = state.n_bands, state.muted_shown, state.window, state.window_width
    coefficients, figures = _reconstruct(light, projection, *shape)
    return Picture(
        state=state,
        light=light,
        lobes=light.lobes if isinstance(light, LobeLight) else (),
        original_map=light.radiance_map(),
        coefficients=coefficients,
        reconstruction_map=None
        if state.n_bands <= MAX_DIRECT_BANDS
        else _reconstruction_map(light, projection, *shape),
        world_from_view=camera.world_from_view(*state.camera),
        light_from_world=camera.light_from_world(state.light_rotation),
        exposure_stops=exposure_stops(state, light),
        projection=projection,
        figures=figures,
        needs=needs(state),
    )


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


def _sampling(state: ViewState) -> tuple[str, int, int]:
    """Method, samples and seed; the last two do not matter to the best way, which is then the same for all of them."""
    return BEST if state.method == "best" else (state.method, state.samples, state.seed)


def load_light(state: ViewState) -> Light:
    """The state's light, or its irradiance; one named by text is read once."""
    light = _find(state.light, state.sanitize) if isinstance(state.light, str) else state.light
    return _irradiance(light) if state.quantity == "irradiance" else light


def needs(state: ViewState) -> Needs:
    """How many bands the state's light needs for its tolerance, by the best way and for both quantities.

    With a sampled method the answer for the quantity shown is that of the samples' own error.
    """
    answers = {}
    for quantity in QUANTITIES:
        light = load_light(replace(state, quantity=quantity))
        errors = _errors(light, *(_sampling(state) if quantity == state.quantity else BEST))
        answers[quantity] = smallest_band_count(errors, state.tolerance), errors
    errors = answers[state.quantity][1]
    best = int(errors.argmin())
    return Needs(
        state.tolerance, answers["radiance"][0], answers["irradiance"][0], float(errors[best]), best + 1, len(errors)
    )


def estimate_from_samples(state: ViewState) -> SampleEstimate:
    """What the state's number of jittered samples alone says, as if the light were not known otherwise.

    Two sets of half as many, drawn independently: the halves of one set would share its cells, and depend on each other.
    """
    light = load_light(state)
    halves = [jittered(max(state.samples // 2, 1), seed) for seed in (state.seed, state.seed + HALF_SEED)]
    first, second = (project_samples(light.radiance, half, MAX_DIRECT_BANDS) / light.unit for half in halves)
    squares = np.concatenate([((light.radiance(half.directions) / light.unit) ** 2).sum(axis=1) for half in halves])
    deviation = 4 * np.pi * float(squares.std()) / np.sqrt(len(squares))
    return split_half_estimate(first, second, 4 * np.pi * float(squares.mean()), deviation, state.tolerance)


def exposure_stops(state: ViewState, light: Light) -> float:
    """The exposure in use: fixed by the state, or such that 99 % of the original stays just below white."""
    base = _automatic_exposure(light) if state.exposure_stops is None else state.exposure_stops
    return base + state.exposure_offset


@lru_cache(maxsize=32)
def _find(text: str, sanitize: bool) -> Light:
    return find_light(text, sanitize=sanitize)


@lru_cache(maxsize=32)
def _project(light: Light, method: str, samples: int, seed: int, n_bands: int) -> Projection:
    start = perf_counter()
    evaluations = None
    if method == "jittered":
        directions = jittered(samples, seed)
        evaluations = len(directions.weights)
        coefficients = project_samples(light.radiance, directions, n_bands)
        words = "jittered samples"
    elif method == "gauss-legendre":
        rule = gauss_legendre(samples)
        evaluations = len(rule.theta) * rule.n_columns
        coefficients = project_product(light.radiance, rule, n_bands)[0]
        words = "Gauss-Legendre"
    else:
        coefficients = light.coefficients(n_bands)
        words = light.best_method
    return Projection(coefficients, words, evaluations, 1000 * (perf_counter() - start))


@lru_cache(maxsize=32)
def _irradiance(light: Light) -> Light:
    return IrradianceLight(light)


@lru_cache(maxsize=64)
def _errors(light: Light, method: str, samples: int, seed: int) -> Array:
    exact = _project(light, *BEST, MAX_SHOWN_BANDS).coefficients
    n_bands = MAX_SHOWN_BANDS if method == "best" else MAX_DIRECT_BANDS  # samples are rarely good for more
    shown = exact if method == "best" else _project(light, method, samples, seed, n_bands).coefficients
    return errors_by_band_count(light.products(), exact[: n_bands**2] / light.unit, shown / light.unit)


@lru_cache(maxsize=256)
def _reconstruct(
    light: Light, projection: Projection, n_bands: int, muted: tuple[int, ...], window_name: str, width: float | None
) -> tuple[Array, Figures]:
    exact = _project(light, *BEST, projection.n_bands).coefficients
    shown = projection.coefficients[: n_bands**2] * band_weights(n_bands, frozenset(muted))
    factors = _window_factors(shown / light.unit, window_name, width)
    shown = shown * per_coefficient(factors)
    total = float(np.trace(light.products()))
    power = band_power(exact / light.unit).sum(axis=1)
    extremes = _error_grid(light, _grid_rows(n_bands)).compare(shown)
    figures = Figures(
        channels=channel_figures(
            light.products(), exact[: n_bands**2] / light.unit, shown / light.unit, extremes.peak / light.unit
        ),
        floor=max(PARSEVAL_FLOOR, light.accuracy()),
        extremes=extremes,
        energy_share=tuple(float(p) / total if total else 0.0 for p in power),
        factors=tuple(0.0 if band in muted else float(factor) for band, factor in enumerate(factors)),
    )
    return shown, figures


def _window_factors(coefficients: Array, name: str, width: float | None) -> Array:
    """The window's factor per band, (n,). UsageError where it cannot be had."""
    n_bands = count_bands(coefficients)
    if name == "none":
        return np.ones(n_bands)
    if name == "dering":
        if n_bands > MAX_DERINGED_BANDS:
            raise UsageError(f"{n_bands} bands: dering takes at most {MAX_DERINGED_BANDS}")
        try:
            return dering(coefficients).factors
        except ValueError as error:
            raise UsageError(f"dering: {error}") from error
    return window(name, n_bands, width or n_bands)


@lru_cache(maxsize=4)
def _reconstruction_map(
    light: Light, projection: Projection, n_bands: int, muted: tuple[int, ...], window_name: str, width: float | None
) -> LatLongMap:
    shown, _ = _reconstruct(light, projection, n_bands, muted, window_name, width)
    rows, columns = MAP_SIZE
    values = Synthesis(shown).on_rows(np.linspace(0, np.pi, rows), columns)
    return LatLongMap(np.ascontiguousarray(values.transpose(0, 2, 1), dtype=np.float32), rows_on_poles=True)


def _grid_rows(n_bands: int) -> int:
    """Four rows per band, and never so few that a built-in light is seen coarsely."""
    return max(128, 4 * n_bands)


@lru_cache(maxsize=8)
def _error_grid(light: Light, rows: int) -> ErrorGrid:
    return ErrorGrid(light.radiance, light.landmarks(), rows)


@lru_cache(maxsize=32)
def _automatic_exposure(light: Light) -> float:
    grid = _error_grid(light, _grid_rows(1))
    brightest = grid.original.max(axis=1)
    order = np.argsort(brightest, axis=None)
    share = np.cumsum(np.broadcast_to(grid.row_share[:, None], brightest.shape).ravel()[order])
    position = min(int(np.searchsorted(share, WHITE_PERCENTILE)), len(order) - 1)
    level = float(brightest.ravel()[order[position]])
    if level <= 0:
        level = grid.peak
    return float(np.log2(WHITE_LEVEL / level)) if level > 0 else 0.0
