"""What everything that is written has in common: the inks, the face, and how numbers read."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from PIL import ImageFont

Ink = tuple[int, int, int, int]
INK, GREY, FAINT, RULE = (236, 236, 240, 255), (168, 168, 178, 255), (122, 122, 132, 255), (62, 62, 68, 255)
ACCENT, ACCENT_MUTED = (100, 160, 255, 255), (100, 160, 255, 110)
NEGATIVE = (35, 98, 152, 255)
"""What shaders/display.glsl makes of a luminance about a tenth of white below zero."""

UNUSED = (104, 104, 114, 255)
WARNING = (255, 196, 92, 255)

MIN_TYPE = 10
"""Pixels; smaller type of the built-in face cannot be read."""


@lru_cache(maxsize=64)
def font(size: float) -> ImageFont.FreeTypeFont:
    """Pillow's built-in face; its digits all have the same width. size: pixels."""
    face = ImageFont.load_default(size)
    if not isinstance(face, ImageFont.FreeTypeFont):
        raise RuntimeError("this Pillow was built without FreeType; reinstall it from a wheel")
    return face


def shortened(name: str, length: int) -> str:
    """At most `length` letters, with dots in the middle."""
    return name if len(name) <= length else f"{name[: length // 2 - 1]}...{name[len(name) - length // 2 + 2 :]}"


def percent(share: float, digits: int = 3, floor: float = 0.0) -> str:
    """A share of 1 in percent; one below the floor of its method, or too small for the digits, only says so."""
    value = 100 * share
    if not np.isfinite(value):
        return "infinite"
    if share < floor:
        return f"< {100 * floor:.5f}".rstrip("0") + " %"
    if value == 0:
        return "0 %"
    if value < 1e-4:
        return "< 0.0001 %"
    decimals = min(max(0, digits - 1 - int(np.floor(np.log10(value) + 1e-9))), 4)
    while value < 100 and decimals < 4 and f"{value:.{decimals}f}".startswith("100"):
        decimals += 1
    return f"{value:.{decimals}f} %"


def whole_percent(share: float) -> str:
    """A share over its bar: a bar is as high as it is beside the highest, so a small one says that it is small."""
    return f"{100 * share:.0f}" if share >= 0.005 or share == 0 else "<1"


def radiance(value: float, peak: float) -> str:
    """Three digits, with a power of ten where that is shorter; 0 below a millionth of the light's peak."""
    if abs(value) <= 1e-6 * peak:
        return "0"
    if 1e-3 <= abs(value) < 1e5:
        return f"{value:.{max(0, 2 - int(np.floor(np.log10(abs(value)))))}f}"
    mantissa, exponent = f"{value:.2e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def grouped(count: int) -> str:
    return f"{count:,}".replace(",", " ")


def grouped_number(value: float) -> str:
    return f"{value:.2f}" if value < 10 else grouped(round(value))


def short_count(count: int) -> str:
    """625, 2.5k, 160k, 1M."""
    for size, letter in ((1_000_000, "M"), (1000, "k")):
        if count >= size:
            return f"{count / size:.3g}{letter}"
    return str(count)


def round_percent(share: float) -> str:
    """A round share of 1, as it stands beside an axis: 150 %, 0.002 %, 1e-7 %."""
    if share < 0.99e-7:
        mantissa, exponent = f"{100 * share:.1e}".split("e")
        return f"{mantissa.removesuffix('.0')}e{int(exponent)} %"
    return f"{100 * share:.10f}".rstrip("0").rstrip(".") + " %"
