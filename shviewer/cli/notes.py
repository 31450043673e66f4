"""Notes on stderr: what was done to a light, how well compared coefficients agree with it, and what was written."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from shviewer.analysis.comparing.comparison import verdict_of
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import subject
from shviewer.coefficients.suns import sun_left_out
from shviewer.words import one_line

if TYPE_CHECKING:  # a picture loads nothing that writes files of coefficients
    from shviewer.analysis.projected import Projected
    from shviewer.coefficients.parts.axes import Axes


def print_notes(recipe: Recipe) -> None:
    """Print the notes on a light, and on compared coefficients their verdict, or the usual mistake they are off by."""
    shown = subject(recipe)
    notes = [f"note: {shown.light.name}: {note}" for note in shown.light.notes]
    notes += [f"note: {shown.refusal}"] if shown.refusal else []
    notes += [said] if (said := verdict_of(recipe)) else []
    for note in notes:
        _say(note)


def print_notes_on(projected: Projected, axes: Axes, light: str) -> None:
    """Print the notes on a light that was projected, and what was left out of it. axes: those of the file; light: its name."""
    for note in (*projected.notes, *(sun_left_out(sun.directional_light, axes) for sun in projected.suns)):
        own = note.removeprefix(f"{projected.name} ")  # "sky has no sun: ..." names it itself
        _say(f"note: {light}{': ' if own == note else ' '}{own}")


def warn_below_zero(projected: Projected, light: str) -> None:
    """Print what of the numbers that were written is shown below zero. light: its name."""
    if projected.below_zero:
        _say(f"note: {light}: {projected.below_zero}")


def say_written(out: Path, what: str) -> None:
    """Say on a terminal which file was written and what it is; a pipe gets what needs attention alone."""
    if sys.stderr.isatty():
        _say(f"wrote {out}: {what}")


def _say(text: str) -> None:
    print(one_line(f"shviewer: {text}"), file=sys.stderr)
