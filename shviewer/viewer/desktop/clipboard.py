"""Files that a text from the clipboard names."""

from __future__ import annotations

import os
from urllib.parse import urlsplit
from urllib.request import url2pathname


def named_files(text: str) -> list[str]:
    """The files and folders that a text names, a line each: paths, in quotation marks or not, or addresses file://...

    A line that names nothing that there is is left out.
    """
    found = (_path(line.strip().strip("\"'")) for line in text.splitlines())
    return [path for path in found if path and os.path.exists(path)]


def _path(line: str) -> str:
    if not line.startswith("file:"):
        return "" if "\0" in line else os.path.expanduser(line)
    try:
        path = url2pathname(urlsplit(line).path)
    except ValueError:
        return ""
    return "" if "\0" in path else path
