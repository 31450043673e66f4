"""What is said of a light on stderr: what was done to it, and how well coefficients that are compared agree."""

from __future__ import annotations

import sys

from shviewer.analysis.comparison import verdict
from shviewer.analysis.subjects import Subject, load_light
from shviewer.viewer.state import ViewState


def print_notes(subject: Subject) -> None:
    for note in subject.light.notes:
        print(f"shviewer: note: {subject.light.name}: {note}", file=sys.stderr)
    if subject.refusal:
        print(f"shviewer: note: {subject.refusal}", file=sys.stderr)


def print_verdict(state: ViewState) -> None:
    """How well coefficients that are compared agree, or by which usual mistake they are off."""
    if state.compare:
        print(f"shviewer: {verdict(load_light(state), state.compare)}", file=sys.stderr)
