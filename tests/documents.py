"""README and the guide, taken apart for the tests: code blocks, commands, links and headings."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

from places import ROOT

README = ROOT / "README.md"
GUIDE = ROOT / "assets" / "guide"
PAGES = sorted(GUIDE.glob("*.md"))

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def read(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def page(name: str) -> str:
    """The text of a page of the guide, such as "window"."""
    return read(GUIDE / f"{name}.md")


def code_blocks(text: str, language: str) -> list[str]:
    return [block for found, block in BLOCK.findall(text) if found == language]


def without_blocks(text: str) -> str:
    return BLOCK.sub("", text)


def commands(text: str) -> list[list[str]]:
    """The arguments of every command that runs shviewer: lines of shell and CI blocks, and commands within a sentence."""
    lines = [
        line for language in ("sh", "yaml") for block in code_blocks(text, language) for line in block.splitlines()
    ]
    lines = [part for line in lines for part in re.sub("^.*- run: ", "", line).split("&&")]
    lines += re.findall(r"`(shviewer [^`]+)`", without_blocks(text))
    words = [shlex.split(line, comments=True) for line in lines if re.match(r"\s*(\S*/)?shviewer\b", line)]
    return [arguments for _, *arguments in words]


def links(text: str) -> list[str]:
    """Where links and pictures lead, but for those into the web."""
    found = re.findall(r"\]\(([^()\s]+)\)", without_blocks(text))
    return [target for target in found if "://" not in target]


def anchors(text: str) -> list[str]:
    """The names by which a link reaches the headings: lower case, no punctuation, hyphens for spaces."""
    headings = re.findall(r"^#+ (.*)$", without_blocks(text), re.MULTILINE)
    return [re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings]
