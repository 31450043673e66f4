"""Lint, format and types are part of the tests."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from importlib.util import find_spec

import pytest
from places import ROOT, project_files


@pytest.mark.parametrize(
    "command",
    [("ruff", "check", "."), ("ruff", "format", "--check", "."), ("mypy",)],
    ids=["lint", "format", "types"],
)
def test_the_tree_is_clean(command: tuple[str, ...]) -> None:
    if not (find_spec(command[0]) or os.environ.get("CI")):
        pytest.skip(f"no {command[0]}: pip install 'shviewer[dev]'")
    done = subprocess.run([sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_nothing_names_a_machine() -> None:
    """Paths of the machine that wrote a file, and hosts of package registries, mean nothing to anybody else."""
    words = ["/" + name + "/" for name in ("work", "root", "home/")] + ["pypi." + "org", "pythonhosted" + ".org"]
    for name in project_files():
        path = ROOT / name
        if path.suffix in (".png", ".exr", ".hdr", ".webp") or not path.is_file():
            continue
        data = path.read_bytes()
        assert not [word for word in words if word.encode() in data], name


def test_no_docstring_opens_with_of() -> None:
    """A stranger asks what it is that belongs to something."""
    sources = [name for name in project_files() if name.endswith(".py") and (ROOT / name).is_file()]
    assert len(sources) > 500
    assert not [name for name in sources if re.search(r'^\s*"""Of\b', (ROOT / name).read_text("utf-8"), re.MULTILINE)]
