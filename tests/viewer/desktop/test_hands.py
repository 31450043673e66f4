"""What a hand does in the window but turning and muting: copying, writing, facing a point, leaving."""

from __future__ import annotations

import csv
import json
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from viewer.desktop.desktop import PATIENCE, Viewer, output_of

from shviewer.analysis.projected import project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.harmonics.rotation import rotate
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.viewer import camera

Start = Callable[..., Viewer]

CLIPBOARD = """
import glfw
glfw.init()
glfw.window_hint(glfw.VISIBLE, False)
print(glfw.get_clipboard_string(glfw.create_window(64, 64, "", None, None)).decode(), end="")
"""


def said(viewer: Viewer) -> dict[str, Any]:
    found = json.loads(viewer.saved_picture()[1])
    assert isinstance(found, dict)
    return found


def test_what_is_copied_makes_the_picture_again_and_what_is_written_is_turned_as_it_is_shown(
    start: Start, tmp_path: Path
) -> None:
    viewer = start("green", "--bands", "4", "--size", "640", "320")
    viewer.press("plus", "5 bands")
    viewer.press("minus", "4 bands")
    viewer.press("1", "frame")
    viewer.xdotool("mousemove", "--window", viewer.window, "160", "130")
    viewer.forget()
    viewer.xdotool("mousedown", "3", "mousemove", "--window", viewer.window, "190", "120", "mouseup", "3")
    viewer.wait_for("frame")
    pixels, text = viewer.saved_picture()
    rotation = json.loads(text)["state"]["view"]["light_rotation"]
    assert abs(rotation[3]) < 0.999

    viewer.press("ctrl+c", "frame")
    copied = shlex.split(output_of(viewer.display, CLIPBOARD))
    assert copied[:3] == ["shviewer", "screenshot", "shviewer-green.png"]
    output_of("", f"import os\nos.chdir({str(tmp_path)!r})\nfrom shviewer.cli.main import main\nmain({copied[1:]!r})")
    with Image.open(tmp_path / "shviewer-green.png") as image:
        np.testing.assert_array_equal(np.asarray(image.convert("RGB")), pixels)

    wanted = rotate(project_recipe(Recipe(n_bands=4, muted=frozenset({1}))).coefficients, camera.matrix(rotation))
    line = viewer.press("ctrl+e", "saved ")
    written = CoefficientLight.read(tmp_path / line.rpartition("saved ")[2])
    np.testing.assert_allclose(written.given, wanted, rtol=0, atol=1e-12)
    viewer.press("ctrl+shift+c", "frame")
    lines = output_of(viewer.display, CLIPBOARD).splitlines()
    assert lines[0].startswith("# shviewer-coefficients: 1")
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    columns = [[float(row[name]) for name in ("red", "green", "blue")] for row in rows]
    np.testing.assert_allclose(columns, wanted, rtol=0, atol=1e-12)


def test_a_double_click_brings_the_point_to_the_front_and_two_clicks_elsewhere_nothing(start: Start) -> None:
    viewer = start("green", "--size", "640", "320")
    before = said(viewer)
    sphere = before["spheres"]["original"]
    right, up = 0.4, 0.3
    x, y = round(sphere["centre"][0] + right * sphere["radius"]), round(sphere["centre"][1] - up * sphere["radius"])
    viewer.mouse(f"{x - 30},{y}", "down", "up", f"{x},{y}", "down", "up")
    viewer.forget()
    viewer.mouse("down", "up")
    viewer.wait_for("frame")
    after = said(viewer)
    right, up = (x + 0.5 - sphere["centre"][0]) / sphere["radius"], (sphere["centre"][1] - y - 0.5) / sphere["radius"]
    shown = np.array(before["world_from_view"]) @ [right, up, np.sqrt(1 - right * right - up * up)]
    np.testing.assert_allclose(np.array(after["world_from_view"])[:, 2], shown, rtol=0, atol=1e-9)
    assert after["light_from_world"] == before["light_from_world"]


@pytest.mark.parametrize("key", ["ctrl+q", "ctrl+w"])
def test_ctrl_q_and_ctrl_w_quit(start: Start, key: str) -> None:
    viewer = start("--size", "320", "160")
    viewer.xdotool("key", key)
    assert viewer.process.wait(PATIENCE) == 0


LEAVING = """
import glfw
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.state import state_of
with window.open_window((320, 160)) as handle:
    shown = window_of(handle, state_of(help_visible=True, sweep_to=9))
    shown.frame()
    shown.press("F11")
    print(shown.fullscreen, shown.session.state.view.help_visible)
    for _ in range(4):
        shown.press("Esc")
        view = shown.session.state.view
        print(view.help_visible, view.sweep_to, shown.fullscreen, bool(glfw.window_should_close(handle)))
"""


def test_escape_closes_the_help_ends_the_sweep_leaves_full_screen_and_quits(display: str) -> None:
    assert output_of(display, LEAVING).splitlines() == [
        "True True",
        "False 9 True False",
        "False None True False",
        "False None False False",
        "False None False True",
    ]


NO_CLIPBOARD = """
import glfw
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.state import state_of
glfw.set_clipboard_string = lambda handle, text: None
errors = iter([(0, b""), (glfw.PLATFORM_ERROR, b"none")])
with window.open_window((320, 160)) as handle:
    shown = window_of(handle, state_of())
    glfw.get_error = lambda: next(errors)
    for _ in range(2):
        shown.press("Ctrl+C")
        print("said", shown.session.state.view.message)
"""


def test_where_there_is_no_clipboard_it_is_said_once_and_printed(display: str) -> None:
    first, said, second, silent = output_of(display, NO_CLIPBOARD).splitlines()
    assert first == second
    assert first.startswith("shviewer screenshot shviewer-green.png green --bands 5 --size 320 ")
    assert said == "said no clipboard here: the command of this picture is printed in the terminal"
    assert silent == "said "


PASTING = """
import sys
import glfw
from pathlib import Path
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.state import state_of
scene = Path(sys.argv[1]) / "my light.toml"
scene.write_text('[[lobe]]\\nprofile = "constant"\\nradiance = 1\\n')
copied = iter([b"nothing of the kind", scene.as_uri().encode(), None])
glfw.get_clipboard_string = lambda handle: next(copied)
with window.open_window((320, 160)) as handle:
    shown = window_of(handle, state_of())
    for _ in range(3):
        shown.press("Ctrl+V")
        shown.session.prepare()
        print(shown.session.picture.light.name, "-", shown.session.state.view.message)
"""


def test_a_copied_path_is_opened_as_if_it_had_been_dropped(display: str, tmp_path: Path) -> None:
    none = "no path of a file is copied: copy one, or drop the file on the window"
    lines = output_of(display, PASTING, str(tmp_path)).splitlines()
    assert lines == [f"green - {none}", "my light - ", f"my light - {none}"]
