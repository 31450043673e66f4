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

from dataclasses import dataclass

import numpy as np

from shviewer.coefficients.suns import DirectionalLight
from shviewer.harmonics.basis import Array
from shviewer.harmonics.zonal import ClampedLinear, Disc
from shviewer.lights.lobe import Lobe


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
        """What a surface that faces it receives, (3,): pi sin(a)^2 times the radiance."""
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
