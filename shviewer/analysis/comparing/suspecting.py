"""The mistake that makes somebody's numbers those of a light: in their convention, in single rows, or in the light itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.bent import bent
from shviewer.coefficients.diagnosis.chance import CHANCE
from shviewer.coefficients.diagnosis.search import ALIKE, CLEAN, EXPLAINED, TINY, Explanation, explain
from shviewer.coefficients.diagnosis.sentences import differences, slips_in_words, words
from shviewer.coefficients.diagnosis.slips import mended
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.reading import CoefficientFile, interpreted
from shviewer.coefficients.texts import convention_text
from shviewer.errors import LightError
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.filters import per_coefficient
from shviewer.harmonics.quantities.kernels import kernel_of
from shviewer.harmonics.quantities.names import RADIANCE
from shviewer.lights.mistaken import MISTAKES
from shviewer.words import all_of

FITS = 0.02
"""Given coefficients that are off by more than this share of the light's own, in the same bands, are examined."""

MANY = 3
"""So many wrong rows are asked whether not all of a band is."""

Others = Callable[[], Iterator[tuple[list[str], Array]]]
"""What makes the lights that are often taken by mistake: words after "if", and coefficients."""


@dataclass(frozen=True, eq=False)
class Suspicion:
    """An explanation of a list, and the list read in its convention."""

    explanation: Explanation
    file: CoefficientFile
    error: float
    """The relative error that is left once all that is wrong is put right."""
    of_light: list[str]
    """What was done to the light, each in words after "if"."""

    @property
    def text(self) -> str:
        """The convention to be named."""
        return convention_text(self.explanation.convention)

    @property
    def changes(self) -> list[str]:
        """What differs from the convention that was meant, in words."""
        return differences(self.explanation.convention, self.explanation.meant)

    @property
    def slips(self) -> list[str]:
        """What is wrong in single rows, and with the light, each after "if"."""
        rows = slips_in_words(self.explanation.slips, self.file.convention, self.file.n_bands)
        return [*self.of_light, *rows]

    def differs(self, named: Convention) -> bool:
        """Whether another convention than that is suspected."""
        return _plain(self.explanation.convention) != _plain(named)

    def conditions(self, named: Convention) -> str:
        """All that must be put right, after "if"."""
        if not self.differs(named):
            return all_of(self.slips)
        said = words(self.explanation.convention, named, self.explanation.meant)
        return all_of([f"its numbers are {said}", *self.slips])


def suspect(listed: Listed, exact: Array, named: Convention | None, others: Others) -> Suspicion | None:
    """The mistake that leaves least, if chance does not explain it. exact: as in `explain`. LightError if it is no table.

    others: asked where the light itself does not fit.
    """
    best = _suspicion(listed, exact, named, [])
    fits = best is not None and best.error <= FITS
    if best is not None and fits and len(best.explanation.slips) < MANY:
        return best
    for said, coefficients in () if fits else others():
        found = _suspicion(listed, coefficients, named, said)
        if found and found.error <= EXPLAINED and (best is None or found.error < best.error / ALIKE):
            best = found
    if best is None or best.error > CLEAN or fits:
        cost, found = _of_another_light(listed, exact, named)
        if found and (best is None or not fits or cost < best.explanation.cost):
            best = found
    return best


def held_as(exact: Array, quantity: str) -> Array:
    """The coefficients of a quantity, of a light whose radiance has these."""
    return exact if quantity == RADIANCE else exact * per_coefficient(kernel_of(quantity).factors(count_bands(exact)))


def error_of(exact: Array, coefficients: Array, quantity: str) -> float:
    """The relative L2 error of our coefficients of a quantity. exact: the radiance, of at least as many bands."""
    wanted = held_as(exact[: len(coefficients)], quantity)
    norm = float(np.linalg.norm(wanted))
    return float(np.linalg.norm(coefficients - wanted)) / norm if norm else np.inf


def _of_another_light(listed: Listed, exact: Array, named: Convention | None) -> tuple[float, Suspicion | None]:
    """The simplest of those that have numbers of their own, an angle or factors, if it leaves little, and its cost."""
    found: list[tuple[float, Suspicion]] = []
    for light in bent(listed, exact):
        one = _suspicion(listed, light.coefficients, named, [light.said], light.choices)
        if one and one.error <= CLEAN:
            found.append((one.explanation.cost + light.cost, one))
    good = max(ALIKE * min((one.error for _, one in found), default=0.0), TINY)
    near = [(cost, one) for cost, one in found if one.error <= good]
    return min(near, key=lambda each: each[0]) if near else (np.inf, None)


def _suspicion(
    listed: Listed, exact: Array, named: Convention | None, of_light: list[str], choices: int = MISTAKES + 1
) -> Suspicion | None:
    found = explain(listed, exact, named)
    if found is None or found.chance * (choices if of_light else 1) > CHANCE or (of_light and found.slips):
        return None
    try:
        file = interpreted(listed, convention_text(found.convention), overrule=True)
        coefficients = file.coefficients
        if found.slips:
            wanted = np.asarray(file.convention.from_ours(exact[: len(coefficients)]))
            coefficients = file.convention.to_ours(mended(np.asarray(file.numbers), found.slips, wanted))
        return Suspicion(found, file, error_of(exact, coefficients, file.quantity), of_light)
    except LightError:  # of numbers that are too large, read so
        return None


def _plain(convention: Convention) -> Convention:
    return replace(convention, quantity=convention.quantity or RADIANCE)
