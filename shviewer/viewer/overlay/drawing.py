"""The layer that pieces of the overlay make together.

Equal pieces make the same layer, which is remembered: what did not change is neither drawn nor uploaded again.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import Ink
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.letters.lettering import FINE, mask
from shviewer.viewer.overlay.pieces import Curve, Disc, Fill, Piece, Strip, Swatch, Text

NEGATIVE_LINE, ZERO_LINE, FILL = (120, 170, 255), (176, 206, 255), (36, 90, 142)
"""sRGB of the fine lines, of the zero line and of the fill of a swatch, as shaders/display.glsl draws them."""

WHITE, ZEBRA = (244, 244, 246), (40, 40, 44)


@lru_cache(maxsize=96)
def layer_of(pieces: tuple[Piece, ...]) -> Layer | None:
    """The layer of some pieces, the first at the bottom; None of none."""
    return draw(pieces) if pieces else None


def lettering(pieces: Sequence[Piece]) -> Iterator[None]:
    """Draw the texts of some pieces, one after the other: the masks are remembered, and the layer is soon made of them."""
    for piece in pieces:
        if isinstance(piece, Text):
            for stroke in {piece.casing, 0.0}:
                mask(piece.text, piece.size, piece.weight, stroke)
            yield


def draw(pieces: Sequence[Piece]) -> Layer:
    """The same of pieces that will not come again."""
    match pieces:
        case [Fill(hollow=0.0) as fill]:
            left, top, right, bottom = map(round, fill.box)
            if right > left and bottom > top:
                return Layer(np.broadcast_to(np.array(fill.ink, np.uint8), (bottom - top, right - left, 4)), left, top)
    boxes = [_reach(piece) for piece in pieces]
    left, top = floor(min(box.left for box in boxes)), floor(min(box.top for box in boxes))
    right, bottom = ceil(max(box.right for box in boxes)), ceil(max(box.bottom for box in boxes))
    paper = _Paper(left, top, right - left, bottom - top)
    for piece in pieces:
        paper.draw(piece)
    paper.pixels.flags.writeable = False
    return Layer(paper.pixels, left, top)


def _reach(piece: Piece) -> Box:
    """The box that holds every pixel of a piece."""
    if not isinstance(piece, Text):
        return piece.box
    found = mask(piece.text, piece.size, piece.weight, piece.casing)
    x, y = round(piece.x) + found.left, round(piece.baseline) - found.ascent
    return Box(x, y, x + found.coverage.shape[1], y + found.coverage.shape[0])


class _Paper:
    """An image being drawn, whose top left is a pixel of the frame."""

    def __init__(self, left: int, top: int, width: int, height: int) -> None:
        self.left, self.top = left, top
        self.pixels = np.zeros((max(height, 1), max(width, 1), 4), np.uint8)

    def draw(self, piece: Piece) -> None:
        match piece:
            case Text():
                if piece.casing:
                    self._text(piece, piece.rim, piece.casing)
                self._text(piece, piece.ink, 0.0)
            case Fill():
                self._fill(piece)
            case Curve():
                if piece.casing:
                    self._curve(piece, piece.width + 2 * piece.casing, piece.rim)
                self._curve(piece, piece.width, piece.ink)
            case Disc():
                self._disc(piece)
            case Strip():
                colours = np.frombuffer(piece.colours, np.uint8).reshape(1, -1, 3)
                rows = self._part(piece.box)
                rows[..., :3], rows[..., 3] = colours[:, : rows.shape[1]], 255
            case Swatch():
                self._swatch(piece)

    def _text(self, piece: Text, ink: Ink, stroke: float) -> None:
        found = mask(piece.text, piece.size, piece.weight, stroke)
        self._blend(found.coverage, round(piece.x) + found.left, round(piece.baseline) - found.ascent, ink)

    def _fill(self, piece: Fill) -> None:
        if not piece.hollow:
            self._cover(piece.box, piece.ink)
            return
        line, area = max(1, round(piece.hollow)), piece.box
        for part in (
            area._replace(bottom=area.top + line),
            area._replace(top=area.bottom - line),
            area._replace(right=area.left + line),
            area._replace(left=area.right - line),
        ):
            self._cover(part, piece.ink)

    def _curve(self, piece: Curve, width: float, ink: Ink) -> None:
        box = piece.box
        left, top, right, bottom = floor(box.left), floor(box.top), ceil(box.right), ceil(box.bottom)
        if right <= left or bottom <= top:
            return
        image = Image.new("L", (FINE * (right - left), FINE * (bottom - top)))
        points = [(FINE * (x - left), FINE * (y - top)) for x, y in piece.points]
        draw = ImageDraw.Draw(image)
        if piece.closed:
            draw.polygon(points, fill=255)
        else:
            draw.line(points, 255, round(FINE * width), joint="curve")
        self._blend(np.asarray(image.reduce(FINE)), left, top, ink)

    def _disc(self, piece: Disc) -> None:
        box = piece.box
        left, top = floor(box.left), floor(box.top)
        rows, columns = np.mgrid[top : ceil(box.bottom), left : ceil(box.right)] + 0.5
        off = np.hypot(columns - piece.x, rows - piece.y)
        outer = np.clip(piece.radius + piece.width / 2 + 0.5 - off, 0, 1)
        self._blend((255 * outer).astype(np.uint8), left, top, piece.ink)
        if piece.width:
            inner = np.clip(piece.radius - piece.width / 2 + 0.5 - off, 0, 1)
            self._blend((255 * inner).astype(np.uint8), left, top, piece.inside)

    def _swatch(self, piece: Swatch) -> None:
        area = piece.box
        rows, columns = np.mgrid[round(area.top) : round(area.bottom), round(area.left) : round(area.right)] + 0.5
        rising = piece.kind != "white"
        along = (columns + rows if rising else columns - rows) / np.sqrt(2)
        pitch = (4.0 if rising else 5.0) * piece.scale
        off = np.abs(along - pitch * np.round(along / pitch))
        cover = np.clip(0.55 * piece.scale + 0.5 - off, 0, 1)
        shape = rows.shape
        left, top = round(area.left), round(area.top)
        if piece.kind == "lines":
            self._blend((200 * cover).astype(np.uint8), left, top, (*NEGATIVE_LINE, 255))
            return
        ground, lines = (FILL, NEGATIVE_LINE) if rising else (WHITE, ZEBRA)
        self._blend(np.full(shape, 255, np.uint8), left, top, (*ground, 255))
        self._blend(((200 if rising else 255) * cover).astype(np.uint8), left, top, (*lines, 255))
        if rising:
            self._fill(Fill(area, (*ZERO_LINE, 255), hollow=piece.scale))

    def _cover(self, box: Box, ink: Ink) -> None:
        """Put an ink in place of what is there, a pixel at a time: by channels it takes five times as long."""
        self._part(box).view(np.uint32)[:] = np.array(ink, np.uint8).view(np.uint32)

    def _part(self, box: Box) -> NDArray[np.uint8]:
        """The pixels of a box of the frame."""
        return self.pixels[
            max(round(box.top) - self.top, 0) : max(round(box.bottom) - self.top, 0),
            max(round(box.left) - self.left, 0) : max(round(box.right) - self.left, 0),
        ]

    def _blend(self, coverage: NDArray[np.uint8], left: int, top: int, ink: Ink) -> None:
        """Lay an ink over what is there, with straight alpha."""
        y, x = top - self.top, left - self.left
        above, beside = max(-y, 0), max(-x, 0)
        under = self.pixels[max(y, 0) : y + coverage.shape[0], max(x, 0) : x + coverage.shape[1]]
        over = coverage[above : above + under.shape[0], beside : beside + under.shape[1]]
        if not under[..., 3].any():
            under[..., :3], under[..., 3] = ink[:3], over
            return
        rows, columns = np.nonzero(over)  # a curve touches few of the pixels in its box
        alpha = over[rows, columns].astype(np.float32)[:, None] / 255
        before = under[rows, columns].astype(np.float32)
        kept = before[:, 3:] / 255 * (1 - alpha)
        total = alpha + kept
        before[:, :3] = (np.asarray(ink[:3], np.float32) * alpha + before[:, :3] * kept) / total
        before[:, 3:] = 255 * total
        under[rows, columns] = np.rint(before)
