"""The probe under the mouse: the direction, and the values there, computed in float64 and not by the shader."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw

from shviewer.harmonics.basis import Array
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.lettering import FAINT, GREY, INK, MIN_TYPE, Ink, font
from shviewer.viewer.overlay.numerals import MINUS
from shviewer.viewer.picture import Picture
from shviewer.words import theta_phi_degrees

GROUND: Ink = (14, 14, 16, 224)
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
    """An image of the numbers on a dark ground; one column where the light is grey."""
    size = max(round(composition.px(12)), MIN_TYPE)
    face, line, pad = font(size), round(1.5 * size), round(0.8 * size)
    theta, phi = found.theta_phi_degrees
    direction = "   ".join(f"{axis} {value:z.3f}" for axis, value in zip("xyz", found.direction, strict=True))
    heads = [text.replace("-", MINUS) for text in (f"theta {theta:.1f}°   phi {phi:z.1f}°", direction)]
    rows = [
        (name, _numbers(values), ink)
        for name, values, ink in (
            ("original", found.original, GREY),
            ("reconstruction", found.reconstruction, GREY),
            ("error", found.error, INK),
            ("beside", found.beside, GREY),
        )
        if values is not None
    ]
    grey = all(len(set(numbers)) == 1 for _, numbers, _ in rows)
    labels = max(face.getlength(name) for name, _, _ in rows) + size
    column = max(face.getlength(number) for _, numbers, _ in rows for number in numbers) + size
    width = round(max(max(map(face.getlength, heads)), labels + (1 if grey else 3) * column - size)) + 2 * pad
    lines = len(heads) + len(rows) + (0 if grey else 1)
    image = Image.new("RGBA", (width, lines * line + 2 * pad - line + size), GROUND)
    draw = ImageDraw.Draw(image)
    y = float(pad)
    for text in heads:
        draw.text((pad, y), text, FAINT, face)
        y += line
    if not grey:
        for place, letter in enumerate("RGB"):
            draw.text((pad + labels + (place + 1) * column - size, y), letter, FAINT, face, anchor="ra")
        y += line
    for name, numbers, ink in rows:
        draw.text((pad, y), name, ink, face)
        for place, number in enumerate(numbers[:1] if grey else numbers):
            draw.text((pad + labels + (place + 1) * column - size, y), number, ink, face, anchor="ra")
        y += line
    return np.asarray(image)


def _numbers(values: Array) -> list[str]:
    """Values as text, four digits each."""
    texts = (f"{value:z.4g}" if value == 0 or 1e-3 <= abs(value) < 1e5 else f"{value:z.3e}" for value in values)
    return [text.replace("-", MINUS) for text in texts]
