"""Messages of the window: texts that know of what kind they are. A text without a kind is a note."""

from __future__ import annotations

from typing import Self

DONE, WARNING, ERROR = "✓", "▲", "×"
"""The kinds, by the signs that stand before their words; "" is the kind of a note."""

SECONDS = 4.0
"""How long notes, and what has been done, are shown; warnings and errors stay until the next key."""


class Message(str):
    """A text with the kind of message it is."""

    kind: str

    def __new__(cls, text: str, kind: str = "") -> Self:
        made = super().__new__(cls, text)
        made.kind = kind
        return made


def warning(text: str) -> Message:
    """Something that may be wrong with what is shown; "" stays no message at all."""
    return Message(text, WARNING if text else "")


def kind_of(text: str) -> str:
    return text.kind if isinstance(text, Message) else ""


def passes(text: str) -> bool:
    """Whether a message goes after some seconds by itself."""
    return kind_of(text) in ("", DONE)


class Passing:
    """The message that is seen, and since when."""

    def __init__(self) -> None:
        self._seen, self._since = "", 0.0

    def over(self, text: str, now: float) -> bool:
        """Whether a message has been seen for as long as it is shown."""
        if text is not self._seen:
            self._seen, self._since = text, now
        return bool(text) and passes(text) and now - self._since >= SECONDS
