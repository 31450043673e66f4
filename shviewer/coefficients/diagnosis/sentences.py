"""Conventions in plain words: what differs from the one that was meant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.orientations import TURNS, axes_name, between
from shviewer.coefficients.diagnosis.search import CONSTANTS
from shviewer.coefficients.parts.channels import BY_CHANNEL, INTERLEAVED
from shviewer.coefficients.parts.quantities import IRRADIANCE, RADIANCE, is_over_pi, whole
from shviewer.coefficients.parts.rows import ORDERS
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.words import all_of

NO_PHASE = "without the Condon-Shortley phase"
HALF_TURN = f"{NO_PHASE}, or of the map turned by half a turn, which is the same"


def words(convention: Convention, named: Convention | None = None) -> str:
    """The convention in words, after "if its numbers are"; `named` is the one that was taken first."""
    base, found = CONVENTIONS[convention.name], differences(convention)
    named = named or OURS
    plain = named == replace(CONVENTIONS[named.name], quantity=named.quantity)
    if base.name != named.name or not plain or not found:
        found.insert(0, f"in the convention of {base.name}")
    return all_of(found)


def differences(convention: Convention) -> list[str]:
    """What makes it another one than the program's own, or ours, in words."""
    base, found = CONVENTIONS[convention.name], list[str]()
    if convention.sequence in (BY_CHANNEL, INTERLEAVED):
        found.append("listed channel by channel" if convention.sequence == BY_CHANNEL else "listed row by row")
    if convention.order != base.order:
        found.append(f"with rows in the order {ORDERS[convention.order][1]}")
    if convention.phase != base.phase and convention.scale != "polynomial":
        alone = convention.axes == base.axes and not convention.mirrored
        found.append((HALF_TURN if alone else NO_PHASE) if base.phase else "with the Condon-Shortley phase")
    if convention.mirrored:
        found.append("with m and -m swapped")
    if convention.axes != base.axes:
        turn = between(base.axes, convention.axes).text
        usual = base is OURS and axes_name(convention.axes) != convention.axes.text
        found.append(TURNS[turn] if turn in TURNS and not usual else f"in axes {axes_name(convention.axes)}")
    if convention.channels != base.channels:
        found.append(f"with channels in the order {' '.join(convention.channels.upper())}")
    if convention.shift != base.shift:
        found.append(f"with a mean that is less by {convention.shift:g}")
    held, meant = convention.quantity or RADIANCE, base.quantity or RADIANCE
    if whole(held) != whole(meant):
        irradiance = whole(held) == IRRADIANCE
        found.append("multiplied by A(l), as irradiance" if irradiance else "not multiplied by A(l), as radiance")
    if is_over_pi(held) != is_over_pi(meant):
        found.append("divided by pi" if is_over_pi(held) else "multiplied by pi")
    found += _scaled(convention, base)
    return found


def _scaled(convention: Convention, base: Convention) -> list[str]:
    factor = convention.factor
    if convention.scale == base.scale:
        return [factor_words(factor)] if factor != 1 else []
    root = np.sqrt(4 * np.pi)
    together = {("sn3d", 1 / root): "divided by sqrt(2l+1), as in SN3D", ("schmidt", root): "multiplied by sqrt(2l+1)"}
    for (scale, value), said in together.items():
        if convention.scale == scale and abs(factor / value - 1) < 1e-6:
            return [said]
    named = {
        "orthonormal": "orthonormal",
        "4pi": "divided by sqrt(4 pi)",
        "schmidt": "those of Schmidt's semi-normalised functions",
        "sn3d": "integrals with SN3D functions",
        "fuma": "integrals with FuMa's weights",
        "polynomial": "factors of the polynomials 1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2",
    }
    return [named[convention.scale], *([factor_words(factor)] if factor != 1 else [])]


def factor_words(factor: float) -> str:
    """A factor by the name of a constant that it is within a millionth of, or as "times 1.02"."""
    near = [said for said, value in CONSTANTS.items() if abs(factor / value - 1) < 1e-6]
    return near[0] if near else f"times {factor:g}"
