"""Texts of conventions, as --convention takes them: a name and modifiers, such as "three,z-up"."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.parts.axes import NAMED_AXES, Axes
from shviewer.coefficients.parts.channels import CHANNEL_ORDERS, SEQUENCES
from shviewer.coefficients.parts.quantities import QUANTITIES
from shviewer.coefficients.parts.rows import ACN, ORDERS
from shviewer.coefficients.parts.scales import POLYNOMIAL_BANDS, SCALES
from shviewer.coefficients.programs import CONVENTIONS, OURS, READINGS
from shviewer.harmonics.quantities.names import GLOSSY, quantity_of
from shviewer.words import meant

SHIFTED, SHIFT = "shifted", CONVENTIONS["3dgs"].shift
"""The modifier of a list whose mean is less, as 3D Gaussian splatting has it, and by how much."""

_TIMES = "times="
LARGEST_FACTOR = 1e30

FREE = ("axes", "quantity", "channels", "sequence", "factor")
"""Fields in which a list may differ from what the program expects; the others are fixed but in our own convention."""

_WORDS: dict[str, dict[str, object]] = {
    "axes": {name: Axes(text) for name, text in NAMED_AXES.items()},
    "scale": {name: name for name in SCALES},
    "phase": {"phase": True, "no-phase": False},
    "mirrored": {"m-swapped": True},
    "order": {name: name for name in ORDERS if name != ACN},
    "shift": {SHIFTED: SHIFT},
    "quantity": {name: name for name in QUANTITIES},
    "channels": {name: name for name in CHANNEL_ORDERS},
    "sequence": {name: name for name in SEQUENCES},
}
"""Field of a convention -> the modifiers that change it, each with the value that it stands for, in the order of a text."""

_LISTED = ("phase", "mirrored", "shift", "quantity", "scale", "order", "axes", "channels", "sequence")
MODIFIERS = tuple(word for name in _LISTED for word in _WORDS[name])


def parse_convention(text: str) -> Convention:
    """The convention of a text: a name and modifiers, such as "three,z-up" or "shviewer,no-phase,4pi,irradiance".

    Names are those of CONVENTIONS, modifiers those of MODIFIERS, or axes such as "+x+z-y". ValueError for an unknown one, and
    for a modifier that contradicts the program or another modifier.
    """
    name, *modifiers = (part.strip() for part in text.split(","))
    if name in READINGS:
        raise ValueError(
            f"convention {name!r}: nobody documents its phase; name a reading, {' or '.join(READINGS[name])}: with a lamp"
            " overhead row 1 is negative with phase, positive without"
        )
    if name not in CONVENTIONS:
        raise ValueError(f"convention {name!r}: {_advice(name, text)}")
    convention, said = CONVENTIONS[name], dict[str, str]()
    for modifier in modifiers:
        name, value = _change(modifier)
        convention = _modified(convention, modifier, name, value)
        if said.setdefault(name, modifier) != modifier:
            raise ValueError(f"convention {text!r}: {said[name]} and {modifier} contradict each other")
    return convention


def _advice(name: str, text: str) -> str:
    """What to write in place of a name that no convention has; a modifier wants a name before it."""
    try:
        _change(name)
    except ValueError:
        return meant(name, CONVENTIONS)
    return f"that differs from a convention, whose name comes first: {OURS.name},{text}"


def _change(modifier: str) -> tuple[str, object]:
    """The field that a modifier changes, and its new value. ValueError for a word that is none."""
    for name, words in _WORDS.items():
        if modifier in words:
            return name, words[modifier]
    if modifier.startswith(GLOSSY):
        return "quantity", quantity_of(modifier)
    if modifier[:1] in ("+", "-"):
        return "axes", Axes(modifier)
    if modifier.startswith(_TIMES):
        return "factor", _factor(modifier)
    rule = f"it must be one of {', '.join(MODIFIERS)}, times=2 or another factor, or axes such as +x+z-y"
    raise ValueError(f"convention modifier {modifier!r}: {meant(modifier, MODIFIERS, rule)}")


def _factor(modifier: str) -> float:
    try:
        factor = float(modifier.removeprefix(_TIMES))
    except ValueError:
        factor = math.nan
    if not 1 / LARGEST_FACTOR <= factor <= LARGEST_FACTOR:
        raise ValueError(f"convention modifier {modifier!r}: a factor is a number above 0, such as times=2")
    return factor


def _modified(convention: Convention, modifier: str, name: str, value: Any) -> Convention:
    """The convention with another value of a field. ValueError if that contradicts the program."""
    changes = {name: value}
    if value == "polynomial":
        changes |= {"most_bands": POLYNOMIAL_BANDS, "phase": False}
    changed, fixed = replace(convention, **changes), CONVENTIONS[convention.name].quantity
    if name == "quantity" and fixed not in (None, value):
        raise ValueError(f"{value} contradicts {convention.name}, which takes {fixed}")
    if name not in FREE and convention.name != OURS.name and changed != convention:
        raise ValueError(
            f"{modifier} contradicts {convention.name}: it would not be what that program expects; numbers that differ from its"
            f" own so are {in_our_terms(changed)}"
        )
    return changed


def in_our_terms(convention: Convention) -> str:
    """A text for the same numbers that begins with "shviewer"; all of the convention stands in its modifiers."""
    return convention_text(replace(convention, name=OURS.name, axes=convention.basis_axes, pole=Axes()))


def convention_text(convention: Convention) -> str:
    """The text that `parse_convention` turns into this convention again."""
    base, parts = CONVENTIONS[convention.name], [convention.name]
    for name, words in _WORDS.items():
        value = getattr(convention, name)
        if value == getattr(base, name) or (name == "phase" and convention.scale == "polynomial"):
            continue
        own = value.text if name == "axes" else value if name == "quantity" else None
        word = next((word for word, stands_for in words.items() if stands_for == value), own)
        parts += [word] if word else []
    if convention.factor != base.factor:
        parts.append(f"{_TIMES}{convention.factor!r}".removesuffix(".0"))
    return ",".join(parts)
