"""The window as a user has it: real keys, a real mouse, a virtual screen."""

from __future__ import annotations

import json
import signal
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from viewer.desktop.desktop import PATIENCE, Viewer, output_of, screenshot

from shviewer.viewer.animation.metronome import SWEEP_SECONDS
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.desktop.window import Window
from shviewer.viewer.gl.textures import BAND_BYTES
from shviewer.viewer.state import state_of

Start = Callable[..., Viewer]


def test_keys_change_bands_and_the_saved_picture_is_that_of_the_screenshot_mode(start: Start, tmp_path: Path) -> None:
    viewer = start()
    viewer.press("Up", "6 bands")
    viewer.press("Up", "7 bands")
    viewer.press("Next", "3 bands")
    viewer.press("Prior", "7 bands")
    viewer.press("1", "frame")
    viewer.press("3", "frame")
    pixels, text = viewer.saved_picture()
    assert json.loads(text)["muted"] == [1, 3]
    np.testing.assert_array_equal(pixels, screenshot(tmp_path, "green", "--bands", "7", "--mute", "1,3"))


def test_every_kind_of_key_does_what_the_table_says(start: Start) -> None:
    viewer = start("hemisphere", "--bands", "8")
    viewer.press("Home", " 1 bands")
    viewer.press("End", "32 bands")
    viewer.press("Down", "31 bands")
    viewer.press("shift+2", "frame")
    assert json.loads(viewer.saved_picture()[1])["muted"] == [band for band in range(31) if band != 2]
    viewer.press("a", "frame")
    viewer.press("period", "frame")
    viewer.press("period", "frame")
    viewer.press("Return", "frame")
    assert json.loads(viewer.saved_picture()[1])["muted"] == [1]
    viewer.press("m", "frame")
    viewer.press("S", "frame")
    viewer.press("e", "frame")
    described = json.loads(viewer.saved_picture()[1])
    assert (described["method"], described["samples"]) == ("jittered", 2500)
    viewer.press("n", "frame")
    assert json.loads(viewer.saved_picture()[1])["exposure_stops"] == pytest.approx(described["exposure_stops"] - 0.5)
    viewer.press("r", "8 bands")  # what it was started with
    assert viewer.press("Left", "frame").startswith("frame")
    assert json.loads(viewer.saved_picture()[1])["light"] != "hemisphere"


def test_the_tolerance_key_takes_as_many_bands_as_the_light_needs(start: Start) -> None:
    viewer = start()
    viewer.press("t", "15 bands")
    viewer.press("i", "frame")
    viewer.press("t", "3 bands")
    described = json.loads(viewer.saved_picture()[1])
    assert (described["quantity"], described["figures"]["bands_needed"]["irradiance"]) == ("irradiance", 3)
    assert described["figures"]["relative_l2"] < 0.05


def test_the_window_key_goes_through_all_windows_to_one_without_negatives(start: Start) -> None:
    viewer = start("green", "--bands", "6")
    seen = []
    for _ in range(4):
        viewer.press("w", "frame")
        described = json.loads(viewer.saved_picture()[1])
        seen.append(described["window"])
    assert seen == ["hann", "lanczos", "gauss", "dering"]
    assert described["figures"]["minimum"] > -1e-6
    assert described["figures"]["negative_area"] < 1e-3  # where it touches zero, rounding decides


def test_dragging_turns_the_spheres_and_shift_dragging_the_light(start: Start) -> None:
    viewer = start()
    before = json.loads(viewer.saved_picture()[1])
    viewer.mouse("320,270", "down", "360,270", "420,300", "up")
    after = json.loads(viewer.saved_picture()[1])
    assert after["light_from_world"] == before["light_from_world"]
    # what was in front has gone right by 100 and down by 30 pixels, in radii of the sphere: the camera went the other way
    radius = after["spheres"]["original"]["radius"]
    assert after["camera_degrees"][0] == pytest.approx(before["camera_degrees"][0] - np.degrees(100 / radius), abs=0.01)
    assert after["camera_degrees"][1] == pytest.approx(before["camera_degrees"][1] + np.degrees(30 / radius), abs=0.01)
    viewer.xdotool("keydown", "shift")
    viewer.mouse("320,270", "down", "360,270", "400,250", "up")
    viewer.xdotool("keyup", "shift")
    turned = json.loads(viewer.saved_picture()[1])
    assert turned["camera_degrees"] == after["camera_degrees"]
    assert not np.allclose(turned["light_from_world"], before["light_from_world"], atol=0.05)
    viewer.press("f", "frame")
    assert (
        json.loads(viewer.saved_picture()[1])["camera_degrees"][1] == before["camera_degrees"][1]
    )  # of a light turned


def test_scrolling_zooms_and_a_click_on_a_bar_mutes_its_band(start: Start) -> None:
    viewer = start()
    viewer.forget()
    viewer.mouse("320,270", "scroll-up")
    viewer.wait_for("frame")
    assert json.loads(viewer.saved_picture()[1])["zoom"] == pytest.approx(1.1)
    viewer.forget()
    viewer.mouse("745,570", "down", "up")  # the bar of band 1 at 1280 x 640
    viewer.wait_for("frame")
    assert json.loads(viewer.saved_picture()[1])["muted"] == [1]


def test_a_resized_window_shows_the_picture_of_that_size(start: Start, tmp_path: Path) -> None:
    viewer = start()
    viewer.forget()
    viewer.xdotool("windowsize", viewer.window, "900", "700")
    viewer.wait_for("900 x 700")
    pixels, _ = viewer.saved_picture()
    np.testing.assert_array_equal(pixels, screenshot(tmp_path, "green", "--size", "900", "700"))


def test_help_opens_with_h_and_question_mark_and_escape_closes_it_before_the_window(start: Start) -> None:
    viewer = start()
    viewer.press("h", "frame")
    dimmed, _ = viewer.saved_picture()
    viewer.press("Escape", "frame")
    clear, _ = viewer.saved_picture()
    assert (dimmed != clear).any(axis=2)[100:400].mean() > 0.3  # it covers the spheres
    viewer.press("question", "frame")
    np.testing.assert_array_equal(viewer.saved_picture()[0], dimmed)
    viewer.press("Escape", "frame")
    viewer.xdotool("key", "Escape")
    assert viewer.process.wait(PATIENCE) == 0


def test_b_shows_time_against_error_of_what_was_measured_until_escape(start: Start) -> None:
    viewer = start()
    viewer.press("m", "frame")
    viewer.press("b", "frame")
    two, _ = viewer.saved_picture()
    viewer.press("s", "frame")
    three, _ = viewer.saved_picture()
    viewer.press("Escape", "frame")
    clear, described = viewer.saved_picture()
    assert json.loads(described)["samples"] == 40_000
    rows, columns = np.nonzero((three != clear).any(axis=2))
    place = compose(three.shape[1], three.shape[0]).numbers.curve
    assert place is not None
    assert place.left <= columns.min()  # in place of the curve, and of its legend
    assert compose(three.shape[1], three.shape[0]).hairline.bottom <= rows.min()
    orange = [(np.abs(picture.astype(int) - (240, 164, 66)).max(axis=2) < 8).sum() for picture in (clear, two, three)]
    assert orange[0] == 0
    assert min(orange[1:]) > 50  # a disc or two, which may cover each other, and the one in the legend
    assert (two != three)[round(place.top) : round(place.bottom), round(place.left) :].any()  # another measurement
    viewer.xdotool("key", "Escape")
    assert viewer.process.wait(PATIENCE) == 0


def test_pictures_are_numbered_and_never_overwritten(start: Start, tmp_path: Path) -> None:
    (tmp_path / "shviewer-green-001.png").write_text("kept")
    viewer = start()
    viewer.saved_picture()
    viewer.press("ctrl+s", "saved shviewer-green-003.png")
    assert (tmp_path / "shviewer-green-001.png").read_text() == "kept"
    assert (tmp_path / "shviewer-green-002.png").exists()


DROP_SCRIPT = """
import sys
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.state import state_of
with window.open_window((640, 320)) as handle:
    shown = window_of(handle, state_of())
    for path in sys.argv[1:]:
        shown._on_drop(handle, [path])
        shown.frame()
        print(shown.session.picture.light.name, "|", shown.session.state.view.message)
"""


def test_a_dropped_file_opens_and_a_bad_one_leaves_the_present_light_and_says_why(display: str, tmp_path: Path) -> None:
    good, bad = tmp_path / "mine.toml", tmp_path / "broken.hdr"
    good.write_text('[[lobe]]\nprofile = "constant"\nradiance = 2\n')
    bad.write_text("no image")
    printed = output_of(display, DROP_SCRIPT, str(good), str(bad), str(tmp_path / "gone.toml"), "sun-sky")
    said = [[part.strip() for part in line.split("|")] for line in printed.splitlines()]
    names, messages = zip(*said, strict=True)
    assert names == ("mine", "mine", "mine", "sun-sky")
    assert "broken.hdr" in messages[1]
    assert "gone.toml" in messages[2]
    assert messages[0] == messages[3] == ""


REFUSED_SWEEP_SCRIPT = """
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.control.playing import step_sweep
from shviewer.viewer.state import state_of
with window.open_window((640, 320)) as handle:
    shown = window_of(handle, state_of(n_bands=32, window="dering", sweep_to=40))
    shown.frame()
    shown.change(step_sweep(shown.session.state))
    shown.frame()
    print(shown.session.state.recipe.n_bands, shown.session.state.view.sweep_to, shown.session.state.view.message)
"""


def test_a_sweep_to_a_state_that_cannot_be_shown_ends_there_and_says_why(display: str) -> None:
    printed = output_of(display, REFUSED_SWEEP_SCRIPT)
    assert printed.startswith("32 None ")
    assert "dering" in printed


def test_an_idle_window_costs_under_one_percent_of_a_core(start: Start) -> None:
    start().rest()


def test_ctrl_c_in_the_terminal_ends_it_at_once(start: Start) -> None:
    viewer = start()
    viewer.rest()
    viewer.process.send_signal(signal.SIGINT)
    assert viewer.process.wait(PATIENCE) == 130  # without a key or a mouse that wakes it up
    assert not any("Traceback" in line for line in viewer.seen)


def test_space_plays_a_sweep_to_the_bands_in_use_and_then_costs_nothing(start: Start) -> None:
    viewer = start("green", "--bands", "4", "--size", "640", "320")
    begin = time.monotonic()
    lines = [viewer.press("space", " 1 bands")]
    while " 4 bands" not in lines[-1]:
        lines.append(viewer.wait_for("frame"))
    assert time.monotonic() - begin > 3 * SWEEP_SECONDS
    shown = [int(line.split(" bands")[0].split()[-1]) for line in lines]
    assert list(dict.fromkeys(shown)) == sorted(set(shown)) == [1, 2, 3, 4]
    viewer.rest(seconds=1.2 * SWEEP_SECONDS)
    assert json.loads(viewer.saved_picture()[1])["bands"] == 4


def test_a_sweep_goes_on_under_other_keys_until_space_or_a_band_key(start: Start) -> None:
    viewer = start("green", "--bands", "32", "--size", "640", "320")
    for key in ("space", "Prior"):
        viewer.press("space", " 1 bands")  # the second time to where the first one was stopped
        if key == "space":
            viewer.press("e", "frame")
            viewer.wait_for(" 3 bands")
        viewer.press(key, "frame")
        stopped = json.loads(viewer.saved_picture()[1])["bands"]
        assert stopped < 32
        viewer.rest(seconds=1.2 * SWEEP_SECONDS)
        assert json.loads(viewer.saved_picture()[1])["bands"] == stopped


TWO_KEYS_SCRIPT = """
import glfw
from shviewer.errors import GraphicsError
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.state import state_of
titles = []
glfw.set_window_title = lambda handle, title: titles.append(title)
with window.open_window((320, 160)) as handle:
    shown = window_of(handle, state_of("green", "constant", "studio"))
    shown.frame()
    for key in ("Right", "T"):
        shown.press(key)
    shown.frame()
    print(titles[-1])
    show = shown.canvas.show

    def too_large(picture, composition, *others):
        if picture.light.name == "studio":
            raise GraphicsError("a map too large")
        return show(picture, composition)

    shown.canvas.show = too_large
    for key in ("Right", "T"):
        shown.press(key)
    shown.frame()
    print(titles[-1], shown.session.state.recipe.light, shown.session.state.view.message, sep="|")
"""


def test_keys_between_two_frames_leave_neither_an_old_title_nor_what_opengl_cannot_hold(display: str) -> None:
    """T makes the picture before the frame does, so that the frame finds nothing new."""
    printed = output_of(display, TWO_KEYS_SCRIPT)
    assert printed.splitlines() == [
        "shviewer - constant (2 of 3)",
        "shviewer - constant (2 of 3)|constant|a map too large",
    ]


def test_a_map_that_another_thread_hands_to_opengl_is_that_of_the_screenshot(start: Start, tmp_path: Path) -> None:
    pixels = np.random.default_rng(5).random((600, 1200, 3), dtype=np.float32)
    assert pixels.nbytes > BAND_BYTES
    np.save(tmp_path / "large.npy", pixels)
    shown, _ = start("large.npy").saved_picture()
    np.testing.assert_array_equal(shown, screenshot(tmp_path, "large.npy"))


def test_escape_stops_a_map_on_its_way_to_opengl_and_closes_nothing() -> None:
    session = Session(state_of("green", "hemisphere"))
    before = session.picture
    session.press("Right")
    assert session.prepare()
    shown = Window.__new__(Window)
    shown.session, shown.shown, shown.frames_due = session, before, 0
    shown.canvas = SimpleNamespace(pending="handing the map to OpenGL")
    shown.press("Esc")
    assert session.prepare()
    assert session.picture.light is before.light
    assert session.state.recipe.light == "green"
    assert session.state.view.message == "stopped handing the map to OpenGL"
    assert shown.frames_due == 1


def test_a_window_closes_while_a_map_is_opened(start: Start, tmp_path: Path) -> None:
    np.save(tmp_path / "large.npy", np.random.default_rng(6).random((600, 1200, 3), dtype=np.float32))
    viewer = start("green", "large.npy")
    viewer.xdotool("key", "Right", "ctrl+q")
    assert viewer.process.wait(PATIENCE) == 0


TAKING_TURNS = """
import numpy as np
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.screenshot import read_rgb, render_in_parts, render_rgb
from shviewer.viewer.state import state_of

def pixels(screen):
    return np.frombuffer(screen.read((0, 0, 320, 160)), np.uint8)

with window.open_window((320, 160)) as handle:
    shown = window_of(handle, state_of("studio", n_bands=6, evaluate="direct"))
    canvas, picture, composition = shown.canvas, shown.session.picture, shown.composition()
    for lines in (1, 2, 3):
        canvas.show(picture, composition)
        canvas.begin(composition)
        canvas.go_on()
        frame, saved = pixels(canvas.screen), render_rgb(canvas.renderer, picture, composition)
        parts, whole = render_in_parts(canvas.renderer, picture, composition), False
        canvas._panes = None, 0
        canvas.begin(composition)
        while True:
            try:
                for _ in range(lines):
                    next(parts)
            except StopIteration as last:
                print((last.value() == saved).all(), (frame == pixels(canvas.screen)).all() or not whole)
                break
            whole = whole or canvas.go_on(0.0)
        if not whole:
            canvas.go_on()
        print((frame == pixels(canvas.screen)).all())
"""


def test_a_frame_and_a_picture_that_take_turns_are_what_they_are_alone(display: str) -> None:
    """Mesa drew one of them upside down: a window is, a framebuffer is not, and both are drawn by one program."""
    assert set(output_of(display, TAKING_TURNS).split()) == {"True"}
