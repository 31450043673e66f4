"""Nine coefficients of radiance that are hard to encode, by what is hard in them."""

from __future__ import annotations

import numpy as np
from harmonics.independent import random_directions

from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.quantities.encodings import ENCODINGS

AXIS = np.array([[0.36, 0.48, 0.8]])


def _points(seed: int, count: int) -> Array:
    """A few point lights of several colours in a dim room."""
    rng = np.random.default_rng(seed)
    found = evaluate_basis(random_directions(count, seed), 3).T @ rng.random((count, 3))
    found[0] += 0.1
    return np.asarray(found)


def _without(rows: slice, columns: slice) -> Array:
    found = _points(5, 4)
    found[rows, columns] = 0
    return found


def _dark_red() -> Array:
    """The mean of one channel is below zero, as of a few samples."""
    found = _points(6, 4)
    found[0, 0] *= -1
    return found


POINT = np.repeat(evaluate_basis(AXIS, 3).T, 3, axis=1)
HARD: dict[str, Array] = {
    "room": _points(0, 4),
    "two lamps": _points(1, 2),
    "noise": np.concatenate([np.ones((1, 3)), np.random.default_rng(2).normal(size=(8, 3))]),
    "no first band": _without(slice(1, 4), slice(None)),
    "no first band of green": _without(slice(1, 4), slice(1, 2)),
    "constant": _without(slice(1, 9), slice(None)),
    "first band of rounding": _without(slice(1, 4), slice(None)) + 1e-17 * _points(7, 2),
    "green black": _without(slice(None), slice(1, 2)),
    "black": np.zeros((9, 3)),
    "monochrome": np.repeat(_points(3, 3)[:, :1], 3, axis=1),
    "point": POINT,
    "more than a point": POINT * np.repeat([1.0, 1.7, 2.0], [1, 3, 5])[:, None],
    "negative": -_points(4, 4),
    "dark red": _dark_red(),
    "bright sun": 1e28 * POINT + _points(8, 3),
    "faint": 1e-29 * _points(9, 3),
}

CASES = [
    (name, light)
    for name in ENCODINGS
    for light in HARD
    if name != "l2-deringed" or light not in ("negative", "dark red")  # no factors take a negative mean away
]
"""Each encoding with each light that it takes."""
