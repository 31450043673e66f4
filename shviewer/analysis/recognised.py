"""The convention of a bare list that does not name it, found by comparing it with a known light."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace

from shviewer.analysis.comparison import EXPLAINED, FITS, error_of
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.chance import CHANCE
from shviewer.coefficients.diagnosis.search import ALIKE, TINY, explain
from shviewer.coefficients.diagnosis.sentences import differences
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.coefficients.reading import CoefficientFile, interpreted
from shviewer.coefficients.texts import convention_text
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


def recognise(listed: Listed, exact: Array) -> Recognised:
    """The convention of a bare list. exact: the light's radiance in our convention, with at least its bands.

    A program's own convention that fits is taken as it is; one with changes if chance does not explain it. LightError if
    the numbers are no table in any convention.
    """
    plain = list(_fits(listed, exact, _different()))
    if not plain:
        interpreted(listed, "shviewer")  # says what is wrong
        raise LightError("numbers in no known convention: name it, --convention")
    found, changes = None, list[str]()
    with suppress(LightError):
        if (best := explain(listed, exact)) is not None:
            found = next(_fits(listed, exact, [convention_text(best.convention)]), None)
            changes = differences(best.convention)
            if found and (found.error > EXPLAINED or (changes and best.chance > CHANCE)):
                found = None
    if found is None:
        nearest = min(plain, key=lambda fit: max(fit.error, TINY))
        fits = nearest.error <= FITS
        said = f"{nearest.text} fits{_alike(nearest, plain)}" if fits else ""
        nothing = f"no usual one fits; read as {nearest.text}, which is {brief_percent(nearest.error)} off"
        return Recognised(nearest.file, said or nothing, fits)
    base = found.text.partition(",")[0]
    turned = replace(CONVENTIONS[base], name="", program="") == replace(OURS, name="", program="", phase=False)
    also = ", or shviewer of the map turned by half a turn, which is the same" if turned and not changes else ""
    called = f"{', '.join([base, *changes])}," if changes else base
    fits = found.error <= FITS
    said = (
        f"{called} fits{also}{_alike(found, plain)}"
        if fits
        else f"{called} is nearest, {brief_percent(found.error)} off"
    )
    return Recognised(found.file, f"{said}: --convention {found.text}" if changes else said, fits)


def _alike(best: _Fit, plain: list[_Fit]) -> str:
    same = [fit.text for fit in plain if fit.text != best.text and fit.error <= max(ALIKE * best.error, TINY)]
    alike = all_of(same)
    return f", as {alike} would" if alike else ""


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
