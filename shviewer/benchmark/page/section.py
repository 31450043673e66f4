"""The page and its sections, made of the report and the plots that were drawn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from shviewer.benchmark.rows.report import Report


@dataclass(frozen=True)
class Page:
    """A report and the names of the plots in its folder."""

    report: Report
    plots: Sequence[str] = ()
    plot_message: str = ""
    """The reason why there are no plots, and the remedy."""

    def picture(self, stem: str, words: str) -> list[str]:
        """The lines that show a plot; none if it was not drawn."""
        return [f"![{words}]({stem}.svg)", ""] if f"{stem}.svg" in self.plots else []


class Section(NamedTuple):
    """A section of the page. It is left out if it has no lines."""

    title: str
    command: str
    """The command that measures it; empty if it is no measurement."""
    lines: Callable[[Page], list[str]]
