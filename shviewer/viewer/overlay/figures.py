"""The answers, in the largest type, and the figures under them with samples of how the spheres are coded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor
from typing import TypeAlias

from shviewer.analysis.figures import PENDING, Pending
from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE, in_words, roughness_of
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Cell
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.inks import GREY, INK
from shviewer.viewer.overlay.letters.lettering import MEDIUM, REGULAR, width_of
from shviewer.viewer.overlay.letters.numerals import bound_text, share, typeset, value
from shviewer.viewer.overlay.pieces import Piece, Swatch, Text
from shviewer.viewer.picture import Picture

UNIT = 0.61
"""The type of the word "bands" after an answer, in sizes of the answer."""

SWATCH, COLUMN_GAP, BOUND_GAP = 12.0, 12.0, 9.0
"""The side of a sample, and the space after a figure, or the bound after it, before the next column; pixels of the design."""

SMALLER = 0.9
"""How much smaller than it should be a value with a bound may be set."""


def answer_pieces(picture: Picture, at: Composition) -> list[Piece]:
    """How many bands are enough: for looking, and for shading."""
    needs, numbers = picture.needs, at.numbers
    counts: tuple[int | Pending | None, ...] = (PENDING, PENDING)
    if not isinstance(needs, Pending):
        glossy = roughness_of(picture.state.recipe.quantity) is not None
        counts = needs.shown if glossy else needs.radiance, needs.irradiance
    size, label_size = at.px(numbers.answer_size), at.px(numbers.label_size)
    within = typeset(f"within {100 * picture.state.recipe.tolerance:g} %")
    rest = ["", ", of the rest"] if picture.subject.suns else [""]
    pieces: list[Piece] = []
    for name, count, cell in zip(("radiance", "shading"), counts, numbers.answers, strict=False):
        said = str(count)
        if count is None and not isinstance(needs, Pending):
            said = f"> {needs.searched}"
        pieces.append(Text(f"{name}_answer", cell.left, cell.value, said, size, INK, MEDIUM))
        after = cell.left + width_of(said, size, MEDIUM) + 0.2 * size
        word = "band" if count == 1 else "bands"
        if after + width_of(word, UNIT * size) <= cell.right - 0.4 * size:
            pieces.append(Text(f"{name}_unit", after, cell.value, word, UNIT * size, INK))
        what = looked_at(picture.state.recipe.quantity) if name == "radiance" else name
        labels = [f"{what} {within}{more}" for more in reversed(rest)] + [f"{what} {within}", what]
        pieces.append(_label(f"{name}_label", cell, labels, label_size))
    return pieces


Wording: TypeAlias = tuple[str, str]
"""A value, and the bound after it or ""."""


@dataclass(frozen=True)
class _Figure:
    """A figure under the spheres. Of what is said and of the labels, the longest wording is the first."""

    name: str
    said: Sequence[Wording]
    labels: tuple[str, ...]
    sample: str = ""
    """The kind of swatch that shows how it is drawn."""


def figure_pieces(picture: Picture, at: Composition) -> list[Piece]:
    """Error, largest error, lowest channel, negative area, and the energy in use or what an encoding keeps."""
    found = zip(_figures(picture, at), at.numbers.figures, strict=False)
    return [piece for figure, cell in found for piece in _figure(figure, cell, at)]


def _figures(picture: Picture, at: Composition) -> list[_Figure]:
    figures, extremes, peak = picture.figures, picture.extremes, picture.figures.peak
    rest = " of rest" if picture.subject.suns else ""
    errors = [(share(figures.relative_l2, digits, figures.floor), "") for digits in (3, 2, 1)]
    errors += [(typeset("< 0.01 %"), "")] if figures.relative_l2 < 1e-5 else []
    errors += [(typeset("> 99.9 %"), "")] if 0.999 < figures.relative_l2 < 1 else []
    largest = lowest = negative = [(str(PENDING), "")]
    only, lines, area = "", "", ""
    if not isinstance(extremes, Pending):
        largest = _wordings(extremes.max_error, extremes.max_error_bound, peak)
        lowest = _wordings(extremes.minimum, extremes.minimum_bound if extremes.minimum < 0 else None, peak)
        negative = [(share(extremes.negative_area, 2), "")]
        only = " found" if extremes.max_error_bound is None else ""  # a function is known only where it was looked at
        lines = "lines" if extremes.minimum < -1e-6 * peak and not at.compact else ""
        area = "negative" if extremes.negative_area > 0 else ""
    return [
        _Figure(
            "relative_l2",
            errors,
            (f"relative L2 error{rest}", f"L2 error{rest}", "L2 error"),
        ),
        _Figure(
            "max_error", largest, (f"largest error{only}{rest}", f"largest{only}{rest}", f"largest{only}", "largest")
        ),
        _Figure("minimum", lowest, ("lowest channel", "lowest"), lines),
        _Figure("negative_area", negative, ("luminance < 0", "negative"), area),
        _last_figure(picture),
    ]


def _last_figure(picture: Picture) -> _Figure:
    """The energy in use; while an encoding is shown, how many numbers it keeps."""
    if encoding := picture.state.view.encode:
        return _Figure("numbers", [(str(ENCODINGS[encoding].floats), "")], ("numbers a channel", "numbers"))
    return _Figure("energy", [(share(energy_in_use(picture), 2), "")], ("energy in use", "energy"))


def _wordings(found: float, bound: float | None, peak: float) -> list[Wording]:
    """An extreme and its bound, in fewer and fewer digits."""
    bounds = dict.fromkeys(bound_text(found, bound, peak, digits) for digits in (3, 2))
    said = [(value(found, peak), bound) for bound in bounds]
    return said + [(value(found, peak, digits), "") for digits in (3, 2, 1)]


def _figure(figure: _Figure, cell: Cell, at: Composition) -> list[Piece]:
    """A value with its bound, its sample, and its label, which end before the next column begins."""
    numbers, name = at.numbers, figure.name
    weight = MEDIUM if name == "relative_l2" else REGULAR
    room, label_size = cell.right - cell.left - at.px(COLUMN_GAP), at.px(numbers.label_size)
    sizes = at.px(numbers.figure_size), label_size, at.small
    spare = at.px(COLUMN_GAP - BOUND_GAP)
    (said, bound), size, bound_size = _fitting(figure.said, room, sizes, weight, spare)
    pieces: list[Piece] = [Text(name, cell.left, cell.value, said, size, INK, weight)]
    if bound:
        pieces.append(Text(f"{name}_bound", pieces[0].box.right, cell.value, bound, bound_size, GREY))
    side = round(at.px(SWATCH * (0.8 if at.compact else 1.0)))
    after, beside = 0.6 * side, cell.left + room - pieces[-1].box.right
    labelled = bool(figure.sample) and beside < after + side  # no room: it stands after the label
    label = _label(f"{name}_label", cell, figure.labels[numbers.short :], label_size, after + side if labelled else 0.0)
    pieces.append(label)
    if figure.sample:
        last, baseline = (label, cell.label) if labelled else (pieces[-2], cell.value)
        left, bottom = round(last.box.right + after), round(baseline + 1)
        scale = max(at.scale * (0.8 if at.compact else 1.0), 0.8)
        if left + side <= cell.left + room:
            pieces.append(Swatch(Box(left, bottom - side, left + side, bottom), figure.sample, scale, f"{name}_swatch"))
    return pieces


def _fitting(
    wordings: Sequence[Wording], room: float, sizes: tuple[float, float, float], weight: str, spare: float = 0.0
) -> tuple[Wording, float, float]:
    """The first wording that has room, with the sizes of the value and of the bound: best as large as the other figures.

    sizes: of a value, of a label, and the least. A value that stands alone becomes as small as labels before it loses
    digits. spare: more room, which only a bound may take.
    """
    size, label, least = sizes
    for large, small in ((size, label), (SMALLER * size, least)):
        for said, bound in wordings:
            if bound and width_of(said, large, weight) + width_of(bound, small) <= room + spare:
                return (said, bound), large, small
    for said, bound in wordings:
        alone = min(size, floor(4 * size * room / width_of(said, size, weight)) / 4)  # type has quarters of a pixel
        alone -= 0.25 if width_of(said, alone, weight) > room else 0.0  # and raised digits have rounded ones
        if not bound and alone >= label:
            return (said, ""), alone, label
    return wordings[-1], label, label


def looked_at(quantity: str) -> str:
    """What the first answer and the white line are of: the radiance, or what a glossy surface reflects if that is shown."""
    return RADIANCE if quantity == IRRADIANCE else in_words(quantity)


def energy_in_use(picture: Picture) -> float:
    """The share of the light's energy in the bands as they are shown: muted ones hold none, a window keeps a part."""
    figures = picture.figures
    parts = zip(figures.energy_share, figures.factors, strict=False)
    kept = sum(energy * min(max(factor, 0.0), 1.0) ** 2 for energy, factor in parts)
    return kept if kept < 1 - 5e-5 else 1.0


def _label(name: str, cell: Cell, labels: Sequence[str], size: float, kept: float = 0.0) -> Text:
    """The longest label that has room in its column, of which some pixels are kept free; the last in any case."""
    room = cell.right - cell.left - 0.9 * size - kept  # or it would read on in the next
    said = next((text for text in labels if width_of(text, size) <= room), labels[-1])
    return Text(name, cell.left, cell.label, said, size, GREY)
