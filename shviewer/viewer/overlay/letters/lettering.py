"""Lettering: text in the face that everything shares, as coverage of pixels.

Text is drawn at four times its size and averaged, so it is not hinted; its baseline lies between two rows of pixels.
"""

from __future__ import annotations

import unicodedata
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont, features

from shviewer.resources import resource_folder
from shviewer.viewer.overlay.letters.glyphs import Face, has, system_face

REGULAR, MEDIUM, SEMIBOLD = "Regular", "Medium", "SemiBold"
FINE = 4
"""How many times larger letters are drawn before they are averaged."""

MIN_TYPE = 11
"""The smallest type, in pixels, and only in a compact frame; elsewhere it is 12."""

RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789−", strict=True))
RAISED_SIZE, RISE = 0.68, 0.38
"""The size and height of an exponent, in type sizes."""


class Mask(NamedTuple):
    """Coverage (rows, columns) uint8 of a text, the column from where it begins to the first, and rows over the baseline."""

    coverage: NDArray[np.uint8]
    left: int
    ascent: int


class _Run(NamedTuple):
    """A part of a text that one face draws: its font at the fine size, its letters, and how far it is raised, pixels."""

    font: ImageFont.FreeTypeFont
    text: str
    rise: float


@lru_cache(maxsize=4096)
def mask(text: str, size: float, weight: str = REGULAR, stroke: float = 0.0) -> Mask:
    """The pixels of a text. size: pixels; stroke: the width in pixels by which the letters are grown, for a casing."""
    runs = _runs(text, size, weight)
    around = round(FINE * stroke)
    ascent = int(np.ceil(1.2 * size)) + int(np.ceil(stroke))
    rows = ascent + int(np.ceil(0.45 * size)) + int(np.ceil(stroke))
    left = int(np.ceil(stroke)) + 1
    columns = left + int(np.ceil(sum(run.font.getlength(run.text) for run in runs) / FINE + stroke)) + 2
    image = Image.new("L", (FINE * columns, FINE * rows))
    draw, x = ImageDraw.Draw(image), float(FINE * left)
    for run in runs:
        draw.text((x, FINE * (ascent - run.rise)), run.text, 255, run.font, anchor="ls", stroke_width=around)
        x += run.font.getlength(run.text)
    coverage = np.asarray(image.reduce(FINE))
    coverage.flags.writeable = False
    return Mask(coverage, -left, ascent)


@lru_cache(maxsize=4096)
def width_of(text: str, size: float, weight: str = REGULAR) -> float:
    """The length in pixels that a text takes."""
    return sum(run.font.getlength(run.text) for run in _runs(text, size, weight)) / FINE


@lru_cache(maxsize=1024)
def escaped(text: str) -> str:
    """The text with an escape, such as \\u4e2d, for everything that no face of this machine has as a letter."""
    return "".join(c if _face_of(c) is not None else ascii(c)[1:-1] for c in text)


def shortened_to(text: str, most: float, size: float, weight: str = REGULAR) -> str:
    """The text, or its two ends with dots between them, no longer than `most` pixels; "" if not even that has room."""
    text = escaped(text)
    if width_of(text, size, weight) <= most:
        return text
    low, high = 0, len(text)
    while high - low > 1:
        kept = (low + high) // 2
        low, high = (kept, high) if width_of(_ends(text, kept), size, weight) <= most else (low, kept)
    return _ends(text, low) if low >= 4 else ""


def _ends(text: str, kept: int) -> str:
    return f"{text[: (kept + 1) // 2].rstrip()}…{text[len(text) - kept // 2 :].lstrip()}"


def _runs(text: str, size: float, weight: str) -> list[_Run]:
    """The parts of a text by the face that draws them."""
    runs = []
    for face, letters in groupby(escaped(text), key=lambda c: _face_of(c)):
        part = "".join(letters)
        if face is None:
            raise ValueError(f"{part!r}: letters that no face has are escaped")
        if face == RAISE:
            digits = "".join(RAISED[c] for c in part)
            runs.append(_Run(_opened(_ours(weight), FINE * RAISED_SIZE * size), digits, RISE * size))
        else:
            runs.append(_Run(_opened(_ours(weight) if face == OURS else face, FINE * size), part, 0.0))
    return runs


OURS, RAISE = Face(""), Face("^")
"""In place of a face: ours in the weight that is wanted, and ours smaller and raised."""


@lru_cache(maxsize=2048)
def _face_of(character: str) -> Face | None:
    """The face that draws a character. Scripts from right to left need a shaper; without it they count as missing."""
    if character in RAISED:
        return RAISE
    if character == " " or has(_ours(REGULAR), character):
        return OURS
    if not character.isprintable():
        return None
    if unicodedata.bidirectional(character) in ("R", "AL", "NSM", "AN") and not features.check("raqm"):
        return None
    return system_face(character)


@lru_cache(maxsize=8)
def _ours(weight: str) -> Face:
    return Face(str(Path(resource_folder("assets")) / "fonts" / f"Inter-{weight}.otf"))


@lru_cache(maxsize=256)
def _opened(face: Face, size: float) -> ImageFont.FreeTypeFont:
    plain = Path(face.path).name.startswith("Inter-") or not features.check("raqm")
    engine = ImageFont.Layout.BASIC if plain else ImageFont.Layout.RAQM
    return ImageFont.truetype(face.path, round(size), face.number, layout_engine=engine)
