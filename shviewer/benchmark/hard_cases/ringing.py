"""Hard cases of work on coefficients: Gibbs ringing, deringing, irradiance and error figures."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from math import comb, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from shviewer.benchmark.hard_cases.outcome import Case, worst
from shviewer.benchmark.hard_cases.radiances import relative_figures
from shviewer.benchmark.hard_cases.shader import SUN_AXIS
from shviewer.harmonics.basis import Array
from shviewer.harmonics.deringing import dering
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.zonal import ClampedLinear, Disc, orient
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.find import find_light

OVERSHOOT = {
    2: 0.25,
    4: 0.1137378162887285723,
    8: 0.09551075795076457401,
    16: 0.09103763872917110069,
    64: 0.08959009982631300286,
}
"""Bands -> how far the sum for a hemisphere of radiance 1 exceeds 0 and 1 (mpmath, 40 digits): the known 25, 11.4, 9.6,
9.1 and 9.0 %."""

GREEN_LEFT_OUT = {1: "0.83125", 2: "0.61284548611111111111"}
"""Bands -> the share of the energy of R. Green's light that they leave out (closed form, 80 digits)."""

Reconstruct = Callable[[Array, Array], Array]
"""Coefficients (n**2, 3) and theta (k,) -> values (k,) at phi = 0 and pi."""


def hemisphere(n_bands: int, axis: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> Array:
    return np.repeat(orient(Disc(pi / 2).zonal(n_bands), np.array(axis))[:, None], 3, axis=1)


def meridian(coefficients: Array, theta: Array) -> Array:
    return Synthesis(coefficients).on_rows(theta, 2)[:, 0, 0]


@worst
def gibbs(reconstruct: Reconstruct = meridian) -> Iterator[float]:
    """The overshoot of a hemisphere in 2 to 64 bands against OVERSHOOT.

    Bound: two grids find a minimum to (pi/4000/1000)^2 n^2 / 4, 6e-10 at 64 bands; the known figures have 5e-4.
    """
    for n_bands, wanted in OVERSHOOT.items():
        coefficients = hemisphere(n_bands)
        coarse = np.linspace(0, pi, 4001)
        place = coarse[reconstruct(coefficients, coarse).argmin()]
        fine = np.clip(place + np.linspace(-1, 1, 2001) * pi / 4000, 0, pi)
        yield -reconstruct(coefficients, fine).min() - wanted


def deringed(factors: Callable[[Array], Array] = lambda coefficients: dering(coefficients).factors) -> float:
    """How far a deringed hemisphere, sun and pair of lobes are below zero, relative to their mean, on 721 x 1440 points.

    Bound: 1e-9, which the search for the minimum may leave.
    """
    green = find_light("green").coefficients(8)
    sun = np.repeat(orient(Disc(0.05).zonal(12), np.array(SUN_AXIS))[:, None], 3, axis=1)
    worst = 0.0
    for coefficients in (hemisphere(16), hemisphere(8, SUN_AXIS), sun, green):
        shown = coefficients * per_coefficient(factors(coefficients))
        lowest = Synthesis(shown).on_rows(np.linspace(0, pi, 721), 1440).min()
        worst = max(worst, -float(lowest) / (float(coefficients[0, 0]) / sqrt(4 * pi)))
    return worst


@worst
def irradiance(factors: Callable[[int], Array] = irradiance_factors) -> Iterator[ArrayLike]:
    """A(l) to l = 1000, relative; the odd ones above 1 are 0, relative to pi.

    Closed form 2 pi (-1)^(l/2-1) / ((l+2)(l-1)) l!/(2^l (l/2)!^2), exact as a fraction of 2 pi. Bound: 1000 steps of
    two roundings, 1000 * 2 * 2^-53 = 2.2e-13.
    """
    ours = np.asarray(factors(1001), dtype=np.float64)
    yield ours[1] * 3 / (2 * pi) - 1
    yield ours[3::2] / pi
    for l in range(0, 1001, 2):
        share = Fraction((-1) ** (l // 2 - 1 if l else 1) * comb(l, l // 2), 2**l * (l + 2) * (l - 1))
        yield ours[l] / (2 * pi * float(share)) - 1


@worst
def green_figures() -> Iterator[float]:
    """The energy of the first bands of Green's light in the figures. Bound: 1e-13, sums of a hundred squares."""
    shares = np.cumsum(relative_figures(find_light("green"))[1:])
    yield from (1 - shares[n - 1] - float(Fraction(text)) for n, text in GREEN_LEFT_OUT.items())


def band_limited() -> float:
    """A light of two bands shown with five reads no error. Bound: 5e-8, the resolution of a difference of squares."""
    light = LobeLight((Lobe(ClampedLinear(0.5, -1.0), np.array(SUN_AXIS), np.array([1.0, 0.3, 2.0])),))
    return relative_figures(light)[0]


CASES = (
    Case("Gibbs ringing of the hemisphere", "25, 11.4, 9.6, 9.1, 9.0 % (mpmath)", 6e-10, gibbs),
    Case("deringing leaves nothing negative", "0, relative to the mean", 1e-9, deringed),
    Case("irradiance factors to l = 1000", "closed form, exact fractions, relative", 2.2e-13, irradiance),
    Case("energy of Green's light", "closed form, 80 digits", 1e-13, green_figures),
    Case("band-limited light", "reads 0", 5e-8, band_limited),
)
