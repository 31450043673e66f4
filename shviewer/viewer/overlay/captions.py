"""How the words about each pane are set: a head, a few words after it, and at its foot how it came about."""

from __future__ import annotations

from collections.abc import Sequence

from shviewer.viewer.composing.caption import Caption
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.drawn import Surfaces
from shviewer.viewer.overlay.inks import FAINT, GREY, INK, Ink
from shviewer.viewer.overlay.letters.lettering import REGULAR, SEMIBOLD, shortened_to, width_of
from shviewer.viewer.overlay.letters.numerals import typeset
from shviewer.viewer.overlay.pane_words import Words, describe_evaluation, describe_suns, notes_of, words_of_panes
from shviewer.viewer.overlay.pieces import Piece, Swatch, Text
from shviewer.viewer.overlay.setting import Part, set_on
from shviewer.viewer.picture import Picture
from shviewer.words import grouped, grouped_number

HEAD, SECOND, FOOT, SMALL = 15.0, 13.0, 12.0, 11.0
"""Sizes of type, in pixels of the design; the last is that of a compact frame."""

ZEBRA = 11.0

RADIUS = ("radius: square root of magnitude", "radius: root of magnitude", "radius: root")
"""What the radius of a light's surface is, in place of the exposure."""


def caption_blocks(
    picture: Picture, at: Composition, timing: bool
) -> tuple[list[list[Piece]], list[list[Piece]], list[Part]]:
    """The pieces of each pane's head, those of each foot, and what no picture may hide but no pane has room for."""
    panes = zip(words_of_panes(picture, at), at.captions, strict=False)
    blocks = [_head(name, words, places, at) for (name, words), places in panes]
    unsaid = [part for _, parts in blocks[1:2] for part in parts]
    feet = [exposure_pieces(picture, at, places.foot) for places in at.captions[:1] if places.foot]
    for foot in (places.foot for places in at.captions[1:2] if places.foot):
        feet.append(_foot(picture, foot, at, timing, unsaid))
        unsaid = []
    return [pieces for pieces, _ in blocks], feet, unsaid


def exposure_pieces(picture: Picture, at: Composition, line: Line, unsaid: Sequence[Part] = ()) -> list[Piece]:
    """The exposure, and what means beyond white, in as many words as have room; of surfaces what their radius is.

    unsaid: what stands before it, in its shortest wording, as it has no room elsewhere.
    """
    surfaces = isinstance(picture.drawn, Surfaces)
    view, stops = picture.state.view, typeset(f"{picture.exposure_stops:+z.1f} stops")
    size = at.px(SMALL if at.compact else FOOT)
    curve = "" if view.tone == "none" else f", {view.tone} curve"
    fixed = "" if view.exposure_stops is None else ", fixed"
    beyond = picture.figures.peak * 2.0**picture.exposure_stops > 1.0
    white = beyond and view.tone == "none" and view.marks and not surfaces
    ink = INK if at.over else FAINT
    others = [next(words for words in reversed(part) if words) for part in unsaid]
    notes = typeset(", ".join([*notes_of(picture) * at.compact, *others]))  # elsewhere the second line has the light's
    choices: tuple[str, ...] = RADIUS if surfaces else (f"exposure {stops}{curve}{fixed}", f"exposure {stops}", stops)
    if notes:
        choices = (f"{notes}, {choices[0]}", f"{notes}, {choices[-1]}", notes, notes.partition(",")[0])
    for words in choices:
        length = width_of(words, size)
        if line.left + length <= line.right:
            break
    else:
        return []
    pieces: list[Piece] = [_text("radius" if surfaces else "exposure", line.left, line.baseline, words, size, ink, at)]
    x, side = line.left + length + at.px(12), at.px(ZEBRA)
    for label in ("beyond white", "> white"):
        if white and x + side + at.px(5) + width_of(label, size) <= line.right:
            area = Box(round(x), round(line.baseline - side + 1), round(x + side), round(line.baseline + 1))
            pieces.append(Swatch(area, "white", at.scale, "zebra"))
            pieces.append(_text("beyond_white", area.right + at.px(5), line.baseline, label, size, ink, at))
            break
    return pieces


def _text(
    name: str, x: float, baseline: float, text: str, size: float, ink: Ink, at: Composition, weight: str = REGULAR
) -> Text:
    return Text(name, x, baseline, text, size, ink, weight, at.px(1.6) if at.over else 0.0)


def _head(name: str, said: Words, places: Caption, at: Composition) -> tuple[list[Piece], Sequence[Part]]:
    """A head, shortened in the middle, and the parts of what is said about it on the lines after it.

    Return those, too, that no picture may hide and that have no room: not even where the others give way, or after the head.
    """
    (head, parts, must), size = said, at.px(12.0 if at.compact else HEAD)
    shown = shortened_to(head, places.head.right - places.head.left, size, SEMIBOLD)
    if not shown:
        return [], must
    pieces: list[Piece] = [_text(name, places.head.left, places.head.baseline, shown, size, INK, at, SEMIBOLD)]
    lines = list(places.lines)
    after = places.head._replace(left=pieces[0].box.right + at.px(10))
    if lines and lines[0].baseline == places.head.baseline:
        lines[0] = after
    size, ink = at.px(SMALL if at.compact else SECOND), INK if at.over else GREY
    found, unsaid = set_on(parts, lines, size)
    if any(part in unsaid for part in must):
        found, unsaid = set_on([*must, *(part for part in parts if part not in must)], lines, size)
    unsaid = [part for part in must if part in unsaid]
    if unsaid and after not in lines:
        beside, unsaid = set_on(unsaid, [after], size)
        found += beside
    for number, (line, words) in enumerate(found):
        called = f"{name}_about" if number == 0 else f"{name}_about_{number}"
        pieces.append(_text(called, line.left, line.baseline, words, size, ink, at))
    return pieces, unsaid


def _foot(picture: Picture, line: Line, at: Composition, timing: bool, unsaid: list[Part]) -> list[Piece]:
    """How the coefficients came about and the sun that was split off; first what no line after the head has room for."""
    projection = picture.projection
    method = projection.method.partition("; ")[0]
    how: Part = (method, *(("exact",) if method.startswith("exact") else ()))
    if projection.evaluations is not None:
        count, noun = grouped(projection.evaluations), projection.evaluation_noun
        how = (f"{count} {method} {noun}", f"{count} {noun}")
    spent = timing and projection.milliseconds is not None
    time = f"{grouped_number(projection.milliseconds or 0.0)} ms" if spent else ""
    said: list[Part] = [*unsaid, how, (describe_suns(picture),), (time,), (describe_evaluation(picture, timing),)]
    size, ink = at.px(SMALL if at.compact else FOOT), INK if at.over else FAINT
    if how in set_on([*unsaid, how], [line], size)[1]:  # of what would nobody know
        said = unsaid
    return [
        _text("method", where.left, where.baseline, words, size, ink, at)
        for where, words in set_on(said, [line], size)[0]
    ]
