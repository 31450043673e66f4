"""The error as one number per direction, and the range of its colours. shaders/error.glsl has the same formula.

The error of a direction is that of the channel where it is largest in magnitude, so that its largest magnitude over the
sphere is the figure "largest error". Relative to the original, it is measured against no less than a floor: black has no
relative error.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array

QUIET, SPIKE = 0.95, 2.5
"""The colours end at SPIKE times what this share of the sphere stays below: beyond, an error leaves no colours to the rest."""

NOISE = 1e-6
"""Of the light's peak: smaller errors are rounding, which a range of its own would blow up to colours."""

NOISE_SHARE = 100.0
"""The colours end no nearer to noise than this many times it, where it cannot be seen."""

MOST_RELATIVE = 1.0
"""Colours of the relative error end at 100 % or before."""


@dataclass(frozen=True, eq=False)
class ErrorScale:
    """How the error of one picture is shown. Radiance, or for the relative error shares of the original."""

    kind: str
    floor: float
    """The radiance that a darker original counts as in the relative error."""
    largest: float
    """Where its magnitude is largest; negative only if signed."""
    direction: Array
    """There, (3,), in the frame of the light."""
    end: float
    """Where the colours end."""
    noise: float
    """Errors below this are what float32 makes of none."""

    @property
    def worth_showing(self) -> bool:
        return abs(self.largest) > self.noise

    @property
    def beyond(self) -> bool:
        """Whether there are errors without a colour of their own."""
        return abs(self.largest) > self.end * (1 + 1e-6)


def error_values(kind: str, original: Array, reconstruction: Array, floor: float) -> Array:
    """Radiance (..., 3) twice -> the error (...), by one of the ERRORS but "off". Only a signed one may be negative.

    floor: radiance; of the relative error alone.
    """
    error = reconstruction - original
    if kind == "relative":
        error = error / np.maximum(np.abs(original), floor)
    worst = np.take_along_axis(error, np.abs(error).argmax(axis=-1)[..., None], axis=-1)[..., 0]
    return np.asarray(worst if kind == "signed" else np.abs(worst))


def automatic_range(kind: str, errors: Array, shares: Array, largest: float, noise: float = 0.0) -> float:
    """Where the colours end: at the largest error, unless it is a spike; and far enough above noise not to show that.

    errors: on a grid, (k,); shares: of the sphere that each stands for, (k,), sum 1; largest: what the metrics found, and
    noise: both in the unit of the errors. Never 0, so that it can be divided by.
    """
    magnitude = np.abs(errors)
    order = np.argsort(magnitude)
    place = min(int(np.searchsorted(np.cumsum(shares[order]), QUIET)), len(order) - 1)
    quiet = float(magnitude[order[place]])
    end = max(min(largest, SPIKE * quiet) if quiet > 0 else largest, NOISE_SHARE * noise)
    if kind == "relative":
        end = min(end, MOST_RELATIVE)
    return end if end > 0 else 1.0
