"""Noticing that a light's file has changed, by looking at it now and then."""

from __future__ import annotations

from typing import NamedTuple

from shviewer.lights.light import split_light


class Stamp(NamedTuple):
    """What tells one content of a file from the next without reading it."""

    modified_ns: int
    size: int
    inode: int


def stamp(text: str) -> Stamp | None:
    """Of the file of the light that `text` names; None where there is none at the moment."""
    try:
        status = split_light(text)[0].stat()
    except (OSError, ValueError):
        return None
    return Stamp(status.st_mtime_ns, status.st_size, status.st_ino)


class Watch:
    """Two equal looks in a row make a change: a file that is still being written is not read too early.

    A stamp is reported once, so that a file that cannot be read is not tried again until it has changed. Editors replace
    files: one that is gone is waited for.
    """

    def __init__(self) -> None:
        self._seen: tuple[str, Stamp | None] | None = None
        self._reported: tuple[str, Stamp | None] | None = None

    def changed(self, text: str, read: Stamp | None) -> bool:
        """Whether the file of the light `text` is no longer that with the stamp `read`, and has come to rest."""
        now = stamp(text)
        look = (text, now)
        at_rest, self._seen = look == self._seen, look
        if now is None or now == read or not at_rest or look == self._reported:
            return False
        self._reported = look
        return True
