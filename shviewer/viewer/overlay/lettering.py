"""Lettering: the inks and the face that all text shares."""

from __future__ import annotations

from functools import lru_cache

from PIL import ImageFont

Ink = tuple[int, int, int, int]
INK, GREY, FAINT, RULE = (236, 236, 240, 255), (168, 168, 178, 255), (122, 122, 132, 255), (62, 62, 68, 255)
ACCENT = (100, 160, 255, 255)
NEGATIVE = (35, 98, 152, 255)
"""The colour that shaders/display.glsl gives to a luminance about a tenth of white below zero."""

UNUSED = (104, 104, 114, 255)
WARNING = (255, 196, 92, 255)

MIN_TYPE = 10
"""The smallest type, in pixels: smaller letters of the built-in face cannot be read."""


@lru_cache(maxsize=64)
def font(size: float) -> ImageFont.FreeTypeFont:
    """Pillow's built-in face; its digits all have the same width. size: pixels."""
    face = ImageFont.load_default(size)
    if not isinstance(face, ImageFont.FreeTypeFont):
        raise RuntimeError("this Pillow was built without FreeType; reinstall it from a wheel")
    return face
