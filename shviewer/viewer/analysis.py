"""What is known of a light: its projections, the figures of a reconstruction, the band counts it needs.

What is expensive is remembered (memory.py): a light is read once, projected once per method to at least MAX_DIRECT_BANDS
bands, and sampled once for its error figures. A band key then costs a sum of what is there.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Any

import numpy as np

from shviewer.errors import LightError, UsageError
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.deringing import MAX_DERINGED_BANDS, dering
from shviewer.harmonics.extremes import ErrorGrid, Extremes
from shviewer.harmonics.filters import irradiance_factors, per_coefficient, window
from shviewer.harmonics.metrics import (
    PARSEVAL_FLOOR,
    ChannelFigures,
    SampleEstimate,
    band_power,
    band_weights,
    channel_figures,
    errors_by_band_count,
    relative,
    smallest_band_count,
    split_half_estimate,
    squared_error,
)
from shviewer.harmonics.projection import project_product
from shviewer.harmonics.quadrature import gauss_legendre, jittered
from shviewer.harmonics.scattered import project_samples
from shviewer.lights.coefficients.light import CoefficientLight
from shviewer.lights.irradiance import IrradianceLight
from shviewer.lights.light import Light, built_in_lights, find_light
from shviewer.lights.sun import Split, Sun, split_suns
from shviewer.viewer.layout import MAX_DIRECT_BANDS, MAX_SHOWN_BANDS
from shviewer.viewer.memory import MEMORY, remember
from shviewer.viewer.state import QUANTITIES, ViewState
from shviewer.viewer.watching import Stamp, stamp

BEST = ("best", 0, 0)
"""Method, samples and seed of the best way, to which the last two do not matter."""

MIN_ESTIMATE = 256
"""Fewer samples than this do not even tell how noisy they are."""

HALF_SEED = 2**31
"""Added to the seed for the second, independent set of samples."""

MOST_MEASUREMENTS = 128
"""Per light, quantity and bands: more than the keys reach, of at most 1 KiB each."""


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

    @property
    def evaluation_noun(self) -> str:
        """What its evaluations are called."""
        return "samples" if self.method == "jittered" else "points"


@dataclass(frozen=True)
class Measurement:
    """What one way to project a light cost, and how good it is: a few numbers, kept longer than the projection itself."""

    method: str
    samples: int
    seed: int
    words: str
    """The method as `Projection` names it."""
    milliseconds: float
    """The least of all repetitions."""
    repetitions: int
    errors: Array = field(compare=False)
    """Relative L2 error with the first n = 1 ... N bands, (N,); it follows from the other fields and the light."""

    @property
    def sampling(self) -> tuple[str, int, int]:
        return self.method, self.samples, self.seed


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
    irradiance_relative_l2: float
    """The error that the same coefficients have where they shade a white Lambertian surface."""
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


def sampling_of(state: ViewState) -> tuple[str | CoefficientLight, int, int]:
    """Method, samples and seed; the last two do not matter to the best way, which is then the same for all of them.

    Coefficients that are given are a method, too: that of the file they come from.
    """
    return way_of(state) if state.compare is None else (state.compare, 0, 0)


def way_of(state: ViewState) -> tuple[str, int, int]:
    """The same by name; coefficients that are given are no way to project, and nothing is measured of them."""
    if state.compare is not None:
        return "given", 0, 0
    return BEST if state.method == "best" else (state.method, state.samples, state.seed)


@dataclass(frozen=True, eq=False)
class Subject:
    """What is shown as the original, and what is projected: the same, unless suns are split off."""

    whole: Light
    light: Light
    """What the figures are of."""
    suns: tuple[Sun, ...] = ()
    refusal: str = ""
    """Why nothing was split off although it was asked for."""


def subject(state: ViewState) -> Subject:
    """Of the state's light, or of its irradiance; a light named by text is read once."""
    light = state.light
    if isinstance(light, str):
        light = MEMORY.named(_name(state)) or read_again(state)
    found = Subject(light, light)
    if state.split_sun:
        split = _split(light)
        found = replace(found, refusal=split) if isinstance(split, str) else Subject(light, split.rest, split.suns)
    if state.quantity == "irradiance":
        return replace(found, whole=_irradiance(found.whole), light=_irradiance(found.light))
    return found


def load_light(state: ViewState) -> Light:
    """The light that is projected."""
    return subject(state).light


def read_again(state: ViewState) -> Light:
    """The light that the state names, read anew. LightError leaves what was known of it as it was.

    A light that is not named by a text is what it is.
    """
    if not isinstance(state.light, str):
        return state.light
    read = stamp(state.light)  # before: what is written during the reading is a later change
    safe = state.light in built_in_lights()
    light = find_light(state.light, replace(state.reading, isolated=False) if safe else state.reading)
    MEMORY.name(_name(state), light)
    MEMORY.results(light, stamp)[None] = read
    return light


def keep_light(state: ViewState, light: Light) -> None:
    """Let the state's text go on meaning `light`, whatever its file holds by now."""
    if isinstance(state.light, str):
        MEMORY.name(_name(state), light)


def stamp_read(state: ViewState) -> Stamp | None:
    """The stamp that the file of the state's light had when it was read; None if that is not known."""
    light = MEMORY.named(_name(state))
    found: Stamp | None = MEMORY.results(light, stamp).get(None) if light is not None else None
    return found


def _name(state: ViewState) -> Hashable:
    return state.light, state.reading


def needs(state: ViewState) -> Needs:
    """How many bands the state's light needs for its tolerance, by the best way and for both quantities.

    With a sampled method the answer for the quantity shown is that of the samples' own error.
    """
    answers = {}
    for quantity in QUANTITIES:
        light = load_light(replace(state, quantity=quantity))
        errors = errors_of(light, *(sampling_of(state) if quantity == state.quantity else BEST))
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
    first, second = (project_samples(light.integrand, half, MAX_DIRECT_BANDS) / light.unit for half in halves)
    squares = np.concatenate([((light.integrand(half.directions) / light.unit) ** 2).sum(axis=1) for half in halves])
    deviation = 4 * np.pi * float(squares.std()) / np.sqrt(len(squares))
    if len(squares) < MIN_ESTIMATE:
        return SampleEstimate(None, 1, None)
    return split_half_estimate(first, second, 4 * np.pi * float(squares.mean()), deviation, state.tolerance)


def project(light: Light, method: str | CoefficientLight, samples: int, seed: int, n_bands: int) -> Projection:
    """Project a light; the irradiance of a sampled light comes from the samples of the light itself.

    method: "best", "jittered" or "gauss-legendre"; or given coefficients, which are taken instead.
    """
    if isinstance(method, CoefficientLight):
        return _given_projection(light, method, n_bands)
    found = _measured_projection(light, method, samples, seed, n_bands)
    _known(light, n_bands).move_to_end((method, samples, seed))
    return found


def measurements(light: Light, n_bands: int) -> tuple[Measurement, ...]:
    """What this session knows of the cost of projecting the light to `n_bands` bands, by method, samples and seed."""
    return tuple(found for _, found in sorted(_known(light, n_bands).items())) if light in MEMORY else ()


def _known(light: Light, n_bands: int) -> OrderedDict[tuple[str, int, int], Measurement]:
    known: OrderedDict[Any, Measurement] = MEMORY.results(
        light, (Measurement, isinstance(light, IrradianceLight), n_bands)
    )
    return known


def _measure(light: Light, sampling: tuple[str, int, int], projection: Projection) -> None:
    """Add to what is known of the cost of this way to project."""
    n_bands, shown = projection.n_bands, projection.coefficients
    exact = shown if sampling == BEST else project(light, *BEST, n_bands).coefficients
    errors = errors_by_band_count(light.products(), exact / light.unit, shown / light.unit)
    known = _known(light, n_bands)
    if isinstance(light, IrradianceLight) and sampling != BEST:  # the only time spent was that on the light itself
        known[sampling] = replace(_known(light.source, n_bands)[sampling], errors=errors)
    else:
        before = known.get(sampling)
        least = min(projection.milliseconds, before.milliseconds if before else np.inf)
        repetitions = 1 + (before.repetitions if before else 0)
        known[sampling] = Measurement(*sampling, projection.method, least, repetitions, errors)
    if len(known) > MOST_MEASUREMENTS:
        known.popitem(last=False)


@remember(most=8)
def _given_projection(light: Light, given: CoefficientLight, n_bands: int) -> Projection:
    coefficients = given.coefficients(n_bands)
    if isinstance(light, IrradianceLight):
        coefficients = coefficients * per_coefficient(irradiance_factors(n_bands))
    return Projection(coefficients, f"read as {given.convention}", None, 0.0)


@remember(most=16)
def _measured_projection(light: Light, method: str, samples: int, seed: int, n_bands: int) -> Projection:
    """A projection made, timed and measured."""
    projection = _timed_projection(light, method, samples, seed, n_bands)
    _measure(light, (method, samples, seed), projection)
    return projection


def _timed_projection(light: Light, method: str, samples: int, seed: int, n_bands: int) -> Projection:
    """A projection made and timed."""
    start = perf_counter()
    if isinstance(light, IrradianceLight) and method != "best":
        source = project(light.source, method, samples, seed, n_bands)
        return replace(source, coefficients=source.coefficients * per_coefficient(irradiance_factors(n_bands)))
    evaluations = None
    if method == "jittered":
        directions = jittered(samples, seed)
        evaluations = len(directions.weights)
        coefficients = project_samples(light.integrand, directions, n_bands)
        words = "jittered"
    elif method == "gauss-legendre":
        rule = gauss_legendre(samples)
        evaluations = len(rule.theta) * rule.n_columns
        coefficients = project_product(light.integrand, rule, n_bands)[0]
        words = "Gauss-Legendre"
    else:
        coefficients = light.coefficients(n_bands)
        words = light.best_method
    return Projection(coefficients, words, evaluations, 1000 * (perf_counter() - start))


@remember(most=1)
def _split(light: Light) -> Split | str:
    """The light and its suns apart, or why it has none."""
    try:
        split = split_suns(light)
    except LightError as error:
        return str(error)
    MEMORY.belongs(split.rest, light)
    return split


@remember(most=2)
def _irradiance(light: Light) -> Light:
    return IrradianceLight(light)


@remember(most=16)
def errors_of(light: Light, method: str | CoefficientLight, samples: int, seed: int) -> Array:
    """The relative L2 error for every band count that is searched, (MAX_SHOWN_BANDS,) or (MAX_DIRECT_BANDS,) of samples."""
    exact = project(light, *BEST, MAX_SHOWN_BANDS).coefficients
    n_bands = MAX_SHOWN_BANDS if method == "best" else MAX_DIRECT_BANDS  # samples are rarely good for more
    shown = exact if method == "best" else project(light, method, samples, seed, n_bands).coefficients
    return errors_by_band_count(light.products(), exact[: n_bands**2] / light.unit, shown / light.unit)


@remember(most=64)
def reconstruct(
    light: Light, projection: Projection, n_bands: int, muted: tuple[int, ...], window_name: str, width: float | None
) -> tuple[Array, Figures]:
    """What is shown of a projection, (n_bands**2, 3), and how good it is."""
    exact = project(light, *BEST, projection.n_bands).coefficients
    shown = projection.coefficients[: n_bands**2] * band_weights(n_bands, frozenset(muted))
    factors = _window_factors(shown / light.unit, window_name, width)
    shown = shown * per_coefficient(factors)
    total = float(np.trace(light.products()))
    power = band_power(exact / light.unit).sum(axis=1)
    extremes = error_grid(light, grid_rows(n_bands)).compare(shown)
    irradiance = light if isinstance(light, IrradianceLight) else _irradiance(light)
    cosine = np.ones((1, 1)) if irradiance is light else per_coefficient(irradiance_factors(n_bands))
    shaded = squared_error(
        irradiance.products().diagonal(), cosine * exact[: n_bands**2] / light.unit, cosine * shown / light.unit
    )
    figures = Figures(
        irradiance_relative_l2=relative(sum(shaded), irradiance.products().diagonal()),
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


def grid_rows(n_bands: int) -> int:
    """At least four rows per band, in few steps, so that a light is seldom looked at anew."""
    return next(rows for bands, rows in ((16, 96), (32, 128), (64, 256), (MAX_SHOWN_BANDS, 512)) if n_bands <= bands)


@remember(most=8)
def error_grid(light: Light, rows: int) -> ErrorGrid:
    """The light on a grid of so many rows."""
    return ErrorGrid(light.radiance, light.landmarks(), rows, getattr(light, "on_rows", None))
