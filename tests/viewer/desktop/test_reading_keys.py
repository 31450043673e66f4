"""How files are read, changed in the window: L and Z, and what a file that is refused is answered."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from lights.images.hdr_files import exr_file
from PIL import Image
from viewer.desktop.desktop import PATIENCE

SCRIPT = """
import json
import sys
from viewer.desktop.still_window import window, window_of
from shviewer.viewer.state import state_of

first, *steps = sys.argv[1:]
with window.open_window((640, 320)) as handle:
    shown = window_of(handle, state_of(first))
    for step in ["", *steps]:
        if step.startswith("drop "):
            shown._on_drop(handle, [step.removeprefix("drop ")])
        elif step:
            shown.press(step)
        shown.frame()
        light, reading = shown.session.picture.light, shown.session.state.recipe.reading
        layout = light.layout.name if hasattr(light, "layout") else ""
        print(json.dumps([light.name, layout, reading.layout, reading.sanitize, shown.session.state.view.message]))
"""

Step = tuple[str, str, str, bool, str]
"""Light, its layout, the layout asked for, whether values are repaired, the message."""


def steps(display: str, folder: Path, first: str, *keys: str) -> list[Step]:
    """What a window shows at first and after every key or drop."""
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, first, *keys],
        env={**os.environ, "DISPLAY": display, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        timeout=PATIENCE,
    )
    assert done.returncode == 0, done.stderr
    return [tuple(json.loads(line)) for line in done.stdout.splitlines()]


def write_map(path: Path, height: int, width: int, bad: float | None = None) -> None:
    pixels = np.random.default_rng(1).random((3, height, width), dtype=np.float32)
    if bad is not None:
        pixels[0, 1, 2] = bad
    path.write_bytes(exr_file(dict(zip("RGB", pixels, strict=True))))


def test_notes_of_the_first_light_are_said_at_the_start(display: str, tmp_path: Path) -> None:
    write_map(tmp_path / "mine.exr", 16, 32, bad=-3.0)
    write_map(tmp_path / "clean.exr", 16, 32)
    noted, clean = (steps(display, tmp_path, name)[0] for name in ("mine.exr", "clean.exr"))
    assert noted[-1].startswith("mine: 1 negative value, minimum -3, kept")
    assert clean[-1] == ""


def test_a_first_light_of_low_range_says_so_at_the_start(display: str, tmp_path: Path) -> None:
    Image.new("RGB", (32, 16), (90, 120, 200)).save(tmp_path / "ldr.png")
    assert steps(display, tmp_path, "ldr.png")[0][-1].startswith("ldr: ")


def test_l_goes_past_a_layout_that_does_not_fit_and_the_old_picture_stays(display: str, tmp_path: Path) -> None:
    write_map(tmp_path / "square.exr", 32, 32)
    shown = steps(display, tmp_path, "square.exr", *"LLLLL")
    assert [step[1] for step in shown] == ["lat-long", "lat-long", "lat-long", "angular", "mirror-ball", "lat-long"]
    assert [step[2] for step in shown] == ["auto", "lat-long", "lat-long", "angular", "mirror-ball", "auto"]
    assert shown[2][-1].startswith("square.exr: 32 x 32 is no cube")
    assert shown[2][-1].endswith("press L for another layout")
    assert shown[4][-1].startswith("layout mirror-ball")


def test_a_dropped_file_with_nan_is_repaired_by_z(display: str, tmp_path: Path) -> None:
    write_map(tmp_path / "bad.exr", 16, 32, bad=np.nan)
    drop = f"drop {tmp_path / 'bad.exr'}"
    _, refused, repaired, kept = steps(display, tmp_path, "green", drop, "Z", "Z")
    assert refused[0] == "green"
    assert refused[-1].startswith("bad.exr: 1 NaN")  # without its folder, so that the end is not cut off
    assert refused[-1].endswith("Z repairs them")
    assert repaired[0] == "bad"
    assert "1 NaN -> 0" in repaired[-1]
    assert kept[0] == "bad"
    assert kept[3]  # without repairs it cannot be shown
    assert "1 NaN" in kept[-1]
    assert kept[-1].endswith("they stay repaired")


def test_a_layout_holds_for_files_dropped_afterwards(display: str, tmp_path: Path) -> None:
    write_map(tmp_path / "ball.exr", 32, 32)
    write_map(tmp_path / "other.exr", 32, 32)
    write_map(tmp_path / "wide.exr", 16, 32)
    shown = steps(display, tmp_path, "ball.exr", *"LLLL", "drop other.exr", "drop wide.exr", "L", "L")
    assert shown[5][:3] == ("other", "mirror-ball", "mirror-ball")
    assert shown[6][0] == "other"
    assert shown[6][-1].endswith("press L for another layout")
    assert shown[7][:3] == ("wide", "lat-long", "auto")  # the file that was refused, in the next layout
    assert shown[8][:3] == ("wide", "lat-long", "lat-long")


def test_any_other_key_leaves_a_file_that_was_refused_alone(display: str, tmp_path: Path) -> None:
    write_map(tmp_path / "bad.exr", 16, 32, bad=np.nan)
    _, refused, moved, said = steps(display, tmp_path, "green", f"drop {tmp_path / 'bad.exr'}", "Up", "Z")
    assert refused[-1].endswith("Z repairs them")
    assert (moved[0], said[0]) == ("green", "green")
    assert said[-1] == "green is no image, and has no values to repair"


def test_a_drop_that_no_key_can_help_is_offered_none(display: str, tmp_path: Path) -> None:
    (tmp_path / "text.exr").write_text("no picture")
    refused = steps(display, tmp_path, "green", "drop text.exr")[1]
    assert "text.exr" in refused[-1]
    assert "Z repairs" not in refused[-1]
    assert "press L" not in refused[-1]
