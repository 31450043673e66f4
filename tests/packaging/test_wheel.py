"""The wheel holds everything: installed into an empty environment, it works from any folder."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import venv
from pathlib import Path

import pytest
from PIL import Image
from places import ROOT


def run(*command: str | Path, cwd: Path) -> subprocess.CompletedProcess[str]:
    environment = {
        key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY", "PYTHONPATH")
    }
    return subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )


def test_an_installed_wheel_draws_every_kind_of_built_in_light_from_another_folder(tmp_path: Path) -> None:
    built = run(sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", tmp_path, ROOT, cwd=tmp_path)
    if built.returncode and not os.environ.get("CI"):
        pytest.skip(f"the wheel cannot be built, perhaps for want of a package registry: {built.stderr.strip()[-200:]}")
    assert built.returncode == 0, built.stderr
    (wheel,) = tmp_path.glob("*.whl")
    venv.create(tmp_path / "empty", with_pip=True)
    programs = tmp_path / "empty" / ("Scripts" if os.name == "nt" else "bin")
    installed = run(programs / "pip", "install", "-q", "-c", ROOT / "requirements.lock", wheel, cwd=tmp_path)
    assert installed.returncode == 0, installed.stderr
    for light in ("green", "film_studio"):
        done = run(programs / "shviewer", "screenshot", f"{light}.png", light, "--size", "640", "320", cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        with Image.open(tmp_path / f"{light}.png") as image:
            assert json.loads(image.text["shviewer"])["light"] == light  # type: ignore[attr-defined]
    place = run(programs / "python", "-c", "import shviewer; print(shviewer.__path__[0])", cwd=tmp_path).stdout.strip()
    pages = {path.name: path.read_bytes() for path in (ROOT / "assets" / "guide").iterdir()}
    assert {path.name: path.read_bytes() for path in (Path(place) / "assets" / "guide").iterdir()} == pages
    for name in ("man/man1/shviewer.1", "bash-completion/completions/shviewer", "zsh/site-functions/_shviewer"):
        assert (tmp_path / "empty" / "share" / name).stat().st_size > 1000
    listed = run(programs / "shviewer", "--list-lights", cwd=tmp_path).stdout
    lights = [path.stem for kind in ("scenes", "environments") for path in (ROOT / "assets" / kind).glob("*.*")]
    assert set(lights) == {line.split()[0] for line in listed.splitlines()}
