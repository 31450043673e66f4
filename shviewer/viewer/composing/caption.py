"""Where the words about a pane stand, each line ending before its sphere. In pixels of the frame."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Sphere


@dataclass(frozen=True)
class Caption:
    """The places of what is written about a pane: the head, lines after it, and the line at its foot."""

    head: Line
    lines: tuple[Line, ...]
    """The lines after the head: none in a compact frame; over a map one, on the head's baseline."""
    foot: Line | None


def clear(line: Line, sphere: Sphere | None, high: float, gap: float) -> Line:
    """The line, cut where its text, which is so high, would come nearer to the sphere than the gap. All in pixels."""
    if sphere is None:
        return line
    top, bottom, reach = line.baseline - high, line.baseline + 0.3 * high, sphere.radius + gap
    down = max(top - sphere.y, sphere.y - bottom, 0.0)
    if down >= reach:
        return line
    return line._replace(right=max(min(line.right, sphere.x - sqrt(reach * reach - down * down)), line.left))
