"""A light that is a sum of lobes: coefficients at every band, norm and radiance all in closed form."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.zonal_sum import Lobes
from shviewer.harmonics.extremes.zonal_table import around_edge
from shviewer.harmonics.overlap import inner_product
from shviewer.harmonics.quantities.names import IRRADIANCE
from shviewer.harmonics.zonal import Constant, Disc
from shviewer.lights.analytic.convolved_lobes import ConvolvedLobes
from shviewer.lights.analytic.lobe import Lobe, angle_between, lobes_form, pair_products
from shviewer.lights.convolved import UP, RadianceLight, convolved
from shviewer.lights.light import Light, Split
from shviewer.limits import check_brightness

MAX_LOBES = 64
"""The most lobes: as many as the uniform block of shaders/lobes.glsl holds."""


@dataclass(frozen=True, eq=False, repr=False)
class LobeLight(RadianceLight):
    """The sum of up to MAX_LOBES lobes. ValueError for none or more, LightError for more radiance than can be shown."""

    lobes: tuple[Lobe, ...]
    name: str = "lobes"
    description: str = ""
    notes: tuple[str, ...] = ()
    best_method: str = "closed form"

    map = None

    def __post_init__(self) -> None:
        if not 1 <= len(self.lobes) <= MAX_LOBES:
            raise ValueError(f"{len(self.lobes)} lobes: there must be 1 to {MAX_LOBES}")
        check_brightness(float(np.abs(self.radiance(self.form.axes)).max()), self.name)

    def radiance(self, directions: Array) -> Array:
        return self.form.values(directions)

    def coefficients(self, n_bands: int) -> Array:
        return self.form.coefficients(self.form.zonal(n_bands))

    def products(self) -> Array:
        return self._products

    @cached_property
    def _products(self) -> Array:
        return pair_products(
            self.lobes, lambda one, two: float(inner_product(one.profile, two.profile, angle_between(one, two)))
        )

    def landmarks(self) -> Array:
        """The axes, and points just inside and outside the edge of every profile that has one: (j, 3)."""
        edges = ((lobe.axis[None], around_edge(lobe.profile, lobe.axis, 8)) for lobe in self.lobes)
        return np.concatenate([*chain.from_iterable(edges)])

    @cached_property
    def form(self) -> Lobes:
        return lobes_form([lobe.profile for lobe in self.lobes], self.lobes)

    def through(self, quantity: str) -> Light:
        return self._irradiance if quantity == IRRADIANCE else convolved(self, quantity, ConvolvedLobes)

    @cached_property
    def _irradiance(self) -> Light:
        """Kept, since the maps of glossy quantities are made of its map."""
        return convolved(self, IRRADIANCE, ConvolvedLobes)

    def irradiance_up(self) -> Array:
        return np.asarray(self.irradiance().radiance(UP[None])[0])

    def split_suns(self, wanted: int | str = "auto") -> Split:
        """Split off the discs that are suns by the rule for images; no rest of them is left."""
        from shviewer.lights.suns.rule import MOST, CompactSource, chosen
        from shviewer.lights.suns.sun import Sun

        found: list[CompactSource] = []
        taken: list[Lobe] = []
        rest, why = self, ""
        while len(found) < MOST:
            discs = [lobe for lobe in rest.lobes if isinstance(lobe.profile, Disc) and lobe.radiance.mean() > 0]
            discs.sort(key=lambda lobe: -lobe.radiance.mean())
            refusals = [rest._disc_refusal(disc) for disc in discs]
            if "" not in refusals:
                why = next(iter(refusals), "it has no disc")
                break
            disc = discs[refusals.index("")]
            sun = Sun(disc.axis, disc.profile.half_angle, disc.radiance)
            found.append(CompactSource(sun, sun.half_angle, False, rest._energy_of(disc)))
            taken.append(disc)
            rest = rest._without(disc)
        indices = chosen(self.name, found, wanted, why)
        rest = self
        for i in indices:
            rest = rest._without(taken[i])
        return Split(rest, tuple(found[i].sun for i in indices))

    def _disc_refusal(self, disc: Lobe) -> str:
        """Why one of the discs is no sun; "" if it is. As everywhere, the mean of the channels counts."""
        from shviewer.lights.suns.rule import refusal

        radiance, solid_angle = float(disc.radiance.mean()), float(disc.profile.zonal(1)[0])
        behind = self._without(disc).radiance(disc.axis[None]).mean()
        fluxes = [abs(lobe.profile.zonal(1)[0] * lobe.radiance.mean()) for lobe in self.lobes]
        return refusal(
            disc.profile.half_angle,
            1 + radiance / behind if behind > 0 else np.inf,
            radiance * solid_angle / sum(fluxes),
            self._energy_of(disc),
        )

    def _energy_of(self, disc: Lobe) -> float:
        """The share of ||f||^2 that one of the discs holds by itself, both in the mean of the channels."""
        radiance, solid_angle = float(disc.radiance.mean()), float(disc.profile.zonal(1)[0])
        whole = float(self.products().sum()) / 9 or 1.0  # squares of less than 1e-160 may be 0
        return radiance**2 * solid_angle / whole

    def _without(self, lobe: Lobe) -> LobeLight:
        """The other lobes; a black constant if there are none."""
        others = tuple(other for other in self.lobes if other is not lobe)
        return replace(self, lobes=others or (Lobe(Constant(), np.array([0.0, 0.0, 1.0]), np.zeros(3)),))
