"""The pictures in the README are those that its commands write."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from gallery import ROOT, commands, pictures

SHOTS = [arguments for arguments in commands() if arguments[0] == "screenshot"]


def test_every_command_writes_a_picture_that_is_shown_under_it() -> None:
    assert [arguments[1] for arguments in commands()] == pictures()
    assert len(pictures()) > 3
    assert all((ROOT / path).is_file() for path in pictures())
    kept = {path.name for path in (ROOT / "assets" / "gallery").iterdir()}
    assert kept == {Path(path).name for path in pictures()}


@pytest.mark.usefixtures("session_renderer")
@pytest.mark.parametrize("arguments", SHOTS, ids=lambda arguments: Path(arguments[1]).stem)
def test_a_picture_of_the_gallery_is_what_its_command_draws_today(arguments: list[str], tmp_path: Path) -> None:
    """At most 2 of 255 in all but a thousandth of the pixels: what drivers round differently."""
    _, shown, *rest = arguments
    command = [sys.executable, "-m", "shviewer", "screenshot", "now.png", *rest, "--reference", str(ROOT / shown)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
