"""The pictures in the README are those that its commands write."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from gallery import ROOT, commands, pictures
from PIL import Image

SHOTS = [arguments for arguments in commands() if arguments[0] == "screenshot"]


def test_every_command_writes_a_picture_that_is_shown_under_it() -> None:
    assert [arguments[1] for arguments in commands()] == pictures()
    assert len(pictures()) > 3
    assert all((ROOT / path).is_file() for path in pictures())
    kept = {path.name for path in (ROOT / "assets" / "gallery").iterdir()}
    assert kept == {Path(path).name for path in pictures() if "gallery" in path}


@pytest.mark.usefixtures("session_renderer")
@pytest.mark.parametrize("arguments", SHOTS, ids=lambda arguments: Path(arguments[1]).stem)
def test_a_picture_of_the_gallery_is_what_its_command_draws_today(arguments: list[str], tmp_path: Path) -> None:
    """At most 2 of 255 in all but a thousandth of the pixels: what drivers round differently."""
    _, shown, *rest = arguments
    command = [sys.executable, "-m", "shviewer", "screenshot", "now.png", *rest, "--reference", str(ROOT / shown)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.usefixtures("session_renderer")
def test_the_last_frame_of_the_sweep_is_the_picture_of_its_bands_today(tmp_path: Path) -> None:
    """The sweep takes ten times as long as a picture, so the last of its frames stands for all."""
    (sweep,) = (arguments for arguments in commands() if arguments[0] == "sweep")
    _, shown, light, *options = sweep
    place = options.index("--to")
    last, rest = options[place + 1], options[:place] + options[place + 2 :]
    place = rest.index("--from")
    del rest[place : place + 2]
    with Image.open(ROOT / shown) as animation:
        assert getattr(animation, "n_frames", 1) == int(last)
        animation.seek(int(last) - 1)
        animation.convert("RGB").save(tmp_path / "last.png")
    command = ["screenshot", "now.png", light, "--bands", last, *rest, "--reference", "last.png"]
    done = subprocess.run(
        [sys.executable, "-m", "shviewer", *command], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
