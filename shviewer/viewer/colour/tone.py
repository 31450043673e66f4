"""Tone curves: they map exposed radiance to what is shown, before sRGB. shaders/display.glsl has the same formulas.

A curve lifts the dark and bends towards white, or a little beyond it, where colours are cut; without one nothing is bent.
Automatic exposure needs the way back: which radiance is shown at a given level.
"""

from __future__ import annotations

import math

import numpy as np

ACES = (2.51, 0.03, 2.43, 0.59, 0.14)
"""x (a x + b) / (x (c x + d) + e): a fit to the filmic curve of the Academy Color Encoding System.

[K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016]; without its white balance and desaturation, hence "like".
"""

LOG_RANGE = 1000.0
"""k in log(1 + k x) / log(1 + k): ten stops below white are told apart."""


BRIGHTEST_EXPOSED = 1e6
"""Brighter values count as this, which is white under every curve and has a finite square in float32."""


def steepest(tone: str) -> float:
    """The largest slope of a curve, that is, how much it can enlarge a difference: in the dark, but for ACES's foot."""
    if tone == "log":
        return LOG_RANGE / math.log1p(LOG_RANGE)
    if tone == "aces":  # p/q is steepest where (p' q - p q')' q = 2 (p' q - p q') q'
        p, q = np.poly1d((*ACES[:2], 0)), np.poly1d(ACES[2:])
        rise = p.deriv() * q - p * q.deriv()
        turns = (rise.deriv() * q - 2 * rise * q.deriv()).roots
        return float(max(rise(x) / q(x) ** 2 for x in turns.real[(turns.imag == 0) & (turns.real > 0)]))
    return 1.0


def exposed_for(level: float, tone: str) -> float:
    """The exposed radiance that the curve shows at `level`, 0 < level < 1."""
    if tone == "reinhard":
        return level / (1 - level)
    if tone == "aces":
        a, b, c, d, e = ACES
        square, linear, constant = a - level * c, b - level * d, -level * e
        return (-linear + math.sqrt(linear * linear - 4 * square * constant)) / (2 * square)
    if tone == "log":
        return math.expm1(level * math.log1p(LOG_RANGE)) / LOG_RANGE
    return level
