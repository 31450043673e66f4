"""Parsers made of tables: a row for each option, and a mistake in it said in one line."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple, NoReturn

from shviewer.words import near, one_line


class Argument(NamedTuple):
    """What argparse is told of one option."""

    names: tuple[str, ...]
    keywords: dict[str, Any]


def row(called: str, help: str, read: Callable[[str], object] | None = None, **keywords: Any) -> Argument:
    """An option: its names and what stands for its values, as in "-o --output DIR"; without values it is a switch.

    read: how a value is read; None for a text. keywords: further ones of argparse.
    """
    words = called.split()
    names, values = tuple(word for word in words if word[0] == "-"), [word for word in words if word[0] != "-"]
    if not values:
        return Argument(names, {"action": "store_true", "help": help} | keywords)
    keywords = {"metavar": values[0], "type": read, "help": help} | keywords
    if len(values) > 1:
        keywords |= {"metavar": tuple(values), "nargs": len(values)}
    return Argument(names or (keywords.pop("dest", called.lower()),), keywords)


class Group(NamedTuple):
    """Options that stand under a title in the help. rows: asked for when they are needed, as those of `View` load it."""

    title: str
    rows: Callable[[], Sequence[Argument]]


class OneLineParser(argparse.ArgumentParser):
    """An argparse parser that reports a mistake in one line on stderr, without the usage, and names values that are missing."""

    def error(self, message: str) -> NoReturn:
        for action in self._actions:
            if action.metavar and message.startswith(f"argument {'/'.join(action.option_strings)}: expected "):
                values = (action.metavar,) if isinstance(action.metavar, str) else action.metavar
                message += f", as in {action.option_strings[0]} {' '.join(values)}"
        unknown = message.removeprefix("unrecognized arguments: ").partition(" ")[0].partition("=")[0]
        flags = [flag for action in self._actions for flag in action.option_strings if flag.startswith("--")]
        if unknown.startswith("--") and message.startswith("unrecognized") and (found := near(unknown, flags)):
            message += f"; did you mean {' or '.join(found)}?"
            self.exit(2, f"shviewer: {one_line(message)}\n")
        self.exit(2, f"shviewer: {one_line(message)}; see {self.prog} --help\n")

    def add(self, table: Iterable[Argument | Group]) -> None:
        """Add the options of a table, in its order."""
        for part in table:
            if isinstance(part, Argument):
                self.add_argument(*part.names, **part.keywords)
                continue
            group = self.add_argument_group(part.title)
            for names, keywords in part.rows():
                group.add_argument(*names, **keywords)


class Paragraphs(argparse.HelpFormatter):
    """Keeps the lines of a text, and breaks those that are too long for the terminal."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        fill = super()._fill_text
        return "\n".join(line if len(line) <= width else fill(line, width, indent) for line in text.splitlines())
