"""The wheel holds everything: installed into an empty environment, it works from any folder."""

from __future__ import annotations

import json
import os
import subprocess
import tarfile
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest
from documents import links
from PIL import Image
from places import ROOT, project_files


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


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Two folders, each with a wheel and an sdist that were built on their own."""
    folder = tmp_path_factory.mktemp("built")
    venv.create(folder / "tools", with_pip=True)
    programs = folder / "tools" / ("Scripts" if os.name == "nt" else "bin")
    needed = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["build-system"]["requires"]
    got = run(programs / "pip", "install", "-q", *needed, "twine", cwd=folder)
    if got.returncode and not os.environ.get("CI"):
        pytest.skip(f"nothing can be built, perhaps for want of a package registry: {got.stderr.strip()[-200:]}")
    assert got.returncode == 0, got.stderr
    outs = [folder / "one", folder / "two"]
    for out in outs:
        done = run(programs / "python", "-m", "hatchling", "build", "-d", out, cwd=ROOT)
        assert done.returncode == 0, done.stderr
    checked = run(programs / "twine", "check", "--strict", *outs[0].iterdir(), cwd=folder)
    assert checked.returncode == 0, checked.stdout
    return outs


def test_two_builds_are_alike_bit_for_bit(built: list[Path]) -> None:
    one, two = ({path.name: path.read_bytes() for path in out.iterdir()} for out in built)
    assert len(one) == 2
    assert one == two


def test_the_sdist_holds_every_file_of_the_project(built: list[Path]) -> None:
    files = project_files()
    (sdist,) = built[0].glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        held = {name.partition("/")[2] for name in archive.getnames()}
    assert {name for name in files if (ROOT / name).exists()} <= held


def test_the_page_of_the_package_leads_nowhere_that_is_not_there(built: list[Path]) -> None:
    (wheel,) = built[0].glob("*.whl")
    assert wheel.stat().st_size < 1.5e6
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        page = archive.read(name).decode().partition("\n\n")[2]
        assert any(name.endswith("licenses/LICENSE") for name in archive.namelist())
    assert "# shviewer" in page
    assert links(page) == []


def test_an_installed_wheel_draws_every_kind_of_built_in_light_from_another_folder(
    built: list[Path], tmp_path: Path
) -> None:
    (wheel,) = built[0].glob("*.whl")
    venv.create(tmp_path / "empty", with_pip=True)
    programs = tmp_path / "empty" / ("Scripts" if os.name == "nt" else "bin")
    installed = run(programs / "pip", "install", "-q", "-c", ROOT / "requirements.lock", wheel, cwd=tmp_path)
    assert installed.returncode == 0, installed.stderr
    for light in ("green", "film_studio"):
        done = run(programs / "shviewer", "screenshot", f"{light}.png", light, "--size", "640", "320", cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        with Image.open(tmp_path / f"{light}.png") as image:
            assert json.loads(image.text["shviewer"])["light"] == light
    place = run(programs / "python", "-c", "import shviewer; print(shviewer.__path__[0])", cwd=tmp_path).stdout.strip()
    pages = {path.name: path.read_bytes() for path in (ROOT / "assets" / "guide").iterdir()}
    assert {path.name: path.read_bytes() for path in (Path(place) / "assets" / "guide").iterdir()} == pages
    for name in ("man/man1/shviewer.1", "bash-completion/completions/shviewer", "zsh/site-functions/_shviewer"):
        assert (tmp_path / "empty" / "share" / name).stat().st_size > 1000
    listed = run(programs / "shviewer", "--list-lights", cwd=tmp_path).stdout
    lights = [path.stem for kind in ("scenes", "environments") for path in (ROOT / "assets" / kind).glob("*.*")]
    assert set(lights) == {line.split()[0] for line in listed.splitlines()}
