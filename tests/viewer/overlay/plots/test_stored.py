"""While an encoding is shown, the errors of all of them stand where the curve was, as published."""

from __future__ import annotations

import numpy as np
import pytest
from harmonics.quantities.test_encodings import NAMES
from helpers import frame_of, overlap
from places import kernels
from viewer.overlay.written import pieces_of, texts_of

from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.harmonics.quantities.names import ENCODED_BANDS
from shviewer.harmonics.zonal import Constant
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.convolved import UP
from shviewer.viewer.overlay.letters.numerals import share
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.overlay.pieces import Fill
from shviewer.viewer.overlay.plots.stored import ROWS, stored_errors
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.state import state_of


def shown(name: str, light: str = "venice_sunset", **view: object) -> Picture:
    return prepare(state_of(light, quantity="irradiance", encode=name, n_bands=ENCODED_BANDS[name], **view))


def test_errors_are_the_published_ones_whichever_is_shown() -> None:
    published = kernels()["B"]["venice_sunset"]["figures"]
    for name in ("l1", "geomerics"):
        found = stored_errors(shown(name))
        assert list(found) == list(ENCODINGS) == list(ROWS)
        for key, error in found.items():
            assert error == pytest.approx(published[NAMES[key]]["rel_l2"], abs=2e-5)


@pytest.mark.parametrize(
    ("width", "height", "view"),
    [
        (1280, 640, {}),
        (1280, 720, {"error": "signed"}),
        (500, 1000, {}),
        (640, 320, {}),
        (1280, 640, {"whole_sphere": True}),
    ],
    ids=str,
)
def test_every_encoding_has_a_row_that_touches_no_other_text(width: int, height: int, view: dict[str, object]) -> None:
    picture = shown("zh3-shared", **view)
    drawn = draw_overlay(picture, frame_of(picture, width, height))
    said = {text.name: text.text for text in texts_of(drawn)}
    for name, encoding in ENCODINGS.items():
        assert said[f"stored_{name}_floats"] == str(encoding.floats)
        assert said[f"stored_{name}_error"] == share(stored_errors(picture)[name] or 0.0)
    boxes = [box for name, box in drawn.boxes.items() if name in said]
    for number, box in enumerate(boxes):
        assert 0 <= box.left < box.right <= width
        assert not any(overlap(box, other) for other in boxes[:number])
    assert not drawn.bars  # no band to click


def test_bars_are_as_long_as_their_errors_from_zero() -> None:
    picture = shown("l2")
    drawn = draw_overlay(picture, frame_of(picture))
    bars = [piece.box for piece in pieces_of(drawn) if isinstance(piece, Fill) and 6 <= piece.box.height <= 10]
    errors = [error or 0.0 for error in stored_errors(picture).values()]
    assert len(bars) == len(errors)
    for bar, error in zip(bars, errors, strict=True):
        assert bar.width == pytest.approx(error / errors[0] * bars[0].width, abs=1.1)


def test_what_an_encoding_cannot_have_is_none_and_the_numbers_stand_for_the_energy() -> None:
    below = LobeLight((Lobe(Constant(), UP, -np.ones(3)),))
    dark = prepare(state_of(below, quantity="irradiance", encode="l1", n_bands=2))
    assert stored_errors(dark)["l2-deringed"] is None  # no factors take a negative mean away
    said = {text.name: text.text for text in texts_of(draw_overlay(dark, frame_of(dark)))}
    assert said["stored_l2-deringed_error"] == "none"
    assert (said["numbers"], "energy" in said) == ("4", False)
    roughness = shown("l1", by_roughness=True)
    assert "steps_sentence" in {text.name for text in texts_of(draw_overlay(roughness, frame_of(roughness)))}
