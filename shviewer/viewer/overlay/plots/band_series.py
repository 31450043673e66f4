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
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE
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
    """The numbers of a picture's curve. least: the fewest bands that the axis shows.

    While figures are pending, what is known at once: the error of the bands that are projected, and what they are worth.
    """
    recipe, figures, needs, light = picture.state.recipe, picture.figures, picture.needs, picture.light
    on_shading, ahead = recipe.quantity == IRRADIANCE, picture.state.bands_ahead
    if isinstance(needs, Pending):
        needed = shading_needed = None
        slots = band_slots(ahead, None, least)
        known = _floored(_projected_errors(picture), picture, slots)
        errors, shading = ((), known) if on_shading else (known, ())
        worth = np.sqrt(np.maximum(figures.energy_share[:slots], 0.0))
    else:
        needed, shading_needed = needs.radiance if on_shading else needs.shown, needs.irradiance
        slots = band_slots(ahead, needed, least)
        radiance = load_light(replace(recipe, quantity=RADIANCE)) if on_shading else light
        irradiance = light if on_shading else load_light(replace(recipe, quantity=IRRADIANCE))
        errors, shading = (_floored(_errors(picture, one), picture, slots) for one in (radiance, irradiance))
        worth = _worth(light)[:slots]
    return BandSeries(
        slots=slots,
        errors=errors,
        shading=shading,
        worth=tuple(value if value > figures.floor else 0.0 for value in worth.tolist()),
        factors=figures.factors,
        shown=max(figures.relative_l2, figures.floor),
        on_shading=on_shading,
        needed=needed,
        shading_needed=shading_needed,
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


def _errors(picture: Picture, light: Light) -> Array:
    """The error with bands 0 to l by the method in use, as far as it is known."""
    errors = errors_of(light, way_of(picture.state.recipe))
    searched_no_further = light is picture.light and picture.state.recipe.n_bands > len(errors)
    return _projected_errors(picture) if searched_no_further else errors


def _projected_errors(picture: Picture) -> Array:
    """The error with bands 0 to l, as far as they are projected."""
    light, projection = picture.light, picture.projection
    exact = project(light, BEST, projection.n_bands).coefficients
    return errors_by_band_count(light.products(), exact, projection.coefficients)


def _floored(errors: Array, picture: Picture, slots: int) -> tuple[float, ...]:
    """The first errors; below the floor of the figures it is the floor."""
    return tuple(np.maximum(errors[:slots], picture.figures.floor).tolist())
