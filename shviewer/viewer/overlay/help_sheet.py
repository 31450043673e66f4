"""The key table over the whole window: columns wide enough for its sentences, if they fit on one page; else PageDown turns."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.control.keys import BINDINGS, Binding
from shviewer.viewer.overlay.inks import FAINT, GREY, GROUND, INK, RULE, Ink
from shviewer.viewer.overlay.letters.lettering import MEDIUM, SEMIBOLD, shortened_to, width_of
from shviewer.viewer.overlay.letters.numerals import typeset
from shviewer.viewer.overlay.pieces import Fill, Piece, Text
from shviewer.viewer.state import State

COLUMN, APART, AFTER_KEYS = 240.0, 28.0, 14.0
"""The least width of a column, and the spaces after it and after its keys; pixels of the design."""

ARROWS = {"Up": "↑", "Down": "↓", "Left": "←", "Right": "→", "PageUp": "PgUp", "PageDown": "PgDn"}


class Row(NamedTuple):
    """A row of the sheet. A title has no binding, a gap no label either."""

    label: str
    binding: Binding | None = None
    lines: tuple[str, ...] = ()
    """What the keys do, in one line or more."""
    after: float = 0.0
    """Where that begins: after the longest keys of its group, pixels."""

    @property
    def height(self) -> int:
        """In rows of one line."""
        return max(len(self.lines), 1)


Page = list[list[Row]]
"""The rows of each column."""


class Type(NamedTuple):
    """The size of the type and the pixels from row to row."""

    size: float
    row: float


def help_blocks(state: State, at: Composition, foot: str, page: int = 0, ink: Ink = FAINT) -> list[list[Piece]]:
    """A ground over the frame, the head, the columns, and present values, each a block: turning the camera changes two of them.

    foot: what stands under it, if there is room, or if it is in an ink of its own in place of the title where there is none;
    page: how often PageDown was pressed.
    """
    pieces = list[Piece]()
    margin = at.margin
    pages, pitch, (size, step) = pages_of(at)
    shown = pages[page % len(pages)]
    top = _top(at)
    place = f"{page % len(pages) + 1} of {len(pages)}"
    wordings = ("H closes",) if len(pages) == 1 else (f"PageDown: page {place}   H closes", f"PageDown: {place}", place)
    pieces.append(Text("help_title", margin, round(top), "Keys", at.px(15), INK, SEMIBOLD))
    room = at.width - margin - pieces[-1].box.right - at.px(12)
    closes = next((words for words in wordings if width_of(words, 0.92 * size) <= room), wordings[-1])
    x = at.width - margin - width_of(closes, 0.92 * size)
    pieces.append(Text("help_closes", round(x), round(top), closes, 0.92 * size, FAINT))
    rule = round(top + at.px(12))
    pieces.append(Fill(Box(margin, rule, at.width - margin, rule + at.hair), RULE))
    columns, values, lowest = list[list[Piece]](), list[list[Piece]](), 0.0
    for number, column in enumerate(shown):
        columns.append([])
        left, y = round(margin + number * pitch), rule + at.px(28)
        for row in _aligned(column, pitch - at.px(APART), size):
            said = _row(row, left, y, Type(size, step))
            columns[-1] += said
            if said and row.binding is not None:
                values.append(_value(row, said[-1], state, left + pitch - at.px(APART), size))
            y += max(len(row.lines), 1) * step
        lowest = max(lowest, y)
    last = at.height - at.px(12)
    if foot and last - at.px(14) > lowest - step:
        words = shortened_to(foot, at.width - 2 * margin, at.px(12))
        pieces.append(Text("help_foot", margin, round(last), words, at.px(12), ink))
    elif foot and ink != FAINT:
        words = shortened_to(foot, x - at.px(12) - margin, at.px(12))
        pieces[0] = Text("help_foot", margin, round(top), words, at.px(12), ink)
    return [[Fill(Box(0, 0, at.width, at.height), GROUND)], pieces, *columns, *values]


def _aligned(column: list[Row], room: float, size: float) -> list[Row]:
    """The rows of a column, their sentences in one line below each other if all have room there."""
    after = max((row.after for row in column), default=0.0)
    widest = max((width_of(line, size) for row in column for line in row.lines), default=0.0)
    return [row._replace(after=after) for row in column] if after + widest <= room else column


def _row(row: Row, x: float, y: float, face: Type) -> list[Text]:
    """Keys, and what they do."""
    (label, binding, lines, after), size = row, face.size
    if not label:
        return []
    if binding is None:
        return [Text(f"help_{label}", x, round(y), label, size, INK, SEMIBOLD)]
    does = (
        Text(f"does_{label}_{number}", round(x + after), round(y + number * face.row), text, size, GREY)
        for number, text in enumerate(lines)
    )
    return [Text(f"key_{label}", x, round(y), _keys(label), size, GREY, MEDIUM), *does]


def _value(row: Row, last: Text, state: State, right: float, size: float) -> list[Piece]:
    """The present value, at the right end of the column after the last line, where there is room."""
    value = row.binding.value(state) if row.binding is not None else ""
    value = shortened_to(typeset(value), right - last.box.right - 0.8 * size, size)
    if not value or "…" in value:
        return []
    return [Text(f"value_{row.label}", round(right - width_of(value, size)), last.baseline, value, size, INK)]


@lru_cache(maxsize=2)
def pages_of(at: Composition) -> tuple[list[Page], float, Type]:
    """The pages, the pixels from one column to the next, and the type: the larger one, if one page has room for all of it."""
    large, small = Type(at.px(13.0), at.px(20.0)), Type(at.px(12.0), at.px(17.0))
    pages, pitch = _pages(at, large)
    if at.compact or len(pages) > 1:
        return *_pages(at, small), small
    return pages, pitch, large


def _pages(at: Composition, face: Type) -> tuple[list[Page], float]:
    """The pages, and the pixels from one column to the next: on one page if possible, with the fewest broken sentences.

    A group stays together where it can, and columns on one page are no higher than need be.
    """
    room = at.width - 2 * at.margin + at.px(APART)
    most = max(int((at.height - _top(at) - at.px(12 + 28 + 8)) / face.row), 3)
    best: tuple[int, Page, float] | None = None
    widest = max(1, int(room / at.px(COLUMN)))
    for columns in range(widest, 0, -1):
        groups = _groups(room / columns - at.px(APART), face.size)
        low = (found for height in range(3, most + 1) if len(found := _filled(groups, height)) <= columns)
        pages = list(low)
        broken = sum(len(row.lines) - 1 for group in groups for row in group[1:])
        if pages and (best is None or broken < best[0]):
            best = broken, next((page for page in pages if _whole(page)), pages[0]), room / columns
    if best is not None:
        return [best[1]], best[2]
    filled = _filled(_groups(room / widest - at.px(APART), face.size), most)
    return [filled[start : start + widest] for start in range(0, len(filled), widest)], room / widest


def _groups(room: float, size: float) -> list[list[Row]]:
    """Each group with its title, its sentences broken into the lines for which a column has room."""
    found = []
    for title, bindings in BINDINGS.items():
        after = max(width_of(_keys(row.label), size, MEDIUM) for row in bindings) + AFTER_KEYS / 13 * size
        rows = [Row(row.label, row, _broken(row.help, room - after, size), after) for row in bindings]
        found.append([Row(title), *rows])
    return found


def _broken(text: str, room: float, size: float) -> tuple[str, ...]:
    lines: list[str] = []
    for word in text.split():
        if lines and width_of(f"{lines[-1]} {word}", size) <= room:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    return tuple(lines)


def _filled(groups: list[list[Row]], most: int) -> Page:
    """Columns of at most so many rows."""
    filled: Page = [[]]
    used = 0
    for group in groups:
        if filled[-1] and used + GAP.height + sum(row.height for row in group) > most:
            filled.append([])
            used = 0
        if filled[-1]:
            filled[-1].append(GAP)
            used += GAP.height
        for row in group:
            if used + row.height > most:
                filled.append([group[0]] if row is not group[0] else [])
                used = len(filled[-1])
            filled[-1].append(row)
            used += row.height
    return filled


def _whole(columns: Page) -> bool:
    """Whether no group goes on in another column."""
    titles = [row.label for column in columns for row in column if row.binding is None and row.label]
    return len(titles) == len(BINDINGS)


GAP = Row("")


def _top(at: Composition) -> float:
    return at.px(24 if at.compact else 34)


def _keys(label: str) -> str:
    """A row's keys as they are set: arrows as arrows, without strokes between them."""
    return " ".join(ARROWS.get(part, part) for part in label.replace("-", "–").split(" / "))
