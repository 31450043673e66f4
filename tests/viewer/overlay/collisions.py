"""What is wrong with a frame's text, in words: boxes that meet, that are cut, that run together or that are said twice."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator

from viewer.overlay.written import pieces_of, texts_of

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.directions.marks import Placed, place_marks
from shviewer.viewer.overlay.overlay import Overlay
from shviewer.viewer.overlay.pieces import Strip, Swatch, Text
from shviewer.viewer.picture import Picture

APART = 0.45
"""The least space between two texts on one line that are not one phrase, in sizes of the smaller: a word space is 0.28."""

FIGURES = ("relative_l2", "max_error", "minimum", "negative_area", "energy")


def faults(picture: Picture, at: Composition, drawn: Overlay) -> list[str]:
    """Everything that is wrong with what is written over a picture in a frame."""
    marks = place_marks(picture, at, tuple(drawn.boxes.values()))
    return [
        *_cut(at, drawn),
        *_meeting(drawn),
        *_running_on(drawn),
        *_too_near(at, drawn),
        *_said_twice(drawn),
        *_marks(at, drawn, marks),
    ]


def _cut(at: Composition, drawn: Overlay) -> Iterator[str]:
    """Texts and samples that leave the frame, or that lie on the hairline."""
    line, alone = at.hairline, "help_title" not in drawn.boxes  # the help has a rule of its own
    for piece in pieces_of(drawn):
        if isinstance(piece, Text | Swatch | Strip):
            box = piece.box
            if not (min(box.left, box.top) >= 2 and box.right <= at.width - 2 and box.bottom <= at.height - 1):
                yield f"{piece.name} is cut"
            if alone and line.right <= at.width and line.bottom <= at.height and box.overlaps(line):
                yield f"{piece.name} lies on the hairline"


def _meeting(drawn: Overlay) -> Iterator[str]:
    """Texts and samples that meet. Numbers of rings may stand on bars and lines, and over each other."""
    pieces = [piece for piece in pieces_of(drawn) if isinstance(piece, Text | Swatch | Strip)]
    pieces = [piece for piece in pieces if not piece.name.startswith("ring_")]
    for one, two in itertools.combinations(pieces, 2):
        if shrunk(one.box).overlaps(two.box):
            yield f"{one.name} meets {two.name}"


def _running_on(drawn: Overlay) -> Iterator[str]:
    """Texts on one baseline that read on in the next: neighbours of different columns or kinds."""
    texts = [piece for piece in texts_of(drawn) if not piece.name.startswith(("ring_", "band_"))]
    for one, two in itertools.permutations(texts, 2):
        if abs(one.baseline - two.baseline) > 2 or _phrase(one.name) == _phrase(two.name):
            continue
        if one.x < two.x and two.x - one.right < APART * min(one.size, two.size):
            yield f"{one.name} runs on in {two.name}: {one.text!r} {two.text!r}"


def _too_near(at: Composition, drawn: Overlay) -> Iterator[str]:
    """Figures, or the samples after them, that nearly touch the figure in the next column."""
    figures = [text for text in texts_of(drawn) if text.name in FIGURES]
    samples = [piece for piece in pieces_of(drawn) if isinstance(piece, Swatch) and piece.name.endswith("_swatch")]
    for one, two in itertools.product([*figures, *samples], figures):
        if one.box.top < two.baseline < one.box.bottom + 2 and one.box.left < two.x < one.box.right + 11 * at.scale:
            yield f"{one.name} nearly touches {two.name}"


def _phrase(name: str) -> str:
    """The phrase that a text belongs to."""
    for end in ("_bound", "_unit", "_answer"):
        name = name.removesuffix(end)
    return "keys" if name.startswith("key_") else name


def _said_twice(drawn: Overlay) -> Iterator[str]:
    """Sentences that stand twice: not names of keys and lines, and not what two panes have alike."""
    names = ("key_", "legend_", "in_use", "count_", "radiance_label", "stored_", *FIGURES)
    said = [piece.text for piece in texts_of(drawn) if not piece.name.startswith(names)]
    for text, count in Counter(said).items():
        if count > 1 and " " in text and not text.startswith(("radius", "cut at", ">")):
            yield f"said twice: {text!r}"


def _marks(at: Composition, drawn: Overlay, marks: dict[str, Placed]) -> Iterator[str]:
    """Words of marks that are cut or that touch other text, and lines to them that cross it."""
    for name, mark in marks.items():
        roomy = all(sphere.radius > 160 * at.scale for sphere in at.spheres)
        if mark.label is None and mark.behind and roomy:
            yield f"{name} is behind and has no words"
        boxes = [mark.label] if mark.label else []
        boxes += [other.label for key, other in marks.items() if key > name and other.label]
        for one, two in itertools.combinations(boxes, 2):
            if one.overlaps(two):
                yield f"words of {name} meet those of another mark"
        for box in boxes[:1]:
            if not (min(box.left, box.top) >= 2 and box.right <= at.width - 2 and box.bottom <= at.height - 2):
                yield f"words of {name} are cut"
            if box.overlaps(at.hairline):
                yield f"words of {name} lie on the hairline"
            if at.maps and not any(pane.clip.top <= box.top and box.bottom <= pane.clip.bottom for pane in at.maps):
                yield f"words of {name} are cut where their map ends"
        for layer in mark.layers:
            rows, columns = (layer.image[..., 3] > 100).nonzero()
            for text, box in ((text, shrunk(box)) for text, box in drawn.boxes.items()):
                inside = (columns + layer.left + 1 > box.left) & (columns + layer.left < box.right)
                if (inside & (rows + layer.top + 1 > box.top) & (rows + layer.top < box.bottom)).any():
                    yield f"{name} is drawn on {text}"
        if mark.behind and mark.label:
            for text, box in drawn.boxes.items():
                beside = max(box.left - mark.label.right, mark.label.left - box.right)
                over = max(box.top - mark.label.bottom, mark.label.top - box.bottom)
                if beside < 10 * at.scale and over < 3 * at.scale:
                    yield f"words of {name} stand too near to {text}: {beside:.0f} beside, {over:.0f} over"


def shrunk(box: Box) -> Box:
    return Box(box.left + 1, box.top + 1, box.right - 1, box.bottom - 1)
