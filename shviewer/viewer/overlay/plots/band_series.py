"""The numbers that are plotted against bands: the error with 1, 2, ... bands, and the energy of each band."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.analysis.figures import Pending, errors_of
from shviewer.analysis.projections import BEST, project, sampling_of
from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import errors_by_band_count
from shviewer.viewer.overlay.band_axis import band_slots
from shviewer.viewer.picture import Picture


@dataclass(frozen=True)
class BandSeries:
    """Relative L2 errors and shares of the light's energy. Errors below the floor count as it; infinite ones are left out."""

    slots: int
    """How many bands the axis shows."""
    errors: dict[int, float]
    """n -> error with the first n bands, none muted and no window, by the method in use; up to one count beyond the axis."""
    exact: dict[int, float]
    """The same by the best way; empty if that is in use."""
    shown: float | None
    """The error of what is shown, where bands are muted or windowed."""
    tolerance: float
    needed: int | Pending | None
    """The smallest n within the tolerance, for the quantity shown; None if the search found none."""
    energy: dict[int, float]
    """Band -> its share, where that can be told from rounding."""
    kept: dict[int, float]
    """Band in use -> the share that the window leaves of its energy; 0 if muted."""

    def span(self) -> tuple[float, float]:
        """The least and largest error of the axis: at least a factor of 2, and with the tolerance unless it is far below."""
        marked = [share for errors in (self.errors, self.exact) for n, share in errors.items() if n <= self.slots]
        marked += [self.shown] if self.shown is not None else []
        if not marked or self.tolerance > min(marked) / 30:
            marked.append(self.tolerance)
        return min(*marked, max(marked) / 2), max(marked)


def band_series(picture: Picture) -> BandSeries:
    """The numbers of a picture's convergence plot."""
    state, figures, needs = picture.state, picture.figures, picture.needs
    slots, floor = band_slots(state.bands_ahead), figures.floor

    def on_axis(errors: Array) -> dict[int, float]:
        shares = enumerate(map(float, errors[: slots + 1]), 1)
        return {n: max(share, floor) for n, share in shares if np.isfinite(share)}

    altered = bool(state.recipe.muted_shown) or state.recipe.window != "none"
    energy = {band: share for band, share in enumerate(figures.energy_share[:slots]) if share > floor**2}
    factors = np.clip(figures.factors, 0, 1).tolist()
    return BandSeries(
        slots=slots,
        errors=on_axis(errors_by_count(picture)),
        exact=on_axis(errors_of(picture.light, *BEST)) if picture.complete and state.recipe.method != "best" else {},
        shown=max(figures.relative_l2, floor) if altered and np.isfinite(figures.relative_l2) else None,
        tolerance=state.recipe.tolerance,
        needed=needs if isinstance(needs, Pending) else needs.shown,
        energy=energy,
        kept={band: energy[band] * factor**2 for band, factor in enumerate(factors) if band in energy},
    )


def errors_by_count(picture: Picture) -> Array:
    """The relative L2 error of the picture's light with the first 1 ... N bands, none muted and no window, (N,), N >= n."""
    light, sampling = picture.light, sampling_of(picture.state.recipe)
    if not isinstance(picture.needs, Pending):
        errors = errors_of(light, *sampling)
        if picture.state.recipe.n_bands <= len(errors):
            return errors
    exact = project(light, *BEST, picture.projection.n_bands).coefficients  # searched no further, or not yet
    return errors_by_band_count(light.products(), exact, picture.projection.coefficients)
