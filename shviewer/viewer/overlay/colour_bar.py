"""The colours of the error under its sphere, with round numbers."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from PIL import Image, ImageDraw

from shviewer.viewer import colour_maps
from shviewer.viewer.composition import Composition
from shviewer.viewer.drawn import Surfaces
from shviewer.viewer.overlay.lettering import GREY, MIN_TYPE, font
from shviewer.viewer.panes import Box
from shviewer.viewer.picture import Picture

STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
HEIGHT, TIP = 8, 7
"""Height of the bar, and length of its tips, which stand for errors beyond its ends; in pixels of the design."""


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


def draw_colour_bar(sheet: Image.Image, picture: Picture, composition: Composition) -> dict[str, Box]:
    """Draw the bar and its numbers; return their boxes by name, none where there is no room."""
    place, scale = composition.colour_bar, picture.error_scale
    if (
        place is None
        or scale is None
        or isinstance(picture.drawn, Surfaces)
        or place.right - place.left < composition.px(60)
    ):
        return {}
    draw = ImageDraw.Draw(sheet)
    tip = round(composition.px(TIP)) if scale.beyond else 0
    signed, height = scale.kind == "signed", max(round(composition.px(HEIGHT)), 4)
    left, right, top = round(place.left) + tip, round(place.right) - tip, round(place.top)
    colours = colour_maps.table(colour_maps.map_of(scale.kind))
    shades = colours[np.round(np.linspace(0, 255, right - left)).astype(int)]
    sheet.paste(Image.fromarray(np.repeat(shades[None], height, axis=0)), (left, top))
    ends = ((right - 1, right - 1 + tip, 255), (left, left - tip, 0))
    for base, point, colour in ends[: (2 if signed else 1) if tip else 0]:
        draw.polygon(
            [(base, top), (point, top + (height - 1) / 2), (base, top + height - 1)],
            fill=(*map(int, colours[colour]), 255),
        )
    notch_end = top + height + max(1, round(composition.px(2)))
    boxes = {"colour_bar": Box(left - tip, top, right + tip, notch_end)}
    face = font(max(round(composition.px(12)), MIN_TYPE))
    low = -scale.end if signed else 0.0
    for most in (9, 7, 5, 3, 2):
        ticks = round_ticks(low, scale.end, most)
        notches = [left + (tick - low) / (scale.end - low) * (right - 1 - left) for tick in ticks]
        texts = [tick_text(tick, ticks, percent=scale.kind == "relative") for tick in ticks]
        halves = [face.getlength(text) / 2 for text in texts]
        places = [min(max(x, place.left + half), place.right - half) for x, half in zip(notches, halves, strict=True)]
        y = top + height + composition.px(4)
        found = [
            Box(*draw.textbbox((x, y), text, font=face, anchor="ma")) for x, text in zip(places, texts, strict=True)
        ]
        if all(after.left - before.right > composition.px(10) for before, after in pairwise(found)):
            break
    else:
        return boxes
    for number, (notch, x, text) in enumerate(zip(notches, places, texts, strict=True)):
        draw.line((round(notch), top + height, round(notch), notch_end), fill=GREY)
        draw.text((x, y), text, GREY, face, anchor="ma")
        boxes[f"error_tick_{number}"] = found[number]
    return boxes
