"""Notes on stderr: what was done to a light, and how well compared coefficients agree with it."""

from __future__ import annotations

import sys

from shviewer.analysis.comparison import verdict
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import load_light, subject
from shviewer.words import one_line


def print_notes(recipe: Recipe) -> None:
    """Print the notes on a light, and on compared coefficients their verdict, or the usual mistake they are off by."""
    shown = subject(recipe)
    notes = [f"note: {shown.light.name}: {note}" for note in shown.light.notes]
    notes += [f"note: {shown.refusal}"] if shown.refusal else []
    notes += [verdict(load_light(recipe), recipe.compare)] if recipe.compare else []
    for note in notes:
        print(one_line(f"shviewer: {note}"), file=sys.stderr)
