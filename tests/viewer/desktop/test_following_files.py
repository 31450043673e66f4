"""The window and the file it shows: read again by key, by drop and on its own."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from lights.images.hdr_files import exr_file, hdr_file, random_texels
from viewer.desktop.desktop import Viewer, output_of, screenshot

from shviewer.viewer.desktop.watching import LOOK_SECONDS

Start = Callable[..., Viewer]
A_FEW_LOOKS = 1.2
"""Seconds; a watching window looks four times in one."""

SCENE = '[[lobe]]\nprofile = "gaussian"\naxis = [0, 0, 1]\nradiance = [{}, 1, 2]\nsharpness = 3\n'
FUNCTION = "def sky(directions):\n    return {} + directions[:, 2]\n"


def scene(level: int) -> bytes:
    return SCENE.format(level).encode()


def function(level: int) -> bytes:
    return FUNCTION.format(level).encode()


def radiance_hdr(level: int) -> bytes:
    return hdr_file(random_texels(16, 32, seed=level))


def open_exr(level: int) -> bytes:
    pixels = np.random.default_rng(level).random((3, 16, 32), dtype=np.float32)
    return exr_file(dict(zip("RGB", pixels, strict=True)))


def replace_file(path: Path, data: bytes) -> None:
    """As editors do: write beside, move into place."""
    other = path.with_name("written-beside")
    other.write_bytes(data)
    other.replace(path)


# --- by key


@pytest.mark.parametrize("key", ["ctrl+r", "F5"])
def test_the_key_shows_the_file_as_it_is_now_and_keeps_every_setting(start: Start, tmp_path: Path, key: str) -> None:
    path = tmp_path / "mine.toml"
    path.write_bytes(scene(1))
    viewer = start("mine.toml", "--bands", "7", "--mute", "1")
    before, _ = viewer.saved_picture()
    path.write_bytes(scene(5))
    viewer.press(key, "reloaded mine")
    after, _ = viewer.saved_picture()
    assert not np.array_equal(before, after)
    np.testing.assert_array_equal(after, screenshot(tmp_path, "mine.toml", "--bands", "7", "--mute", "1"))


def test_a_file_that_became_unreadable_keeps_its_last_picture_and_every_key_works_on_it(
    start: Start, tmp_path: Path
) -> None:
    path = tmp_path / "mine.hdr"
    path.write_bytes(radiance_hdr(1))
    viewer = start("mine.hdr")
    before, _ = viewer.saved_picture()
    path.write_bytes(b"no picture any more")
    assert "mine.hdr" in viewer.press("ctrl+r", "kept mine: ")
    np.testing.assert_array_equal(viewer.saved_picture()[0], before)
    viewer.press("Up", "6 bands")
    path.unlink()
    assert "no such file" in viewer.press("F5", "kept mine: ")
    viewer.press("Down", "5 bands")
    np.testing.assert_array_equal(viewer.saved_picture()[0], before)


def test_a_function_that_fails_only_when_it_is_called_keeps_the_one_before(start: Start, tmp_path: Path) -> None:
    path = tmp_path / "my.py"
    path.write_bytes(function(1))
    viewer = start("my.py:sky")
    before, _ = viewer.saved_picture()
    path.write_text("def sky(directions):\n    return directions[:, 7]\n")
    assert "IndexError" in viewer.press("F5", "kept sky: ")
    viewer.press("Up", "6 bands")
    viewer.press("Down", "5 bands")
    np.testing.assert_array_equal(viewer.saved_picture()[0], before)


def test_a_built_in_light_can_be_read_again(start: Start) -> None:
    viewer = start()
    viewer.press("ctrl+r", "reloaded green")
    viewer.press("r", "frame")
    assert not any("kept" in line for line in viewer.seen)


# --- on its own


@pytest.mark.parametrize(
    ("name", "suffix", "content", "write"),
    [
        ("mine.toml", "", scene, Path.write_bytes),
        ("my.py", ":sky", function, replace_file),
        ("mine.hdr", "", radiance_hdr, Path.write_bytes),
        ("mine.exr", "", open_exr, replace_file),
    ],
    ids=["toml in place", "py replaced", "hdr in place", "exr replaced"],
)
def test_a_watching_window_shows_a_changed_file(
    start: Start,
    tmp_path: Path,
    name: str,
    suffix: str,
    content: Callable[[int], bytes],
    write: Callable[[Path, bytes], object],
) -> None:
    path = tmp_path / name
    path.write_bytes(content(1))
    viewer = start(name + suffix, "--watch", "--bands", "6")
    viewer.forget()
    write(path, content(4))
    viewer.wait_for("reloaded ")
    np.testing.assert_array_equal(viewer.saved_picture()[0], screenshot(tmp_path, name + suffix, "--bands", "6"))


def test_a_half_written_file_is_survived(start: Start, tmp_path: Path) -> None:
    path, data = tmp_path / "mine.hdr", radiance_hdr(2)
    path.write_bytes(radiance_hdr(1))
    viewer = start("mine.hdr", "--watch")
    before, _ = viewer.saved_picture()
    viewer.forget()
    with path.open("wb") as file:
        file.write(data[: len(data) // 2])
        file.flush()
        viewer.wait_for("kept mine: ")  # it stayed so for long enough to be taken for whole
        np.testing.assert_array_equal(viewer.saved_picture()[0], before)
        file.write(data[len(data) // 2 :])
    viewer.wait_for("reloaded mine")
    np.testing.assert_array_equal(viewer.saved_picture()[0], screenshot(tmp_path, "mine.hdr"))


def test_a_file_that_is_written_piece_by_piece_is_read_when_it_is_whole(start: Start, tmp_path: Path) -> None:
    path, data = tmp_path / "mine.hdr", radiance_hdr(2)
    path.write_bytes(radiance_hdr(1))
    viewer = start("mine.hdr", "--watch")
    for _ in range(5):
        viewer.forget()
        said = len(viewer.seen)
        longest = write_in_pieces(path, data)
        viewer.wait_for("reloaded mine")
        if longest < LOOK_SECONDS / 2:  # else a busy machine held up the writing, and a look may have found it at rest
            assert not any("kept" in line for line in viewer.seen[said:])
            break


def write_in_pieces(path: Path, data: bytes) -> float:
    """So that every look finds another size; the longest pause that was made, in seconds."""
    times = [time.monotonic()]
    with path.open("wb") as file:
        for begin in range(0, len(data), 200):
            file.write(data[begin : begin + 200])
            file.flush()
            time.sleep(0.06)
            times.append(time.monotonic())
    return max(after - before for before, after in pairwise(times))


def test_a_file_that_vanishes_leaves_its_picture_and_is_read_when_it_is_back(start: Start, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_bytes(scene(1))
    viewer = start("mine.toml", "--watch")
    path.unlink()
    time.sleep(A_FEW_LOOKS)
    viewer.press("Up", "6 bands")
    assert not any("kept" in line or "reloaded" in line for line in viewer.seen)
    path.write_bytes(scene(4))
    viewer.wait_for("reloaded mine")


def test_a_file_that_changed_while_another_light_was_shown_is_read_again_on_return(
    start: Start, tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    path.write_bytes(scene(1))
    viewer = start("mine.toml", "--watch")
    shown = viewer.press("Left", "frame")
    while ": mine," in shown:  # one that was due before
        shown = viewer.wait_for("frame")
    path.write_bytes(scene(4))
    viewer.press("Right", "frame")
    if not any("reloaded mine" in line for line in viewer.seen):
        viewer.wait_for("reloaded mine")
    np.testing.assert_array_equal(viewer.saved_picture()[0], screenshot(tmp_path, "mine.toml"))


def test_a_window_that_does_not_watch_leaves_a_changed_file_alone(start: Start, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_bytes(scene(1))
    viewer = start("mine.toml")
    before, _ = viewer.saved_picture()
    path.write_bytes(scene(5))
    time.sleep(A_FEW_LOOKS)
    np.testing.assert_array_equal(viewer.saved_picture()[0], before)
    assert not any("reloaded" in line for line in viewer.seen)


def test_a_watching_window_at_rest_costs_under_one_percent_of_a_core(start: Start, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_bytes(scene(1))
    start("mine.toml", "--watch").rest()


# --- by drop


DROP_SCRIPT = """
import sys
from pathlib import Path
from shviewer.lights.environment import EnvironmentLight
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.state import state_of

isolated, read = [], EnvironmentLight.read
EnvironmentLight.read = classmethod(
    lambda cls, path, reading, *rest: (isolated.append(reading.isolated), read(path, reading, *rest))[1]
)
path, *contents = map(Path, sys.argv[1:])
path.write_bytes(contents[0].read_bytes())
with window.open_window((640, 320)) as handle:
    shown = window_of(handle, state_of(str(path)))
    for content in contents[1:]:
        path.write_bytes(content.read_bytes())
        shown._on_drop(handle, [str(path)])
        shown.frame()
        print(shown.session.state.view.message.split(":")[0], shown.session.picture.light.coefficients(1)[0, 0], sep="|")
    shown._on_drop(handle, ["film_studio"])
    shown.frame()
print(isolated)
"""


def test_the_file_that_is_shown_can_be_dropped_again_and_is_decoded_apart_from_the_window(
    display: str, tmp_path: Path
) -> None:
    contents = []
    for level in (1, 2, 3):
        contents.append(tmp_path / f"content-{level}")
        contents[-1].write_bytes(open_exr(level))
    printed = output_of(display, DROP_SCRIPT, str(tmp_path / "mine.exr"), *map(str, contents))
    second, third, isolated = printed.splitlines()
    assert second.split("|")[0] == third.split("|")[0] == "reloaded mine"
    assert second != third
    assert isolated == "[None, True, True, False]"  # the first is decoded as its kind is, as is what is built in
