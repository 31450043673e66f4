"""The reading: a user's choices of how image and coefficient files are read."""

from __future__ import annotations

from dataclasses import dataclass, field

from shviewer.limits import DEFAULT_LIMITS, Limits

LAYOUTS = ("lat-long", "cube", "angular", "mirror-ball")
"""The layouts, that is, the ways in which an image may cover the sphere; lights/layouts has a file for each."""

LAYOUT_CHOICES = ("auto", *LAYOUTS)


@dataclass(frozen=True)
class Reading:
    """How files are read.

    sanitize: NaN and -Inf become 0, +Inf the largest finite value, negative values 0. Without it NaN and Inf are
    refused and negative values kept: projection is linear, and real maps have some.
    """

    sanitize: bool = False
    layout: str = "auto"
    """"auto" or a name of lights/layouts."""
    limits: Limits = DEFAULT_LIMITS
    convention: str = ""
    """The convention of coefficient files that do not name theirs: a text for parse_convention (coefficients/programs.py)."""
    isolated: bool | None = field(default=None, compare=False)
    """Decode in a child process, which a broken file may kill without harm: OpenEXR if True, OpenImageIO unless False.

    It changes no value.
    """


DEFAULT_READING = Reading()
