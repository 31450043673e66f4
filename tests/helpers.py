"""What tests of several folders say in the same words."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import NoReturn, TypeVar

import numpy as np
import pytest

from shviewer.errors import LightError
from shviewer.harmonics.basis import Array
from shviewer.lights.light import Light
from shviewer.viewer.composing.composition import Composition, frame_for
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.state import state_of

T = TypeVar("T")


def unavailable(reason: str) -> NoReturn:
    """What a test needs is not on this machine: it is skipped with the reason; on CI, where all has to be, it fails."""
    if os.environ.get("CI"):
        pytest.fail(reason)
    pytest.skip(reason)


def hear_signals() -> None:
    """From here on, child processes are ended by Ctrl+C and the like, as if they were started from a terminal.

    A shell starts its background jobs with SIGINT ignored, nohup adds SIGHUP, and what is ignored is inherited. A handler
    is not: a child has the default again. This process goes on ignoring them.
    """
    for name in ("SIGINT", "SIGTERM", "SIGQUIT", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) == signal.SIG_IGN:
            signal.signal(number, lambda *_: None)


def ended(number: int, patience: float = 10.0) -> bool:
    """Whether a process has ended, or does so within `patience` seconds."""
    deadline = time.monotonic() + patience
    while time.monotonic() < deadline:
        try:
            os.kill(number, 0)
            stat = Path(f"/proc/{number}/stat")
            if stat.exists() and stat.read_text().rpartition(")")[2].split()[0] == "Z":
                return True  # nobody in a container may bury it
        except (ProcessLookupError, FileNotFoundError):
            return True
        time.sleep(0.02)
    return False


def picture_of(light: str | Light = "green", **changes: object) -> Picture:
    """The picture of a light, an object or a name, with these changes to the state at the start."""
    return prepare(state_of(light, **changes))


def frame_of(picture: Picture, width: int = 1280, height: int = 640, content_scale: float = 1.0) -> Composition:
    """The frame that a picture is drawn in, with its zoom and as many spheres as it has."""
    return frame_for(picture.state.view, width, height, content_scale)


def overlap(one: Box, other: Box) -> bool:
    return one.left < other.right and other.left < one.right and one.top < other.bottom and other.top < one.bottom


def centre(box: Box) -> tuple[float, float]:
    return (box.left + box.right) / 2, (box.top + box.bottom) / 2


def refusal(call: Callable[..., object], *arguments: object, **options: object) -> str:
    """The one line of printable text with which a light is refused."""
    with pytest.raises(LightError) as caught:
        call(*arguments, **options)
    line = str(caught.value)
    assert line.isprintable()
    return line


def to_srgb(linear: Array) -> Array:
    """Encoded values of linear ones, 0 to 1: IEC 61966-2-1."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


def from_srgb(encoded: Array) -> Array:
    """The way back."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


class Lazily(Mapping[str, T]):
    """Named values, each made when it is first asked for. While tests are collected only the names are."""

    def __init__(self, makers: Mapping[str, Callable[[], T]]) -> None:
        self._makers = makers
        self._made: dict[str, T] = {}

    def __getitem__(self, name: str) -> T:
        if name not in self._made:
            self._made[name] = self._makers[name]()
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)


def lat_long_grid(rows: int) -> Array:
    """Directions (rows, 2 (rows - 1), 3) of a lat-long grid with rows on the poles, without shviewer."""
    columns = 2 * (rows - 1)
    theta = np.pi * np.arange(rows)[:, None] / (rows - 1)
    phi = np.pi * (1 - 2 * (np.arange(columns) + 0.5) / columns)
    x, y = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi)
    return np.stack([x, y, np.broadcast_to(np.cos(theta), x.shape)], axis=-1)
