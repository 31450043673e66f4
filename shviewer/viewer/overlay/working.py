"""What goes on: the hairline, which fills, how far the work is, and that the light turns."""

from __future__ import annotations

from shviewer.viewer.animation.metronome import TURN_STEP
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.foot import message_line
from shviewer.viewer.overlay.inks import ACCENT, GREY, INK, RULE
from shviewer.viewer.overlay.letters.lettering import shortened_to, width_of
from shviewer.viewer.overlay.letters.numerals import typeset
from shviewer.viewer.overlay.pieces import Fill, Piece, Text
from shviewer.viewer.overlay.setting import ended, sentence
from shviewer.viewer.picture import Picture
from shviewer.viewer.work import Work

UNKNOWN = 0.2
"""The part of the hairline that is lit where nobody knows how long the work takes."""

ACROSS_SECONDS = 2.4
"""The time that this part takes from end to end."""


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
    phase = (seconds / ACROSS_SECONDS) % 2
    start = (1 - UNKNOWN) * (phase if phase < 1 else 2 - phase)
    return start, start + UNKNOWN


def work_pieces(at: Composition, work: Work) -> list[Piece]:
    """What is at work, and at the right how far it is."""
    line = message_line(at)
    if line is None:
        return []
    size, small = at.px(12.0 if at.compact else 13.0), at.small
    parts = [
        "" if work.share is None else f"{100 * work.share:.0f} %",
        "" if work.seconds_left is None else f"{max(1, round(work.seconds_left))} s left",
        "Esc stops",
    ]
    pieces: list[Piece] = []
    right = at.width - at.margin if not at.compact else line.right
    for number, part in reversed(list(enumerate(filter(None, parts)))):
        text = ended(f"work_{number}", right, line.baseline, part, small, GREY)
        if text.x < line.left + at.px(60):
            break
        pieces.append(text)
        right = text.x - at.px(10)
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
    ends = [round(one.box.right + at.px(18)) for one in said]
    return [*said, *(Text("turning_stops", end, line.baseline, "Esc stops", small, GREY) for end in ends)]
