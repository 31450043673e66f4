"""Third sphere, marks, tone, surfaces, sheets and the values under the mouse, with real keys and a real mouse."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from viewer.desktop.desktop import PATIENCE, Viewer, output_of, screenshot

Start = Callable[..., Viewer]

MODES = {
    "d": ["--error", "signed"],
    "x": ["--no-marks"],
    "o": ["--tone", "reinhard"],
    "v": ["--lobes"],
    "Tab": ["--basis", "0", "0"],
}


@pytest.mark.parametrize("key", MODES)
def test_a_key_shows_what_its_option_writes(start: Start, tmp_path: Path, key: str) -> None:
    viewer = start("studio", "--bands", "6")
    viewer.press(key, "frame")
    pixels, _ = viewer.saved_picture()
    np.testing.assert_array_equal(pixels, screenshot(tmp_path, "studio", "--bands", "6", *MODES[key]))


def test_d_goes_through_all_errors_and_back_to_two_spheres(start: Start) -> None:
    viewer = start()
    seen = []
    for _ in range(5):
        viewer.press("d", "frame")
        described = json.loads(viewer.saved_picture()[1])
        third = described["error"] or described["beside"]
        seen.append((third["kind"] if third else None, len(described["spheres"])))
    assert seen == [("signed", 3), ("absolute", 3), ("relative", 3), ("method", 3), (None, 2)]


def test_tab_steps_through_the_basis_and_shift_tab_back(start: Start) -> None:
    viewer = start("--bands", "3")
    seen = []
    for key in ("Tab", "Tab", "Tab", "shift+Tab", "shift+Tab", "shift+Tab", "shift+Tab"):
        viewer.press(key, "frame")
        seen.append(json.loads(viewer.saved_picture()[1])["basis"])
    assert seen == [[0, 0], [1, -1], [1, 0], [1, -1], [0, 0], None, [2, 2]]


def test_a_saved_picture_is_summed_even_where_the_window_draws_from_a_map(start: Start, tmp_path: Path) -> None:
    viewer = start("--bands", "20", "--evaluate", "auto")
    pixels, described = viewer.saved_picture()
    assert json.loads(described)["evaluated"] == "direct"
    np.testing.assert_array_equal(pixels, screenshot(tmp_path, "green", "--bands", "20"))


def test_the_mouse_over_a_sphere_draws_a_frame_and_elsewhere_none(start: Start) -> None:
    viewer = start("--evaluate", "direct")  # so that no frame is drawn again for its time
    viewer.mouse("640,630")
    viewer.press("Up", "6 bands")  # whatever the first move drew is behind us
    viewer.forget()
    viewer.mouse("300,260")
    viewer.wait_for("frame")
    viewer.mouse("640,630")
    viewer.wait_for("frame")  # and one that takes the numbers away
    viewer.rest()
    begin = len(viewer.seen)
    viewer.mouse("645,632")
    viewer.mouse("650,628")
    viewer.press("Down", "5 bands")
    assert [line for line in viewer.seen[begin:] if "6 bands" in line] == []


SCRIPT = """
import json
import operator
import sys
from shviewer.viewer.desktop import canvas
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.state import state_of
from shviewer.viewer.control.placing import orbit, rotate_light

drawn = []
draw_overlay = canvas.draw_overlay
canvas.draw_overlay = lambda *a, **k: (drawn.append(1), draw_overlay(*a, **k))[1]
said = {}
with window.open_window((800, 400)) as handle:
    shown = window_of(handle, state_of(evaluate=sys.argv[1], n_bands=int(sys.argv[2])))
    for _ in range(4):
        shown.frame()
    said["evaluated"] = type(shown.session.picture.drawn).__name__
    before, count = [*vars(shown.session.picture.drawn).values()], len(drawn)
    for _ in range(5):
        shown.change(orbit(shown.session.placed, 0.1, 0.05))
        shown.frame()
        shown.change(rotate_light(shown.session.placed, 0.1, 0.05))
        shown.frame()
    shown._on_cursor(handle, 200.0, 150.0)
    shown.frame()
    said["redrawn by turning and pointing"] = len(drawn) - count
    said["same map"] = all(map(operator.is_, vars(shown.session.picture.drawn).values(), before))
    composition = shown.composition()
    assert shown.hovering
    said["layers of the probe"] = len(shown.canvas.layers(composition, shown.mouse.at)) - len(shown.canvas.layers(composition))
    shown._on_enter(handle, 0)
    assert not shown.hovering
    said["error"] = shown.canvas.renderer.context.error
    count = len(drawn)
    shown.press("X")
    shown.frame()
    said["redrawn by a key"] = len(drawn) - count
print(json.dumps(said))
"""


def window_says(display: str, *arguments: str) -> dict[str, object]:
    printed = output_of(display, SCRIPT, *arguments)
    said = json.loads(printed)
    assert isinstance(said, dict)
    return said


@pytest.mark.parametrize(("evaluate", "drawn"), [("direct", "DirectSum"), ("map", "SplineMap")])
def test_turning_and_pointing_write_nothing_anew(display: str, evaluate: str, drawn: str) -> None:
    said = window_says(display, evaluate, "5")
    assert said == {
        "evaluated": drawn,
        "redrawn by turning and pointing": 0,
        "same map": True,
        "layers of the probe": 2,  # the numbers, and a cross on the other sphere
        "error": "GL_NO_ERROR",
        "redrawn by a key": 1,
    }


def test_a_frame_that_is_too_slow_by_the_sum_is_drawn_from_a_map(display: str) -> None:
    """32 bands take a software renderer hundreds of milliseconds; a graphics processor sums them in time, and may."""
    said = window_says(display, "auto", "32")
    assert said["evaluated"] in ("SplineMap", "DirectSum")
    if "llvmpipe" in renderer_name(display):
        assert said["evaluated"] == "SplineMap"


def renderer_name(display: str) -> str:
    script = (
        "from shviewer.viewer.desktop import window\nimport moderngl\n"
        "with window.open_window((64, 64)): print(moderngl.create_context(require=330).info['GL_RENDERER'])"
    )
    environment = {**os.environ, "DISPLAY": display}
    return subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True, timeout=PATIENCE
    ).stdout


def test_y_turns_the_next_mark_to_the_front(start: Start) -> None:
    viewer = start("--error", "signed", "--rotate-light", "40", "10")
    for name in ("minimum", "largest", "minimum"):
        viewer.press("y", "frame")
        described = json.loads(viewer.saved_picture()[1])
        if name == "minimum":
            direction = described["figures"]["minimum_direction_in_light"]
        else:
            direction = described["error"]["largest_direction_in_light"]
        matrix = np.array(described["light_from_world"]) @ np.array(described["world_from_view"])
        np.testing.assert_allclose(matrix.T @ direction, [0, 0, 1], atol=1e-6)
    viewer.press("x", "frame")
    before = json.loads(viewer.saved_picture()[1])["camera_degrees"]
    viewer.press("y", "frame")
    assert json.loads(viewer.saved_picture()[1])["camera_degrees"] == before
