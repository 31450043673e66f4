"""How probable it is that an explanation fits by chance.

Somebody's list of another light, or of nothing, has in each degree a vector of d = (2l+1) r numbers whose direction is, for
all we know, any. That it comes within an angle of the light's own whose sine is e is less probable than e^(d-1)/2, a bound of
the share of a cap on the sphere of d dimensions. r is how many channels tell something of their own, 1 for a grey light: the
squared sum of the eigenvalues of the channels' products over the sum of their squares. Degrees are independent, and constants
are not counted: each degree may have its own. An explanation is named if, of all that are at most as costly, less than CHANCE
are expected to fit so well.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array

CHANCE = 1e-3
"""The most explanations that may be expected to fit by chance."""

FAINT = 1e-3
"""A degree with less than this share of the strongest one's norm tells nothing."""


ROUNDING = 1e-8
"""Errors below this are roundings of none: the root of a difference of float64."""


def chance(errors: Array, told: NDArray[np.bool_], exact: Array) -> float:
    """The probability that one random list fits so well.

    errors: of each degree, relative to its own norm, (n_bands,); told: whether a degree counts, (n_bands,); exact: the light's
    coefficients, (n_bands**2, 3).
    """
    starts = np.arange(len(errors)) ** 2
    norms = np.sqrt(np.add.reduceat((exact**2).sum(axis=1), starts))
    products = exact.T @ exact
    channels = float(np.trace(products) ** 2 / (products**2).sum())
    sizes = (2 * np.arange(len(errors)) + 1) * channels
    counts = told & (norms > FAINT * norms.max())
    shares = np.clip(errors, ROUNDING, 1.0) ** np.maximum(sizes - 1, 0.0) / 2
    return float(np.prod(np.where(counts, shares, 1.0)))
