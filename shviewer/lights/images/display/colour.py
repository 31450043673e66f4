"""What the codes of a picture mean: the curve from codes to light, and the matrix from its primaries to Rec. 709.

Sources
    [sRGB] IEC 61966-2-1:1999, 5.2: the curve from codes to linear light
    [H273] Rec. ITU-T H.273 (07/2024), tables 2 and 3: primaries and curves by number
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.chromaticities import rec709_from

Curve = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""Codes from 0 to 1 -> light from 0 to 1."""

_D65, _C = (0.3127, 0.3290), (0.310, 0.316)
_PRIMARIES = {  # by number in [H273]; 1 is Rec. 709
    4: ((0.67, 0.33), (0.21, 0.71), (0.14, 0.08), _C),
    5: ((0.64, 0.33), (0.29, 0.60), (0.15, 0.06), _D65),
    6: ((0.630, 0.340), (0.310, 0.595), (0.155, 0.070), _D65),
    7: ((0.630, 0.340), (0.310, 0.595), (0.155, 0.070), _D65),
    9: ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), _D65),
    11: ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), (0.314, 0.351)),
    12: ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), _D65),
}
_SRGB = 13
_POWERS = {4: 2.2, 5: 2.8, 8: 1.0}
_HDR = {16: "PQ", 18: "HLG"}


def linear_from_srgb(encoded: NDArray[np.float64]) -> NDArray[np.float64]:
    """The inverse of the curve [sRGB]; encoded and linear are in 0 to 1, of any shape."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def srgb_from_linear(linear: NDArray[np.floating]) -> NDArray[np.floating]:
    """The curve [sRGB], which goes on above 1; of any shape and precision."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


@dataclass(frozen=True, eq=False)
class Colour:
    """How codes become linear Rec. 709. Without arguments: sRGB."""

    curves: tuple[Curve, ...] = (linear_from_srgb,)
    """One for all channels, or one for each."""
    curve_name: str = "sRGB"
    rec709_from: NDArray[np.float64] | None = None
    """(3, 3), from the picture's own linear RGB; None for the identity."""
    notes: tuple[str, ...] = ()
    """What was assumed or honoured, for the user."""

    def table(self, bits: int) -> NDArray[np.float32]:
        """The light of every code, (1 or 3, 2**bits)."""
        steps = np.arange(2**bits) / (2**bits - 1)
        return np.array([curve(steps) for curve in self.curves], np.float32)


def power(exponent: float) -> Curve:
    """The curve light = code ** exponent."""
    return lambda encoded: encoded**exponent


def power_name(exponent: float) -> str:
    """What a curve of this exponent is called in notes: "gamma 2.2"."""
    return "linear" if exponent == 1.0 else f"gamma {exponent:g}"


def from_cicp(primaries: int, transfer: int) -> Colour:
    """The colour of code points of [H273]. LightError for the curves of HDR."""
    if transfer in _HDR:
        raise LightError(
            f"coded in {_HDR[transfer]} (it says so itself); only sRGB, plain powers and curves of ICC profiles are read:"
            " convert it to .exr"
        )
    colour, notes = Colour(), []
    if exponent := _POWERS.get(transfer):
        colour = Colour((power(exponent),), power_name(exponent))
    elif transfer != _SRGB:
        notes = [f"its curve (cICP {transfer}) is taken for that of sRGB"]
    matrix = None
    if primaries in _PRIMARIES:
        matrix = rec709_from(_PRIMARIES[primaries])
        notes.append(f"its primaries (cICP {primaries}) are converted to Rec. 709")
    elif primaries != 1:
        notes.append(f"its primaries (cICP {primaries}) are taken for Rec. 709")
    return replace(colour, rec709_from=matrix, notes=tuple(notes))
