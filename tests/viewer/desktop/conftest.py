"""A virtual screen for all window tests, and viewers on it that are closed at the end."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from helpers import unavailable
from viewer.desktop.desktop import Viewer, missing_programs, virtual_display


@pytest.fixture(scope="session")
def display() -> Iterator[str]:
    missing = missing_programs()
    if missing:
        unavailable(f"window tests need {' and '.join(missing)} (apt-get install -y xvfb xauth xdotool)")
    with virtual_display() as name:
        yield name


@pytest.fixture
def start(display: str, tmp_path: Path) -> Iterator[Callable[..., Viewer]]:
    viewers: list[Viewer] = []

    def begin(*arguments: str) -> Viewer:
        viewers.append(Viewer(display, tmp_path, *arguments))
        return viewers[-1]

    yield begin
    for viewer in viewers:
        viewer.close()
