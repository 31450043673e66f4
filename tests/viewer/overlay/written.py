"""What an overlay has written, as tests look at it: its pieces, its texts, and all of it as one image."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from shviewer.viewer.overlay.overlay import Overlay
from shviewer.viewer.overlay.pieces import Piece, Text


def pieces_of(drawn: Overlay) -> list[Piece]:
    return [piece for block in drawn.blocks for piece in block]


def texts_of(drawn: Overlay) -> list[Text]:
    return [piece for piece in pieces_of(drawn) if isinstance(piece, Text)]


def image_of(drawn: Overlay, size: tuple[int, int] = (1280, 640)) -> NDArray[np.uint8]:
    """All layers over each other in a frame, (height, width, 4) with straight alpha."""
    sheet = Image.new("RGBA", size)
    for layer in drawn.layers:
        sheet.alpha_composite(Image.fromarray(layer.image), (max(layer.left, 0), max(layer.top, 0)))
    return np.asarray(sheet)
