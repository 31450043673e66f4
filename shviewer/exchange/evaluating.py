"""`reconstruct` and `evaluate_basis` for callers from outside: what they can put right is a ShviewerError."""

from __future__ import annotations

from operator import index

import numpy as np
from numpy.typing import ArrayLike

from shviewer.errors import UsageError
from shviewer.harmonics import basis, synthesis
from shviewer.harmonics.basis import Array


def reconstruct(coefficients: ArrayLike, directions: ArrayLike) -> Array:
    """The function with the coefficients (n**2, 3) of harmonics/basis.py in directions (..., 3) of any length: (..., 3).

    ShviewerError if n**2 is no square or a row has not three numbers, or for a direction that is zero or not finite.
    """
    try:
        numbers = np.asarray(coefficients, dtype=np.float64)
        if numbers.ndim != 2 or numbers.shape[1] != 3:
            raise UsageError(f"coefficients of shape {numbers.shape}: they are (n**2, 3), rows of red, green and blue")
        return synthesis.reconstruct(numbers, directions)
    except (ValueError, TypeError) as error:
        raise UsageError(str(error)) from error


def evaluate_basis(directions: ArrayLike, n_bands: int) -> Array:
    """Every Y(l, m) of the first `n_bands` bands in directions (..., 3) of any length: (..., n_bands**2), float64.

    The convention is in harmonics/basis.py. ShviewerError for bad directions or too many bands.
    """
    try:
        return basis.evaluate_basis(directions, whole(n_bands, "n_bands"))
    except (ValueError, TypeError) as error:
        raise UsageError(str(error)) from error


def whole(value: object, name: str) -> int:
    """UsageError unless it is a whole number of some integer type."""
    try:
        if isinstance(value, bool):
            raise TypeError
        return index(value)  # type: ignore[arg-type]
    except TypeError:
        raise UsageError(f"{name} {value!r}: it must be a whole number, such as 5") from None
