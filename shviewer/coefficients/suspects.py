"""The usual suspects: mistakes by which two sets of coefficients of one function differ, tried alone and together.

Somebody else's coefficients g should equal ours, c, and do not. The usual mistakes are few: the Condon-Shortley phase, m and
-m, the axes, a constant (pi, sqrt(4 pi), any other), the clamped cosine A(l), SN3D's sqrt(2l+1), the sequence of the channels,
or the way the numbers were read. Every combination is undone, and the error that is left decides; among nearly equal errors
the simplest explanation is taken.

The first three are orthogonal and keep each degree's power; factors multiply a degree. Let g' be g with the first three undone,
and e = sum of c^2, d = sum of c g' and p = sum of g'^2 per degree. Then the squared error with a factor f(l) is the sum of
e - 2 f d + f^2 p, so each g' serves all factors at once. The best constant s in front of f is sum f d / sum f^2 p.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from itertools import permutations
from typing import NamedTuple

import numpy as np

from shviewer.coefficients.parts.axes import NAMED_AXES, Axes, all_axes, alternating, mirrored_orders, orders, turn
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.filters import irradiance_factors

MOST_BANDS = 6
"""The most bands compared: enough to tell all suspects apart, and fast to turn."""

ALIKE = 1.5
"""Errors within this factor of the smallest count as equal: what is left then is noise of sampling and digits."""

TINY = 1e-6
"""Relative errors below this count as none: single precision, or six printed digits."""

USUAL_AXES = {"+y+z+x": "z forward", "+z+x+y": "y polar"} | {text: name for name, text in NAMED_AXES.items()}
"""Axes that programs have; any others cost as much as two mistakes."""

ODD_AXES = 2.5

NO_PHASE, SWAPPED = "without the Condon-Shortley phase", "with m and -m swapped"
AS_IRRADIANCE, AS_RADIANCE = "multiplied by A(l), as irradiance", "not multiplied by A(l), as radiance"
SN3D = "divided by sqrt(2l+1), as in SN3D"
OVER_PI, OVER_ROOT, TIMES_ROOT = "divided by pi", "divided by sqrt(4 pi)", "multiplied by sqrt(4 pi)"

SCALES = {
    "": 1.0,
    OVER_PI: np.pi,
    "multiplied by pi": 1 / np.pi,
    OVER_ROOT: np.sqrt(4 * np.pi),
    TIMES_ROOT: 1 / np.sqrt(4 * np.pi),
}
"""A change to the numbers -> the factor that undoes it."""

ANY_SCALE = 1.4
"""The cost of a constant without a name."""

NO_SCALE = 0.01
"""A constant that differs from 1 by no more than this counts as 1."""

CHANNELS = {
    order: (f"with channels in the order {' '.join('RGB'[channel] for channel in order)}", cost)
    for order, cost in zip(permutations(range(3)), (0.0, 2.0, 2.0, 2.0, 2.0, 1.0), strict=True)
}
"""The places of red, green and blue -> words and cost. Blue first is the usual mistake."""


@dataclass(frozen=True)
class Suspect:
    """An explanation. changes: in words, what was done to the given numbers. error: the relative L2 error once undone."""

    changes: tuple[str, ...]
    error: float
    cost: float = 0.0
    """How much must have gone wrong: 1 for each change, more for unusual axes or constants."""

    @property
    def words(self) -> str:
        if not self.changes:
            return "as they are"
        return " and ".join([", ".join(self.changes[:-1]), self.changes[-1]] if len(self.changes) > 1 else self.changes)


class _Tried(NamedTuple):
    """Results for one reading: arrays over channels, orientations, factors per degree, and constants, any constant last."""

    reading: tuple[str, ...]
    errors: Array
    constants: Array
    """The best constant that undoes each, without the last axis."""


def usual_suspects(
    exact: Array, given: Array, readings: Mapping[tuple[str, ...], Array] | None = None
) -> list[Suspect]:
    """Explanations of what was done to `given`: the best, then the best of every other number of changes.

    exact: (N**2, 3), given: (n**2, 3), both in our convention. Errors are relative to `exact`, over the bands that both have,
    up to MOST_BANDS. readings: other ways to read a file's numbers, in words -> the coefficients (n**2, 3) read so.
    """
    n_bands = min(count_bands(exact), count_bands(given), MOST_BANDS)
    exact = exact[: n_bands**2]
    total = float((exact**2).sum())
    if total == 0 or not given[: n_bands**2].any():
        any_given = bool(given[: n_bands**2].any())
        return [Suspect((), 0.0 if not any_given and total == 0 else np.inf if total == 0 else 1.0)]
    ways = {(): given, **(readings or {})}
    tried = [_tried(reading, exact, numbers[: n_bands**2], total) for reading, numbers in ways.items()]
    return _ranked(tried, n_bands)


def _tried(reading: tuple[str, ...], exact: Array, given: Array, total: float) -> _Tried:
    n_bands = count_bands(exact)
    starts = np.arange(n_bands) ** 2
    turned = _orientations(n_bands)[2] @ given  # (orientations, n**2, 3)
    own = np.add.reduceat((turned**2).sum(axis=2), starts, axis=1)
    pairs = np.add.reduceat(exact[None, :, :, None] * turned[:, :, None, :], starts, axis=1)
    with_exact = np.stack([sum(pairs[:, :, i, order[i]] for i in range(3)) for order in CHANNELS])
    f = np.array(list(_by_degree(n_bands).values()))
    linear, square = with_exact @ f.T, np.broadcast_to(own @ (f**2).T, (len(CHANNELS), len(own), len(f)))
    squared = [total - 2 * scale * linear + scale**2 * square for scale in SCALES.values()]
    with np.errstate(divide="ignore", invalid="ignore"):
        best = np.where((linear > 0) & (square > 0), linear / square, 1.0)
    squared.append(np.where(np.abs(best - 1) < NO_SCALE, np.inf, total - best * linear))
    errors = np.sqrt(np.maximum(np.stack(squared, axis=-1), 0.0) / total)
    return _Tried(reading, errors, best)


def _ranked(tried: list[_Tried], n_bands: int) -> list[Suspect]:
    """The simplest explanation that fits about as well as the best; then the best of every other number of changes."""
    cost, length = _costs(n_bands)
    errors = np.stack([one.errors for one in tried])
    extra = np.array([len(one.reading) for one in tried]).reshape(-1, 1, 1, 1, 1)
    costs, lengths = extra + cost, extra + length
    good = errors <= max(ALIKE * float(errors.min()), TINY)
    first = int(np.where(good, costs, np.inf).argmin())  # of equals the first
    places = [first]
    for changes in np.unique(lengths):
        others = np.where(lengths == changes, errors, np.inf).reshape(-1)
        others[first] = np.inf
        if np.isfinite(others.min()):
            places.append(int(others.argmin()))
    places[1:] = sorted(places[1:], key=lambda place: float(errors.flat[place]))
    return [_suspect(tried, n_bands, np.unravel_index(at, errors.shape), float(costs.flat[at])) for at in places]


def _suspect(tried: list[_Tried], n_bands: int, place: tuple[np.intp, ...], cost: float) -> Suspect:
    at, channels, orientation, degree, constant = map(int, place)
    one = tried[at]
    named = list(SCALES)
    scale = (
        named[constant] if constant < len(named) else f"times {1 / one.constants[channels, orientation, degree]:.3g}"
    )
    changes = (
        *one.reading,
        *_orientations(n_bands)[0][orientation],
        list(CHANNELS.values())[channels][0] if channels else "",
        list(_by_degree(n_bands))[degree],
        scale,
    )
    return Suspect(tuple(filter(None, changes)), float(one.errors[channels, orientation, degree, constant]), cost)


@cache
def _costs(n_bands: int) -> tuple[Array, Array]:
    """Cost and number of changes without those of the reading, as arrays with the axes of `_Tried`."""
    words, costs, _ = _orientations(n_bands)
    orientation = np.array(costs)[:, None, None], np.array([len(changes) for changes in words])[:, None, None]
    degree = np.array([bool(word) for word in _by_degree(n_bands)])[:, None].astype(float)
    constant = np.array([*(float(bool(word)) for word in SCALES), ANY_SCALE])
    channel = np.array([cost for _, cost in CHANNELS.values()])[:, None, None, None]
    return (
        channel + orientation[0] + degree + constant,
        (channel > 0) + orientation[1] + degree + (constant > 0),
    )


@cache
def _orientations(n_bands: int) -> tuple[list[tuple[str, ...]], list[float], Array]:
    """Every choice of phase, sign of m and axes: in words, its cost, and the matrix that undoes it, (k, n**2, n**2).

    A half-turn about z equals the phase, and is left out.
    """
    identity = np.eye(n_bands**2)
    phases, swapped = alternating(orders(n_bands)) * identity, identity[mirrored_orders(n_bands)]
    starts = (((), identity), ((NO_PHASE,), phases), ((SWAPPED,), swapped), ((NO_PHASE, SWAPPED), swapped @ phases))
    words: list[tuple[str, ...]] = []
    costs: list[float] = []
    matrices = []
    cycle = turn(identity, CYCLE)
    for axes in all_axes():
        if axes.text == "-x-y+z":
            continue
        turned = _turning(axes.inverse, identity, cycle)
        for changes, start in starts:
            where = () if axes == Axes() else (f"in axes {_axes_name(axes)}",)
            words.append((*changes, *where))
            costs.append(len(changes) + (0 if not where else 1 if axes.text in USUAL_AXES else ODD_AXES))
            matrices.append(turned @ start)
    return words, costs, np.array(matrices)


CYCLE = Axes("+y+z+x")
"""Any axes are this, repeated as needed, and then axes that keep z in its place, whose turns are exact and quick."""


def _turning(axes: Axes, identity: Array, cycle: Array) -> Array:
    """The matrix (n**2, n**2) of `turn`."""
    rest, turned = axes, identity
    while rest.text[5] != "z":
        rest, turned = CYCLE.inverse.then(rest), cycle @ turned
    return turn(turned, rest)


def _axes_name(axes: Axes) -> str:
    name = USUAL_AXES.get(axes.text)
    return f"{axes.text} ({name})" if name else axes.text


def _by_degree(n_bands: int) -> dict[str, Array]:
    """A change -> the factor per degree that undoes it, (n_bands,). Where A(l) is zero nothing can be undone."""
    cosine = irradiance_factors(n_bands)
    zero = (np.arange(n_bands) > 1) & (np.arange(n_bands) % 2 == 1)
    root = np.sqrt(2 * np.arange(n_bands) + 1)
    return {
        "": np.ones(n_bands),
        AS_IRRADIANCE: np.where(zero, 0.0, 1 / np.where(zero, 1.0, cosine)),
        AS_RADIANCE: np.where(zero, 0.0, cosine),
        SN3D: root,
        "multiplied by sqrt(2l+1)": 1 / root,
    }
