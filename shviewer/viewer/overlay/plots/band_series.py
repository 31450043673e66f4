"""The numbers that are plotted against bands: the error with 1, 2, ... bands, and what each band is worth."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shviewer.analysis.cache import remember
from shviewer.analysis.figures import Pending, errors_of
from shviewer.analysis.projections import BEST, project, way_of
from shviewer.analysis.subjects import load_light
from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import band_power, errors_by_band_count
from shviewer.lights.light import Light
from shviewer.limits import MAX_BANDS
from shviewer.viewer.picture import Picture

SLOT_COUNTS = (18, 24, 36, 48, 64, 96, MAX_BANDS)
"""Bands shown: the smallest of these with room for a few more than are in use, so that a band stays where it is."""

AHEAD, MOST_FOR_ANSWER = 4, 36
"""How many bands more than are in use are shown, and up to how many the answer moves the end of the axis."""


@dataclass(frozen=True)
class BandSeries:
    """Everything that the curve shows. Errors are relative L2 errors, with no band muted and no window."""

    slots: int
    """How many bands the axis shows."""
    errors: tuple[float, ...]
    """The error with bands 0 to l, of the radiance (or of what is shown, where that is neither it nor the irradiance)."""
    shading: tuple[float, ...]
    """The same of the irradiance."""
    worth: tuple[float, ...]
    """The error with band l alone left out, of the quantity shown; 0 where it cannot be told from rounding."""
    factors: tuple[float, ...]
    """The factor of each band in use: 0 if muted."""
    shown: float
    """The error of what is shown."""
    on_shading: bool
    """Whether that is an error of the irradiance."""
    needed: int | None
    shading_needed: int | None
    tolerance: float


def band_series(picture: Picture, least: int = SLOT_COUNTS[0]) -> BandSeries:
    """The numbers of a picture's curve. least: the fewest bands that the axis shows."""
    recipe, figures, needs = picture.state.recipe, picture.figures, picture.needs
    if isinstance(needs, Pending):
        return _pending(picture, least)
    needed = needs.radiance if recipe.quantity == "irradiance" else needs.shown
    slots = band_slots(picture.state.bands_ahead, needed, least)
    on_shading = recipe.quantity == "irradiance"
    radiance = load_light(replace(recipe, quantity="radiance")) if on_shading else picture.light
    irradiance = picture.light if on_shading else load_light(replace(recipe, quantity="irradiance"))
    return BandSeries(
        slots=slots,
        errors=_errors(picture, radiance, slots),
        shading=_errors(picture, irradiance, slots),
        worth=tuple(value if value > figures.floor else 0.0 for value in _worth(picture.light)[:slots].tolist()),
        factors=figures.factors,
        shown=max(figures.relative_l2, figures.floor),
        on_shading=on_shading,
        needed=needed,
        shading_needed=needs.irradiance,
        tolerance=needs.tolerance,
    )


def _pending(picture: Picture, least: int) -> BandSeries:
    """What is known at once: the error of the bands that are projected, and what they are worth."""
    recipe, figures, light = picture.state.recipe, picture.figures, picture.light
    slots, on_shading = band_slots(picture.state.bands_ahead, None, least), recipe.quantity == "irradiance"
    exact = project(light, BEST, picture.projection.n_bands).coefficients
    errors = errors_by_band_count(light.products(), exact, picture.projection.coefficients)[:slots]
    known = tuple(np.maximum(errors, figures.floor).tolist())
    worth = np.sqrt(np.maximum(figures.energy_share[:slots], 0.0))
    return BandSeries(
        slots=slots,
        errors=() if on_shading else known,
        shading=known if on_shading else (),
        worth=tuple(value if value > figures.floor else 0.0 for value in worth.tolist()),
        factors=figures.factors,
        shown=max(figures.relative_l2, figures.floor),
        on_shading=on_shading,
        needed=None,
        shading_needed=None,
        tolerance=recipe.tolerance,
    )


def band_slots(n_bands: int, answer: int | None, least: int = SLOT_COUNTS[0]) -> int:
    """How many bands are shown while `n_bands` are in use and `answer` would be enough."""
    wanted = max(n_bands + AHEAD, min((answer or 0) + AHEAD - 1, MOST_FOR_ANSWER))
    if wanted <= least:
        return least
    return next((count for count in SLOT_COUNTS if count >= wanted), SLOT_COUNTS[-1])


@remember(most=4)
def _worth(light: Light) -> Array:
    """The square roots of the bands' shares of a light's energy, (MAX_BANDS,)."""
    power = band_power(project(light, BEST, MAX_BANDS).coefficients).sum(axis=1)
    total = float(np.trace(light.products()))
    return np.sqrt(power / total) if total > 0 else np.zeros(len(power))


def _errors(picture: Picture, light: Light, slots: int) -> tuple[float, ...]:
    """The error with bands 0 to l by the method in use; as far as it is known, and below the floor the floor."""
    recipe = picture.state.recipe
    errors = errors_of(light, way_of(recipe))
    if light is picture.light and recipe.n_bands > len(errors):  # samples were searched no further
        exact = project(light, BEST, picture.projection.n_bands).coefficients
        errors = errors_by_band_count(light.products(), exact, picture.projection.coefficients)
    return tuple(np.maximum(errors[:slots], picture.figures.floor).tolist())
