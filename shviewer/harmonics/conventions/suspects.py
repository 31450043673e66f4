"""Why two sets of coefficients of one function differ: the usual suspects, tried alone and together.

Somebody else's coefficients g should be ours, c, and are not. What people get wrong is a short list: the Condon-Shortley phase,
m and -m, the axes, a constant (pi, sqrt(4 pi)), the clamped cosine A(l), SN3D's sqrt(2l+1), or the program altogether. Each is
undone in every combination, and the error that is left decides; of nearly equal ones the simplest explanation is taken.

The first three are orthogonal and keep each degree's power; the others multiply a degree. So with e = sum of c^2, d = sum of
c g' and p = sum of g'^2 per degree, for g' = g with the first three undone, the squared error of a factor f(l) is the sum of
e - 2 f d + f^2 p, and each g' answers for all factors at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.conventions.axes import NAMED_AXES, Axes, all_axes, alternating, mirrored_orders, orders, turn
from shviewer.harmonics.filters import irradiance_factors

MOST_BANDS = 6
"""As many tell all suspects apart, and turn in no time."""

ALIKE = 1.5
"""Errors within this factor of the smallest are explained as well; what is left of them is noise of sampling and digits."""

TINY = 1e-6
"""Relative errors below this are all none: single precision, six printed digits."""

USUAL_AXES = {"+y+z+x": "z forward", "+z+x+y": "y polar"} | {text: name for name, text in NAMED_AXES.items()}
"""Those that programs have; any other costs as much as two mistakes."""

ODD_AXES = 2.5

SCALES = {
    "": 1.0,
    "divided by pi": np.pi,
    "multiplied by pi": 1 / np.pi,
    "divided by sqrt(4 pi)": np.sqrt(4 * np.pi),
    "multiplied by sqrt(4 pi)": 1 / np.sqrt(4 * np.pi),
}
"""What was done to the numbers -> the factor that undoes it."""


@dataclass(frozen=True)
class Suspect:
    """changes: what was done to the given numbers, in words; none for as they are. error: relative L2 once it is undone."""

    changes: tuple[str, ...]
    error: float
    cost: float = 0.0
    """How much has to have gone wrong: 1 for each change, more for axes that nobody has."""

    @property
    def words(self) -> str:
        if not self.changes:
            return "as they are"
        return " and ".join([", ".join(self.changes[:-1]), self.changes[-1]] if len(self.changes) > 1 else self.changes)


def usual_suspects(exact: Array, given: Array, readings: Mapping[str, Array] | None = None) -> list[Suspect]:
    """What might have been done to `given`: the best explanation, then the best of every number of changes.

    exact: (N**2, 3), given: (n**2, 3), both in our convention; errors are over the bands both have, up to MOST_BANDS, relative
    to those of `exact`. readings: the numbers of a file as other programs' conventions make them ours, by name.
    """
    n_bands = min(count_bands(exact), count_bands(given), MOST_BANDS)
    exact, given = exact[: n_bands**2], given[: n_bands**2]
    total = float((exact**2).sum())
    if total == 0 or not given.any():
        return [Suspect((), 0.0 if not given.any() and total == 0 else np.inf if total == 0 else 1.0)]
    found = [
        Suspect((*orientation, *done), error, cost + len(done))
        for orientation, cost, turned in _orientations(given)
        for done, error in _factors(exact, turned, total)
    ]
    for name, numbers in (readings or {}).items():
        shared = min(n_bands, count_bands(numbers)) ** 2
        left = float(((exact[:shared] - numbers[:shared]) ** 2).sum() + (exact[shared:] ** 2).sum())
        found.append(Suspect((f"in the convention of {name}",), float(np.sqrt(left / total)), 1.0))
    return _ranked(found)


def _ranked(found: list[Suspect]) -> list[Suspect]:
    """The simplest of those that fit about as well as the best; then the best of every other length."""
    best = min(suspect.error for suspect in found)
    good = [suspect for suspect in found if suspect.error <= max(ALIKE * best, TINY)]
    first = min(good, key=lambda suspect: suspect.cost)  # of equal ones that which comes first
    rest: dict[int, Suspect] = {}
    for suspect in found:
        length = len(suspect.changes)
        if suspect is not first and (length not in rest or suspect.error < rest[length].error):
            rest[length] = suspect
    return [first, *sorted(rest.values(), key=lambda suspect: suspect.error)]


def _orientations(given: Array) -> Iterator[tuple[tuple[str, ...], float, Array]]:
    """Every choice of phase, order and axes: in words, what it costs, undone. Half a turn about z is the phase: left out."""
    n_bands = count_bands(given)
    phases = alternating(orders(n_bands))
    swapped = given[mirrored_orders(n_bands)]
    starts = (((), given), (("phase",), given * phases), (("swap",), swapped), (("phase", "swap"), swapped * phases))
    words = {"phase": "without the Condon-Shortley phase", "swap": "with m and -m swapped"}
    together = np.concatenate([start for _, start in starts], axis=1)
    for axes in all_axes():
        if axes.text == "-x-y+z":
            continue
        turned = turn(together, axes.inverse)
        for number, (changes, _) in enumerate(starts):
            done = tuple(words[change] for change in changes)
            where = () if axes == Axes() else (f"in axes {_axes_name(axes)}",)
            cost = len(done) + (0 if not where else 1 if axes.text in USUAL_AXES else ODD_AXES)
            yield (*done, *where), cost, turned[:, 3 * number : 3 * number + 3]


def _axes_name(axes: Axes) -> str:
    name = USUAL_AXES.get(axes.text)
    return f"{axes.text} ({name})" if name else axes.text


def _factors(exact: Array, turned: Array, total: float) -> Iterator[tuple[tuple[str, ...], float]]:
    """(what was done, the error once it is undone) for every factor per degree."""
    n_bands = count_bands(exact)
    starts = np.arange(n_bands) ** 2
    with_exact = np.add.reduceat((exact * turned).sum(axis=1), starts)
    own = np.add.reduceat((turned**2).sum(axis=1), starts)
    for (by_degree, factors), (constant, scale) in product(_by_degree(n_bands).items(), SCALES.items()):
        f = factors * scale
        squared = total + float((f * (f * own - 2 * with_exact)).sum())
        yield tuple(word for word in (by_degree, constant) if word), float(np.sqrt(max(squared, 0.0) / total))


def _by_degree(n_bands: int) -> dict[str, Array]:
    """What was done -> the factor per degree that undoes it, (n_bands,). Where A(l) is zero nothing can be undone."""
    cosine = irradiance_factors(n_bands)
    zero = (np.arange(n_bands) > 1) & (np.arange(n_bands) % 2 == 1)
    root = np.sqrt(2 * np.arange(n_bands) + 1)
    return {
        "": np.ones(n_bands),
        "multiplied by A(l), as irradiance": np.where(zero, 0.0, 1 / np.where(zero, 1.0, cosine)),
        "not multiplied by A(l), as radiance": np.where(zero, 0.0, cosine),
        "divided by sqrt(2l+1), as in SN3D": root,
        "multiplied by sqrt(2l+1)": 1 / root,
    }
