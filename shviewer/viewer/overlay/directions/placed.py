"""A mark in a frame: where it is, the box of its words, and what shows both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.drawing import layer_of
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.pieces import Piece

TYPE, COMPACT_TYPE, GAP = 12.0, 11.0, 5.0
"""Sizes of the text, and the space before it."""

FAR = Box(-1e6, -1e6, 1e6, 1e6)


@dataclass(frozen=True)
class Placed:
    """A mark in a frame: its pixel, the box of its text, and the layers that show both."""

    x: float
    y: float
    behind: bool
    """Whether it is on the far side: then x, y is where one would see it through the sphere."""
    label: Box | None
    """None where there is no room for words."""
    layers: tuple[Layer, ...]


def type_size(composition: Composition) -> float:
    return composition.px(COMPACT_TYPE if composition.compact else TYPE)


def layers_at(pieces: tuple[Piece, ...], left: int, top: int) -> tuple[Layer, ...]:
    """The layer of pieces, moved: pieces around 0, 0 are drawn once."""
    found = layer_of(pieces)
    return () if found is None else (Layer(found.image, found.left + left, found.top + top),)


def free(box: Box, obstacles: Sequence[Box]) -> bool:
    return not any(box.overlaps(other) for other in obstacles)
