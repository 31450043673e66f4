"""The convention of a bare list that does not name it, found by comparing it with a known light."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from shviewer.analysis.comparing.suspecting import FITS, Others, error_of, suspect
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.search import ALIKE, EXPLAINED, TINY
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.coefficients.reading import CoefficientFile, interpreted
from shviewer.errors import LightError
from shviewer.harmonics.basis import Array
from shviewer.words import all_of, brief_percent


@dataclass(frozen=True, eq=False)
class Recognised:
    """A list read in the convention that fits it, or else in the program's that is nearest; and one line on that."""

    file: CoefficientFile
    said: str
    fits: bool


@dataclass(frozen=True, eq=False)
class _Fit:
    text: str
    file: CoefficientFile
    error: float


def recognise(listed: Listed, exact: Array, others: Others = lambda: iter(())) -> Recognised:
    """The convention of a bare list. exact: the light's radiance in our convention, with at least its bands.

    others: the lights that are taken for it by mistake.

    A program's own convention that fits is taken as it is; one with changes if chance does not explain it. LightError if
    the numbers are no table in any convention.
    """
    plain = list(_fits(listed, exact, _different()))
    if not plain:
        interpreted(listed, "scipy" if np.iscomplexobj(listed.numbers) else "shviewer")  # says what is wrong
        raise LightError("numbers in no known convention: name it, --convention")
    found = None
    with suppress(LightError):
        found = suspect(listed, exact, None, others)
    nearest = min(plain, key=lambda fit: max(fit.error, TINY))
    if found is None or found.error > EXPLAINED:
        fits = nearest.error <= FITS
        said = f"{nearest.text} fits{_alike(nearest.error, nearest.text, plain)}" if fits else ""
        nothing = f"no usual one fits; read as {nearest.text}, which is {brief_percent(nearest.error)} off"
        return Recognised(nearest.file, said or nothing, fits)
    base, changes, slips = found.explanation.convention.name, found.changes, all_of(found.slips)
    turned = replace(CONVENTIONS[base], name="", program="") == replace(OURS, name="", program="", phase=False)
    also = (
        ", which is shviewer,no-phase, or shviewer of the map turned by half a turn" if turned and not changes else ""
    )
    called = f"{', '.join([base, *changes])}," if changes else base
    fits = found.error <= FITS
    if fits:
        alike = f", if {slips}" if slips else _alike(found.error, found.text, plain)
        said = f"{called} fits{also}{alike}"
    else:
        said = f"{called} is nearest, {brief_percent(found.error)} off{f' if {slips}' if slips else ''}"
    return Recognised(found.file, f"{said}: --convention {found.text}" if changes else said, fits)


def _alike(error: float, text: str, plain: list[_Fit]) -> str:
    same = [fit.text for fit in plain if fit.text != text and fit.error <= max(ALIKE * error, TINY)]
    return f", as {all_of(same)} would" if same else ""


def _different() -> list[str]:
    """The names of all conventions, of those with the same numbers the first."""
    first: dict[Convention, str] = {}
    for name, one in CONVENTIONS.items():
        first.setdefault(
            replace(one, name="", program="", layout="", sequence="", most_bands=None, fewest_bands=1), name
        )
    return list(first.values())


def _fits(listed: Listed, exact: Array, conventions: list[str]) -> Iterator[_Fit]:
    """The numbers read in each convention that can hold them."""
    for text in conventions:
        with suppress(LightError):
            file = interpreted(listed, text)
            yield _Fit(text, file, error_of(exact, file.coefficients, file.quantity))
