"""The line under the curve while a light turns: how far its reconstruction moves from frame to frame."""

from __future__ import annotations

import math
from collections.abc import Sequence

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import ACCENT, GROUND, INK, RULE
from shviewer.viewer.overlay.letters.numerals import share
from shviewer.viewer.overlay.pieces import Curve, Fill, Piece
from shviewer.viewer.overlay.setting import sentence
from shviewer.words import counted

WIDTH, HEIGHT = 160.0, 14.0
"""The size of the line, pixels of the design."""

NOTHING = 1e-9
"""Changes below are rounding."""


def trace_pieces(changes: Sequence[float], line: Line, at: Composition) -> list[Piece]:
    """The changes of the last frames as a line from zero up, and their root mean square in words."""
    size, base, top = at.px(12.0), line.baseline + at.px(2), line.baseline - at.px(HEIGHT - 2)
    right = line.left + at.px(WIDTH)
    rms, most = math.sqrt(sum(change**2 for change in changes) / len(changes)), max(changes)
    pieces: list[Piece] = [Fill(Box(line.left, round(base), right, round(base) + at.hair), RULE)]
    if most > NOTHING and len(changes) > 1:
        step = (right - line.left) / (len(changes) - 1)
        points = tuple((line.left + k * step, base - change / most * (base - top)) for k, change in enumerate(changes))
        clip = Box(line.left - 2, top - 2, right + 2, base + 2)
        pieces.append(Curve(points, at.px(1.4), ACCENT, clip, at.px(1.0), GROUND, name="trace"))
    frames = counted(len(changes), "frame")
    said = [
        f"changes by {share(rms)} of the light from frame to frame, RMS of {frames}",
        f"changes by {share(rms)} a frame, RMS",
    ]
    if most == 0:
        said = [f"its coefficients turn with it: no change in {frames}", "no change"]
    elif most <= NOTHING:
        said = [f"turned back it does not change: the same to rounding in {frames}", "no change but by rounding"]
    return [*pieces, *sentence("trace_words", line._replace(left=round(right + at.px(12))), said, size, INK)]
