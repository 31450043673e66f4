"""The answers, in the largest type, and the figures under them with samples of how the spheres are coded."""

from __future__ import annotations

from shviewer.analysis.figures import PENDING, Pending
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE, in_words, roughness_of
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Cell
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.lettering import GREY, INK, MEDIUM, REGULAR, width_of
from shviewer.viewer.overlay.numerals import bound_text, share, typeset, value
from shviewer.viewer.overlay.pieces import Piece, Swatch, Text
from shviewer.viewer.picture import Picture

UNIT = 0.61
"""The type of the word "bands" after an answer, in sizes of the answer."""

SWATCH = 12.0


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
        if after + width_of(word, UNIT * size) <= cell.right:
            pieces.append(Text(f"{name}_unit", after, cell.value, word, UNIT * size, INK))
        what = looked_at(picture.state.recipe.quantity) if name == "radiance" else name
        labels = [f"{what} {within}{more}" for more in reversed(rest)] + [f"{what} {within}", what]
        pieces += _label(f"{name}_label", cell, labels, label_size)
    return pieces


def figure_pieces(picture: Picture, at: Composition) -> list[Piece]:
    """Error, largest error, lowest channel, negative area, and the energy in use."""
    figures, numbers = picture.figures, at.numbers
    extremes, peak = picture.extremes, figures.peak
    rest = " of rest" if picture.subject.suns else ""
    error = minimum = negative = str(PENDING)
    error_bound = minimum_bound = found = ""
    if not isinstance(extremes, Pending):
        error, minimum = value(extremes.max_error, peak), value(extremes.minimum, peak)
        negative = share(extremes.negative_area, 2)
        error_bound = bound_text(extremes.max_error, extremes.max_error_bound, peak)
        minimum_bound = bound_text(extremes.minimum, extremes.minimum_bound, peak) if extremes.minimum < 0 else ""
        if extremes.max_error_bound is None:  # a Python function is known only where it was looked at
            found = " found"
    rows = (
        (
            "relative_l2",
            share(figures.relative_l2, floor=figures.floor),
            "",
            f"relative L2 error{rest}",
            f"L2 error{rest}",
            "L2 error",
        ),
        (
            "max_error",
            error,
            error_bound,
            f"largest error{found}{rest}",
            f"largest{found}{rest}",
            f"largest{found}",
            "largest",
        ),
        (
            "minimum",
            minimum,
            minimum_bound,
            "lowest channel",
            "lowest",
        ),
        ("negative_area", negative, "", "luminance < 0", "negative"),
        ("energy", share(energy_in_use(picture), 2), "", "energy in use", "energy"),
    )
    pieces: list[Piece] = []
    label_size = at.px(numbers.label_size)
    for (name, said, bound, *labels), cell in zip(rows, numbers.figures, strict=False):
        weight = MEDIUM if name == "relative_l2" else REGULAR
        room = cell.right - cell.left - at.px(4)
        size = at.px(numbers.figure_size)
        size = max(min(size, size * room / width_of(said, size, weight)), label_size)
        both = width_of(said, size, weight) + width_of(bound, label_size)
        if bound and room < both <= 1.12 * room:  # a little smaller, both have room
            size, bound_size = size * room / both, max(label_size * room / both, at.px(12.0))
        else:
            bound_size = label_size
        pieces.append(Text(name, cell.left, cell.value, said, size, INK, weight))
        x = cell.left + width_of(said, size, weight)
        if bound and x + width_of(bound, bound_size) <= cell.left + room + 1:
            pieces.append(Text(f"{name}_bound", x, cell.value, bound, bound_size, GREY))
            x += width_of(bound, bound_size)
        pieces += _swatch(name, picture, x, cell, at)
        pieces += _label(f"{name}_label", cell, labels if not numbers.short else labels[1:], label_size)
    return pieces


def looked_at(quantity: str) -> str:
    """What the first answer and the white line are of: the radiance, or what a glossy surface reflects if that is shown."""
    return RADIANCE if quantity == IRRADIANCE else in_words(quantity)


def energy_in_use(picture: Picture) -> float:
    """The share of the light's energy in the bands as they are shown: muted ones hold none, a window keeps a part."""
    figures = picture.figures
    parts = zip(figures.energy_share, figures.factors, strict=False)
    kept = sum(energy * min(max(factor, 0.0), 1.0) ** 2 for energy, factor in parts)
    return kept if kept < 1 - 5e-5 else 1.0


def _swatch(name: str, picture: Picture, x: float, cell: Cell, at: Composition) -> list[Piece]:
    extremes = picture.extremes
    if isinstance(extremes, Pending):
        return []
    kind = {"minimum": "lines", "negative_area": "negative"}.get(name)
    side = at.px(SWATCH * (0.8 if at.compact else 1.0))
    shown = extremes.minimum < -1e-6 * extremes.peak if kind == "lines" else extremes.negative_area > 0
    left = round(x + 0.6 * side)
    if kind is None or not shown or left + side > cell.right - 0.4 * side:
        return []
    if at.compact and kind == "lines":
        return []
    bottom = round(cell.value + 1)
    return [
        Swatch(
            Box(left, bottom - round(side), left + round(side), bottom),
            kind,
            max(at.scale * (0.8 if at.compact else 1.0), 0.8),
            f"{name}_swatch",
        )
    ]


def _label(name: str, cell: Cell, labels: list[str], size: float) -> list[Piece]:
    """The longest label that has room in its column; the last in any case."""
    room = cell.right - cell.left - 0.9 * size  # or it would read on in the next
    said = next((text for text in labels if width_of(text, size) <= room), labels[-1])
    return [Text(name, cell.left, cell.label, said, size, GREY)]
