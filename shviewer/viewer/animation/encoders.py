"""Animations as bytes: GIF with one palette for all frames, and lossless WebP. Frames are drawn when they are written.

At 1280 x 640 a frame of the band sweeps of green and venice_sunset takes 51 and 68 kB and 0.3 to 0.4 s as lossless WebP.
Quality 90 would take 19 and 21 kB and 0.06 s, but be off by 74 of 255 at the edges of letters: a tool that measures errors
keeps its pixels. As GIF a frame takes 63 and 38 kB and 0.3 s, most of which is drawing it twice.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from shviewer.version import __version__
from shviewer.viewer.animation.palette import ColourCount, SharedPalette

Draw = Callable[[int], NDArray[np.uint8]]
"""Frame number -> (height, width, 3) uint8, top row first; the same each time it is asked for."""

WEBP_EFFORT = {"method": 2, "quality": 50}
"""Settings of the lossless encoder: files half as large as without effort; twice the time would save another 2 %."""

DESCRIPTION, SOFTWARE = 0x010E, 0x0131
"""Numbers of EXIF tags."""


def encode_gif(draw: Draw, milliseconds: Sequence[int], text: str) -> bytes:
    """An endless GIF, `text` as its comment. Every frame is drawn twice: to count its colours, and to be written.

    milliseconds: the time of each frame, in whole hundredths of a second. Pixels equal to the last frame's are transparent.
    """
    counted = ColourCount()
    for number in range(len(milliseconds)):
        counted.add(draw(number))
    palette = counted.palette(255)
    transparent = len(palette.colours)
    table = palette.colours.tobytes() + bytes(3)
    frames = _indexed(draw, len(milliseconds), palette, table)
    buffer = io.BytesIO()
    next(frames).save(
        buffer,
        "GIF",
        save_all=True,
        append_images=frames,
        palette=table,
        transparency=transparent,
        optimize=True,
        disposal=1,  # leave the frame: the next one is drawn over it
        duration=list(milliseconds),
        loop=0,
        comment=text.encode("ascii"),
    )
    return buffer.getvalue()


def encode_webp(draw: Draw, milliseconds: Sequence[int], text: str) -> bytes:
    """An endless lossless WebP, `text` as the image description of its EXIF. Every frame is drawn once."""
    about = Image.Exif()
    about[DESCRIPTION] = text
    about[SOFTWARE] = f"shviewer {__version__}"
    buffer = io.BytesIO()
    reel = _Reel(draw, len(milliseconds))
    reel.save(
        buffer, "WEBP", save_all=True, lossless=True, duration=list(milliseconds), loop=0, exif=about, **WEBP_EFFORT
    )
    return buffer.getvalue()


def _indexed(draw: Draw, count: int, palette: SharedPalette, table: bytes) -> Iterator[Image.Image]:
    for number in range(count):
        image = Image.fromarray(palette.indices(draw(number)))
        image.putpalette(table)
        yield image


class _Reel(Image.Image):
    """An image of several frames, like those that Pillow reads from files: a frame is drawn when its pixels are wanted."""

    def __init__(self, draw: Draw, n_frames: int) -> None:
        super().__init__()
        self.draw = draw
        self.n_frames = n_frames
        self.position, self.drawn = 0, -1
        self.load()

    def seek(self, frame: int) -> None:
        if frame >= self.n_frames:
            raise EOFError("no more frames")
        self.position = frame

    def tell(self) -> int:
        return self.position

    def load(self) -> Any:
        if self.drawn != self.position:
            self.drawn = self.position
            image = Image.fromarray(self.draw(self.position))
            self.im, self._mode, self._size = image.im, image.mode, image.size
        return super().load()
