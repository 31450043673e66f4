"""The error as one number per direction, and the range of its colours. shaders/error.glsl has the same formula.

The error in a direction is that of the channel with the largest error in magnitude, so that its largest magnitude over the
sphere is the figure "largest error". The relative error is divided by the original, but by no less than a floor: black has
no relative error.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array

QUIET, SPIKE = 0.95, 2.5
"""The colours end at SPIKE times the error that this share of the sphere stays below: a spike must not take all colours."""

NOISE = 1e-6
"""A share of the light's peak: smaller errors are rounding, and a range fitted to them would show rounding as colours."""

NOISE_SHARE = 100.0
"""The colours end at no less than this many times the noise, so that the noise cannot be seen."""

MOST_RELATIVE = 1.0
"""The largest relative error with a colour of its own: 100 %."""


@dataclass(frozen=True, eq=False)
class ErrorScale:
    """The scale of the error in one picture: in radiance, or for the relative error in shares of the original."""

    kind: str
    floor: float
    """The least radiance that the relative error divides by: a darker original counts as this."""
    largest: float
    """The error of largest magnitude; negative only if signed."""
    direction: Array
    """The direction (3,) of the largest error, in the frame of the light."""
    end: float
    """The error at which the colours end."""
    noise: float
    """Errors below this are rounding of float32."""

    @property
    def worth_showing(self) -> bool:
        return abs(self.largest) > self.noise

    @property
    def beyond(self) -> bool:
        """Whether there are errors without a colour of their own."""
        return abs(self.largest) > self.end * (1 + 1e-6)


def error_values(kind: str, original: Array, reconstruction: Array, floor: float) -> Array:
    """Radiance (..., 3) twice -> the error (...), by one of the ERRORS but "off". Only a signed one may be negative.

    floor: a radiance, used by the relative error alone.
    """
    error = reconstruction - original
    if kind == "relative":
        error = error / np.maximum(np.abs(original), floor)
    worst = np.take_along_axis(error, np.abs(error).argmax(axis=-1)[..., None], axis=-1)[..., 0]
    return np.asarray(worst if kind == "signed" else np.abs(worst))


def automatic_range(kind: str, errors: Array, shares: Array, largest: float, noise: float = 0.0) -> float:
    """The end of the colours: the largest error, unless it is a spike, and far enough above the noise to hide it.

    errors: on a grid, (k,); shares: the share of the sphere that each stands for, (k,), sum 1; largest: the largest error
    that the metrics found; noise: as in ErrorScale. All in the same unit. The end is never 0, so that it can be divided by.
    """
    magnitude = np.abs(errors)
    quiet = _below(magnitude, shares)
    end = max(min(largest, SPIKE * quiet) if quiet > 0 else largest, NOISE_SHARE * noise)
    if kind == "relative":
        end = min(end, MOST_RELATIVE)
    return end if end > 0 else 1.0


def _below(magnitude: Array, shares: Array) -> float:
    """The magnitude that QUIET of the sphere does not pass. Only the largest are sorted, as many as it takes."""
    total, count = float(shares.sum()), max(1, len(shares) // 16)
    while True:
        top = np.argpartition(magnitude, -count)[-count:]
        rest = total - float(shares[top].sum())
        if rest < QUIET or count == len(shares):
            break
        count = min(4 * count, len(shares))
    top = top[np.argsort(magnitude[top])]
    place = min(int(np.searchsorted(rest + np.cumsum(shares[top]), QUIET)), count - 1)
    return float(magnitude[top[place]])
