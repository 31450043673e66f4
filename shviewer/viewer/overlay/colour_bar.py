"""The colours of the error under its pane, with round numbers; and the azimuths under maps."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from shviewer.viewer.colour import colour_maps
from shviewer.viewer.colour.error_scale import ErrorScale
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box, WholeSphere
from shviewer.viewer.drawn import Surfaces
from shviewer.viewer.overlay.inks import FAINT, GREY
from shviewer.viewer.overlay.letters.lettering import width_of
from shviewer.viewer.overlay.letters.numerals import typeset
from shviewer.viewer.overlay.pieces import Curve, Fill, Piece, Strip, Text
from shviewer.viewer.overlay.setting import centred
from shviewer.viewer.picture import Picture

STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
HEIGHT, TIP, TICK = 7, 7, 4
"""Height of the bar, length of its tips, which stand for errors beyond its ends, and of its ticks; pixels of the design."""


def round_ticks(low: float, high: float, most: int) -> list[float]:
    """At most `most` multiples of a round step in [low, high]; 0 is one of them if it is inside."""
    if not high > low:
        return []
    power = 10.0 ** math.floor(math.log10((high - low) / max(most, 1)))
    for step in (mantissa * scale for scale in (power, 10 * power) for mantissa in STEPS):
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
        if last - first + 1 <= most:
            return [round(number * step, 12 - math.floor(math.log10(step))) for number in range(first, last + 1)]
    return []


def tick_text(value: float, ticks: list[float], *, percent: bool) -> str:
    """One of the ticks, with the decimals that all share; percent: a share. A power of ten where numbers get long."""
    scale = 100.0 if percent else 1.0
    unit = " %" if percent else ""
    largest = max(abs(tick) * scale for tick in ticks)
    if value == 0:
        return f"0{unit}"
    if not 1e-3 <= largest < 1e5:
        mantissa, exponent = f"{value * scale:.2e}".split("e")
        return f"{float(mantissa):g}e{int(exponent)}{unit}"
    decimals = max(len(f"{abs(tick) * scale:.6f}".rstrip("0").partition(".")[2]) for tick in ticks)
    return f"{value * scale:.{decimals}f}{unit}"


def colour_bar_pieces(picture: Picture, at: Composition) -> list[Piece]:
    """The bar, its tips and its numbers; nothing where there is no room."""
    place, scale = at.colour_bar, picture.error_scale
    if place is None or scale is None or isinstance(picture.drawn, Surfaces) or place.width < at.px(60):
        return []
    tip = round(at.px(TIP)) if scale.beyond else 0
    signed, height = scale.kind == "signed", max(round(at.px(HEIGHT * (0.7 if at.compact else 1))), 4)
    left, right, top = round(place.left) + tip * signed, round(place.right) - tip, round(place.top)
    colours = colour_maps.table(colour_maps.map_of(scale.kind))
    shades = colours[np.round(np.linspace(0, 255, right - left)).astype(int)]
    area = Box(left, top, right, top + height)
    pieces: list[Piece] = [Strip(area, shades.astype(np.uint8).tobytes(), "colour_bar")]
    ends = ((right, right + tip, 255), (left, left - tip, 0))
    for base, point, colour in ends[: (2 if signed else 1) if tip else 0]:
        red, green, blue = map(int, colours[colour])
        corners = ((base, top), (point, top + height / 2), (base, top + height))
        clip = Box(min(base, point), top, max(base, point), top + height)
        pieces.append(Curve(corners, 0, (red, green, blue, 255), clip, closed=True))
    return [*pieces, *_ticks(scale, left, right, top + height, place, at)]


def _ticks(scale: ErrorScale, left: int, right: int, under: int, place: Box, at: Composition) -> list[Piece]:
    """As many numbers as stand clear of each other."""
    size = at.small
    low = -scale.end if scale.kind == "signed" else 0.0
    for most in (9, 7, 5, 3, 2):
        ticks = round_ticks(low, scale.end, most)
        texts = [typeset(tick_text(tick, ticks, percent=scale.kind == "relative")) for tick in ticks]
        widths = [width_of(text, size) for text in texts]
        notches = [left + (tick - low) / (scale.end - low) * (right - 1 - left) for tick in ticks]
        starts = [
            round(min(max(notch - width / 2, place.left), place.right - width))
            for notch, width in zip(notches, widths, strict=True)
        ]
        spans = zip(starts, widths, strict=True)
        if all(after[0] - before[0] - before[1] > at.px(10) for before, after in pairwise(spans)):
            break
    else:
        return []
    pieces: list[Piece] = []
    tick = max(2, round(at.px(TICK * (0.5 if at.compact else 1))))
    for number, (notch, start, text) in enumerate(zip(notches, starts, texts, strict=True)):
        pieces.append(Fill(Box(round(notch), under, round(notch) + at.hair, under + tick), GREY))
        pieces.append(Text(f"error_tick_{number}", start, under + tick + 0.95 * size, text, size, GREY))
    return pieces


def azimuth_pieces(at: Composition) -> list[list[Piece]]:
    """Under each map the azimuths that are multiples of 90 degrees."""
    return [_azimuths(number, pane, at) for number, pane in enumerate(at.maps)] if at.ticks else []


def _azimuths(number: int, pane: WholeSphere, at: Composition) -> list[Piece]:
    line, (left, _, right, bottom), quarter = at.hair, pane.clip, pane.width / 4
    first, end = math.ceil((left - pane.x) / quarter - 1e-9), math.floor((right - pane.x) / quarter + 1e-9)
    under, last = round(bottom), -math.inf
    pieces: list[Piece] = []
    for step in range(first, end + 1):
        x, azimuth = pane.x + step * quarter, 180 - (90 * step + 180) % 360
        notch = min(max(round(x), round(left)), round(right) - line)
        pieces.append(Fill(Box(notch, under + at.px(3), notch + line, under + at.px(3 + TICK)), FAINT))
        name, text = f"azimuth_{number}_{step}", f"{azimuth}°"
        label = centred(name, x, (left, right), under + at.px(18), text, at.px(12.0), FAINT)
        if label.x > last + at.px(8):
            pieces.append(label)
            last = label.right
    return pieces
