"""Finding the convention of a bare list of numbers by comparing it with a known light."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.parts.quantities import QUANTITIES, RADIANCE
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.reading import CoefficientFile, interpreted
from shviewer.coefficients.suspects import (
    ALIKE,
    AS_IRRADIANCE,
    NO_PHASE,
    OVER_PI,
    OVER_ROOT,
    SN3D,
    SWAPPED,
    TIMES_ROOT,
    TINY,
    usual_suspects,
)
from shviewer.errors import LightError
from shviewer.harmonics.basis import Array
from shviewer.harmonics.filters import irradiance_factors, per_coefficient

FITS = 0.02
"""Coefficients fit if they are off by no more than this share of the light's own in the same bands."""

MODIFIER_OF = {
    frozenset((NO_PHASE,)): "no-phase",
    frozenset((SWAPPED,)): "m-swapped",
    frozenset((AS_IRRADIANCE, OVER_PI)): "irradiance-over-pi",
    frozenset((AS_IRRADIANCE,)): "irradiance",
    frozenset((SN3D, TIMES_ROOT)): "sn3d",
    frozenset((OVER_ROOT,)): "4pi",
}
"""A change to our numbers, in words -> the modifier of a convention that makes it; the longer words first."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A file read in a convention (`text`, for parse_convention), and its relative L2 error, in the quantity it holds."""

    text: str
    file: CoefficientFile
    error: float


@dataclass(frozen=True)
class Found:
    """The convention that fits best or is nearest, whether it fits, and the others that fit as well."""

    best: Fit
    fits: bool
    alike: tuple[str, ...] = ()


def find_convention(numbers: Listed, exact: Array) -> Found:
    """The convention of a bare list as it was read. exact: the light's radiance in our convention, with at least its bands.

    The programs' own conventions come first, then ours with modifiers. LightError if the numbers are no table in any of them.
    """
    first: dict[Convention, str] = {}  # of those with the same numbers
    for name, one in CONVENTIONS.items():
        first.setdefault(replace(one, name="", program="", layout="", most_bands=None, fewest_bands=1), name)
    names = list(first.values())
    names += [f"shviewer,{quantity}" for quantity in QUANTITIES if quantity != RADIANCE]
    fits = list(_fits(numbers, exact, names))
    if not fits:
        interpreted(numbers, "shviewer")  # says what is wrong
        raise LightError("numbers in no known convention: name it, --convention")
    best = min(fits, key=lambda fit: max(fit.error, TINY))
    if best.error > FITS:
        bent = list(_fits(numbers, exact, _bent(numbers, exact)))
        best = min([best, *bent], key=lambda fit: max(fit.error, TINY))  # of equals the simplest, which comes first
    same = [fit.text for fit in fits if fit is not best and fit.error <= max(ALIKE * best.error, TINY)]
    return Found(best, best.error <= FITS, tuple(same) if best.error <= FITS else ())


def _fits(numbers: Listed, exact: Array, conventions: list[str]) -> Iterator[Fit]:
    """The numbers read in each convention that can hold them."""
    for text in conventions:
        with suppress(LightError):
            file = interpreted(numbers, text)
            wanted = exact[: file.n_bands**2]
            if file.quantity != RADIANCE:
                wanted = wanted * per_coefficient(irradiance_factors(file.n_bands))
            norm = float(np.linalg.norm(wanted))
            yield Fit(text, file, float(np.linalg.norm(file.coefficients - wanted)) / norm if norm else np.inf)


def _bent(numbers: Listed, exact: Array) -> list[str]:
    """Our convention with modifiers for the changes that the usual suspects name, as far as there are modifiers."""
    found = []
    for base in ("shviewer", "shviewer,polynomial"):
        with suppress(LightError):
            given = interpreted(numbers, base).coefficients
            for suspect in usual_suspects(exact, given):
                modifiers = modifiers_of(suspect.changes)
                if suspect.error <= FITS and modifiers is not None and not ("no-phase" in modifiers and "," in base):
                    found.append(",".join([base, *modifiers]))
    return found


def modifiers_of(changes: tuple[str, ...]) -> list[str] | None:
    """The modifiers of a convention that makes all these changes to our numbers; None if there is none."""
    left, found = set(changes), []
    for change in changes:
        if change.startswith("in axes "):
            found.append(change.split()[2])
            left.remove(change)
    for done, modifier in MODIFIER_OF.items():
        if done <= left:
            found.append(modifier)
            left -= done
    return None if left else found
