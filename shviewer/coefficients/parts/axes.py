"""Other programs' axes: signed permutations of ours, and what they do to coefficients.

A direction with our components s has M s in the other program, M with one +1 or -1 in each row and column: 24 rotations and 24
reflections. The function stays the same, so that its coefficients there are those of g(s') = f(M^T s'). Turns about z and
mirrors only change signs and swap m with -m, which is exact; axes that move z mix the orders of a degree (rotation.py).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, count_bands, degrees, orders
from shviewer.harmonics.metrics import band_power
from shviewer.harmonics.rotation import rotate

NAMED_AXES = {"z-up": "+x+y+z", "y-up": "+x+z-y", "z-up-left": "+x-y+z", "y-up-left": "+x+z+y"}
"""z-up and y-up are right-handed, the others left-handed. Ours, +x, stays x in all of them."""

NOISE = 1e-15
"""A coefficient smaller than this share of its degree's norm counts as the rounding of a zero."""


@dataclass(frozen=True)
class Axes:
    """Another program's axes. text: our axes that are its x, y and z, such as "+x+z-y". ValueError if it is no such text."""

    text: str = "+x+y+z"

    def __post_init__(self) -> None:
        if not re.fullmatch(r"(?:[+-][xyz]){3}", self.text) or len(set(self.text[1::2])) < 3:
            names = ", ".join(NAMED_AXES)
            raise ValueError(f"axes {self.text!r}: {names}, or which of our axes x, y and z are there, such as +x+z-y")

    @classmethod
    def named(cls, text: str) -> Axes:
        """The axes of a name of NAMED_AXES, or of a text such as "+x+z-y"."""
        return cls(NAMED_AXES.get(text, text))

    @cached_property
    def matrix(self) -> Array:
        """M, (3, 3): directions there are M times directions here."""
        matrix = np.zeros((3, 3))
        for row in range(3):
            matrix[row, "xyz".index(self.text[2 * row + 1])] = float(f"{self.text[2 * row]}1")
        return matrix

    @property
    def inverse(self) -> Axes:
        return Axes.from_matrix(self.matrix.T)

    @classmethod
    def from_matrix(cls, matrix: Array) -> Axes:
        places = np.abs(matrix).argmax(axis=1)
        return cls("".join("+-"[int(row[at] < 0)] + "xyz"[at] for row, at in zip(matrix, places, strict=True)))

    def then(self, other: Axes) -> Axes:
        """The axes that result if `other` is applied after these."""
        return Axes.from_matrix(other.matrix @ self.matrix)

    @property
    def right_handed(self) -> bool:
        return bool(np.linalg.det(self.matrix) > 0)

    @property
    def words(self) -> str:
        """The axes in words: "x y z are our +x +z -y; y up, right-handed"."""
        ours = " ".join(re.findall("..", self.text))
        sign, up = self.text[self.text.index("z") - 1], "xyz"[self.text.index("z") // 2]
        hand = "right" if self.right_handed else "left"
        return f"x y z are our {ours}; {'' if sign == '+' else '-'}{up} up, {hand}-handed"


def all_axes() -> list[Axes]:
    """All 48 axes, our own first."""
    return [
        Axes("".join(sign + axis for sign, axis in zip(signs, names, strict=True)))
        for names in permutations("xyz")
        for signs in product("+-", repeat=3)
    ]


def turn(coefficients: Array, axes: Axes) -> Array:
    """Coefficients (n**2, k) of a function -> those of the same function in other axes, (n**2, k)."""
    n_bands = count_bands(coefficients)
    matrix, turned = axes.matrix, np.asarray(coefficients, dtype=np.float64)
    if not axes.right_handed:
        matrix, turned = -matrix, turned * alternating(degrees(n_bands))  # Y(l, m)(-s) = (-1)^l Y(l, m)(s)
    if matrix[2, 2] == 0:
        return _without_noise(turned, rotate(turned, matrix))
    if matrix[2, 2] < 0:  # a half-turn about x: y and z change sign
        matrix = matrix * np.array([1.0, -1.0, -1.0])
        turned = (
            turned * alternating(degrees(n_bands) + orders(n_bands)) * np.where(orders(n_bands) < 0, -1, 1)[:, None]
        )
    return _about_z(turned, matrix, n_bands)


def alternating(exponents: NDArray[np.int64]) -> Array:
    """(-1)^exponent as a column, (k, 1)."""
    return np.where(exponents % 2, -1.0, 1.0)[:, None]


def mirrored_orders(n_bands: int) -> NDArray[np.int64]:
    """The index of (l, -m) for each (l, m), shape (n_bands**2,)."""
    return np.arange(n_bands**2) - 2 * orders(n_bands)


def _about_z(coefficients: Array, matrix: Array, n_bands: int) -> Array:
    """Turn about z by a multiple of 90 degrees: cos(m phi) becomes cos(m (phi - angle)), and so with sin."""
    quarters = [(1, 0), (0, 1), (-1, 0), (0, -1)].index(tuple(matrix[:2, 0].tolist()))
    m = orders(n_bands)
    eighth = (quarters * np.abs(m)) % 4
    cosine, sine = np.array([1, 0, -1, 0])[eighth], np.array([0, 1, 0, -1])[eighth]
    other = coefficients[mirrored_orders(n_bands)]
    return np.asarray(
        cosine[:, None] * coefficients + np.where(m > 0, -sine, np.where(m < 0, sine, 0))[:, None] * other
    )


def _without_noise(before: Array, after: Array) -> Array:
    """`after` with 0 where it holds the rounding of a zero."""
    norm = np.sqrt(band_power(before))
    return np.where(np.abs(after) > NOISE * norm[degrees(len(norm))], after, 0.0)
