"""The inks of everything that is written and plotted: sRGB and alpha, 0 to 255."""

from __future__ import annotations

Ink = tuple[int, int, int, int]
INK, GREY, FAINT, RULE = (236, 236, 240, 255), (178, 178, 188, 255), (146, 146, 156, 255), (66, 66, 72, 255)
GROUND = (39, 39, 42, 255)
BAR, UNUSED, ACCENT = (72, 122, 204, 255), (100, 100, 110, 255), (100, 160, 255, 255)
WARNING, ERROR = (255, 196, 92, 255), (255, 128, 112, 255)
CASING = (12, 12, 14, 255)
"""The ink around what is written over a sphere."""
