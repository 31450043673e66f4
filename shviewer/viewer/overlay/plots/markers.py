"""Markers and lines as coverage masks, drawn large and averaged, and the look of each method."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from PIL import Image, ImageDraw

from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.lettering import INK, Ink

LOOKS: dict[str, tuple[str, Ink]] = {
    "best": ("diamond", INK),
    "jittered": ("disc", (240, 164, 66, 255)),
    "gauss-legendre": ("square", (60, 190, 150, 255)),
}
"""Shape and colour of each method: either alone tells them apart, to any kind of colour vision."""

MARKER_FINE, CURVE_FINE = 8, 4
"""How many times larger markers and curves are drawn before they are averaged."""

Place = tuple[float, float]
"""x and y in pixels; the middle of the first pixel is at 0.5, 0.5."""


@lru_cache(maxsize=64)
def marker_mask(shape: str, radius: int, thickness: float) -> Image.Image:
    """Coverage of a marker: "diamond", "square", "disc", "ring" or "line"; `thickness` of the last two, in pixels."""
    side = 2 * radius + 3
    image = Image.new("L", (MARKER_FINE * side, MARKER_FINE * side))
    draw = ImageDraw.Draw(image)
    middle, reach = MARKER_FINE * side / 2, float(MARKER_FINE * radius)
    disc, square = ((middle - r, middle - r, middle + r, middle + r) for r in (reach, 0.88 * reach))
    if shape == "diamond":
        near, far = middle - 1.25 * reach, middle + 1.25 * reach
        draw.polygon([(middle, near), (far, middle), (middle, far), (near, middle)], 255)
    elif shape == "square":
        draw.rectangle(square, 255)
    elif shape == "ring":
        draw.ellipse(disc, outline=255, width=round(MARKER_FINE * thickness))
    elif shape == "line":
        half = MARKER_FINE * thickness / 2
        draw.rectangle((middle - reach, middle - half, middle + reach, middle + half - 1), 255)
    else:
        draw.ellipse(disc, 255)
    return image.reduce(MARKER_FINE)


def curve_mask(area: Box, places: Sequence[Place], thickness: float, dot: float) -> Image.Image:
    """Coverage, over an area of whole pixels, of a line through the places with a dot of radius `dot` on each; 0: no dots."""
    width, height = round(area.right - area.left), round(area.bottom - area.top)
    image = Image.new("L", (CURVE_FINE * width, CURVE_FINE * height))
    draw = ImageDraw.Draw(image)
    fine = [(CURVE_FINE * (x - area.left), CURVE_FINE * (y - area.top)) for x, y in places]
    draw.line(fine, 255, max(1, round(CURVE_FINE * thickness)), joint="curve")
    reach = CURVE_FINE * dot
    for x, y in fine if dot else ():
        draw.ellipse((x - reach, y - reach, x + reach, y + reach), 255)
    return image.reduce(CURVE_FINE)
