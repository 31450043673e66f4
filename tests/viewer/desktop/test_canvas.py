"""What a window lays over its frames, without a window."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from helpers import centre, frame_of, picture_of

from shviewer.lights.function import FunctionLight
from shviewer.viewer.desktop.canvas import Canvas
from shviewer.viewer.gl.renderer import Renderer


@pytest.fixture
def canvas(renderer: Renderer) -> Iterator[Canvas]:
    made = Canvas(renderer.context)
    yield made
    renderer.rest.use()
    made.release()


def test_the_pointer_adds_its_values_over_a_sphere_and_nothing_beside_it(canvas: Canvas) -> None:
    shown = picture_of(error="signed")
    canvas.show(shown, frame_of(shown))
    plain = len(canvas.layers(frame_of(shown)))
    sphere = frame_of(shown).spheres[1]
    assert len(canvas.layers(frame_of(shown), (sphere.x, sphere.y))) == plain + 3  # the numbers, and two crosses
    assert len(canvas.layers(frame_of(shown), (3.0, 3.0))) == plain


def test_a_light_that_fails_in_one_direction_does_not_end_the_program(canvas: Canvas) -> None:
    def touchy(directions: np.ndarray) -> np.ndarray:
        if len(directions) == 1:
            raise ValueError("never alone")
        return np.asarray(1 + directions[:, 2])

    shown = picture_of(light=FunctionLight(touchy, "touchy"))
    canvas.show(shown, frame_of(shown))
    sphere = frame_of(shown).spheres[0]
    assert len(canvas.layers(frame_of(shown), (sphere.x, sphere.y))) == len(canvas.layers(frame_of(shown)))


def test_the_values_of_the_band_under_the_pointer_are_in_place_of_the_legend(canvas: Canvas) -> None:
    shown = picture_of()
    canvas.show(shown, frame_of(shown))
    assert canvas.overlay is not None
    legend, slot = set(canvas.overlay.boxes), centre(canvas.overlay.bars[3])
    assert canvas.band_at(slot) == 3
    canvas.show(shown, frame_of(shown), pointer=slot)
    assert "hovered" in set(canvas.overlay.boxes) - legend
    canvas.show(shown, frame_of(shown), pointer=(3.0, 3.0))
    assert set(canvas.overlay.boxes) == legend


def test_turning_writes_nothing_anew_and_a_band_does(canvas: Canvas) -> None:
    shown = picture_of()
    canvas.show(shown, frame_of(shown))
    written = canvas.overlay
    for changes in ({"camera": (3.0, 4.0)}, {"light_rotation": (0.0, 0.0, 1.0, 0.0)}):
        turned = picture_of(**changes)
        canvas.show(turned, frame_of(turned))
        assert canvas.overlay is written
    canvas.show(picture_of(n_bands=6), frame_of(shown))
    assert canvas.overlay is not written
