"""Kinds of messages. A message is a text; its first sign says its kind, so that shape says it, too."""

from __future__ import annotations

DONE, WARNING, ERROR = "✓", "▲", "×"

LASTING = (WARNING, ERROR)
"""The kinds that stay until the next key; the others go after some seconds."""

SECONDS = 4.0


def done(text: str) -> str:
    """Something that was asked for and has been done."""
    return f"{DONE} {text}"


def warning(text: str) -> str:
    """Something that may be wrong with what is shown."""
    return f"{WARNING} {text}"


def error(text: str) -> str:
    """Something that was asked for and could not be done."""
    return f"{ERROR} {text}"


def parted(message: str) -> tuple[str, str]:
    """The sign of a message, "" for a note, and its words."""
    sign, space, words = message.partition(" ")
    return (sign, words) if space and sign in (DONE, WARNING, ERROR) else ("", message)
