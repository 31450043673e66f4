"""Figures of a light and its reconstruction, and the band counts that a tolerance needs.

Expensive results are remembered (cache.py): a light is sampled once for its error figures.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from typing import Final

import numpy as np

from shviewer.analysis.cache import remember
from shviewer.analysis.projections import BEST, Projection, Way, project, way_of
from shviewer.analysis.recipe import Recipe, Shown
from shviewer.analysis.subjects import load_light, through
from shviewer.errors import UsageError, refused_as
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.deringing import MAX_DERINGED_BANDS, dering
from shviewer.harmonics.extremes.error_grid import ErrorGrid, Extremes, Lows
from shviewer.harmonics.filters import per_coefficient, window
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
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import jittered
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE
from shviewer.lights.light import Light
from shviewer.limits import MAX_BANDS, MAX_DIRECT_BANDS
from shviewer.words import counted

MIN_ESTIMATE = 256
"""Fewer samples than this do not even tell how noisy they are."""

HALF_SEED = 2**31
"""The number added to the seed for the second, independent set of samples."""


class Pending(Enum):
    """The type of a figure that is still being computed: it is neither 0 nor absent."""

    PENDING = "\u2026"

    def __str__(self) -> str:
        return str(self.value)


PENDING: Final = Pending.PENDING


@dataclass(frozen=True)
class Needs:
    """The fewest bands within a tolerance, for the radiance, the irradiance and the quantity shown; None if no count is."""

    tolerance: float
    radiance: int | None
    irradiance: int | None
    shown: int | None
    best: float
    """The least relative L2 error, of the quantity shown, that any number of bands reaches."""
    best_bands: int
    searched: int
    """The number of bands up to which was searched: fewer for samples, and of given coefficients all that there are."""

    @property
    def best_words(self) -> str:
        """ "the best is 7.31 % with 12 bands", of the quantity shown"""
        return f"the best is {100 * self.best:.3g} % with {counted(self.best_bands, 'band')}"


@dataclass(frozen=True)
class Sums:
    """The figures that are sums of squares, which follow from coefficients and norm at once. Radiance is linear."""

    channels: dict[str, ChannelFigures]
    """Figures of "all" channels together, and of "red", "green", "blue" and "luminance"."""
    floor: float
    """Relative L2 errors below this cannot be told from rounding or from the quadrature's own error."""
    peak: float
    """The largest |radiance| of the original seen on a grid."""
    energy_share: tuple[float, ...]
    """The energy of each band divided by that of the light, for all bands that were projected exactly."""
    factors: tuple[float, ...]
    """The factor of each band in use: the window's, or 0 if muted."""

    @property
    def relative_l2(self) -> float:
        return self.channels["all"].relative_l2


@dataclass(frozen=True)
class Figures(Sums):
    """All figures that the overlay and the metadata show: those that are sums, and those that are searched for."""

    irradiance_relative_l2: float
    """The relative L2 error of the irradiance: the error of the same coefficients if they shade a white Lambertian surface."""
    extremes: Extremes


def needs(recipe: Recipe) -> Needs:
    """How many bands the recipe's light needs for its tolerance, for radiance, irradiance and the quantity shown.

    The answers are of what is shown: the light's own coefficients, those of its samples, or those that are compared.
    """
    answers = {}
    for quantity in dict.fromkeys((RADIANCE, IRRADIANCE, recipe.quantity)):
        errors = errors_of(load_light(replace(recipe, quantity=quantity)), way_of(recipe))
        answers[quantity] = smallest_band_count(errors, recipe.tolerance), errors
    radiance, irradiance = answers[RADIANCE][0], answers[IRRADIANCE][0]
    shown, errors = answers[recipe.quantity]
    best = int(errors.argmin())
    return Needs(recipe.tolerance, radiance, irradiance, shown, float(errors[best]), best + 1, len(errors))


def estimate_from_samples(recipe: Recipe) -> SampleEstimate:
    """The bands needed, estimated from the recipe's jittered samples alone, as if the light were not known otherwise.

    Two sets of half as many are drawn independently: the halves of one set would share its cells and depend on each other.
    """
    light = load_light(recipe)
    halves = [jittered(max(recipe.samples // 2, 1), seed) for seed in (recipe.seed, recipe.seed + HALF_SEED)]
    first, second = (project_samples(light.integrand, half, MAX_DIRECT_BANDS) for half in halves)
    squares = np.concatenate([(light.integrand(half.directions) ** 2).sum(axis=1) for half in halves])
    deviation = 4 * np.pi * float(squares.std()) / np.sqrt(len(squares))
    if len(squares) < MIN_ESTIMATE:
        return SampleEstimate(None, 1, None)
    return split_half_estimate(first, second, 4 * np.pi * float(squares.mean()), deviation, recipe.tolerance)


@remember(most=16, doing="searching bands")
def errors_of(light: Light, way: Way) -> Array:
    """The relative L2 error for every band count searched: (MAX_BANDS,), for samples, which are rarely good for more,
    (MAX_DIRECT_BANDS,), of given coefficients all that there are.
    """
    exact, shown = searched_coefficients(light, way)
    return errors_by_band_count(light.products(), exact[: len(shown)], shown)


def searched_coefficients(light: Light, way: Way) -> tuple[Array, Array]:
    """The exact coefficients of MAX_BANDS bands, and those of a way to project, as many as a search for bands goes through."""
    exact = project(light, BEST, MAX_BANDS).coefficients
    if way == BEST:
        return exact, exact
    n_bands = MAX_DIRECT_BANDS if way.given is None else min(way.given.n_bands, MAX_BANDS)
    return exact, project(light, way, n_bands).coefficients


@remember(most=64)
def sums(light: Light, projection: Projection, what: Shown) -> tuple[Array, Sums]:
    """The coefficients shown of a projection, (n_bands**2, 3), and the figures that need no search."""
    n_bands, muted, window_name, width = what
    exact = project(light, BEST, projection.n_bands).coefficients
    shown = projection.coefficients[: n_bands**2] * band_weights(n_bands, frozenset(muted))
    factors = _window_factors(shown, window_name, width)
    shown = shown * per_coefficient(factors)
    total = float(np.trace(light.products()))
    power = band_power(exact).sum(axis=1)
    peak = error_grid(light, grid_rows(n_bands)).peak
    figures = Sums(
        channels=channel_figures(light.products(), exact[: n_bands**2], shown, peak),
        floor=max(PARSEVAL_FLOOR, light.accuracy()),
        peak=peak,
        energy_share=tuple(float(p) / total if total else 0.0 for p in power),
        factors=tuple(0.0 if band in muted else float(factor) for band, factor in enumerate(factors)),
    )
    return shown, figures


@remember(most=64, doing="comparing")
def figures_of(light: Light, projection: Projection, what: Shown) -> Figures:
    """All figures of a projection as it is shown."""
    shown, known = sums(light, projection, what)
    return Figures(
        **vars(known),
        irradiance_relative_l2=irradiance_error(light, projection, what),
        extremes=error_grid(light, grid_rows(what.n_bands)).compare(shown),
    )


@remember(most=64)
def lows_of(light: Light, projection: Projection, what: Shown) -> Lows:
    """The extremes of the reconstruction alone, for which no look at the light is taken."""
    return error_grid(light, grid_rows(what.n_bands)).lows(sums(light, projection, what)[0])


@remember(most=64)
def irradiance_error(light: Light, projection: Projection, what: Shown) -> float:
    """`Figures.irradiance_relative_l2`, without the others."""
    shown, known = sums(light, projection, what)
    if projection.stored is not None or light.quantity == IRRADIANCE:
        return known.relative_l2
    irradiance = through(light, IRRADIANCE)
    own = project(light, BEST, projection.n_bands).radiance[: len(shown)]
    shading = projection.radiance[: len(shown)] * per_coefficient(np.array(known.factors))
    norm = irradiance.products().diagonal()
    return relative(sum(squared_error(norm, *map(irradiance.from_source, (own, shading)))), norm)


def _window_factors(coefficients: Array, name: str, width: float | None) -> Array:
    """The window's factor per band, (n,). UsageError where there is none, as for deringing with too many bands."""
    n_bands = count_bands(coefficients)
    if name == "none":
        return np.ones(n_bands)
    if name == "dering":
        if n_bands > MAX_DERINGED_BANDS:
            raise UsageError(f"{n_bands} bands: dering takes at most {MAX_DERINGED_BANDS}")
        with refused_as(UsageError, "dering: "):
            return dering(coefficients).factors
    return window(name, n_bands, width or n_bands)


def grid_rows(n_bands: int) -> int:
    """The rows of the error grid: at least four per band, in few steps, so that a light is seldom sampled anew."""
    return next(rows for bands, rows in ((16, 96), (32, 128), (64, 256), (MAX_BANDS, 512)) if n_bands <= bands)


@remember(most=8, doing="sampling the light")
def error_grid(light: Light, rows: int) -> ErrorGrid:
    """The light on a grid of so many rows."""
    form = (lambda: light.form) if light.about.size else light.form  # of an image in another layout it takes a raster
    return ErrorGrid(light.radiance, light.landmarks(), rows, light.rows, form)
