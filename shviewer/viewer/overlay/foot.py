"""The foot: the keys to begin with, or a message with a mark of its kind."""

from __future__ import annotations

from shviewer.analysis.comparing.comparison import agrees
from shviewer.viewer import message
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import ERROR, FAINT, GREY, INK, WARNING, Ink
from shviewer.viewer.overlay.letters.lettering import MEDIUM, escaped, shortened_to, width_of
from shviewer.viewer.overlay.letters.numerals import typeset
from shviewer.viewer.overlay.pieces import Curve, Piece, Text
from shviewer.viewer.picture import Picture

KEYS = (("↑ ↓", "bands"), ("0–9", "mute"), ("D", "error"), ("G", "whole sphere"), ("U", "sun apart"), ("H", "help"))
"""The keys to begin with, and what they do; the last ones but one go first where there is no room."""

OTHERS = ("← →", "light")
"""The keys that go through several lights; they stand after the first, and go before any other."""

INKS: dict[str, Ink] = {message.DONE: INK, "": INK, message.WARNING: WARNING, message.ERROR: ERROR}
MARK, AFTER_MARK = 11.0, 18.0
"""The size of a mark before a message, and where its words begin."""


def said_of(picture: Picture, remark: str = "") -> str:
    """The message of a picture: what a key said, a remark, or the verdict on compared coefficients."""
    said = picture.state.view.message or remark
    if said:
        return said
    return picture.verdict if not picture.verdict or agrees(picture.verdict) else message.warning(picture.verdict)


def foot_pieces(
    at: Composition, said: str, *, after: float = 0.0, proposed: str = "", others: bool = False
) -> list[Piece]:
    """The line at the foot: a message, or else keys.

    after: where what stands before them ends; proposed: one that helps; others: whether there are other lights.
    """
    line, foot = message_line(at), at.numbers.foot
    if said and line is not None:
        return message_pieces(line._replace(right=at.width - at.margin) if takes_legend(at, said) else line, said, at)
    return [] if foot is None or said else _keys(foot._replace(left=max(foot.left, after)), at, proposed, others)


def takes_legend(at: Composition, said: str) -> bool:
    """Whether a message is too long for its line, so that the legend beside it gives way."""
    line = message_line(at)
    if not said or line is None or not at.numbers.on_foot(at.numbers.legend):
        return False
    mark = at.px(AFTER_MARK) if message.kind_of(said) else 0
    return mark + width_of(escaped(typeset(str(said))), at.px(13.0)) > line.right - line.left


def message_line(at: Composition) -> Line | None:
    """The line on which messages stand: the foot as far as the frame reaches, or in a compact frame the figures' place."""
    numbers = at.numbers
    if numbers.foot is not None:
        right, legend = at.width - at.margin, numbers.legend
        if legend is not None and numbers.on_foot(legend):
            right = legend.left - at.px(12)
        return numbers.foot._replace(right=min(max(right, numbers.foot.right), at.width - at.margin))
    places = numbers.figures or numbers.answers
    if not places:
        return Line(at.margin, at.width - at.margin, at.height - at.px(8))
    beside = numbers.curve and numbers.curve.top < places[0].value
    right = numbers.curve.left - at.px(12) if numbers.curve and beside else at.width - at.margin
    return Line(places[0].left, right, places[0].value)


def message_pieces(line: Line, said: str, at: Composition) -> list[Piece]:
    """A message with its mark, on as many lines as it needs and has; the last is shortened to its line.

    A foot has two, upwards. In a compact frame they go on down, and begin in the place of the answers where that is too short.
    """
    sign, words = message.kind_of(said), str(said)
    size, ink = at.px(12.0 if at.compact else 13.0), INKS[sign]
    left, apart = line.left + (at.px(AFTER_MARK) if sign else 0), 1.25 * size
    foot, curve = at.numbers.foot, at.numbers.curve
    end = curve.top if curve and curve.top > line.baseline else at.height
    most = 2 if foot else 1 + max(0, int((end - line.baseline - 0.35 * size) / apart))
    lines = _lines(escaped(typeset(words)), line.right - left, size, most)
    places = at.numbers.answers if at.numbers.figures and not foot else ()
    if places and line.baseline > places[0].value and " ".join(lines) != escaped(typeset(words)):
        return message_pieces(line._replace(baseline=places[0].value), said, at)
    first = line.baseline - (apart * (len(lines) - 1) if foot else 0.0)
    pieces = _mark(sign, line.left, first, at.px(MARK), ink, at) if sign else []
    for number, text in enumerate(lines):
        name = "message" if number == 0 else f"message_{number}"
        pieces.append(Text(name, left, round(first + number * apart), text, size, ink))
    return pieces


def _lines(text: str, room: float, size: float, most: int) -> list[str]:
    """The text parted at spaces into lines that have room, at most so many.

    The last is shortened in its middle, and so is a word that is too long for a line, such as a path.
    """
    words = text.split(" ")
    if most == 1 or len(words) == 1 or width_of(text, size) <= room:
        return [shown] if (shown := shortened_to(text, room, size)) else []
    count = max((n for n in range(1, len(words)) if width_of(" ".join(words[:n]), size) <= room), default=1)
    first = shortened_to(" ".join(words[:count]), room, size)
    return [first, *_lines(" ".join(words[count:]), room, size, most - 1)] if first else []


def _mark(sign: str, x: float, baseline: float, size: float, ink: Ink, at: Composition) -> list[Piece]:
    """A tick, a triangle or a cross."""
    clip = Box(x - 2, baseline - size - 2, x + size + 2, baseline + 3)
    top, width = baseline - size + 1, at.px(1.6)

    def place(right: float, down: float) -> tuple[float, float]:
        return x + right * size, top + down * size

    if sign == message.WARNING:
        return [Curve((place(0.5, 0), place(1, 0.95), place(0, 0.95)), 0, ink, clip, closed=True, name="mark")]
    if sign == message.DONE:
        return [Curve((place(0, 0.5), place(0.35, 0.88), place(0.95, 0.12)), width, ink, clip, name="mark")]
    strokes = ((place(0.05, 0.05), place(0.9, 0.9)), (place(0.05, 0.9), place(0.9, 0.05)))
    return [Curve(stroke, width, ink, clip, name=f"mark_{n}") for n, stroke in enumerate(strokes)]


def _keys(line: Line, at: Composition, proposed: str, others: bool) -> list[Piece]:
    """As many keys as have room; help is always among them, and one that is proposed, which stands out."""
    size = at.px(12.0)
    keys = [KEYS[0], *([OTHERS] if others else []), *KEYS[1:]]
    gone_first = [OTHERS, *(key for key in reversed(KEYS[:-1]) if key[0] != proposed)]
    for gone in range(len(gone_first) + 1):
        shown, x = [key for key in keys if key not in gone_first[:gone]], line.left
        pieces: list[Piece] = []
        if len(shown) == 1:
            x = line.right - width_of("H", size, MEDIUM) - at.px(5) - width_of("help", size)
        for key, words in shown:
            pieces.append(
                Text(f"key_{key}", round(x), line.baseline, key, size, INK if key == proposed else GREY, MEDIUM)
            )
            x = pieces[-1].box.right + at.px(6)
            ink = INK if key == proposed else FAINT
            pieces.append(Text(f"key_{words}", round(x), line.baseline, words, size, ink))
            x = pieces[-1].box.right + at.px(18)
        if line.left <= pieces[0].box.left and pieces[-1].box.right <= line.right + 1:
            return pieces
    return []
