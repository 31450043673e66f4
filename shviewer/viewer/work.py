"""Work behind a picture, as it is told to whoever waits: what is done, and how far it is."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Work:
    """What is at work behind the picture: in words, the share that is done, and the seconds left, where they are known."""

    words: str
    share: float | None = None
    seconds_left: float | None = None
    seconds: float = 0.0
    """How long it has been at work."""
