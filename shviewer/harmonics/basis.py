"""Real spherical harmonics Y(l, m) and the one place where their convention is written.

Convention (pinned by tests/harmonics/test_basis.py against independent references):
    orthonormal over the sphere; z is the polar axis; the Condon-Shortley phase is kept, so that
    Y(1,-1), Y(1,0), Y(1,1) are sqrt(3/4pi) times -y, z, -x.
    Degree l >= 0 and order -l <= m <= l are stored at index l(l+1) + m. A band is all orders of one degree;
    "n bands" means the degrees 0 to n-1, which is n**2 functions.

With theta the angle from +z and phi the angle from +x towards +y,
    Y(l, m)  = sqrt(2) K(l, m) cos(m phi) P(l, m)(cos theta)      for m > 0,
    Y(l,-m)  = sqrt(2) K(l, m) sin(m phi) P(l, m)(cos theta)      for m > 0,
    Y(l, 0)  = K(l, 0) P(l)(cos theta),      K(l, m) = sqrt((2l+1)/(4 pi) (l-m)!/(l+m)!),
where the phase (-1)^m is part of P(l, m).

Sources
    [Green]   R. Green, "Spherical Harmonic Lighting: The Gritty Details", GDC 2003: the convention.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from shviewer.harmonics.evaluation.indices import (
    MAX_BANDS,
    Array,
    Indices,
    check_bands,
    count_bands,
    degree_order,
    degrees,
    index,
    normalise,
    orders,
)
from shviewer.harmonics.evaluation.products import FEWEST_BANDS, FEWEST_DIRECTIONS, MOST_BANDS, evaluate_by_products
from shviewer.harmonics.evaluation.recurrence import evaluate_by_recurrence, normalisation

__all__ = [
    "MAX_BANDS",
    "MAX_VALUES",
    "Array",
    "Indices",
    "check_bands",
    "count_bands",
    "degree_order",
    "degrees",
    "evaluate_basis",
    "index",
    "normalisation",
    "normalise",
    "orders",
]

MAX_VALUES = 2**28
"""The most basis values one call may return (2 GiB); callers evaluate larger sets in blocks."""


def evaluate_basis(directions: ArrayLike, n_bands: int) -> Array:
    """Every Y(l, m) of `n_bands` bands in every direction.

    directions: (..., 3), any length. Returns (..., n_bands**2), float64, right to 1e-14 of the largest value; one direction has
    the same values to rounding whatever others are given. ValueError for bad directions, more than MAX_BANDS bands or more than
    MAX_VALUES values. shaders/sh.glsl runs the recurrence of evaluation/recurrence.py in float32.
    """
    check_bands(n_bands)
    vectors = np.asarray(directions, dtype=np.float64)
    if vectors.ndim == 0 or vectors.shape[-1] != 3:
        vectors = normalise(vectors)  # which says what is wrong
    points = vectors.reshape(-1, 3)
    if len(points) * n_bands**2 > MAX_VALUES:
        raise ValueError(
            f"{len(points)} directions x {n_bands**2} functions: at most {MAX_VALUES} values at once; use blocks"
        )
    many = FEWEST_BANDS <= n_bands <= MOST_BANDS and len(points) >= FEWEST_DIRECTIONS
    try:
        table = (evaluate_by_products if many else evaluate_by_recurrence)(points, n_bands)
    except ValueError:
        normalise(vectors)  # which says what is wrong, and where in the array
        raise
    return table.T.reshape(*vectors.shape[:-1], n_bands**2)
