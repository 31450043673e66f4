"""Noticing that a light's file has changed, by looking at it now and then."""

from __future__ import annotations

from time import perf_counter

from shviewer.files import FileVersion
from shviewer.lights.find import file_version

LOOK_SECONDS = 0.2
"""The least time between two looks at a file, also while events come."""


class Watch:
    """A watch on one file. A change counts after two equal looks, so that a file still being written is not read too early.

    A version is reported once, so that a file that cannot be read is not tried again until it has changed. Editors replace
    files: a file that is gone is waited for; `gone` tells of one that stays away.
    """

    def __init__(self) -> None:
        self._seen: tuple[str, FileVersion | None] | None = None
        self._reported: tuple[str, FileVersion | None] | None = None
        self._looked_at = perf_counter()
        self.gone = False
        """Whether the file that was read is no longer there."""

    def due(self, now: float) -> bool:
        """Whether it is time for another look, which is then taken to be made."""
        due = now - self._looked_at >= LOOK_SECONDS
        if due:
            self._looked_at = now
        return due

    def changed(self, text: str, read: FileVersion | None) -> bool:
        """Whether the file of the light `text` is no longer the version `read`, and has come to rest."""
        now = file_version(text)
        look = (text, now)
        at_rest, self._seen = look == self._seen, look
        self.gone = at_rest and now is None and read is not None
        if now is None or now == read or not at_rest or look == self._reported:
            return False
        self._reported = look
        return True
