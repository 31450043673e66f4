"""How words are set on lines, of a sentence the longest wording that has room there; and the dashed lines of plots."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import GREY, Ink
from shviewer.viewer.overlay.letters.lettering import REGULAR, shortened_to, width_of
from shviewer.viewer.overlay.letters.numerals import typeset
from shviewer.viewer.overlay.pieces import Fill, Piece, Text

Part: TypeAlias = tuple[str, ...]
"""Something to be said, in wordings of which the longest that has room is taken; "" and what has none is left out."""


def ended(name: str, right: float, baseline: float, text: str, size: float, ink: Ink, weight: str = REGULAR) -> Text:
    """A text that ends at `right`."""
    said = typeset(text)
    return Text(name, round(right - width_of(said, size, weight)), baseline, said, size, ink, weight)


def centred(
    name: str,
    x: float,
    ends: tuple[float, float],
    baseline: float,
    text: str,
    size: float,
    ink: Ink,
    weight: str = REGULAR,
) -> Text:
    """A text in the middle over or under x, as far as it stays between its ends."""
    said = typeset(text)
    wide = width_of(said, size, weight)
    return Text(name, round(min(max(x - wide / 2, ends[0]), ends[1] - wide)), baseline, said, size, ink, weight)


def dashes(left: float, right: float, y: int, at: Composition) -> list[Piece]:
    """A dashed line."""
    dash = at.px(4)
    starts = [left + 2 * number * dash for number in range(int((right - left) / (2 * dash)))]
    return [Fill(Box(start, y, start + dash, y + at.hair), GREY) for start in starts]


def sentence(name: str, line: Line, wordings: Sequence[str], size: float, ink: Ink) -> list[Piece]:
    """A sentence in the first of its wordings that has room on a line; else the last, shortened in its middle."""
    room, said = line.right - line.left, [typeset(wording) for wording in wordings]
    text = next((one for one in said if width_of(one, size) <= room), "") or shortened_to(said[-1], room, size)
    return [Text(name, line.left, line.baseline, text, size, ink)] if text else []


def set_on(parts: Sequence[Part], lines: Sequence[Line], size: float) -> tuple[list[tuple[Line, str]], list[Part]]:
    """Set parts on lines, with commas between those on one; of each the longest wording that has room.

    Return the parts, too, that have none.
    """
    found: list[tuple[Line, str]] = []
    unsaid: list[Part] = []
    for part in parts:
        for words in (typeset(wording) for wording in part if wording):
            line, said = found[-1] if found else (None, "")
            if line is not None and line.left + width_of(f"{said}, {words}", size) <= line.right:
                found[-1] = line, f"{said}, {words}"
                break
            free = lines[len(found) :]
            if free and free[0].left + width_of(words, size) <= free[0].right:
                found.append((free[0], words))
                break
        else:
            unsaid += [part] if any(part) else []
    return found, unsaid
