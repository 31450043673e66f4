"""The mistake that makes somebody's numbers those of a light: in their convention, in single rows, or in the light itself."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.bent import NEAR, Bending, Bent
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

MOST_NEAR = 6
"""The most lights to which several things are done at once."""

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
    best = _suspicion(listed, named, Bent([], exact))
    fits = best is not None and best.error <= FITS
    if best is not None and fits and len(best.explanation.slips) < MANY:
        return best
    lights = [Bent([], exact)]
    for said, coefficients in () if fits else others():
        lights.append(Bent(said, coefficients, MISTAKES + 1))
        found = _suspicion(listed, named, lights[-1])
        if found and found.error <= EXPLAINED and (best is None or found.error < best.error / ALIKE):
            best = found
    bending = Bending(listed, count_bands(exact))
    plain = bending.plain(lights[0])
    single = [light for one in plain for light in ([one, *bending.bent(one)] if not one.said else [one]) if light.said]
    if one := _simplest(listed, named, single):
        cost, found = one
        if best is None or (cost < best.explanation.cost if fits else found.error < best.error / ALIKE):
            best = found
    if fits or (best is not None and best.error <= FITS):
        return best
    several = _simplest(listed, named, _several(bending, lights))
    left = EXPLAINED * (best.error if best is not None else 1.0)
    return several[1] if several and several[1].error <= max(left, TINY) else best


def _several(bending: Bending, lights: list[Bent]) -> Iterator[Bent]:
    """Lights to which two things were done or more, of those that come nearest to the list by them."""
    bases = [one for light in lights for one in bending.plain(light)]
    near = sorted(((1 - bending.nearness(one), number) for number, one in enumerate(bases)))
    for far, number in near[:MOST_NEAR]:
        if far > min(max(ALIKE * near[0][0], TINY), 1 - NEAR):
            break
        yield from (light for light in [bases[number], *bending.bent(bases[number])] if len(light.said) > 1)


def held_as(exact: Array, quantity: str) -> Array:
    """The coefficients of a quantity, of a light whose radiance has these."""
    return exact if quantity == RADIANCE else exact * per_coefficient(kernel_of(quantity).factors(count_bands(exact)))


def error_of(exact: Array, coefficients: Array, quantity: str) -> float:
    """The relative L2 error of our coefficients of a quantity. exact: the radiance, of at least as many bands."""
    wanted = held_as(exact[: len(coefficients)], quantity)
    norm = float(np.linalg.norm(wanted))
    return float(np.linalg.norm(coefficients - wanted)) / norm if norm else np.inf


def _simplest(listed: Listed, named: Convention | None, lights: Iterable[Bent]) -> tuple[float, Suspicion] | None:
    """The simplest of lights to which something was done that leaves little, if one does, and its cost."""
    found: list[tuple[float, Suspicion]] = []
    for light in lights:
        one = _suspicion(listed, named, light)
        if one and one.error <= CLEAN:
            found.append((one.explanation.cost + light.cost, one))
    good = max(ALIKE * min((one.error for _, one in found), default=0.0), TINY)
    return min((each for each in found if each[1].error <= good), key=lambda each: each[0], default=None)


def _suspicion(listed: Listed, named: Convention | None, light: Bent) -> Suspicion | None:
    found = explain(listed, light.coefficients, named)
    if found is None or found.chance * light.choices > CHANCE or (light.said and found.slips):
        return None
    try:
        file = interpreted(listed, convention_text(found.convention), overrule=True)
        coefficients = file.coefficients
        if found.slips:
            wanted = np.asarray(file.convention.from_ours(light.coefficients[: len(coefficients)]))
            coefficients = file.convention.to_ours(mended(np.asarray(file.numbers), found.slips, wanted))
        return Suspicion(found, file, error_of(light.coefficients, coefficients, file.quantity), light.said)
    except LightError:  # of numbers that are too large, read so
        return None


def _plain(convention: Convention) -> Convention:
    return replace(convention, quantity=convention.quantity or RADIANCE)
