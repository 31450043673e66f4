"""Pieces of text that are drawn where they have room and else left out: inside the frame, clear of pieces and spheres."""

from __future__ import annotations

from collections.abc import Sequence

from PIL import ImageDraw, ImageFont

from shviewer.viewer.composition import Composition
from shviewer.viewer.overlay.lettering import MIN_TYPE, Ink, font
from shviewer.viewer.panes import Box


class Painter:
    """Draws pieces one after the other and remembers their boxes."""

    def __init__(self, draw: ImageDraw.ImageDraw, composition: Composition) -> None:
        self.draw = draw
        self.at = composition
        self.boxes: dict[str, Box] = {}
        self.bars: dict[int, Box] = {}

    def face(self, size: float) -> ImageFont.FreeTypeFont:
        """Type of `size` pixels of the design, but never too small to read."""
        return font(max(round(self.at.px(size)), MIN_TYPE))

    def text(self, name: str, x: float, y: float, text: str, size: float, ink: Ink, anchor: str) -> bool:
        """Draw a text unless it would leave the frame or touch a piece; return whether. size: in pixels of the design."""
        return self.texts(x, ((name, y, text, size, ink),), anchor)

    def texts(self, x: float, lines: Sequence[tuple[str, float, str, float, Ink]], anchor: str) -> bool:
        """Draw all lines (name, y, text, size, ink) at one x, or none of them; return whether."""
        faces = [self.face(size) for _, _, _, size, _ in lines]
        boxes = {
            name: Box(*self.draw.textbbox((x, y), text, font=face, anchor=anchor))
            for (name, y, text, _, _), face in zip(lines, faces, strict=True)
            if text
        }
        if not boxes or not all(self.free(box) for box in boxes.values()):
            return False
        for (_, y, text, _, ink), face in zip(lines, faces, strict=True):
            self.draw.text((x, y), text, font=face, fill=ink, anchor=anchor)
        self.boxes.update(boxes)
        return True

    def free(self, box: Box) -> bool:
        gap = self.at.px(6)
        inside = box.left >= 0 and box.top >= 0 and box.right <= self.at.width and box.bottom <= self.at.height
        return (
            inside
            and not any(sphere.touches(box) for sphere in self.at.spheres)
            and not any(
                box.left < other.right + gap
                and other.left < box.right + gap
                and box.top < other.bottom + 1
                and other.top < box.bottom + 1
                for other in self.boxes.values()
            )
        )
