"""The key table over the whole window, in as many columns as have room; where it is too high, PageDown turns."""

from __future__ import annotations

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.keys import BINDINGS, Binding
from shviewer.viewer.overlay.lettering import (
    FAINT,
    GREY,
    GROUND,
    INK,
    MEDIUM,
    RULE,
    SEMIBOLD,
    shortened_to,
    width_of,
)
from shviewer.viewer.overlay.numerals import typeset
from shviewer.viewer.overlay.pieces import Fill, Piece, Text
from shviewer.viewer.state import State

COLUMN, KEY_COLUMN, ROW, GAP = 240.0, 78.0, 20.0, 18.0
"""Widths of a column and of the keys in it, the height of a row, and the space over a group; pixels of the design."""

ARROWS = {"Up": "↑", "Down": "↓", "Left": "←", "Right": "→", "PageUp": "PgUp", "PageDown": "PgDn"}

Row = tuple[str, Binding | None, tuple[str, ...]]
"""A row: its label, its binding, and what it does in one line or more. A title has no binding, a gap no label either."""


def help_pieces(state: State, at: Composition, opengl: str, page: int = 0) -> list[Piece]:
    """The sheet, which covers the frame. page: how often PageDown was pressed."""
    pieces: list[Piece] = [Fill(Box(0, 0, at.width, at.height), GROUND)]
    size, margin = _size(at), at.margin
    pages = pages_of(at)
    shown = pages[page % len(pages)]
    top = _top(at)
    closes = "H closes" if len(pages) == 1 else f"PageDown: page {page % len(pages) + 1} of {len(pages)}   H closes"
    pieces.append(Text("help_title", margin, round(top), "Keys", at.px(15), INK, SEMIBOLD))
    x = at.width - margin - width_of(closes, 0.92 * size)
    pieces.append(Text("help_closes", round(x), round(top), closes, 0.92 * size, FAINT))
    rule = round(top + at.px(12))
    pieces.append(Fill(Box(margin, rule, at.width - margin, rule + max(1, round(at.scale))), RULE))
    across, lowest = _pitch(at), 0.0
    for number, column in enumerate(shown):
        left, y = round(margin + number * across), rule + at.px(28)
        for row in column:
            pieces += _row(row, state, left, y, across - at.px(12), size)
            y += max(len(row[2]), 1) * at.px(ROW) if row[0] else at.px(GAP)
        lowest = max(lowest, y)
    last = at.height - at.px(12)
    if opengl and last - at.px(14) > lowest - at.px(ROW):
        words = shortened_to(opengl, at.width - 2 * margin, at.px(12))
        pieces.append(Text("opengl", margin, round(last), words, at.px(12), FAINT))
    return pieces


def _row(row: Row, state: State, x: float, y: float, room: float, size: float) -> list[Piece]:
    """A key, what it does, and after that its present value where there is room."""
    label, binding, lines = row
    if not label:
        return []
    if binding is None:
        return [Text(f"help_{label}", x, round(y), label, size, INK, SEMIBOLD)]
    after = x + _key_width(label, size)
    pieces: list[Piece] = [Text(f"key_{label}", x, round(y), _keys(label), size, GREY, MEDIUM)]
    for number, text in enumerate(lines):
        pieces.append(
            Text(f"does_{label}_{number}", round(after), round(y + number * ROW / 13 * size), text, size, GREY)
        )
    left = pieces[-1].box.right + 0.8 * size
    value = shortened_to(typeset(binding.value(state)), x + room - left, size)
    if value and "…" not in value:
        baseline = round(y + (len(lines) - 1) * ROW / 13 * size)
        pieces.append(Text(f"value_{label}", round(left), baseline, value, size, INK))
    return pieces


def pages_of(at: Composition) -> list[list[list[Row]]]:
    """The rows of each column of each page: columns of about the same height. A group stays together where it can."""
    columns = max(1, round((at.width - 2 * at.margin + at.px(12)) / _pitch(at)))
    most = max(int((at.height - _top(at) - at.px(12 + 28 + 8)) / at.px(ROW)), 3)
    groups = [[(title, None, ()), *(_broken(row, at) for row in rows)] for title, rows in BINDINGS.items()]
    filled = _filled(groups, most)
    if len(filled) <= columns:  # on one page the columns are no higher than need be
        low = [found for height in range(3, most + 1) if len(found := _filled(groups, height)) <= columns]
        filled = next((found for found in low if _whole(found)), low[0])
    return [filled[start : start + columns] for start in range(0, len(filled), columns)]


def _filled(groups: list[list[Row]], most: int) -> list[list[Row]]:
    """Columns of at most so many rows."""
    filled: list[list[Row]] = [[]]
    for group in groups:
        if filled[-1] and _height([*filled[-1], GAP_ROW, *group]) > most:
            filled.append([])
        if filled[-1]:
            filled[-1].append(GAP_ROW)
        for row in group:
            if _height([*filled[-1], row]) > most:
                filled.append([group[0]] if row is not group[0] else [])
            filled[-1].append(row)
    return filled


def _whole(columns: list[list[Row]]) -> bool:
    """Whether no group goes on in another column."""
    titles = [row[0] for column in columns for row in column if row[1] is None and row[0]]
    return len(titles) == len(BINDINGS)


GAP_ROW: Row = ("", None, ())


def _height(rows: list[Row]) -> int:
    return sum(max(len(lines), 1) for _, _, lines in rows)


def _broken(binding: Binding, at: Composition) -> Row:
    """A row with its words broken into the lines that its column has room for."""
    size = _size(at)
    room = _pitch(at) - at.px(12) - _key_width(binding.label, size)
    lines: list[str] = []
    for word in binding.help.split():
        if lines and width_of(f"{lines[-1]} {word}", size) <= room:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    return binding.label, binding, tuple(lines)


def _key_width(label: str, size: float) -> float:
    """The width of a row's keys: that of the column of keys, unless they are longer."""
    return max(KEY_COLUMN / 13 * size, width_of(_keys(label), size, MEDIUM) + 0.5 * size)


def _top(at: Composition) -> float:
    return at.px(24 if at.compact else 34)


def _size(at: Composition) -> float:
    return at.px(12.0 if at.compact else 13.0)


def _pitch(at: Composition) -> float:
    """The width of a column: an even part of the frame, at least COLUMN."""
    room = at.width - 2 * at.margin + at.px(12)
    return room / max(1, int(room / at.px(COLUMN)))


def _keys(label: str) -> str:
    """A row's keys as they are set: arrows as arrows, without strokes between them."""
    return " ".join(ARROWS.get(part, part) for part in label.replace("-", "–").split(" / "))
