"""Animations as files: their frames are the screenshots, they play as asked, and a failure loses nothing."""

from __future__ import annotations

import json
import os
import pty
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image, ImageSequence

from shviewer import outputs
from shviewer.errors import GraphicsError, OutputError
from shviewer.version import __version__
from shviewer.viewer.animation import animation
from shviewer.viewer.animation.animation import HOLD, Animation, band_sweep, save_animation, turntable
from shviewer.viewer.composing.composition import Composition, compose
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import prepare
from shviewer.viewer.screenshot import render_rgb
from shviewer.viewer.state import changed, state_of

SMALL = compose(480, 300)
STATE = state_of("green", muted=frozenset({1}))

GIF_LARGEST, GIF_RMS = 20, 2.5
"""In steps of 255. Measured at 1280 x 640: 16 and 1.7 for the sweep of venice_sunset, 6 and 0.4 for that of green."""

Save = Callable[..., Path]


@pytest.fixture
def save(renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Save:
    """save_animation into the test's folder, in the context of all tests."""

    @contextmanager
    def shared() -> Iterator[Renderer]:
        yield renderer

    monkeypatch.setattr(animation, "headless_renderer", shared)

    def call(made: Animation, name: str, composition: Composition = SMALL, **options: object) -> Path:
        save_animation(made, composition, tmp_path / name, **options)
        return tmp_path / name

    return call


def frames_of(path: Path) -> tuple[list[NDArray[np.uint8]], list[int]]:
    """Pixels and milliseconds of every frame, as somebody else's decoder has them."""
    with Image.open(path) as image:
        assert image.info["loop"] == 0
        pixels, durations = [], []
        for frame in ImageSequence.Iterator(image):
            pixels.append(np.asarray(frame.convert("RGB")))
            durations.append(int(image.info["duration"]))
    return pixels, durations


def local_tables(data: bytes) -> list[bool]:
    """Whether each frame of a GIF89a has a colour table of its own; every frame must stay (disposal 1)."""
    assert data[:6] == b"GIF89a"
    assert data[10] & 0x80
    at, found = 13 + 3 * 2 ** (1 + (data[10] & 7)), []
    while data[at] != 0x3B:
        if data[at] == 0x2C:
            found.append(bool(data[at + 9] & 0x80))
            at += 11
        else:
            assert data[at] == 0x21
            if data[at + 1] == 0xF9:
                assert data[at + 3] >> 2 & 7 == 1
            at += 2
        while data[at]:
            at += 1 + data[at]
        at += 1
    return found


def screenshots(renderer: Renderer, made: Animation, composition: Composition = SMALL) -> list[NDArray[np.uint8]]:
    return [render_rgb(renderer, prepare(state), composition) for state in made.states]


@pytest.mark.parametrize("light", ["green", "venice_sunset"])
def test_every_frame_of_a_webp_sweep_is_the_screenshot_of_its_state_to_the_bit(
    save: Save, renderer: Renderer, light: str
) -> None:
    made = band_sweep(changed(STATE, light=light), 1, 12, 0.3)
    pixels, durations = frames_of(save(made, "a.webp"))
    assert durations == [300] * 11 + [300 * HOLD]
    for shown, wanted in zip(pixels, screenshots(renderer, made), strict=True):
        np.testing.assert_array_equal(shown, wanted)


def test_a_turntable_in_webp_begins_with_the_screenshot_and_every_frame_is_one(save: Save, renderer: Renderer) -> None:
    made = turntable(STATE, 6, 0.1)
    pixels, durations = frames_of(save(made, "a.webp"))
    assert durations == [100] * 6
    np.testing.assert_array_equal(pixels[0], render_rgb(renderer, prepare(STATE), SMALL))
    for shown, wanted in zip(pixels, screenshots(renderer, made), strict=True):
        np.testing.assert_array_equal(shown, wanted)
    assert all((one != other).any() for one, other in pairwise(pixels))


@pytest.mark.parametrize("light", ["green", "venice_sunset"])
@pytest.mark.parametrize("kind", ["bands", "turntable"])
def test_every_frame_of_a_gif_is_the_screenshot_within_the_error_of_the_palette(
    save: Save, renderer: Renderer, light: str, kind: str
) -> None:
    state = changed(STATE, light=light)
    made = band_sweep(state, 1, 8) if kind == "bands" else turntable(state, 8)
    pixels, durations = frames_of(save(made, "a.gif"))
    assert durations == list(made.milliseconds)
    off = np.array(pixels).astype(int) - np.array(screenshots(renderer, made))
    assert np.abs(off).max() <= GIF_LARGEST
    assert np.sqrt((off**2).mean()) <= GIF_RMS
    assert (off == 0).mean() > 0.3  # the grey around it all is exact


def test_a_gif_has_one_palette_and_keeps_the_blue_of_negative_radiance(save: Save, renderer: Renderer) -> None:
    made = band_sweep(state_of(), 1, 6)
    path = save(made, "a.gif")
    assert local_tables(path.read_bytes()) == [False] * 6
    last, wanted = frames_of(path)[0][-1].astype(int), screenshots(renderer, made)[-1].astype(int)
    negative = wanted[..., 2] > wanted[..., 0] + 12
    assert negative.mean() > 0.02
    assert np.abs(last - wanted)[negative].max() <= 8


def test_the_files_tell_what_made_them(save: Save) -> None:
    sweep, turn = band_sweep(changed(STATE, method="jittered"), 2, 5), turntable(changed(STATE, n_bands=3), 4)
    for name, made, kind in (
        ("a", sweep, {"kind": "bands", "from": 2, "to": 5, "frames": 4, "milliseconds": [700, 700, 700, 2100]}),
        ("b", turn, {"kind": "turntable", "frames": 4, "milliseconds": [80] * 4}),
    ):
        with Image.open(save(made, f"{name}.gif")) as image:
            in_gif = json.loads(image.info["comment"])
        with Image.open(save(made, f"{name}.webp")) as image:
            exif = image.getexif()
        assert json.loads(exif[0x010E]) == in_gif
        assert exif[0x0131] == f"shviewer {__version__}"
        assert in_gif["animation"] == kind
        assert (in_gif["light"], in_gif["version"], in_gif["muted"]) == ("green", __version__, [1])
        assert in_gif["bands"] == (5 if name == "a" else 3)
        assert in_gif["method"] == ("jittered" if name == "a" else "best")
        assert in_gif["camera_degrees"] == pytest.approx([98.24, 22.0], abs=0.01)  # facing the light


def test_equal_frames_become_one_that_is_shown_as_long(save: Save, tmp_path: Path) -> None:
    """A constant light looks the same from everywhere."""
    scene = tmp_path / "scene.toml"
    scene.write_text('[[lobe]]\nprofile = "constant"\nradiance = 2\n')
    made = turntable(state_of(str(scene)), 5, 0.1)
    with Image.open(save(made, "a.gif")) as image:
        assert (image.n_frames, image.info["duration"]) == (1, 500)
    with Image.open(save(made, "a.webp")) as image:
        assert image.n_frames == 1  # a still picture, which needs no time


def test_one_frame_can_be_written_in_both_formats(save: Save, renderer: Renderer) -> None:
    made = band_sweep(STATE, 4, 4)
    (wanted,) = screenshots(renderer, made)
    for suffix, most in (("gif", GIF_LARGEST), ("webp", 0)):
        with Image.open(save(made, f"a.{suffix}")) as image:
            assert getattr(image, "n_frames", 1) == 1
            assert np.abs(np.asarray(image.convert("RGB")).astype(int) - wanted).max() <= most


def test_without_overlay_the_spheres_are_alone(save: Save, renderer: Renderer) -> None:
    made = band_sweep(STATE, 3, 4)
    pixels, _ = frames_of(save(made, "a.webp", overlay=False))
    np.testing.assert_array_equal(pixels[0], render_rgb(renderer, prepare(made.states[0]), SMALL, overlay=False))


@pytest.mark.parametrize(("suffix", "drawings"), [("gif", 6), ("webp", 3)])
def test_progress_is_told_before_every_drawing_and_never_goes_back(save: Save, suffix: str, drawings: int) -> None:
    told: list[tuple[float, float, str]] = []
    save(band_sweep(STATE, 1, 3), f"a.{suffix}", progress=lambda *said: told.append(said))
    assert [done for done, _, _ in told] == pytest.approx([k / drawings for k in range(drawings)])
    assert all(left >= 0 for _, left, _ in told)
    assert [words for _, _, words in told] == [f"frame {1 + k % 3} of 3" for k in range(drawings)]


@pytest.mark.parametrize("suffix", ["gif", "webp"])
def test_a_failure_in_the_middle_leaves_the_file_there_was(
    save: Save, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str
) -> None:
    kept = tmp_path / f"a.{suffix}"
    kept.write_text("kept")
    drawn = []

    def failing(*arguments: object, **options: object) -> NDArray[np.uint8]:
        drawn.append(arguments)
        if len(drawn) == 3:
            raise GraphicsError("lost")
        return render_rgb(*arguments, **options)

    monkeypatch.setattr(animation, "render_rgb", failing)
    with pytest.raises(GraphicsError, match="lost"):
        save(band_sweep(STATE, 1, 4), kept.name)
    monkeypatch.setattr(animation, "render_rgb", render_rgb)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(outputs.os, "fsync", full)
    with pytest.raises(OutputError, match=rf"a\.{suffix}: cannot be written: No space left on device"):
        save(band_sweep(STATE, 1, 2), kept.name)
    assert ([*tmp_path.iterdir()], kept.read_text()) == ([kept], "kept")


# --- the command


def run(folder: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "shviewer", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.usefixtures("session_renderer")
def test_the_command_writes_the_frames_of_the_screenshot_command(tmp_path: Path) -> None:
    view = ("studio", "--mute", 2, "--camera", 10, 20, "--exposure", 1, "--size", 320, 160)
    done = run(tmp_path, "sweep", "a.webp", *view, "--from", 3, "--to", 5, "--seconds", 0.2)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")  # no bar where stderr is no terminal
    pixels, durations = frames_of(tmp_path / "a.webp")
    assert durations == [200, 200, 600]
    for n_bands, shown in zip((3, 4, 5), pixels, strict=True):
        assert run(tmp_path, "screenshot", f"{n_bands}.png", *view, "--bands", n_bands).returncode == 0
        with Image.open(tmp_path / f"{n_bands}.png") as image:
            np.testing.assert_array_equal(shown, np.asarray(image))
    done = run(tmp_path, "sweep", "--turntable", "t.webp", "--frames", 4, *view, "--bands", 3)
    assert (done.returncode, done.stderr) == (0, "")
    pixels, durations = frames_of(tmp_path / "t.webp")
    assert durations == [80] * 4
    with Image.open(tmp_path / "3.png") as image:
        np.testing.assert_array_equal(pixels[0], np.asarray(image))


@pytest.mark.usefixtures("session_renderer")
def test_on_a_terminal_a_bar_runs_and_is_wiped_before_it_is_said_what_was_written(tmp_path: Path) -> None:
    reading, writing = pty.openpty()
    command = [sys.executable, "-m", "shviewer", "sweep", "a.gif", "--to", "3", "--size", "128", "64"]
    with subprocess.Popen(command, cwd=tmp_path, stderr=writing, stdout=writing) as process:
        os.close(writing)
        said = b""
        try:
            while part := os.read(reading, 4096):
                said += part
        except OSError:  # how Linux says that the other end is closed
            pass
    os.close(reading)
    assert process.returncode == 0
    lines = said.decode().split("\r\x1b[K")
    assert (lines[0], lines[-1]) == ("", "shviewer: wrote a.gif: 3 frames of 128 x 64, 3.5 s, 1 to 3 bands\r\n")
    assert [re.sub(r" +\d+ s left", "", line) for line in lines[1:-1]] == [
        f"[{'#' * filled}{'.' * (24 - filled)}]  frame {1 + k % 3} of 3" for k, filled in enumerate(range(0, 24, 4))
    ]
