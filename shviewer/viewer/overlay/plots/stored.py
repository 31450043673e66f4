"""The errors of all encodings of irradiance beside each other, in place of the curve while one of them is shown."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil

from shviewer.analysis.figures import sums
from shviewer.analysis.projections import encoded, project, way_of
from shviewer.analysis.recipe import Shown
from shviewer.errors import UsageError
from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.harmonics.quantities.names import CUBES, ENCODED_BANDS
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import BAR, FAINT, GREY, INK, RULE, UNUSED
from shviewer.viewer.overlay.letters.lettering import MEDIUM, REGULAR, SEMIBOLD, width_of
from shviewer.viewer.overlay.letters.numerals import share, typeset
from shviewer.viewer.overlay.pieces import Fill, Piece, Text
from shviewer.viewer.overlay.setting import sentence
from shviewer.viewer.picture import Picture
from shviewer.words import round_percent

ROWS = {
    "l1": ("L1", "L1"),
    "geomerics": ("L1 Geomerics", "Geomerics"),
    "hallucinated": ("ZH3 hallucinated", "hallucinated"),
    "hallucinated-shared": ("hallucinated, shared", "halluc. shared"),
    "zh3": ("ZH3", "ZH3"),
    "zh3-shared": ("ZH3, shared axis", "ZH3 shared"),
    "zh3-solved": ("ZH3 solved", "ZH3 solved"),
    "ambient-cube": ("ambient cube", "cube"),
    "ambient-cube-fitted": ("cube, fitted", "cube fitted"),
    "l2": ("L2", "L2"),
    "l2-deringed": ("L2 deringed", "deringed"),
}
"""What each row is called, and where that takes more than half of its width."""

LOWEST_ROW, HIGHEST_ROW, GAP = 18.0, 26.0, 28.0
"""Pixels of the design from row to row, at least of one column and at most, and those between two columns."""

DENSEST = 0.85
"""The largest size of letters over that of a row."""


def stored_errors(picture: Picture) -> dict[str, float | None]:
    """The relative L2 error of each encoding of the picture's irradiance; None for one that it cannot have."""
    recipe, light = picture.state.recipe, picture.light
    turn = tuple(picture.light_from_world.T.ravel().tolist())
    plain, found = project(light, way_of(recipe), recipe.projected_bands), dict[str, float | None]()
    for name, n_bands in ENCODED_BANDS.items():
        try:
            shown = (
                recipe.shown if name == picture.state.view.encode else Shown(n_bands)
            )  # with its window and muted bands
            figures = sums(light, encoded(light, plain, name, turn if name in CUBES else None), shown)[1]
        except UsageError:
            found[name] = None
        else:
            found[name] = max(figures.relative_l2, figures.floor)
    return found


def stored_pieces(errors: Mapping[str, float | None], picture: Picture, at: Composition) -> list[Piece]:
    """A row for each encoding: its numbers a channel, its name, a bar from zero, and its error; that shown stands out."""
    area = at.numbers.curve
    assert area is not None
    names = list(ROWS)
    rows = len(names) if area.height >= len(names) * at.px(LOWEST_ROW) else ceil(len(names) / 2)
    columns = [names[first : first + rows] for first in range(0, len(names), rows)]
    wide = (area.width - at.px(GAP) * (len(columns) - 1)) / len(columns)
    step = min(area.height / rows, at.px(HIGHEST_ROW))
    size = min(at.px(11.0 if at.compact else 13.0), DENSEST * step)
    widest = [max(width_of(words[kind], size, MEDIUM) for words in ROWS.values()) for kind in (0, 1)]
    kind = 0 if widest[0] < 0.45 * wide else 1
    after = 1.2 * size + widest[kind] + 0.8 * size  # of a row, where its bar begins
    length = wide - after - width_of(typeset("88.8 %"), size, SEMIBOLD) - 0.8 * size
    known = [error for error in errors.values() if error is not None]
    each = max(length, 0.0) / max((*known, picture.state.recipe.tolerance))  # pixels for an error of 1
    line, pieces = at.hair, list[Piece]()
    for number, column in enumerate(columns):
        left = area.left + number * (wide + at.px(GAP))
        within = round(left + after + each * picture.state.recipe.tolerance)
        if length > 0:
            pieces.append(Fill(Box(within, area.top, within + line, round(area.top + len(column) * step)), RULE))
        for row, name in enumerate(column):
            encoding, error, shown = ENCODINGS[name], errors[name], name == picture.state.view.encode
            base = round(area.top + (row + 0.5) * step + 0.36 * size)
            said, ink = ROWS[name][kind], INK if shown else GREY
            pieces.append(Text(f"stored_{name}_floats", left, base, str(encoding.floats), size, FAINT))
            weight = MEDIUM if shown else REGULAR
            pieces.append(Text(f"stored_{name}", left + 1.2 * size, base, said, size, ink, weight))
            if error is not None and length > 0:
                start, thick = round(left + after), round(0.62 * size)
                end = max(round(left + after + each * error), start + line)
                pieces.append(Fill(Box(start, base - thick, end, base), BAR if shown else UNUSED))
            value, weight = share(error) if error is not None else "none", SEMIBOLD if shown else REGULAR
            x = left + wide - width_of(value, size, weight)
            pieces.append(Text(f"stored_{name}_error", x, base, value, size, ink, weight))
    return pieces


def stored_legend(picture: Picture, line: Line, at: Composition) -> list[Piece]:
    """What the rows are."""
    within = round_percent(picture.state.recipe.tolerance)
    wordings = (
        f"numbers a channel, relative L2 error of the irradiance that they keep, line at {within}",
        f"numbers a channel, relative L2 error of the irradiance, line at {within}",
        f"numbers a channel, error, line at {within}",
    )
    return sentence("stored_legend", line, wordings, at.px(12.0), GREY)
