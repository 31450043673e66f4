"""The foot: keys, or a message with a mark of its kind, or how far the work is, for which the hairline fills."""

from __future__ import annotations

from dataclasses import dataclass

from shviewer.analysis.comparing.comparison import agrees
from shviewer.analysis.figures import Pending
from shviewer.viewer import message
from shviewer.viewer.animation.metronome import TURN_STEP
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import ACCENT, ERROR, FAINT, GREY, INK, RULE, WARNING, Ink
from shviewer.viewer.overlay.lettering import MEDIUM, escaped, shortened_to, width_of
from shviewer.viewer.overlay.numerals import typeset
from shviewer.viewer.overlay.pieces import Curve, Fill, Piece, Text
from shviewer.viewer.overlay.setting import sentence
from shviewer.viewer.picture import Picture

KEYS = (("↑ ↓", "bands"), ("0–9", "mute"), ("D", "error"), ("G", "whole sphere"), ("U", "sun apart"), ("H", "help"))
"""The keys to begin with, and what they do; the last ones but one go first where there is no room."""

INKS: dict[str, Ink] = {message.DONE: INK, "": INK, message.WARNING: WARNING, message.ERROR: ERROR}
MARK, AFTER_MARK = 11.0, 18.0
"""The size of a mark before a message, and where its words begin."""

UNKNOWN = 0.2
"""The part of the hairline that is lit where nobody knows how long the work takes."""

TURN_SECONDS = 2.4
"""The time that this part takes from end to end."""


@dataclass(frozen=True)
class Work:
    """What is at work behind the picture: in words, the share that is done, and the seconds left, where they are known."""

    words: str
    share: float | None = None
    seconds_left: float | None = None
    seconds: float = 0.0
    """How long it has been at work."""


def hairline_pieces(at: Composition, work: Work | None = None) -> list[Piece]:
    """The hairline, which fills in the accent while something is at work."""
    line = at.hairline
    if line.bottom > at.height or line.right > at.width:
        return []
    pieces: list[Piece] = [Fill(line, RULE)]
    if work is None:
        return pieces
    start, end = (0.0, min(max(work.share, 0.0), 1.0)) if work.share is not None else _moving(work.seconds)
    thick = max(2, round(2 * at.scale))
    if line.height > line.width:
        lit = Box(line.left, line.top + start * line.height, line.left + thick, line.top + end * line.height)
    else:
        lit = Box(line.left + start * line.width, line.top, line.left + end * line.width, line.top + thick)
    return [*pieces, Fill(lit, ACCENT)] if end > start else pieces


def _moving(seconds: float) -> tuple[float, float]:
    """The lit part of a work of unknown length: it goes to and fro."""
    phase = (seconds / TURN_SECONDS) % 2
    start = (1 - UNKNOWN) * (phase if phase < 1 else 2 - phase)
    return start, start + UNKNOWN


def said_of(picture: Picture, remark: str = "") -> str:
    """The message of a picture: what a key said, a remark, or the verdict on compared coefficients."""
    said = picture.state.view.message or remark
    if said:
        return said
    return picture.verdict if not picture.verdict or agrees(picture.verdict) else message.warning(picture.verdict)


def foot_pieces(
    at: Composition, said: str, work: Work | None = None, *, after: float = 0.0, proposed: str = ""
) -> list[Piece]:
    """The line at the foot. said: a message; after: where what stands before the keys ends; proposed: a key that would help."""
    line = message_line(at)
    if line is None:
        return []
    if work is not None:
        return work_pieces(at, work)
    if said:
        whole = line._replace(right=at.width - at.margin) if takes_legend(at, said) else line
        return message_pieces(whole, said, at)
    foot = at.numbers.foot
    return [] if foot is None else _keys(foot._replace(left=max(foot.left, after)), at, proposed)


def takes_legend(at: Composition, said: str) -> bool:
    """Whether a message is too long for its line, so that the legend beside it gives way."""
    foot, legend, line = at.numbers.foot, at.numbers.legend, message_line(at)
    if not said or foot is None or legend is None or line is None or legend.baseline != foot.baseline:
        return False
    mark = at.px(AFTER_MARK) if message.kind_of(said) else 0
    return mark + width_of(escaped(typeset(str(said))), at.px(13.0)) > line.right - line.left


def message_line(at: Composition) -> Line | None:
    """The line on which messages stand: the foot as far as the frame reaches, or in a compact frame the figures' place."""
    numbers = at.numbers
    if numbers.foot is not None:
        right, legend = at.width - at.margin, numbers.legend
        if legend is not None and legend.baseline == numbers.foot.baseline:
            right = legend.left - at.px(12)
        return numbers.foot._replace(right=min(max(right, numbers.foot.right), at.width - at.margin))
    places = numbers.figures or numbers.answers
    if not places:
        return Line(at.margin, at.width - at.margin, at.height - at.px(8))
    right = (
        numbers.curve.left - at.px(12)
        if numbers.curve and numbers.curve.top < places[0].value
        else at.width - at.margin
    )
    return Line(places[0].left, right, places[0].value)


def message_pieces(line: Line, said: str, at: Composition) -> list[Piece]:
    """A message with its mark, on as many lines as it needs and has: a foot two, upwards; the last is shortened to its line."""
    sign, words = message.kind_of(said), str(said)
    size, ink = at.px(12.0 if at.compact else 13.0), INKS[sign]
    left, apart = line.left + (at.px(AFTER_MARK) if sign else 0), 1.25 * size
    foot, curve = at.numbers.foot, at.numbers.curve
    end = curve.top if curve and curve.top > line.baseline else at.height
    most = 2 if foot else 1 + max(0, int((end - line.baseline - 0.35 * size) / apart))
    lines = _lines(escaped(typeset(words)), line.right - left, size, most)
    first = line.baseline - (apart * (len(lines) - 1) if foot else 0.0)
    pieces = _mark(sign, line.left, first, at.px(MARK), ink, at) if sign else []
    for number, text in enumerate(lines):
        name = "message" if number == 0 else f"message_{number}"
        pieces.append(Text(name, left, round(first + number * apart), text, size, ink))
    return pieces


def _lines(text: str, room: float, size: float, most: int) -> list[str]:
    """The text parted at spaces into lines that have room, at most so many; the last is shortened in its middle."""
    if most == 1 or width_of(text, size) <= room:
        return [shown] if (shown := shortened_to(text, room, size)) else []
    words = text.split(" ")
    fitting = [n for n in range(1, len(words)) if width_of(" ".join(words[:n]), size) <= room]
    if not fitting:
        return [shown] if (shown := shortened_to(text, room, size)) else []
    rest = _lines(" ".join(words[fitting[-1] :]), room, size, most - 1)
    return [" ".join(words[: fitting[-1]]), *rest]


def work_pieces(at: Composition, work: Work) -> list[Piece]:
    """What is at work, and at the right how far it is."""
    line = message_line(at)
    if line is None:
        return []
    size, small = at.px(12.0 if at.compact else 13.0), at.small
    parts = []
    if work.share is not None:
        parts.append(typeset(f"{100 * work.share:.0f} %"))
    if work.seconds_left is not None:
        parts.append(f"{max(1, round(work.seconds_left))} s left")
    parts.append("Esc stops")
    pieces: list[Piece] = []
    far = at.width - at.margin if not at.compact else line.right
    right = far
    for number in range(len(parts) - 1, -1, -1):
        x = round(right - width_of(parts[number], small))
        if x < line.left + at.px(60):
            break
        pieces.append(Text(f"work_{number}", x, line.baseline, parts[number], small, GREY))
        right = x - at.px(10)
    words = shortened_to(typeset(work.words), right - at.px(8) - line.left, size)
    if words:
        pieces.append(Text("message", line.left, line.baseline, words, size, INK))
    return pieces


def turning_pieces(at: Composition, picture: Picture, pace: float | None) -> list[Piece]:
    """That the light turns, what is projected in each frame, and how many there are a second where that is not known."""
    line = message_line(at)
    if line is None:
        return []
    recipe, size, small = picture.state.recipe, at.px(12.0 if at.compact else 13.0), at.small
    samples = "fresh samples" if picture.state.view.turning == "fresh" else "the same samples"
    how = {"best": "projected exactly", "gauss-legendre": "points that stand still"}.get(recipe.method, samples)
    rate = "" if pace is None else f"{pace:.0f} frames a second" if pace >= 9.5 else f"{pace:.1g} frames a second"
    parts = [f"the light turns by {TURN_STEP:g}° a frame", how, *([rate] if rate else [])]
    within = line._replace(right=line.right - width_of("Esc stops", small) - at.px(18))
    wordings = [", ".join(parts), ", ".join(["turning", *parts[1:]]), f"turning, {how}", "turning"]
    said = sentence("turning", within, wordings, size, INK)
    return [
        *said,
        *(
            Text("turning_stops", round(one.box.right + at.px(18)), line.baseline, "Esc stops", small, GREY)
            for one in said
        ),
    ]


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


def proposed_key(picture: Picture) -> str:
    """U, where no band count is enough for the radiance and a sun may be to blame: it can be taken apart."""
    needs, recipe = picture.needs, picture.state.recipe
    if isinstance(needs, Pending) or needs.radiance is not None or recipe.split_sun or recipe.compare:
        return ""
    return "U" if picture.light.map is not None or picture.light.lobes else ""


def _keys(line: Line, at: Composition, proposed: str) -> list[Piece]:
    """As many keys as have room; help is always among them, and one that is proposed, which stands out."""
    size = at.px(12.0)
    gone_first = [key for key in reversed(KEYS[:-1]) if key[0] != proposed]
    for gone in range(len(gone_first) + 1):
        shown, x = [key for key in KEYS if key not in gone_first[:gone]], line.left
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
