"""The array `cilm` of SHTOOLS: cilm[0, l, m] for m >= 0, cilm[1, l, m] for -m, one of them or one for each channel."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.numbers import Listed
from shviewer.errors import LightError
from shviewer.limits import MAX_BANDS

SHTOOLS = "shtools"

_IMPLIED = "an array cilm: taken as SHTOOLS makes it if not told otherwise, 4-pi-normalised without phase, shtools"


def has_shape_of_cilm(shape: tuple[int, ...]) -> bool:
    """Whether it is (2, n, n), or (1, 2, n, n) or (3, 2, n, n)."""
    *channels, parts, rows, columns = shape if len(shape) > 2 else (0, 0, 0)
    return parts == 2 and rows == columns > 0 and channels in ([], [1], [3])


def rows_of_cilm(array: NDArray[Any]) -> Listed:
    """The coefficients in our order, (n**2, 1) or (n**2, 3). LightError for an array that is no cilm of real harmonics."""
    if not has_shape_of_cilm(array.shape):
        raise LightError(
            f"an array of shape {array.shape}; coefficients are (n^2, 3), cilm of SHTOOLS is (2, n, n), or (3, 2, n, n) for"
            " red, green and blue: transpose it, or save SHCoeffs.to_array()"
        )
    if array.dtype.kind not in "fiu":
        raise LightError("cilm of complex harmonics; convert them first: SHCoeffs.convert(kind='real')")
    n_bands = array.shape[-1]
    if n_bands > MAX_BANDS:
        raise LightError(f"{n_bands} bands: at most {MAX_BANDS} are read; keep cilm[:, :{MAX_BANDS}, :{MAX_BANDS}]")
    channels = array.reshape(-1, 2, n_bands, n_bands).astype(np.float64)
    l, m = np.indices((n_bands, n_bands))
    unused = np.stack([m > l, (m > l) | (m == 0)])
    if np.any(channels[:, unused] != 0):
        raise LightError(
            "cilm with numbers where m is above l, or at cilm[1, l, 0], where none can be: it is something else"
        )
    rows = np.zeros((n_bands**2, len(channels)))
    used = ~unused
    rows[(l * (l + 1) + m)[used[0]]] = channels[:, 0][:, used[0]].T
    rows[(l * (l + 1) - m)[used[1]]] = channels[:, 1][:, used[1]].T
    return Listed(rows, implied=SHTOOLS, implied_by=_IMPLIED, placed=True)
