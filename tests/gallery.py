"""Draw the pictures of the README anew: python tests/gallery.py

Every command of its section "Gallery" is run as it stands there, in the folder of the project.
"""

from __future__ import annotations

import os
import re
import shlex

from places import ROOT

from shviewer.cli.main import main


def section() -> str:
    """What the README says in it."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return text.partition("\n## Gallery\n")[2].partition("\n## ")[0]


def commands() -> list[list[str]]:
    """The arguments of each."""
    blocks = re.findall(r"^```sh\n(.*?)^```$", section(), re.MULTILINE | re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    return [shlex.split(line, comments=True)[1:] for line in lines if line.startswith("shviewer ")]


def pictures() -> list[str]:
    """The paths of the pictures that the README shows up to there."""
    text = (ROOT / "README.md").read_text(encoding="utf-8").partition(section())
    return re.findall(r"!\[[^\]]+\]\(([^)]+)\)", text[0] + text[1])


if __name__ == "__main__":
    os.chdir(ROOT)
    for arguments in commands():
        print("shviewer", *arguments)
        if main(arguments):
            raise SystemExit(1)
