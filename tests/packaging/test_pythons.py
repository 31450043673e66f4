"""The mathematics, the readers and a picture on every other Python that this machine has."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from places import ROOT

VERSIONS = ("3.11", "3.12", "3.13", "3.14")
FAST = ("tests/harmonics", "tests/coefficients", "tests/lights", "tests/analysis", "tests/test_api.py")


def interpreter(version: str) -> Path | None:
    """A Python of a version that runs, on the path or among those of pyenv; None if there is none, or if it is this one."""
    roots = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    found = [shutil.which(f"python{version}"), *sorted(roots.glob(f"{version}.*/bin/python"))]
    for path in map(Path, filter(None, found)):
        asked = [path, "-c", "import sys, ensurepip; print('%d.%d' % sys.version_info[:2])"]
        done = subprocess.run(asked, capture_output=True, text=True, check=False)
        if done.stdout.strip() == version and version != "{}.{}".format(*sys.version_info):
            return path
    return None


@pytest.mark.parametrize("version", VERSIONS)
def test_the_fast_tests_pass_on_every_python_that_is_here(version: str, tmp_path: Path) -> None:
    python = interpreter(version)
    if python is None:
        pytest.skip(f"no Python {version} here beside the one of these tests")
    subprocess.run([python, "-m", "venv", tmp_path / "venv"], check=True)
    programs = tmp_path / "venv" / ("Scripts" if os.name == "nt" else "bin")
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}

    def run(*command: str | Path) -> str:
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
        return done.stdout

    run(programs / "pip", "install", "-q", "-c", "requirements.lock", "-e", ".[test]")
    run(programs / "python", "-m", "pytest", "-q", "-n", "0", "-p", "no:cacheprovider", *FAST)
    run(programs / "shviewer", "screenshot", tmp_path / "a.png", "film_studio", "--size", "640", "320")
