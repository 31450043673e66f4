"""Shader files joined by their #includes, and a driver's messages with the file and line that people edit."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from shviewer.errors import ShaderError
from shviewer.resources import resource_folder

INCLUDE = re.compile(r'\s*#include\s+"([^"]+)"\s*$')
DRIVER_POSITION = re.compile(r"^(?:\s*(?:ERROR|WARNING):\s*)?\d+[:(](\d+)(?:\((\d+)\))?\)?\s*:?\s*(.*)$")
"""Positions in messages: Mesa "0:42(29): error: ...", NVIDIA "0(42) : error ...", AMD, Intel and Apple "ERROR: 0:42: ..."."""


@dataclass(frozen=True)
class ShaderSource:
    """A joined shader. origins: the file and the line number, from 1, that each of its lines comes from."""

    text: str
    origins: tuple[tuple[str, int], ...]

    def explain(self, log: str) -> str:
        """The driver's messages in one line, with shaders/FILE:LINE in place of line numbers of the joined text."""
        lines = [self._place(line.strip()) for line in log.splitlines() if line.strip(" =")]
        return "; ".join(line for line in lines if line) or "the driver gave no reason"

    def _place(self, line: str) -> str:
        found = DRIVER_POSITION.match(line)
        if not found or not 1 <= int(found[1]) <= len(self.origins):
            return line
        file, number = self.origins[int(found[1]) - 1]
        return f"shaders/{file}:{number}: {found[3]}"


def load_shader(name: str, generated: Mapping[str, str] | None = None) -> ShaderSource:
    """shaders/`name` with its #includes joined, each file once; `generated` holds the text of includes that are no files.

    ShaderError if a file is missing, listing those that are there.
    """
    joined: list[tuple[str, str, int]] = []
    seen: set[str] = set()
    _join(name, generated or {}, joined, seen)
    return ShaderSource(
        "\n".join(text for text, _, _ in joined) + "\n", tuple((file, number) for _, file, number in joined)
    )


def _join(name: str, generated: Mapping[str, str], joined: list[tuple[str, str, int]], seen: set[str]) -> None:
    if name in seen:
        return
    seen.add(name)
    for number, line in enumerate(_read(name, generated).splitlines(), 1):
        include = INCLUDE.match(line)
        if include:
            _join(include[1], generated, joined, seen)
        else:
            joined.append((line, name, number))


def _read(name: str, generated: Mapping[str, str]) -> str:
    if name in generated:
        return generated[name]
    folder = resource_folder("shaders")
    try:
        return (folder / name).read_text(encoding="utf-8")
    except OSError as error:
        there = ", ".join(sorted(path.name for path in folder.iterdir()))
        raise ShaderError(f"no shaders/{name}; there is: {there}") from error
