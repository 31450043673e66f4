"""Numbers that an engine stores of irradiance beside those of a light: whether they are what its encoding makes of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from shviewer.analysis.comparing.suspecting import FITS, Others, suspect
from shviewer.coefficients.diagnosis.chance import CHANCE, share_of_directions
from shviewer.coefficients.diagnosis.search import ALIKE, CLEAN, TINY
from shviewer.coefficients.diagnosis.sentences import differences
from shviewer.coefficients.diagnosis.tried import constant_of
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.parts.axes import Axes, all_axes
from shviewer.coefficients.reading import CoefficientFile
from shviewer.coefficients.stored_code import in_axes
from shviewer.harmonics.basis import Array
from shviewer.harmonics.quantities.encodings import ENCODINGS, Stored
from shviewer.words import all_of, brief_percent


def verdict_on_stored(radiance: Array, file: CoefficientFile, name: str, others: Others = lambda: iter(())) -> str:
    """One line on a file of an encoding: how near its irradiance is to what the encoding makes of a light, or what is wrong.

    radiance: the light's coefficients, (n**2, 3), of as many bands as a cube is made of; others: as in `suspect`.
    """
    given = file.stored
    assert given is not None
    encoding = given.encoding
    try:
        wanted = encoding.expand(encoding.store(radiance))
    except ValueError as error:  # as of deringing
        return f"{name} holds {encoding.words}, which the light has not: {error}"
    norm, off = float(np.linalg.norm(wanted)), float(np.linalg.norm(encoding.expand(given.numbers) - wanted))
    if off <= FITS * norm:
        near = brief_percent(max(off / norm if norm else 0.0, TINY))
        return f"{name} agrees with the light's own {encoding.words} to {near} over its {encoding.floats} numbers"
    says = f"{name} is {brief_percent(off / norm) if norm else 'wholly'} off the light's own {encoding.words}"
    if not given.numbers.any():
        return f"{says}: its numbers are all zero"
    found = min(_causes(radiance, file, given), key=lambda one: one[0], default=None)
    found = found or _of_a_list(radiance, file, given, others)
    if found is None:
        return f"{says}, which no usual mistake explains"
    left = "not at all" if found[0] < TINY else brief_percent(found[0])
    return f"{says}, but {left} if {found[1]}"


def _causes(radiance: Array, file: CoefficientFile, given: Stored) -> Iterator[tuple[float, str]]:
    """What would make the numbers right and chance does not: the error that is left, and words after "if"."""
    plain = replace(file.convention, quantity=None)
    held = given.numbers  # in our axes, as the file says
    alike = [name for name, one in ENCODINGS.items() if one.formula == given.encoding.formula]
    places = [Axes(), *(axes for axes in all_axes() if axes != Axes())]
    least = np.inf
    for name in sorted(alike, key=lambda name: name != given.name):
        try:
            own = Stored(name, ENCODINGS[name].store(radiance))
        except ValueError:
            continue
        for axes in places:
            wanted = in_axes(own, axes)
            factor = float((wanted * held).sum() / ((wanted**2).sum() or 1.0))
            if factor <= 0:
                continue
            error = float(np.linalg.norm(held - factor * wanted) / np.linalg.norm(held))
            sure = share_of_directions(_turning(own, held), _turning(own, wanted)) * len(places) * len(alike) <= CHANCE
            if error > CLEAN or not sure or error >= max(least, TINY) / ALIKE:
                continue
            least = error
            read = replace(plain, axes=axes.then(plain.axes), factor=constant_of(factor, error))
            said = [f"they are those of {name}"] if name != given.name else []
            if changes := differences(read, plain):
                said = [*said, f"its numbers are {all_of(changes)}"]
            if said:
                yield error, all_of(said)


def _of_a_list(radiance: Array, file: CoefficientFile, given: Stored, others: Others) -> tuple[float, str] | None:
    """What is wrong with coefficients of radiance, where an encoding keeps nothing else: the same, or None."""
    encoding, plain = given.encoding, replace(file.convention, quantity=None)
    if encoding.coefficients < encoding.floats:
        return None
    found = suspect(Listed(file.numbers), encoding.store(radiance), plain, others)
    return (found.error, found.conditions(plain)) if found and found.error <= CLEAN else None


def _turning(stored: Stored, numbers: Array) -> Array:
    """What tells a direction in numbers of an encoding, (k, 3): not their mean, nor what is about an axis of its own."""
    count = stored.encoding.coefficients
    return numbers[1:count] if count else numbers - numbers.mean(axis=0)
