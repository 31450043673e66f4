"""The tone curves as arrays: what shaders/display.glsl shows, in float64."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.viewer.colour.tone import ACES, BRIGHTEST_EXPOSED, LOG_RANGE


def toned(exposed: NDArray[np.floating], tone: str) -> Array:
    """The linear level at which exposed radiance >= 0, of any shape, is shown by one of the TONES."""
    x: Array = np.minimum(exposed, BRIGHTEST_EXPOSED).astype(np.float64)
    a, b, c, d, e = ACES
    curves = {
        "none": x,
        "reinhard": x / (1 + x),
        "aces": x * (a * x + b) / (x * (c * x + d) + e),
        "log": np.log1p(LOG_RANGE * x) / np.log1p(LOG_RANGE),
    }
    return np.asarray(curves[tone])
