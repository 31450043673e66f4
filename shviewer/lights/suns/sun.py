"""Suns split off a light: each becomes a disc with a direction, a size and a radiance; the rest then needs few bands.

compact_sources.py finds them, and excess.py says which part of an image belongs to them. In a sum of lobes, the suns are the
discs to which the same rule applies; they are taken out without a rest.

In an image the disc has the flux that was taken, per channel. Its axis is the direction of the flux vector of the channels'
mean, and its half-angle a follows from the vector's length: |vector| = cos(a/2)^2 flux. So rest plus disc
have band 0 of the whole in every channel, and band 1 in the mean of the channels. Band 1 of single channels and other bands are
off, by about this share of the sun's flux:
    l^2 |s^2 - t^2| / 8    for standard deviations s along and t across, in radians: of texels that are not square, of glare;
    (l a)^4 / 200          for another profile than a uniform disc;
    l b                    in a channel whose own centre is at the angle b to the axis.
The half-angle is that of a uniform disc that spreads as much as the radiance taken, glare included: in a photograph, more than
the sun's own 0.265 degrees.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.coefficients.suns import DirectionalLight
from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.zonal_table import perpendicular
from shviewer.harmonics.quantities.kernels import kernel_of
from shviewer.harmonics.quantities.names import RADIANCE
from shviewer.harmonics.zonal import ClampedLinear, Disc
from shviewer.lights.analytic.lobe import Lobe


def points_of_suns(count: int) -> int:
    """In how many points each of so many suns is spread, so that all fit the shader."""
    return 19 if count <= 3 else 7 if count <= 9 else 4


@dataclass(frozen=True, eq=False)
class Sun:
    """A disc of uniform radiance, added to what is behind it."""

    axis: Array
    """The unit vector towards the sun, (3,)."""
    half_angle: float
    """The half-angle of the disc, radians."""
    radiance: Array
    """Linear RGB, (3,); times the solid angle it is the flux taken."""
    clipped: bool = False
    """Whether the image is clipped there, so that the sun had more than this."""

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
        """The irradiance of a surface that faces it, (3,): pi sin(a)^2 times the radiance."""
        return np.asarray(self.radiance * (np.pi * np.sin(self.half_angle) ** 2))

    @property
    def directional_light(self) -> DirectionalLight:
        """The sun as it is written beside coefficients of the rest."""
        return DirectionalLight(
            self.axis, self.irradiance, self.radiance, float(np.degrees(2 * self.half_angle)), self.clipped
        )

    @property
    def lobe(self) -> Lobe:
        return Lobe(Disc(self.half_angle), self.axis, self.radiance)

    def lobes(self, quantity: str, points: int) -> list[Lobe]:
        """A quantity of the sun as few lobes, as a function of the direction asked for.

        Irradiance is exact while the disc is all above or all below the horizon. Where the horizon cuts the disc it is too
        small: by 2a / 3 pi of `irradiance` if half of it has set, else by less. What a glossy surface reflects is that of
        `points` suns without width, spread over the disc: 4, 7 or 19.
        """
        kernel = kernel_of(quantity)
        if kernel.profile is None:
            return [self.lobe if quantity == RADIANCE else Lobe(ClampedLinear(), self.axis, self.irradiance)]
        part = self.flux * (kernel.scale / points)
        return [Lobe(kernel.profile, axis, part) for axis in self._spread(points)]

    def _spread(self, points: int) -> Array:
        """Directions on the disc, (points, 3), on rings that stand for equal areas and spread as much as the disc does."""
        rings = {4: [4], 7: [1, 6], 19: [1, 6, 12]}[points]
        ends = np.cumsum([0, *rings]) / points
        middles = np.where(np.array(rings) == 1, 0, (ends[:-1] + ends[1:]) / 2)  # shares of the squared radius
        middles *= 0.5 / (middles @ rings / points)
        side = perpendicular(self.axis)
        other = np.cross(self.axis, side)
        found = []
        for count, share in zip(rings, middles, strict=True):
            turn = 2 * np.pi * np.arange(count)[:, None] / count
            angle = 2 * np.arcsin(np.sin(self.half_angle / 2) * np.sqrt(share))
            found.append(np.cos(angle) * self.axis + np.sin(angle) * (np.cos(turn) * side + np.sin(turn) * other))
        return np.concatenate(found)
