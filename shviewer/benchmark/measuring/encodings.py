"""The section of the report on encodings of irradiance: what four to nine floats a channel keep of shading."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.analysis.figures import error_grid, grid_rows
from shviewer.analysis.subjects import through
from shviewer.benchmark.measuring.measured_lights import MeasuredLight
from shviewer.harmonics.quantities.encodings import GEOMERICS_BANDS, REPORTED
from shviewer.harmonics.quantities.names import IRRADIANCE

KEY = "encodings"
"""The key in the report's `extra`."""


@dataclass(frozen=True)
class Kept:
    """The errors of one encoding of one light's irradiance."""

    light: str
    encoding: str
    words: str
    floats: int
    relative_l2: float
    largest_error: float
    """Over the largest irradiance, and so is the minimum."""
    minimum: float
    saved_by_a_float: float
    """How much less the relative L2 error is than that of the mean alone, divided by floats - 1."""


def kept_of(measured: MeasuredLight) -> list[Kept]:
    """The errors of all encodings of a light; none for a black one."""
    light = through(measured.light, IRRADIANCE)
    exact, norm = light.from_source(measured.exact[: GEOMERICS_BANDS**2]), float(np.trace(light.products()))
    if norm == 0:
        return []
    grid = error_grid(light, grid_rows(GEOMERICS_BANDS))
    alone = np.sqrt(max(norm - float((exact[0] ** 2).sum()), 0.0) / norm)
    found = []
    for name, encoding in REPORTED.items():
        if name == "l2-deringed" and (exact[0] < 0).any():
            continue  # no factors take a negative mean away
        made = encoding.make(measured.exact[: GEOMERICS_BANDS**2])
        shown = np.zeros_like(exact)
        shown[: len(made)] = made
        squared = max(norm - float((exact**2).sum()), 0.0) + float(((exact - shown) ** 2).sum())
        error = float(np.sqrt(squared / norm))
        extremes = grid.compare(made)
        found.append(
            Kept(
                measured.name,
                name,
                encoding.words,
                encoding.floats,
                error,
                extremes.max_error / grid.peak,
                extremes.minimum / grid.peak,
                (float(alone) - error) / (encoding.floats - 1),
            )
        )
    return found
