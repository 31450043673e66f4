"""Where the project's files are, wherever a test of them stands."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
ASSETS = ROOT / "assets"
DATA = ROOT / "tests" / "data"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}
"""That of a process that a test starts: it imports this checkout."""


def hard_cases() -> Any:
    """Reference values with 34 digits; README.md beside them says where they come from."""
    return json.loads((DATA / "hard_cases.json").read_text())


def kernels() -> Any:
    """Reference values of glossy kernels, encodings of irradiance and moving lights; README.md says where they come from."""
    return json.loads((DATA / "kernels.json").read_text())


def project_files() -> list[str]:
    """The files of the project, as git lists them; without git or a checkout the test is skipped."""
    import pytest  # scripts that only ask for places need none

    if shutil.which("git") is None:
        pytest.skip("git is not installed: there is no list of the project's files")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=False)
    if listed.returncode:
        pytest.skip("not a git checkout, so there is no list of the project's files")
    return [name for name in listed.stdout.decode().split("\0") if name]
