"""Orientations: phase, sign of m and axes, alone and together, and the matrices that undo them."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from shviewer.coefficients.parts.axes import NAMED_AXES, Axes, all_axes, alternating, mirrored_orders, turn
from shviewer.harmonics.basis import Array, orders

USUAL_AXES = {"+y+z+x": "z forward", "+z+x+y": "y polar"} | {text: name for name, text in NAMED_AXES.items()}
"""Axes that programs have; any others cost as much as two mistakes."""

HALF_TURN = "-x-y+z"

TURNS = {
    HALF_TURN: "of the map turned by half a turn",
    "+y-x+z": "of the map turned by a quarter, its left in the middle",
    "-y+x+z": "of the map turned by a quarter, its right in the middle",
    "+x-y+z": "of the map mirrored left to right",
    "+x+y-z": "of the map flipped top to bottom",
    "+x-y-z": "of the map turned upside down",
    "-x-y-z": "of the light from opposite directions",
}
"""What happened to a light, if the axes are these against those that were meant -> words. Our y is left, our x the middle."""

FLIPS = ("+x-y+z", "+x+y-z")

CYCLE = Axes("+y+z+x")
"""Any axes are this, repeated as needed, and then axes that keep z in its place, whose turns are exact and quick."""


class Orientation(NamedTuple):
    """What was done to coefficients: the phase left out, m and -m swapped, other axes."""

    phase: bool
    mirrored: bool
    axes: Axes


@cache
def orientations() -> list[Orientation]:
    """All 192: for each choice of phase and sign of m all axes, our own first."""
    return [Orientation(phase, swap, axes) for swap in (False, True) for phase in (True, False) for axes in all_axes()]


@cache
def undoing(n_bands: int) -> Array:
    """The matrices that undo each orientation, (192, n_bands**2, n_bands**2)."""
    identity = np.eye(n_bands**2)
    cycle = turn(identity, CYCLE)
    turned = [_turning(axes.inverse, identity, cycle) for axes in all_axes()]
    phases, swapped = alternating(orders(n_bands)) * identity, identity[mirrored_orders(n_bands)]
    starts = (identity, phases, swapped, swapped @ phases)
    return np.array([one @ start for start in starts for one in turned])


def _turning(axes: Axes, identity: Array, cycle: Array) -> Array:
    """The matrix (n**2, n**2) of `turn`."""
    rest, turned = axes, identity
    while rest.text[5] != "z":
        rest, turned = CYCLE.inverse.then(rest), cycle @ turned
    return turn(turned, rest)


def between(meant: Axes, found: Axes) -> Axes:
    """What was done to our light, if it was written in `found` for a program with the axes `meant`."""
    return found.then(meant.inverse)


def axes_name(axes: Axes) -> str:
    """The axes as --axes takes them, with their usual name if they have one: "+x+z-y (y-up)"."""
    name = USUAL_AXES.get(axes.text)
    return f"{axes.text} ({name})" if name else axes.text
