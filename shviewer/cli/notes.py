"""Notes on stderr: what was done to a light, and how well compared coefficients agree with it."""

from __future__ import annotations

import sys

from shviewer.analysis.comparison import verdict
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import Subject, load_light
from shviewer.words import one_line


def print_notes(subject: Subject) -> None:
    for note in subject.light.notes:
        print(one_line(f"shviewer: note: {subject.light.name}: {note}"), file=sys.stderr)
    if subject.refusal:
        print(f"shviewer: note: {subject.refusal}", file=sys.stderr)


def print_verdict(recipe: Recipe) -> None:
    """Print how well compared coefficients agree, or by which usual mistake they are off."""
    if recipe.compare:
        print(f"shviewer: {verdict(load_light(recipe), recipe.compare)}", file=sys.stderr)
