"""Texts of conventions, as --convention takes them: a name and modifiers, such as "three,z-up"."""

from __future__ import annotations

import math
from dataclasses import replace

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.parts.axes import NAMED_AXES, Axes
from shviewer.coefficients.parts.channels import CHANNEL_ORDERS, SEQUENCES
from shviewer.coefficients.parts.quantities import QUANTITIES
from shviewer.coefficients.parts.rows import ACN, ORDERS
from shviewer.coefficients.parts.scales import POLYNOMIAL_BANDS, SCALES
from shviewer.coefficients.programs import CONVENTIONS, OURS, READINGS
from shviewer.harmonics.quantities.names import GLOSSY, quantity_of
from shviewer.words import meant

SHIFTED = "shifted"
"""The modifier of a list whose mean is less by SHIFT, as 3D Gaussian splatting has it."""

SHIFT = CONVENTIONS["3dgs"].shift

MODIFIERS = (
    *("phase", "no-phase", "m-swapped", SHIFTED),
    *QUANTITIES,
    *SCALES,
    *list(ORDERS)[1:],
    *NAMED_AXES,
    *CHANNEL_ORDERS,
    *SEQUENCES,
)
_TIMES = "times="
LARGEST_FACTOR = 1e30


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
        kind, convention = _modified(convention, modifier)
        if said.setdefault(kind, modifier) != modifier:
            raise ValueError(f"convention {text!r}: {said[kind]} and {modifier} contradict each other")
    return convention


def _advice(name: str, text: str) -> str:
    """What to write in place of a name that no convention has; a modifier wants a name before it."""
    try:
        _modified(OURS, name)
    except ValueError:
        return meant(name, CONVENTIONS)
    return f"that differs from a convention, whose name comes first: {OURS.name},{text}"


def _modified(convention: Convention, modifier: str) -> tuple[str, Convention]:
    """The aspect that the modifier changes, and the convention changed."""
    if modifier in QUANTITIES or modifier.startswith(GLOSSY):
        modifier = modifier if modifier in QUANTITIES else quantity_of(modifier)
        fixed = CONVENTIONS[convention.name].quantity
        if fixed not in (None, modifier):
            raise ValueError(f"{modifier} contradicts {convention.name}, which takes {fixed}")
        return "quantity", replace(convention, quantity=modifier)
    if modifier in NAMED_AXES or modifier[:1] in ("+", "-"):
        return "axes", replace(convention, axes=Axes.named(modifier))
    if modifier in CHANNEL_ORDERS:
        return "channels", replace(convention, channels=modifier)
    if modifier in SEQUENCES:
        return "sequence", replace(convention, sequence=modifier)
    if modifier.startswith(_TIMES):
        return "factor", replace(convention, factor=_factor(modifier))
    if modifier in ("phase", "no-phase"):
        return "phase", _if_free(convention, modifier, replace(convention, phase=modifier == "phase"))
    if modifier == "m-swapped":
        return "sign of m", _if_free(convention, modifier, replace(convention, mirrored=True))
    if modifier == SHIFTED:
        return "shift", _if_free(convention, modifier, replace(convention, shift=SHIFT))
    if modifier in ORDERS and modifier != ACN:
        return "order", _if_free(convention, modifier, replace(convention, order=modifier))
    if modifier in SCALES:
        changed = replace(convention, scale=modifier)
        if modifier == "polynomial":
            changed = replace(changed, most_bands=POLYNOMIAL_BANDS, phase=False)
        return "scale", _if_free(convention, modifier, changed)
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


def _if_free(convention: Convention, modifier: str, changed: Convention) -> Convention:
    """Our own convention changed. ValueError for another program's, which is fixed."""
    if convention.name != OURS.name and changed != convention:
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
    base = CONVENTIONS[convention.name]
    parts = [convention.name]
    if convention.axes != base.axes:
        parts.append(
            next((name for name, text in NAMED_AXES.items() if text == convention.axes.text), convention.axes.text)
        )
    if convention.scale != base.scale:
        parts.append(convention.scale)
    if convention.phase != base.phase and convention.scale != "polynomial":
        parts.append("phase" if convention.phase else "no-phase")
    if convention.mirrored != base.mirrored:
        parts.append("m-swapped")
    if convention.order != base.order:
        parts.append(convention.order)
    if convention.shift != base.shift:
        parts.append(SHIFTED)
    if convention.quantity != base.quantity and convention.quantity:
        parts.append(convention.quantity)
    if convention.channels != base.channels:
        parts.append(convention.channels)
    if convention.sequence != base.sequence and convention.sequence in SEQUENCES:
        parts.append(convention.sequence)
    if convention.factor != base.factor:
        parts.append(f"{_TIMES}{convention.factor!r}".removesuffix(".0"))
    return ",".join(parts)
