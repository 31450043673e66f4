"""What is written about each pane: a head, a few words after it, and at its foot how it came about."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TypeAlias

from shviewer.analysis.comparing.comparison import caption
from shviewer.analysis.recipe import Recipe
from shviewer.harmonics.basis import index
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE, in_words
from shviewer.viewer.beside import Beside, words_of
from shviewer.viewer.composing.caption import Caption
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.drawn import DirectSum, Encoded, SplineMap, Surfaces
from shviewer.viewer.overlay.inks import FAINT, GREY, INK, Ink
from shviewer.viewer.overlay.lettering import REGULAR, SEMIBOLD, shortened_to, width_of
from shviewer.viewer.overlay.numerals import share, typeset
from shviewer.viewer.overlay.pieces import Piece, Swatch, Text
from shviewer.viewer.overlay.setting import Part, set_on
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import describe_basis, describe_muted, describe_window
from shviewer.words import counted, grouped, grouped_number, radiance, theta_phi_degrees

HEAD, SECOND, FOOT, SMALL = 15.0, 13.0, 12.0, 11.0
"""Sizes of type, in pixels of the design; the last is that of a compact frame."""

ZEBRA = 11.0

RADIUS = ("radius: square root of magnitude", "radius: root of magnitude", "radius: root")
"""What the radius of a light's surface is, in place of the exposure."""

Words: TypeAlias = tuple[str, list[Part], list[Part]]
"""A head, the parts of what is said about it in their order, and those among them that no picture may hide."""


def caption_blocks(
    picture: Picture, at: Composition, timing: bool
) -> tuple[list[list[Piece]], list[list[Piece]], list[Part]]:
    """The pieces of each pane's head, those of each foot, and what no picture may hide but no pane has room for."""
    heads = [_original_words(picture, at), _reconstruction_words(picture, at)]
    if picture.error_scale is not None:
        heads.append((*_error_words(picture), []))
    elif picture.beside is not None:
        heads.append((*_beside_words(picture, picture.beside), []))
    names = ("original", "reconstruction", "error")
    blocks = [_head(name, *words, places, at) for name, words, places in zip(names, heads, at.captions, strict=False)]
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
    notes = typeset(", ".join([*_notes(picture) * at.compact, *others]))  # elsewhere the second line has the light's
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


def describe_evaluation(picture: Picture, timing: bool) -> str:
    """How the reconstruction is drawn. timing: whether the picture may depend on the machine; if not, the sum is not named."""
    match picture.drawn:
        case DirectSum():
            return "summed per pixel" if timing else ""
        case Encoded():
            return "its formula per pixel"
        case SplineMap(splines):
            height, width = splines.shape[:2]
            return f"from a map of {width} × {height}"
        case Surfaces():
            return ""


def _text(
    name: str, x: float, baseline: float, text: str, size: float, ink: Ink, at: Composition, weight: str = REGULAR
) -> Text:
    return Text(name, x, baseline, text, size, ink, weight, at.px(1.6) if at.over else 0.0)


def _head(
    name: str, head: str, parts: list[Part], must: list[Part], places: Caption, at: Composition
) -> tuple[list[Piece], list[Part]]:
    """A head, shortened in the middle, and the parts of what is said about it on the lines after it.

    Return those of `must`, too, that have no room: not even where the others give way, or after the head.
    """
    size = at.px(12.0 if at.compact else HEAD)
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


def _original_words(picture: Picture, at: Composition) -> Words:
    light = picture.subject.whole
    size = light.about.size
    asked = picture.state.recipe.quantity
    quantity = "original" if asked == RADIANCE else in_words(asked)
    what = f"{size[0]} × {size[1]}" if size else light.description
    suns = len(picture.subject.suns) if isinstance(picture.drawn, Surfaces) else 0
    without = ("without sun" if suns == 1 else "without suns",) if suns else ()
    notes: list[Part] = [(note,) for note in _notes(picture)]
    parts = [] if at.compact else [(quantity,), (what, what.partition(" (")[0]), *notes, without, *_clipped(picture, 0)]
    return picture.light.name, parts, [] if at.compact else notes  # there they stand beside the exposure


def _notes(picture: Picture) -> list[str]:
    """What must not be missed of a light."""
    light = picture.subject.whole
    low_range = "(LDR)" in (light.about.encoding or "")
    return ["LDR"] * low_range + [counted(len(light.notes), "note")] * bool(light.notes)


def _changes(picture: Picture) -> list[Part]:
    """What sets the reconstruction apart from the plain sum of its bands."""
    recipe, suns = picture.state.recipe, len(picture.subject.suns)
    apart = ("sun apart" if suns == 1 else f"{suns} suns apart") if suns else "no sun" * bool(picture.subject.refusal)
    muted, count = describe_muted(recipe), len(recipe.muted_shown)
    fewer = (f"{counted(count, 'band')} muted", f"{count} muted") if muted else ()
    window = describe_window(recipe)
    return [(muted, *fewer), (window, window.partition(" of ")[0], window.partition(" ")[0]), (apart,)]


def _reconstruction_words(picture: Picture, at: Composition) -> Words:
    recipe, view = picture.state.recipe, picture.state.view
    head = f"{caption(recipe)}{counted(recipe.n_bands, 'band')}"
    if view.basis is not None:
        value = float(picture.projection.coefficients[index(*view.basis)] @ LUMINANCE)
        coefficient = f"coefficient {radiance(value, picture.figures.peak)}"
        return typeset(describe_basis(view)), [(coefficient,), ("radius: magnitude",)], []
    changes = _changes(picture)
    if name := view.encode or _encoding_given(recipe):
        encoding = ENCODINGS[name]
        return (
            f"{caption(recipe)}{encoding.words}",
            [(f"{encoding.floats} numbers a channel", f"{encoding.floats} numbers"), *changes],
            changes,
        )
    method, _, missed = picture.projection.method.partition("; ")
    method = "" if any(places.foot for places in at.captions[1:2]) else method
    count = f"{grouped(recipe.n_bands**2)} coefficient{'' if recipe.n_bands == 1 else 's'}"
    may_miss: Part = (_short(missed), _shorter(missed))
    return head, [(count,), *changes, (method,), may_miss, *_clipped(picture, 1)], [*changes, may_miss]


def _encoding_given(recipe: Recipe) -> str:
    """The encoding whose whole irradiance the coefficients are that are compared; "" if they are no such."""
    given = recipe.compare
    if given is None or given.stored is None or (recipe.quantity, recipe.n_bands) != (IRRADIANCE, given.n_bands):
        return ""
    return given.stored.name


def _short(missed: str) -> str:
    """ "features narrower than 3 degrees may be missed" in fewer letters."""
    return re.sub(r" ([\d.]+) degrees", r" \1°", missed.replace("narrower than", "under"))


def _shorter(missed: str) -> str:
    """The same in the fewest: "may miss < 3°"."""
    return re.sub(r"^features under (.*) may be missed$", r"may miss < \1", _short(missed))


def _error_words(picture: Picture) -> tuple[str, list[Part]]:
    signed = ("reconstruction − original", "signed")
    words: dict[str, Part] = {
        "signed": signed,
        "absolute": ("absolute",),
        "relative": ("relative to the original", "relative"),
    }
    kind = "signed" if isinstance(picture.drawn, Surfaces) else picture.state.view.error
    return "error", [words[kind], *_clipped(picture, 2)]


def _beside_words(picture: Picture, second: Beside) -> tuple[str, list[Part]]:
    """Another reconstruction in place of the error: which, and how far it is from the light."""
    reached = share(second.found.sums.relative_l2, floor=second.found.sums.floor)
    what = words_of(picture.state.view.beside, second.found.recipe)
    return f"{what[0].lower()}{what[1:]}", [(f"relative L2 error {reached}", f"error {reached}")]


def _clipped(picture: Picture, pane: int) -> list[Part]:
    """Whether the circle cuts a surface."""
    cut = isinstance(picture.drawn, Surfaces) and picture.drawn.shown[pane].clipped
    return [("cut at the circle", "cut")] if cut else []


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


def describe_suns(picture: Picture) -> str:
    """The greatest sun that was split off, in a few words; "" if none was."""
    if not picture.subject.suns:
        return ""
    theta, phi = theta_phi_degrees(picture.subject.suns[0].axis)
    return f"sun at theta {theta:.0f}°, phi {phi:z.0f}°"
