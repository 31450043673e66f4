"""The steps say at a glance which roughness the bands in use serve, and agree with the sentence under them."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import pytest
from viewer.overlay.written import pieces_of, texts_of

from shviewer.analysis.figures import PENDING
from shviewer.analysis.roughness import ROUGHNESS, staircase
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.control.keys import press
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.overlay.pieces import Curve, Fill
from shviewer.viewer.overlay.plots.steps import LABELS, steps_pieces
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.state import State, state_of


def shown(light: str = "st_fagans_interior", **values: object) -> Picture:
    return prepare(state_of(light, by_roughness=True, **values))


def test_the_sentence_under_the_steps_is_that_of_the_light_and_its_bands() -> None:
    overlay = draw_overlay(shown(n_bands=9), compose(1280, 640))
    (said,) = [text.text for text in texts_of(overlay) if text.name == "steps_sentence"]
    assert said.replace("\u2009", " ").replace("\u202f", " ") == staircase(shown(n_bands=9).state.recipe).sentence(9)
    assert overlay.bars == {}


@pytest.mark.parametrize("size", [(1280, 640), (900, 500), (1920, 1080), (2560, 900)])
@pytest.mark.parametrize("n_bands", [1, 3, 9, 128])
def test_no_texts_of_the_steps_overlap(size: tuple[int, int], n_bands: int) -> None:
    texts = texts_of(draw_overlay(shown("sun-sky", n_bands=n_bands), compose(*size)))
    for one, two in combinations(texts, 2):
        assert not one.box.overlaps(two.box), (one.name, two.name)


def test_the_lit_part_under_the_axis_is_what_the_bands_serve() -> None:
    picture = shown("sun-sky", n_bands=4)
    at = compose(1280, 640)
    steps = staircase(picture.state.recipe)
    ((low, high),) = steps.served(4)
    pieces = steps_pieces(steps, picture, at)
    (lit,) = [piece.box for piece in pieces if isinstance(piece, Fill) and piece.name.startswith("served")]
    box = at.numbers.curve
    assert box is not None
    left, right = box.left + at.px(LABELS), box.right
    for place, roughness in ((lit.left, low), (lit.right, high)):
        share = (roughness - ROUGHNESS[0]) / (ROUGHNESS[-1] - ROUGHNESS[0])
        assert place == pytest.approx(left + share * (right - left), abs=1)


def test_what_needs_more_bands_than_there_are_is_off_the_chart_and_pending_figures_draw_no_steps() -> None:
    picture, at = shown("sun-sky", n_bands=9), compose(1280, 640)
    curves = [piece for piece in steps_pieces(staircase(picture.state.recipe), picture, at) if isinstance(piece, Curve)]
    assert len(curves) == 1
    assert curves[0].points[0][0] > at.numbers.curve.left + at.px(LABELS) + 5
    pending = draw_overlay(replace(picture, needs=PENDING), at)
    assert "steps_sentence" not in pending.boxes
    assert not any(isinstance(piece, Curve) and piece.name == "steps" for piece in pieces_of(pending))


def test_the_quantity_shown_has_its_dot() -> None:
    at = compose(1280, 640)
    for quantity, dots in (("radiance", 0), ("irradiance", 1), ("glossy:0.4", 1)):
        boxes = draw_overlay(shown("green", quantity=quantity), at).boxes
        assert ("roughness_shown" in boxes) == bool(dots)


def test_J_goes_there_and_back() -> None:
    there = press(State(), "J")
    assert isinstance(there, State)
    assert there.view.by_roughness
    assert press(there, "J") == State()


@pytest.mark.parametrize("n_bands", [4, 16])
def test_both_axes_are_named(n_bands: int) -> None:
    boxes = draw_overlay(prepare(state_of(by_roughness=True, n_bands=n_bands)), compose(1280, 640))
    said = {piece.name: piece.text for piece in texts_of(boxes)}
    assert said["roughness_axis"] == "roughness"
    assert "16 bands" in said.values()
