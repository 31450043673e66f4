"""`shviewer help [TOPIC]`: a page of the guide, or the help of a mode that has no page of its name; paged on a terminal."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from pathlib import Path

from shviewer.cli.options.modes import PARSERS
from shviewer.errors import UsageError
from shviewer.resources import resource_folder
from shviewer.words import near


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
        words = " ".join(topics)
        raise UsageError(f"no help on {words!r}{_hint(words, pages)}; {listed}")
    text = PARSERS[topic]().format_help() if topic in modes else pages[topic].read_text(encoding="utf-8")
    if sys.stdout is not None and sys.stdout.isatty():
        import pydoc

        pydoc.pager(text)
    else:
        encoding = (sys.stdout and sys.stdout.encoding) or "utf-8"
        print(text.encode(encoding, "backslashreplace").decode(encoding), end="")  # not every one has all characters
    return 0


def _hint(words: str, pages: dict[str, Path]) -> str:
    """The topic that is meant, or the three pages that have these words most often in a heading or as code."""
    if found := near(words, [*pages, *PARSERS], most=1):
        return f"; did you mean shviewer help {found[0]}?"
    counts = {topic: _told(path).count(words.casefold()) for topic, path in pages.items()}
    found = sorted(filter(counts.get, counts), key=lambda topic: -counts[topic])[:3]
    return f"; it is spoken of in {', '.join(found)}" if found else ""


def _told(page: Path) -> str:
    """The headings of a page and what stands in it as code."""
    return "\n".join(re.findall(r"^#.*|`[^`]+`", page.read_text(encoding="utf-8"), re.MULTILINE)).casefold()


def guide_pages() -> dict[str, Path]:
    """The pages of the guide by topic; "guide" is the list of them."""
    paths = sorted((resource_folder("assets") / "guide").glob("*.md"))
    return {"guide" if path.stem == "README" else path.stem: path for path in paths}
