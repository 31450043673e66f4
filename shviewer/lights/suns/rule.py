"""The rule that tells suns from other compact sources, for images and scenes alike.

A sun is what an engine would make a directional light of: a compact source that is
    small       at least half as bright as its peak over no more than a half-angle of SMALL, or over FEW_TEXELS of an image,
    dominant    SUN_ENERGY of the light's ||f||^2 when its turn comes, or clipped in the file, which hides how much it had,
    one of two  not among more than MOST_SUNS with ALIKE of the strongest one's flux: those are lamps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shviewer.errors import LightError
from shviewer.lights.suns.sun import Sun

WIDEST = np.radians(2.5)
"""The largest half-angle of a compact source."""

CONTRAST, FLUX, ENERGY = 10.0, 0.005, 0.05
MOST = 16
"""The most compact sources that are taken out of a light."""

SMALL, SMALL_CLIPPED = np.radians(1.5), np.radians(2.0)
FEW_TEXELS = 4
SUN_ENERGY = 0.25
MOST_SUNS = 2
ALIKE = 0.25

AUTO, ALL = "auto", "all"

COMPACT = (
    f"a compact source is at most {2 * np.degrees(WIDEST):g} degrees wide, alone, {CONTRAST:g} times as bright as what "
    f"surrounds it, and holds {100 * FLUX:g} % of the flux and {100 * ENERGY:g} % of the squared norm"
)
RULE = (
    f"a sun is a compact source of at most {2 * np.degrees(SMALL):g} degrees with {100 * SUN_ENERGY:g} % of the squared norm, "
    f"or clipped, and one of at most {MOST_SUNS}"
)


@dataclass(frozen=True)
class CompactSource:
    """A compact source, and what the rule asks of it."""

    sun: Sun
    core: float
    """The half-angle of a disc as large as what is at least half as bright as its peak, radians."""
    few_texels: bool
    """Whether that is no more than FEW_TEXELS texels."""
    energy: float
    """Its share of ||f||^2 when its turn came."""

    @property
    def flux(self) -> float:
        return float(self.sun.flux.sum())

    @property
    def why_no_sun(self) -> str:
        """Why it is a lamp, in words; "" if it is none."""
        if self.core > (SMALL_CLIPPED if self.sun.clipped else SMALL) and not self.few_texels:
            return f"is {2 * np.degrees(self.core):.2g} degrees wide"
        if self.energy < SUN_ENERGY and not self.sun.clipped:
            return f"holds only {100 * self.energy:.2g} % of the squared norm"
        return ""


def refusal(half_angle: float, contrast: float, flux: float, energy: float, least_energy: float = ENERGY) -> str:
    """Why the brightest spot is not compact, in words; "" if it is. Flux and energy are shares of the whole."""
    if not contrast >= CONTRAST:
        brighter = f"only {contrast:.2g} times as bright as" if contrast >= 1.05 else "no brighter than"
        return f"its brightest spot is {brighter} what surrounds it"
    if not half_angle <= WIDEST:
        return f"its brightest spot is {2 * np.degrees(half_angle):.2g} degrees wide"
    if not energy >= least_energy:
        return f"its brightest spot holds only {100 * energy:.2g} % of the squared norm"
    if not flux >= FLUX:
        return f"its brightest spot holds only {100 * flux:.2g} % of the flux"
    return ""


def chosen(name: str, found: Sequence[CompactSource], wanted: int | str, why: str) -> list[int]:
    """The indices of the sources to take out of the light `name`, the greatest flux first.

    wanted: AUTO for suns alone, ALL, or a number of compact sources. LightError, one line, if there are none; why: why there
    is no (other) compact source.
    """
    order = sorted(range(len(found)), key=lambda i: -found[i].flux)
    if not found:
        raise LightError(f"{name} has no sun: {why}; {COMPACT}; show it unsplit")
    if wanted != AUTO:
        return order if wanted == ALL else order[: int(wanted)]
    alike = sum(found[i].flux >= ALIKE * found[order[0]].flux for i in order)
    suns = [i for i in order[:MOST_SUNS] if not found[i].why_no_sun]
    if alike > MOST_SUNS:
        why = f"its {alike} brightest compact sources are alike, as lamps are"
    elif not suns:
        why = f"its strongest compact source {found[order[0]].why_no_sun}"
    else:
        return suns
    raise LightError(f"{name} has no sun: {why}; {RULE}; --suns takes lamps, too")
