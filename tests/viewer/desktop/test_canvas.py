"""What a window lays over its frames, without a window."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from helpers import centre, frame_of, picture_of

from shviewer.lights.function import FunctionLight
from shviewer.viewer.desktop.canvas import Canvas
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.overlay.letters.lettering import mask
from shviewer.viewer.screenshot import offscreen


@pytest.fixture
def canvas(renderer: Renderer) -> Iterator[Canvas]:
    made = Canvas(renderer.context)
    yield made
    made.release()
    renderer.rest.use()


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


def test_the_first_help_is_written_a_text_at_a_time(canvas: Canvas) -> None:
    """Each go_on without time to spare draws one part; a text may be drawn with a casing, too."""
    shown, passes, most = picture_of(help_visible=True, evaluate="direct"), 0, 0
    frame = frame_of(shown, 717, 411)  # of a size that no other test has written in
    with offscreen(canvas.renderer, frame) as target:
        canvas.screen = target
        canvas.show(shown, frame)
        canvas.begin(frame)
        whole, last = False, mask.cache_info().misses
        while not whole:
            whole = canvas.go_on(0.0)
            passes, most, last = passes + 1, max(most, mask.cache_info().misses - last), mask.cache_info().misses
    assert canvas.overlay is not None
    assert passes > sum(len(block) for block in canvas.overlay.blocks) > 50
    assert 1 <= most <= 2


CHANGES: dict[str, dict[str, Any]] = {
    "camera": {"camera": (5.0, 6.0)},
    "light": {"light_rotation": (0.0, 0.0, 1.0, 0.0)},
    "exposure": {"exposure_offset": 1.0},
    "marks": {"marks": False},
    "zoom": {"zoom": 1.5},
    "bands": {"n_bands": 6},
    "tone": {"tone": "reinhard"},
    "error": {"error": "signed"},
    "map": {"whole_sphere": True},
    "surfaces": {"lobe_view": True},
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_is_written_over_panes_draws_none_of_them_and_what_changes_them_draws_all(
    canvas: Canvas, monkeypatch: pytest.MonkeyPatch, change: str
) -> None:
    draw, panes = canvas.renderer.panes.draw, 0

    def counted(*given: Any, **named: Any) -> None:
        nonlocal panes
        panes += 1
        draw(*given, **named)

    monkeypatch.setattr(canvas.renderer.panes, "draw", counted)
    first, other = picture_of(), picture_of(**CHANGES[change])
    for shown in (first, other, first):
        frame, counts = frame_of(shown, 320, 200), []
        with offscreen(canvas.renderer, frame) as target:
            canvas.screen = target
            for pointer in ((80.0, 80.0), (81.0, 80.0), (82.0, 80.0), (83.0, 80.0), (240.0, 82.0)):
                before = panes
                canvas.show(shown, frame, pointer=pointer)
                while True:
                    canvas.begin(frame, pointer)
                    assert canvas.go_on()
                    if not canvas.again:  # a sum that seemed slow is drawn once more
                        break
                counts.append(panes - before)
            pixels = target.read()
            canvas.renderer.draw(target, frame, canvas.layers(frame, pointer))
            assert target.read() == pixels
        assert counts[-1] == 0
        assert counts[0] > 0 or shown.state.view.lobe_view
