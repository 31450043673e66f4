"""The change from linear RGB with any primaries to linear RGB with those of Rec. 709 and the white D65.

Four chromaticities, the CIE xy of red, green, blue and white, make an RGB space: its matrix to XYZ has the primaries
(x, y, 1 - x - y) as columns, scaled so that (1, 1, 1) is the white of luminance 1. Where the white is not D65 the
colours are adapted to it after Bradford, so white stays (1, 1, 1) and greys stay grey.

A primary may be imaginary, as in ACES (AP0) or XYZ itself, whose y is 0 or below; the white may not.

Sources
    [709]  Rec. ITU-R BT.709-6, item 1.3 and 1.4: the primaries and the white
    [L]    B. Lindbloom, "RGB/XYZ Matrices" and "Chromatic Adaptation", brucelindbloom.com: the Bradford matrix
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shviewer.errors import LightError

REC709 = np.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]])
"""(4, 2): x and y of red, green, blue and white [709]."""

_BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])  # [L]
_SAME = 1e-3  # in x and y; files round them to three or four digits
_FARTHEST = 10.0  # of x and y from 0; the widest space in use (REDWideGamutRGB) reaches 1.5
_FLATTEST = 1e-4  # twice the area of the triangle of primaries; that of Rec. 709 is 0.22
_BLOCK_TEXELS = 2**16  # of an image at a time, so that they stay in the cache


def are_same(chromaticities: ArrayLike, others: ArrayLike) -> bool:
    """Whether (4, 2) chromaticities are those others, each within 1e-3."""
    return bool(np.all(np.abs(np.asarray(chromaticities, np.float64) - np.asarray(others)) <= _SAME))


def rec709_from(chromaticities: ArrayLike) -> NDArray[np.float64]:
    """(3, 3): linear RGB with these primaries and white, a column vector, to linear Rec. 709.

    chromaticities: (4, 2), CIE xy of red, green, blue and white.
    Raises LightError for values that make no RGB space.
    """
    checked = _checked(chromaticities)
    return np.asarray(_rec709_from_xyz(checked[3]) @ _xyz_from_rgb(checked))


def convert(pixels: NDArray[np.float32], matrix: NDArray[np.float64] | None) -> None:
    """Multiply the colours of an image (height, width, 3) by a (3, 3) matrix, in place; None is the identity.

    A texel with an Inf or NaN is left alone: it would spread to all its channels unreported.
    """
    if matrix is None:
        return
    transposed = matrix.T.astype(np.float32)
    rows = max(1, _BLOCK_TEXELS // pixels.shape[1])
    for top in range(0, len(pixels), rows):
        block = pixels[top : top + rows]
        with np.errstate(invalid="ignore", over="ignore"):
            converted = block @ transposed
        sound = True if np.isfinite(converted).all() else np.isfinite(block).all(axis=2, keepdims=True)
        np.copyto(block, converted, where=sound)


def rec709_from_columns(columns: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3): linear RGB whose red, green and blue are these columns of XYZ, to linear Rec. 709, white to white.

    Raises LightError for columns that make no RGB space.
    """
    x, y, z = columns.sum(axis=1)
    if not (
        np.all(np.abs(columns) <= _FARTHEST) and abs(np.linalg.det(columns)) > _FLATTEST and min(y, x + y + z) > 0.0
    ):
        raise LightError("its matrix makes no RGB space")
    white = np.array([x, y]) / (x + y + z)
    if not np.all(_BRADFORD @ _three_coordinates(white) > 0.0):
        raise LightError("its white is no colour")
    return np.asarray(_rec709_from_xyz(white) @ columns / y)


def xyz_from_rgb(chromaticities: ArrayLike) -> NDArray[np.float64]:
    """(3, 3): linear RGB with these primaries and white, a column vector, to CIE XYZ; the white has Y = 1.

    chromaticities: (4, 2), CIE xy of red, green, blue and white.
    Raises LightError for values that make no RGB space.
    """
    return _xyz_from_rgb(_checked(chromaticities))


def luminance_weights(chromaticities: ArrayLike) -> NDArray[np.float64]:
    """(3,): the luminance of red, of green and of blue; their sum is 1, that of white.

    chromaticities: (4, 2), CIE xy of red, green, blue and white.
    Raises LightError for values that make no RGB space.
    """
    return np.asarray(xyz_from_rgb(chromaticities)[1])


def _checked(chromaticities: ArrayLike) -> NDArray[np.float64]:
    values = np.asarray(chromaticities, np.float64)
    if not np.all(np.abs(values) <= _FARTHEST):  # false for NaN too
        raise _refusal(values, f"each x and y must be a number within {_FARTHEST:g}")
    if abs(np.linalg.det(_three_coordinates(values[:3]))) < _FLATTEST:
        raise _refusal(values, "red, green and blue must span a triangle")
    white = _three_coordinates(values[3])
    if not (white[1] > 0.0 and np.all(_BRADFORD @ white > 0.0)):
        raise _refusal(values, "the white must be a colour that an eye can see, its y above 0")
    if not np.all(_amounts_for_white(values) > 0.0):
        raise _refusal(values, "the white must lie within the triangle of red, green and blue")
    return values


def _refusal(chromaticities: NDArray[np.float64], rule: str) -> LightError:
    shown = ", ".join(f"({x:.4g}, {y:.4g})" for x, y in chromaticities)
    return LightError(f"chromaticities {shown} of red, green, blue, white: {rule}; correct them or export as Rec. 709")


def _xyz_from_rgb(chromaticities: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3); (1, 1, 1) has luminance 1."""
    return _three_coordinates(chromaticities[:3]).T * _amounts_for_white(chromaticities)


def _amounts_for_white(chromaticities: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3,): how much of each primary makes the white of luminance 1."""
    white = _three_coordinates(chromaticities[3])
    return np.linalg.solve(_three_coordinates(chromaticities[:3]).T, white / white[1])


def _three_coordinates(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 2) -> (..., 3): x, y and z = 1 - x - y."""
    return np.concatenate([xy, 1.0 - xy.sum(axis=-1, keepdims=True)], axis=-1)


def _rec709_from_xyz(white: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3): XYZ as it looks under a white, given as xy, to linear Rec. 709 that looks the same under D65."""
    old, new = (_BRADFORD @ _three_coordinates(one) / one[1] for one in (white, REC709[3]))
    adaptation = np.linalg.inv(_BRADFORD) @ ((new / old)[:, None] * _BRADFORD)
    return np.asarray(np.linalg.inv(_xyz_from_rgb(REC709)) @ adaptation)
