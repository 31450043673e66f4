"""A light without its suns: each becomes a disc with a direction, a size and a radiance; what is left needs few bands.

compact_sources.py says what a sun is and what of an image belongs to it. Of a sum of lobes, the suns are the discs to which
the same rule applies; they leave exactly.

In an image the disc has the flux of what was taken, per channel. Its axis is the direction of the flux vector of the channels'
mean, and its half-angle a makes that as long: |vector| = cos(a/2)^2 flux. So bands 0 and 1 of the mean of rest and disc are
those of the whole. What a disc cannot show is missing from the others and from single channels: of the sun's flux, about
    l^2 |s^2 - t^2| / 8    for standard deviations s along and t across, in radians: of texels that are not square, of glare;
    (l a)^4 / 200          for another profile than a uniform disc;
    l b                    in a channel whose own centre is at the angle b to the axis.
The half-angle is that of a uniform disc that spreads as much as what was taken, glare included: in a photograph more than the
sun's own 0.265 degrees.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shviewer.coefficients.suns import DirectionalLight
from shviewer.errors import LightError
from shviewer.harmonics.basis import Array
from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.light import Light
from shviewer.lights.lobes import Lobe, LobeLight
from shviewer.lights.suns.compact_sources import MOST, RULE, CompactSources, refusal


@dataclass(frozen=True, eq=False)
class Sun:
    """A disc of uniform radiance, added to what is behind it."""

    axis: Array
    """Unit, (3,)."""
    half_angle: float
    """Radians."""
    radiance: Array
    """Linear RGB, (3,); times the solid angle it is the flux that was taken."""

    @property
    def solid_angle(self) -> float:
        """Steradians."""
        return float(4 * np.pi * np.sin(self.half_angle / 2) ** 2)

    @property
    def flux(self) -> Array:
        """Radiance times solid angle, (3,)."""
        return np.asarray(self.radiance * self.solid_angle)

    @property
    def irradiance(self) -> Array:
        """Of a surface that faces it, (3,): pi sin(a)^2 times the radiance."""
        return np.asarray(self.radiance * (np.pi * np.sin(self.half_angle) ** 2))

    @property
    def directional_light(self) -> DirectionalLight:
        """The sun as it is written beside coefficients of the rest."""
        return DirectionalLight(self.axis, self.irradiance, self.radiance, float(np.degrees(2 * self.half_angle)))

    @property
    def lobe(self) -> Lobe:
        return Lobe(Disc(self.half_angle), self.axis, self.radiance)

    @property
    def irradiance_lobe(self) -> Lobe:
        """The irradiance as a function of the surface normal, exact while the disc is all above or all below the horizon.

        Where the horizon cuts it, too small: by 2a / 3 pi of `irradiance` when half of it has set, by less before and after.
        """
        return Lobe(ClampedLinear(), self.axis, self.irradiance)


@dataclass(frozen=True, eq=False)
class Split:
    """whole = rest + suns. The whole is the light that was split, untouched."""

    whole: Light
    rest: Light
    suns: tuple[Sun, ...]
    """The greatest flux first."""

    @property
    def sunlight(self) -> LobeLight:
        """The suns as a light: its coefficients and those of the rest add up to the whole's."""
        return LobeLight(tuple(sun.lobe for sun in self.suns), f"sun of {self.whole.name}")


def split_suns(light: Light) -> Split:
    """Takes the suns out of an image or a sum of lobes. LightError for other lights and if there is none."""
    rest: Light
    if isinstance(light, EnvironmentLight):
        sources = CompactSources(light.pixels, light.layout)
        found, why = sources.take_all()
        suns, rest = [Sun(*source) for source in found], replace(light, pixels=sources.pixels)
    elif isinstance(light, LobeLight):
        suns, rest, why = _split_lobes(light)
    else:
        raise LightError(f"{light.name}: only images and sums of lobes can be split; show it with its sun")
    if not suns:
        raise LightError(f"{light.name} has no sun: {why}; {RULE}; show it unsplit")
    return Split(light, rest, tuple(sorted(suns, key=lambda sun: -sun.flux.sum())))


def _split_lobes(light: LobeLight) -> tuple[list[Sun], LobeLight, str]:
    """(suns, rest, why the brightest disc in the rest is none)."""
    suns: list[Sun] = []
    rest = light
    while len(suns) < MOST:
        discs = [lobe for lobe in rest.lobes if isinstance(lobe.profile, Disc) and lobe.radiance.mean() > 0]
        discs.sort(key=lambda lobe: -lobe.radiance.mean())
        refusals = [_disc_refusal(disc, rest) for disc in discs]
        if "" not in refusals:
            return suns, rest, next(iter(refusals), "it has no disc")
        sun = discs[refusals.index("")]
        suns.append(Sun(sun.axis, sun.profile.half_angle, sun.radiance))
        rest = _without(rest, sun)
    return suns, rest, ""


def _disc_refusal(disc: Lobe, light: LobeLight) -> str:
    """Why one of a light's discs is no sun; "" if it is. As everywhere, of the mean of the channels."""
    radiance, solid_angle = float(disc.radiance.mean()), float(disc.profile.zonal(1)[0])
    behind = _without(light, disc).radiance(disc.axis[None]).mean()
    fluxes = [abs(lobe.profile.zonal(1)[0] * lobe.radiance.mean()) for lobe in light.lobes]
    contrast = 1 + radiance / behind if behind > 0 else np.inf
    norm_squared = light.products().sum() / 9
    return refusal(
        disc.profile.half_angle,
        contrast,
        radiance * solid_angle / sum(fluxes),
        radiance**2 * solid_angle / norm_squared,
    )


def _without(light: LobeLight, lobe: Lobe) -> LobeLight:
    """The other lobes; a black constant if there are none."""
    others = tuple(other for other in light.lobes if other is not lobe)
    return replace(light, lobes=others or (Lobe(Constant(), np.array([0.0, 0.0, 1.0]), np.zeros(3)),))
