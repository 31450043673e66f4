"""Marks of files: the size and the SHA-256 by which a picture knows the files that it was made of."""

from __future__ import annotations

import hashlib
import os
from functools import lru_cache
from pathlib import Path
from typing import Any

from shviewer.files import FileVersion, opened, version_of
from shviewer.progress import tell


def mark_of(path: Path, version: FileVersion | None) -> dict[str, Any] | None:
    """The mark of a file as it was in that version; None if it has changed since, or is no regular file."""
    if version is None or version_of(path) != version or not os.path.isfile(path):
        return None
    digest = _digest(os.path.abspath(path), version)
    return None if digest is None else {"bytes": version.size, "sha256": digest}


def has_mark(path: Path, mark: dict[str, Any]) -> bool:
    """Whether a file has these bytes. A file of another size is not read."""
    version, wanted = version_of(path), {"bytes": mark.get("bytes"), "sha256": mark.get("sha256")}
    return version is not None and version.size == wanted["bytes"] and mark_of(path, version) == wanted


@lru_cache(maxsize=64)
def _digest(path: str, version: FileVersion) -> str | None:
    try:
        with opened(Path(path)) as file:
            digest, done = hashlib.sha256(), 0
            while piece := file.read(2**20):
                digest.update(piece)
                done += len(piece)
                tell(share=done / max(version.size, done))
            return digest.hexdigest()
    except OSError:
        return None
