"""What a command or a function loads: mathematics no picture, help no mathematics, and images their own decoder alone."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from places import ASSETS

DRAWING = ("pyrr", "moderngl", "glfw", "shviewer.viewer", "shviewer.benchmark")
CALL = "import shviewer; shviewer.project({light!r}, 5).save({out!r})"
COMMAND = "from shviewer.cli.main import main; assert main({arguments!r}) == 0"
ENDING = "\nimport sys; print(*sorted(sys.modules), sep='\\n')"


def loaded(code: str, folder: Path) -> set[str]:
    """The modules that a new process has loaded once it has run the code."""
    done = subprocess.run(
        [sys.executable, "-c", code + ENDING], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return set(done.stdout.splitlines())


def within(modules: set[str], package: str) -> set[str]:
    return {name for name in modules if name == package or name.startswith(f"{package}.")}


@pytest.mark.parametrize(
    "code",
    [
        CALL.format(light="green", out="green.json"),
        CALL.format(light="venice_sunset", out="venice.npz"),
        COMMAND.format(arguments=["project", "green", "-o", "green.csv"]),
        COMMAND.format(arguments=["project", "sun-sky", "--tolerance", "5%", "-o", "sky.h"]),
        COMMAND.format(arguments=["info", "green", "venice_sunset"]),
        COMMAND.format(arguments=["info", "--json", "film_studio"]),
    ],
    ids=["project", "project an image", "project command", "project to a tolerance", "info", "info of an EXR"],
)
def test_what_draws_nothing_loads_nothing_that_draws(tmp_path: Path, code: str) -> None:
    modules = loaded(code, tmp_path)
    assert not [name for package in DRAWING for name in within(modules, package)]
    if "venice_sunset" not in code:  # whose packed scanlines are Pillow's to unpack, in a fraction of the time
        assert not within(modules, "PIL")


def test_pillow_is_loaded_for_a_png(tmp_path: Path) -> None:
    """So that the test above cannot hold for another reason."""
    image = str(ASSETS / "gallery" / "room.png")
    assert within(loaded(COMMAND.format(arguments=["info", image]), tmp_path), "PIL")


@pytest.mark.parametrize("arguments", [["--version"], ["--help"], ["project", "--help"], ["--list-keys"]])
def test_help_loads_no_mathematics(tmp_path: Path, arguments: list[str]) -> None:
    code = f"from shviewer.cli.main import main\ntry:\n    main({arguments!r})\nexcept SystemExit:\n    pass"
    modules = loaded(code, tmp_path)
    if arguments != ["--list-keys"]:
        assert not within(modules, "numpy")
    assert not within(modules, "moderngl")
