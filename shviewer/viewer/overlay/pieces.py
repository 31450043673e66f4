"""Pieces of the overlay as plain values: texts, bars, curves, discs, swatches. `overlay/drawing.py` draws them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import CASING, Ink
from shviewer.viewer.overlay.letters.lettering import REGULAR, width_of

Point = tuple[float, float]


@dataclass(frozen=True)
class Text:
    """A text that begins at x on a baseline. size: pixels."""

    name: str
    x: float
    baseline: float
    text: str
    size: float
    ink: Ink
    weight: str = REGULAR
    casing: float = 0.0
    """The width of a dark rim, where it stands on a picture."""
    rim: Ink = CASING

    @property
    def right(self) -> float:
        return self.x + width_of(self.text, self.size, self.weight)

    @property
    def box(self) -> Box:
        """The line's box: from the tops of capitals to below the baseline, as long as the text."""
        up, down = 0.76 * self.size, 0.22 * self.size
        return Box(self.x, self.baseline - up, max(self.right, self.x + 1), self.baseline + down)


@dataclass(frozen=True)
class Fill:
    """A rectangle."""

    box: Box
    ink: Ink
    name: str = ""
    hollow: float = 0.0
    """The width of its outline if it is not filled, pixels."""


@dataclass(frozen=True)
class Curve:
    """A line through points, cut to a box; a casing in another ink keeps it apart from what is under it."""

    points: tuple[Point, ...]
    width: float
    ink: Ink
    clip: Box
    casing: float = 0.0
    rim: Ink = CASING
    closed: bool = False
    """Whether it is an area to be filled."""
    name: str = ""

    @property
    def box(self) -> Box:
        out = self.width / 2 + self.casing + 1
        across, down = zip(*self.points, strict=True)
        return Box(
            max(min(across) - out, self.clip.left),
            max(min(down) - out, self.clip.top),
            min(max(across) + out, self.clip.right),
            min(max(down) + out, self.clip.bottom),
        )


@dataclass(frozen=True)
class Disc:
    """A disc, or with a width a ring in its ink around a disc of another."""

    x: float
    y: float
    radius: float
    ink: Ink
    width: float = 0.0
    inside: Ink = CASING
    name: str = ""

    @property
    def box(self) -> Box:
        out = self.radius + self.width / 2 + 1
        return Box(self.x - out, self.y - out, self.x + out, self.y + out)


@dataclass(frozen=True)
class Strip:
    """A row of colours, repeated over the height of a box. colours: RGB bytes, one pixel each."""

    box: Box
    colours: bytes
    name: str = ""


@dataclass(frozen=True)
class Swatch:
    """A sample of how the spheres are drawn: "lines", "negative" with its zero line, or the zebra "white"."""

    box: Box
    kind: str
    scale: float
    name: str = ""


Piece: TypeAlias = Text | Fill | Curve | Disc | Strip | Swatch
