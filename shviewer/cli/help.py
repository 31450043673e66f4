"""`shviewer help [TOPIC]`: a page of the guide, or the help of a mode that has no page of its name; paged on a terminal."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from shviewer.cli.options.modes import PARSERS
from shviewer.errors import UsageError
from shviewer.resources import resource_folder


def run(topics: Sequence[str]) -> int:
    """Show a topic; without one the options and the topics there are. UsageError for a topic that is none, or for several."""
    pages = guide_pages()
    modes = [mode for mode in PARSERS if mode != "view" and mode not in pages]
    listed = f"topics of shviewer help: {', '.join([*pages, *modes])}"
    if not topics:
        print(f"{PARSERS['view']().format_help()}\n{listed}")
        return 0
    (topic, *others) = topics
    if others or (topic not in pages and topic not in modes):
        raise UsageError(f"no help on {' '.join(topics)!r}; {listed}")
    text = PARSERS[topic]().format_help() if topic in modes else pages[topic].read_text(encoding="utf-8")
    if sys.stdout is not None and sys.stdout.isatty():
        import pydoc

        pydoc.pager(text)
    else:
        print(text, end="")
    return 0


def guide_pages() -> dict[str, Path]:
    """The pages of the guide by topic; "guide" is the list of them."""
    paths = sorted((resource_folder("assets") / "guide").glob("*.md"))
    return {"guide" if path.stem == "README" else path.stem: path for path in paths}
