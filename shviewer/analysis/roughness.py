"""Bands against roughness: what a number of coefficients serves, from shading to the light itself.

Everything follows from the powers of the bands of the radiance: a kernel multiplies band l by f(l)^2. So no light is convolved.
What a light holds beyond the bands that were projected counts as if it all had the next factor, or as if its lobes were points,
whichever is less, so that a count is never too small; from roughness 0.25 on that factor is below 1e-6. More roughness may need
more bands, where f(4) passes through zero: every roughness of the list is asked.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from shviewer.analysis.cache import remember
from shviewer.analysis.figures import needs, searched_coefficients
from shviewer.analysis.projections import Way, way_of
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import load_light
from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import band_power, smallest_band_count
from shviewer.harmonics.quantities.kernels import kernel_of
from shviewer.harmonics.quantities.names import RADIANCE, glossy
from shviewer.lights.light import Light

ROUGHNESS = tuple(round(0.01 * step, 2) for step in range(10, 101))
"""The roughnesses that are asked, from smooth to rough."""

TOLD_BANDS = (3, 4, 5, 9, 16, 32)
"""Numbers of bands that `info` and the report tell of."""


@dataclass(frozen=True)
class Staircase:
    """The fewest bands within a tolerance for each of ROUGHNESS; None where no count searched is."""

    tolerance: float
    counts: tuple[int | None, ...]
    mirror: int | None
    """The fewest bands for the radiance itself."""
    shading: int | None
    """The fewest for the irradiance."""
    searched: int

    def served(self, n_bands: int) -> list[tuple[float, float]]:
        """The ranges of roughness for which so many bands are enough, each from its first to its last of ROUGHNESS."""
        runs = groupby(
            zip(ROUGHNESS, self.counts, strict=True), lambda step: step[1] is not None and step[1] <= n_bands
        )
        found = [[roughness for roughness, _ in run] for enough, run in runs if enough]
        return [(run[0], run[-1]) for run in found]

    def sentence(self, n_bands: int) -> str:
        """ "for 5 %: 3 bands serve shading, 9 serve roughness 0.42 and rougher" """
        shading = f"no count up to {self.searched} serves shading"
        if self.shading is not None:
            shading = f"{self.shading} band{' serves' if self.shading == 1 else 's serve'} shading"
        return f"for {100 * self.tolerance:g} %: {shading}, {n_bands} serve{'s' if n_bands == 1 else ''} {self.words(n_bands)}"

    def words(self, n_bands: int) -> str:
        """What so many bands serve: "roughness 0.42 and rougher"."""
        if self.mirror is not None and self.mirror <= n_bands:
            return "a mirror"
        ranges = [
            (f"{low:g}" if low == high else f"{low:g} and rougher" if high == ROUGHNESS[-1] else f"{low:g} to {high:g}")
            for low, high in self.served(n_bands)
        ]
        if not ranges:
            return "no roughness"
        return "every roughness from 0.1" if ranges == ["0.1 and rougher"] else f"roughness {' and '.join(ranges)}"


def staircase(recipe: Recipe) -> Staircase:
    """The staircase of the recipe's light for its tolerance, by its method or the coefficients that it compares."""
    recipe = replace(recipe, quantity=RADIANCE)
    found, errors = needs(recipe), errors_by_roughness(load_light(recipe), way_of(recipe))
    counts = tuple(smallest_band_count(row, recipe.tolerance) for row in errors)
    return Staircase(recipe.tolerance, counts, found.radiance, found.irradiance, errors.shape[1])


@remember(most=8, doing="searching roughness")
def errors_by_roughness(light: Light, way: Way) -> Array:
    """Relative L2 errors of the first n = 1, 2, ... bands for each of ROUGHNESS, at least as large as they are.

    (roughness, bands), as many bands as `errors_of` searches.
    """
    exact, shown = searched_coefficients(light, way)
    power = band_power(exact).sum(axis=1)
    added = band_power(shown - exact[: len(shown)]).sum(axis=1)
    beyond = max(float(np.trace(light.products())) - float(power.sum()), 0.0)
    flux = sum((np.abs(lobe.radiance) * lobe.profile.zonal(1)[0] for lobe in light.lobes), np.zeros(3))
    points = float((flux**2).sum()) if light.lobes else np.inf
    return np.stack([_errors(power, added, beyond, points, roughness) for roughness in ROUGHNESS])


def _errors(power: Array, added: Array, beyond: float, points: float, roughness: float) -> Array:
    """One row. beyond: the power of the bands that are not in `power`. points: the power in band 0 of all lobes, times 4 pi."""
    kernel = kernel_of(glossy(roughness))
    squares = kernel.factors(len(power)) ** 2
    tail = min(kernel.beyond(len(power)) ** 2 * beyond, kernel.norm_beyond(len(power)) ** 2 * points)
    left = np.append(np.cumsum((squares * power)[:0:-1])[::-1], 0.0) + tail
    total = squares[0] * power[0] + left[0]
    wrong = left[: len(added)] + np.cumsum(squares[: len(added)] * added)
    return np.sqrt(wrong / total) if total > 0 else np.where(wrong > 0, np.inf, 0.0)
