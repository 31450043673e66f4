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
    n_bands = len(errors)
    norms = np.sqrt(np.add.reduceat((exact**2).sum(axis=1), np.arange(n_bands) ** 2))
    return float(_chances(errors[None], told[None], norms[None], np.arange(1.0, 2 * n_bands, 2), exact[None])[0])


def share_of_directions(given: Array, wanted: Array) -> float:
    """The probability that numbers (k, 3) of random directions are, but for a constant, as near to others as these are."""
    sizes = float(np.linalg.norm(given) * np.linalg.norm(wanted))
    if not sizes:
        return 1.0
    share = max(float((given * wanted).sum()) / sizes, 0.0)
    channels = _channels((wanted.T @ wanted)[None])[0]
    return float(max(np.sqrt(max(1 - share**2, 0.0)), ROUNDING) ** max(len(given) * channels - 1, 0.0) / 2)


def chances_of_rows(given: Array, wanted: Array, told: NDArray[np.bool_]) -> Array:
    """The same of lists (k, n**2, 3) that should be `wanted`, each degree with its best constant: (k,).

    told: the rows that count, (k, n**2).
    """
    starts = np.arange(round(given.shape[1] ** 0.5)) ** 2
    given, wanted = given * told[:, :, None], wanted * told[:, :, None]
    own, power, linear = (
        np.add.reduceat((one * other).sum(axis=2), starts, axis=1)
        for one, other in ((wanted, wanted), (given, given), (given, wanted))
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(linear > 0, linear**2 / (own * power), 0.0)
    errors = np.sqrt(np.maximum(1 - share, 0.0))
    rows = np.add.reduceat(told * 1.0, starts, axis=1)
    return _chances(errors, (own > 0) & (power > 0), np.sqrt(own), rows, wanted)


def _channels(products: Array) -> Array:
    """How many channels tell something of their own, (k,), from their products (k, 3, 3)."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # of lists beyond what float64 can square
        found = products.trace(axis1=1, axis2=2) ** 2 / (products**2).sum(axis=(1, 2))
    return np.where(np.isfinite(found), found, 1.0)


def _chances(errors: Array, told: NDArray[np.bool_], norms: Array, rows: Array, exact: Array) -> Array:
    """The chances (k,) of lists `exact` (k, n**2, 3), by the errors, norms and telling rows of each degree, (k, n)."""
    channels = _channels(exact.transpose(0, 2, 1) @ exact)
    counts = told & (norms > FAINT * norms.max(axis=1, keepdims=True))
    shares = np.clip(errors, ROUNDING, 1.0) ** np.maximum(rows * channels[:, None] - 1, 0.0) / 2
    return np.asarray(np.prod(np.where(counts, shares, 1.0), axis=1))
