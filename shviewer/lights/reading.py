"""How files are read: what a user may choose about it, for images and coefficients alike."""

from __future__ import annotations

from dataclasses import dataclass, field

from shviewer.limits import DEFAULT_LIMITS, Limits

LAYOUTS = ("lat-long", "cube", "angular", "mirror-ball")
"""How an image may cover the sphere; lights/layouts has a file for each."""

LAYOUT_CHOICES = ("auto", *LAYOUTS)


@dataclass(frozen=True)
class Reading:
    """How files are read; what a user may choose about it.

    sanitize: NaN and -Inf become 0, +Inf the largest finite value, negative values 0. Without it NaN and Inf are
    refused and negative values kept: projection is linear, and real maps have some.
    """

    sanitize: bool = False
    layout: str = "auto"
    """"auto" or a name of lights/layouts."""
    limits: Limits = DEFAULT_LIMITS
    convention: str = ""
    """What coefficient files have that do not say theirs: a text for parse_convention (coefficients/programs.py)."""
    isolated: bool = field(default=False, compare=False)
    """Decode OpenEXR files in a child process, which a broken file may kill without harm. It changes no value."""


DEFAULT_READING = Reading()
