"""The line under the curve: what its lines and bars stand for, or the values of the band under the mouse."""

from __future__ import annotations

import math

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.figures import looked_at
from shviewer.viewer.overlay.inks import BAR, FAINT, GREY, INK, Ink
from shviewer.viewer.overlay.letters.numerals import share, typeset
from shviewer.viewer.overlay.pieces import Fill, Piece, Text
from shviewer.viewer.overlay.plots.band_series import BandSeries
from shviewer.viewer.overlay.setting import sentence
from shviewer.viewer.state import State
from shviewer.words import brief_percent


def hovered_pieces(series: BandSeries, band: int, line: Line, at: Composition) -> list[Piece]:
    """The values of the band under the mouse, as many as have room."""
    parts = band_words(series, band)
    wordings = [",  ".join(parts[:count]) for count in range(len(parts), 0, -1)]
    return sentence("hovered", line, wordings, at.px(12.0), INK)


def legend_pieces(state: State, line: Line, at: Composition) -> list[Piece]:
    """What lines and bars stand for."""
    size, main = at.px(12.0), looked_at(state.recipe.quantity)
    entries: list[tuple[str, Ink | None, tuple[str, ...], Ink]] = [
        ("line", INK, (main, main, main), INK),
        ("line", GREY, ("shading", "shading", "shading"), GREY),
        ("", None, ("error with bands 0 to here", "with bands 0 to here", "error to here"), FAINT),
        ("bar", BAR, ("with this band alone left out", "this band left out", "left out"), FAINT),
    ]
    for count, brief in ((4, 0), (4, 1), (4, 2), (2, 0)):
        pieces: list[Piece] = []
        x, middle = line.left, line.baseline - 0.36 * size
        for shape, colour, wordings, ink in entries[:count]:
            words = wordings[brief]
            wide, gap = (at.px(14), at.px(5)) if shape == "line" else (at.px(9), at.px(5)) if shape else (0.0, 0.0)
            if colour is not None:
                half = at.px(0.9) if shape == "line" else at.px(4.5)
                box = Box(round(x), round(middle - half), round(x + wide), round(middle + half))
                pieces.append(Fill(box, colour))
            pieces.append(Text(f"legend_{wordings[0]}", round(x + wide + gap), line.baseline, words, size, ink))
            x = pieces[-1].box.right + at.px(12 if shape == "line" else 18)
        if pieces[-1].box.right <= line.right + at.px(2):
            return pieces
    return []


def band_words(series: BandSeries, band: int) -> list[str]:
    """The values of one band, in words, the first with its name."""
    said = []
    if band < len(series.worth):
        said.append(f"{typeset(brief_percent(series.worth[band]))} error with it alone left out")
    if band < len(series.errors) and math.isfinite(series.errors[band]):
        said.append(f"with bands 0 to {band}: {share(series.errors[band])}")
    if band < len(series.shading) and math.isfinite(series.shading[band]):
        said.append(f"shading {share(series.shading[band])}")
    return [f"band {band}:  " + "".join(said[:1]), *said[1:]]
