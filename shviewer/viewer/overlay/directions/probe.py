"""The probe under the mouse: the direction, and the values there, computed in float64 and not by the shader."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, log10

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.drawing import draw
from shviewer.viewer.overlay.inks import FAINT, GREY, INK, Ink
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.letters.lettering import MIN_TYPE, width_of
from shviewer.viewer.overlay.letters.numerals import typeset
from shviewer.viewer.overlay.pieces import Fill, Piece, Text
from shviewer.viewer.overlay.setting import ended
from shviewer.viewer.picture import Picture
from shviewer.words import theta_phi_degrees

GROUND: Ink = (14, 14, 16, 255)
AWAY = 18
"""Pixels of the design between the mouse and the numbers."""

DOT = 3


@dataclass(frozen=True, eq=False)
class Probe:
    """The values (3,) in one direction of the light."""

    direction: Array
    original: Array
    reconstruction: Array
    error: Array
    """Reconstruction minus original; where suns were split off, both without them."""
    beside: Array | None = None
    """The second reconstruction, if there is one."""

    @property
    def theta_phi_degrees(self) -> tuple[float, float]:
        return theta_phi_degrees(self.direction)


def direction_at(picture: Picture, composition: Composition, x: float, y: float) -> Array | None:
    """The direction in the world (3,) that a pixel of the frame shows, in whichever pane; None beside the panes."""
    found = (pane.direction(x, y, picture.world_from_view) for pane in composition.panes)
    return next((direction for direction in found if direction is not None), None)


def probe(picture: Picture, composition: Composition, x: float, y: float) -> Probe | None:
    """Probe the pixel at x, y of the frame; None beside the panes, and where surfaces are shown."""
    seen = direction_at(picture, composition, x, y)
    if seen is None or picture.state.view.lobe_view:
        return None
    direction = picture.light_from_world @ seen
    direction /= np.linalg.norm(direction)
    rest, suns = picture.rest_at(direction[None])[0], picture.suns_at(direction[None])[0]
    beside = picture.beside
    return Probe(
        direction=direction,
        original=picture.subject.whole.radiance(direction[None])[0],
        reconstruction=rest + suns,
        error=rest - picture.light.radiance(direction[None])[0],
        beside=None if beside is None else beside.values_at(direction[None])[0] + suns,
    )


def probe_layers(found: Probe, picture: Picture, composition: Composition, x: float, y: float) -> tuple[Layer, ...]:
    """Layers of the numbers beside the mouse, where they fit, and of a cross in the same direction in the other panes."""
    image = _table(found, composition)
    height, width = image.shape[:2]
    away = round(composition.px(AWAY))
    left, top = round(x) + away, round(y) + away
    if left + width > composition.width:
        left = round(x) - away - width
    if top + height > composition.height:
        top = round(y) - away - height
    left = min(max(left, 0), max(composition.width - width, 0))
    return (*_dots(found, picture, composition, x, y), Layer(image, left, max(top, 0)))


def _dots(found: Probe, picture: Picture, composition: Composition, x: float, y: float) -> list[Layer]:
    size = max(round(composition.px(DOT)), 2)
    image = np.zeros((2 * size + 1, 2 * size + 1, 4), dtype=np.uint8)
    image[size], image[:, size] = INK, INK  # a cross
    direction, layers = picture.light_from_world.T @ found.direction, []
    for pane in composition.panes:
        at = pane.place(direction, picture.world_from_view)
        if not pane.clip.contains(x, y) and not at.behind and pane.clip.contains(at.x, at.y):
            layers.append(Layer(image, round(at.x - 0.5) - size, round(at.y - 0.5) - size))
    return layers


def _table(found: Probe, composition: Composition) -> np.ndarray:
    """An image of the numbers on a dark ground, their points below each other; one column where the light is grey."""
    size = max(float(round(composition.px(12))), float(MIN_TYPE))
    theta, phi = found.theta_phi_degrees
    direction = "   ".join(f"{axis} {value:z.3f}" for axis, value in zip("xyz", found.direction, strict=True))
    heads = [typeset(text) for text in (f"theta {theta:.1f}°   phi {phi:z.1f}°", direction)]
    values = {
        "original": found.original,
        "reconstruction": found.reconstruction,
        "error": found.error,
        "beside": found.beside,
    }
    rows = {name: [_number(one) for one in three] for name, three in values.items() if three is not None}
    grey = all(len(set(numbers)) == 1 for numbers in rows.values())
    before, after = (
        max(width_of(part, size) for numbers in rows.values() for part in (_parted(one)[side] for one in numbers))
        for side in (0, 1)
    )
    pad, line = round(0.8 * size), round(1.5 * size)
    labels = pad + max(width_of(name, size) for name in rows) + size
    points = [round(labels + before + place * (before + after + size)) for place in range(1 if grey else 3)]
    width = max(points[-1] + after, pad + max(width_of(text, size) for text in heads)) + pad
    pieces: list[Piece] = []
    y = round(pad + 0.76 * size)
    for text in heads:
        pieces.append(Text("", pad, y, text, size, FAINT))
        y += line
    if not grey:
        pieces += [ended("", point, y, letter, size, FAINT) for point, letter in zip(points, "RGB", strict=True)]
        y += line
    for name, numbers in rows.items():
        ink = INK if name == "error" else GREY
        pieces.append(Text("", pad, y, name, size, ink))
        for point, number in zip(points, numbers, strict=False):
            pieces.append(Text("", round(point - width_of(_parted(number)[0], size)), y, number, size, ink))
        y += line
    ground = Fill(Box(0, 0, round(width), round(y - line + 0.24 * size + pad)), GROUND)
    return draw([ground, *pieces]).image


def _number(value: float) -> str:
    """A value in four digits, with a power of ten where that is shorter."""
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 1e5:
        return typeset(f"{value:.{max(0, 3 - floor(log10(abs(value))))}f}")
    mantissa, exponent = f"{value:.3e}".split("e")
    return typeset(f"{mantissa}e{int(exponent)}")


def _parted(number: str) -> tuple[str, str]:
    """What stands before the point, and the rest."""
    whole = number.partition(".")[0]
    return whole, number[len(whole) :]
