"""Noise in the texels of a light, and a sun that crosses them: what is left in n bands, simulated beside the formulas.

noise       independent noise of deviation s in each texel of the original, projected exactly: s n / sqrt(N_eff) is left in
            n bands, N_eff = (4 pi)^2 / sum of squared solid angles; of irradiance over pi the root of
            s^2 sum (2l+1)(A_l/pi)^2 / N_eff; of N texels read per frame s n / sqrt(N).
sun         its flux hops from texel to texel, a distance delta with delta_rms^2 = w^2 (1 + cos^2 latitude)/12, w a texel's
            width: (delta_rms/2) sqrt(n^2 - 1), irradiance delta_rms. A texel that takes the radiance at its centre has a
            sun with the chance p, the ratio of their solid angles, and band 0 flickers by sqrt(1/p - 1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer.benchmark.measuring.moving import BANDS, MOST
from shviewer.harmonics.basis import Array
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.metrics import band_power
from shviewer.harmonics.projection.scattered import project_values
from shviewer.harmonics.quadrature import directions_from_angles, jittered
from shviewer.lights.layouts.lat_long import LatLongLayout

NOISE_SIZE, NOISE_FRAMES = (32, 64), 100
"""Rows and columns of the noisy image, and how many of them are made."""

SUN_WIDTH, SUN_PLACES, SUN_DEGREES = 64, 4000, 0.265
"""Columns of the image that a sun crosses, how many places it has, and its half angle."""


@dataclass(frozen=True)
class Stated:
    """A figure that was simulated, beside its formula; n_bands is None for irradiance with all of its bands."""

    what: str
    n_bands: int | None
    simulated: float
    formula: float


def noise(seed: int) -> list[Stated]:
    """The noise that is left in n bands of a lat-long image whose texels have deviation 1, projected exactly or by samples."""
    height, width = NOISE_SIZE
    layout, rng = LatLongLayout(height, width), np.random.default_rng(seed)
    areas = np.broadcast_to(layout.solid_angles(), NOISE_SIZE)
    effective = (4 * np.pi) ** 2 / float((areas**2).sum())
    power, shaded, taken = np.zeros(MOST), np.zeros(MOST), np.zeros(MOST)
    cosine = per_coefficient(irradiance_factors(MOST) / np.pi)
    few = MOST**2 // 2  # fewer than n^2 of all MOST bands
    for frame in range(NOISE_FRAMES):
        pixels = rng.standard_normal((height, width, 3)).astype(np.float32)
        projected = layout.project(pixels, MOST)
        power += band_power(projected).sum(axis=1)
        shaded += band_power(cosine * projected).sum(axis=1)
        points = jittered(few, seed + frame)
        values = pixels[layout.nearest(points.directions)].astype(np.float64)
        taken += band_power(project_values(points.directions, values * points.weights[:, None], MOST)).sum(axis=1)
    share = 1 / (3 * NOISE_FRAMES * 4 * np.pi)  # of a channel and frame, over the sphere
    factors = (2 * np.arange(MOST) + 1) * (irradiance_factors(MOST) / np.pi) ** 2
    drawn = int(np.sqrt(few)) ** 2
    found = [
        Stated(
            f"noise of {width} x {height} texels, exactly projected",
            n,
            _root(power, n, share),
            n / float(np.sqrt(effective)),
        )
        for n in BANDS
    ]
    found += [
        Stated(
            "the same in irradiance over pi", 3, _root(shaded, 3, share), float(np.sqrt(factors[:3].sum() / effective))
        ),
        Stated("the same in irradiance over pi", None, _root(shaded, MOST, share), float(np.sqrt(8 / 3 / effective))),
    ]
    return found + [
        Stated(f"{drawn} of its texels read in each frame", n, _root(taken, n, share), n / float(np.sqrt(drawn)))
        for n in (3, 5, 9, 16)
    ]


def _root(power: Array, n: int, share: float) -> float:
    return float(np.sqrt(power[:n].sum() * share))


def sun(seed: int) -> list[Stated]:
    """A sun whose flux hops between the texels of a lat-long image SUN_WIDTH wide, and one that is sampled at their centres."""
    rng, texel = np.random.default_rng(seed), 2 * np.pi / SUN_WIDTH
    latitude, phi = np.arcsin(rng.uniform(-0.7, 0.7, SUN_PLACES)), rng.uniform(0, 2 * np.pi, SUN_PLACES)
    theta = np.pi / 2 - latitude
    there = directions_from_angles((np.floor(theta / texel) + 0.5) * texel, (np.floor(phi / texel) + 0.5) * texel)
    here = directions_from_angles(theta, phi)
    angle = 2 * np.arcsin(np.linalg.norm(here - there, axis=1) / 2)
    moved = float(np.sqrt((texel**2 * (1 + np.cos(latitude) ** 2) / 12).mean()))
    legendre = np.polynomial.legendre.legvander(np.cos(angle), MOST - 1).mean(axis=0)
    l = np.arange(MOST)
    energy, off = 2 * l + 1, (2 * l + 1) * 2 * (1 - legendre)
    shade = irradiance_factors(MOST) ** 2
    hops = f"a sun that hops between {SUN_WIDTH} columns"
    found = [
        Stated(hops, n, float(np.sqrt(off[:n].sum() / n**2)), moved / 2 * float(np.sqrt(n * n - 1))) for n in BANDS[1:]
    ]
    shaded = float(np.sqrt((shade * off).sum() / (shade * energy).sum()))
    found.append(Stated("the same in irradiance", None, shaded, moved))
    share = float((angle < np.radians(SUN_DEGREES)).mean())
    chance = float((np.pi * np.radians(SUN_DEGREES) ** 2 / (texel**2 * np.cos(latitude))).mean())
    sampled_at = "a sun sampled at the centres of texels"
    return [*found, Stated(sampled_at, 1, float(np.sqrt(1 / share - 1)), float(np.sqrt(1 / chance - 1)))]
