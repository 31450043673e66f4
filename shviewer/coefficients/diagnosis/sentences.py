"""Conventions in plain words: what differs from the one that was meant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.orientations import TURNS, axes_name, between
from shviewer.coefficients.diagnosis.slips import Slip
from shviewer.coefficients.diagnosis.tried import CONSTANTS
from shviewer.coefficients.parts.channels import BY_CHANNEL, INTERLEAVED
from shviewer.coefficients.parts.quantities import is_over_pi, whole
from shviewer.coefficients.parts.rows import ORDERS
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.harmonics.basis import degree_order
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE
from shviewer.words import all_of

NO_PHASE = "without the Condon-Shortley phase"
HALF_TURN = f"{NO_PHASE}, or of the map turned by half a turn, which is the same"


def words(convention: Convention, named: Convention | None = None, meant: Convention | None = None) -> str:
    """The convention in words, after "if its numbers are"; `named` is the one that was taken first, `meant` as below."""
    named = named or OURS
    found = differences(convention, meant)
    plain = named == replace(CONVENTIONS[named.name], quantity=named.quantity)
    if meant is not named and (convention.name != named.name or not plain or not found):
        found.insert(0, f"in the convention of {convention.name}")
    return all_of(found)


def differences(convention: Convention, meant: Convention | None = None) -> list[str]:
    """What makes it another one than was meant, in words. meant: the program's own convention, or ours, unless given."""
    base, found = meant or CONVENTIONS[convention.name], list[str]()
    if convention.sequence in (BY_CHANNEL, INTERLEAVED):
        found.append("listed channel by channel" if convention.sequence == BY_CHANNEL else "listed row by row")
    if convention.order != base.order:
        found.append(f"with rows in the order {ORDERS[convention.order][1]}")
    if convention.phase != base.phase and convention.scale != "polynomial":
        alone = convention.basis_axes == base.basis_axes and not convention.mirrored
        found.append((HALF_TURN if alone else NO_PHASE) if base.phase else "with the Condon-Shortley phase")
    if convention.mirrored:
        found.append("with m and -m swapped")
    if convention.basis_axes != base.basis_axes:
        axes = convention.axes if base.pole == convention.pole else convention.basis_axes
        turn = TURNS.get(between(base.basis_axes, convention.basis_axes).text, "")
        usual = base is OURS and axes_name(axes) != axes.text
        both = f"in axes {axes_name(axes)}, or {turn}, which is the same" if turn else f"in axes {axes_name(axes)}"
        found.append(both if usual or not turn else turn)
    if convention.channels != base.channels:
        found.append(f"with channels in the order {' '.join(convention.channels.upper())}")
    if convention.shift != base.shift:
        found.append(f"with a mean that is less by {convention.shift:g}")
    held, wanted = convention.quantity or RADIANCE, base.quantity or RADIANCE
    if whole(held) != whole(wanted):
        irradiance = whole(held) == IRRADIANCE
        found.append("multiplied by A(l), as irradiance" if irradiance else "not multiplied by A(l), as radiance")
    if is_over_pi(held) != is_over_pi(wanted):
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


def slips_in_words(slips: tuple[Slip, ...], convention: Convention, n_bands: int) -> list[str]:
    """What is wrong in single rows of a list in a convention, each after "if"."""
    places = convention.rows(n_bands).tolist()
    signs = [slip.row for slip in slips if slip.sign < 0 and slip.row == slip.holds]
    empty = [slip.row for slip in slips if not slip.sign]
    moved = [slip for slip in slips if slip.row != slip.holds]
    found = []
    if signs:
        found.append(f"{_rows(signs, places)} {'has' if len(signs) == 1 else 'have'} the other sign")
    if (
        len(moved) == 2
        and {slip.row for slip in moved} == {slip.holds for slip in moved}
        and moved[0].sign > 0 < moved[1].sign
    ):
        found.append(f"{_rows([slip.row for slip in moved], places)} are swapped")
    elif moved:
        rows, holds = [slip.row for slip in moved], [f"{'-' * (slip.sign < 0)}{slip.holds}" for slip in moved]
        also = "" if {slip.row for slip in slips} >= {slip.holds for slip in moved} else ", too"
        into = f"row{'s' if len(holds) > 1 else ''} {all_of(holds)}"
        found.append(f"{_rows(rows, places)} hold{'s' if len(rows) == 1 else ''} what belongs into {into}{also}")
    if empty:
        verb = "is" if len(empty) == 1 else "are"
        found.append(f"{_rows(empty, places)}, which {verb} 0, {verb} left out")
    return found


def _rows(rows: list[int], places: list[int]) -> str:
    """ "row 3 (l=1, m=1)", "rows 4-8 (band 2)" or "rows 1 (l=1, m=-1) and 3 (l=1, m=1)"; places: our index in each row."""
    named = [f"{row} (l={degree_order(places[row])[0]}, m={degree_order(places[row])[1]})" for row in rows]
    if len(rows) == 1:
        return f"row {named[0]}"
    bands = sorted({degree_order(places[row])[0] for row in rows})
    if {places[row] for row in rows} == {l * (l + 1) + m for l in bands for m in range(-l, l + 1)}:
        band = f"bands {bands[0]}-{bands[-1]}" if len(bands) > 1 else f"band {bands[0]}"
        if rows == list(range(rows[0], rows[0] + len(rows))) and bands == list(range(bands[0], bands[0] + len(bands))):
            return f"rows {rows[0]}-{rows[-1]} ({band})"
    return f"rows {all_of(named if len(rows) <= 4 else [str(row) for row in rows])}"
