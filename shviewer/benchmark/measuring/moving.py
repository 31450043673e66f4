"""Lights that turn, projected anew in every frame: what flickers, measured beside the formula.

Turning the light by R and its coefficients back again is projecting the light that stands still at the points R^T d: so no
rotation of coefficients is needed. Errors are relative to the norm ||f|| of the light, over all frames and the whole sphere.

    sampled     N points in each frame: sum var c = (n^2 ||f||^2 - sum c^2)/N for independent ones, so that the error of n bands
                is sqrt((n^2 - kappa)/N), kappa the share of ||f||^2 that they hold.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from shviewer.benchmark.measuring.measured_lights import MeasuredLight
from shviewer.benchmark.rows.row import Row
from shviewer.harmonics.metrics import band_power
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import DirectionSet, jittered, uniform_random
from shviewer.harmonics.rotation import rotate, turn
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight

SECTION = "moving"
BANDS = (1, 2, 3, 5, 9, 16)
MOST = BANDS[-1]
SAMPLES = (100, 1000, 10_000)
FRAMES = {100: 64, 1000: 64, 10_000: 32}
DEGREES = 1.0
"""The turn from frame to frame, about the vertical."""

WAYS: dict[str, Callable[[int, int, int], DirectionSet]] = {
    "jittered, fresh in each frame": lambda count, seed, frame: jittered(count, seed + 1 + frame),
    "jittered, the same in each frame": lambda count, seed, frame: jittered(count, seed),
    "independent, fresh in each frame": lambda count, seed, frame: uniform_random(count, seed + 1 + frame),
}
"""Ways to sample a frame: (count, seed, frame) -> points."""


@dataclass(frozen=True)
class SamplingError:
    """The error of a light projected by samples in every frame, with its first n bands."""

    light: str
    way: str
    samples: int
    """The number that was drawn."""
    n_bands: int
    rms: float
    """From the exact coefficients, over frames and sphere, relative to ||f||."""
    flicker: float
    """From frame to frame, likewise."""
    formula: float
    """The rms of independent samples, by sqrt((n^2 - kappa)/N)."""
    milliseconds: float
    """The median time to project a frame to MOST bands."""

    @property
    def row(self) -> Row:
        note = (
            f"frame to frame {100 * self.flicker:.3g} %; independent samples by the formula {100 * self.formula:.3g} %"
        )
        return Row(
            section=SECTION,
            method=self.way,
            light=self.light,
            n_bands=self.n_bands,
            samples=self.samples,
            evaluations=self.samples,
            milliseconds=self.milliseconds,
            error=self.rms,
            note=note,
        )


def turned_exactly(measured: MeasuredLight) -> float | None:
    """The largest flicker of a sum of lobes that turns, projected in closed form; None for other lights."""
    lobes = measured.light.lobes
    if not lobes:
        return None
    still, norm = measured.exact[: MOST**2], float(np.sqrt(np.trace(measured.products)))
    worst = 0.0
    for degrees in (1.0, 37.0, 200.0):
        matrix = turn(degrees, 0.4 * degrees)
        moved = LobeLight(tuple(Lobe(lobe.profile, matrix @ lobe.axis, lobe.radiance) for lobe in lobes))
        worst = max(worst, float(np.linalg.norm(rotate(moved.coefficients(MOST), matrix.T) - still)))
    return worst / norm if norm else 0.0


def sampled(measured: MeasuredLight, way: str, count: int, seed: int) -> list[SamplingError]:
    """One way to sample a light that turns, for each of BANDS."""
    exact, norm = measured.exact[: MOST**2], float(np.trace(measured.products))
    frames, times = [], []
    for frame in range(FRAMES.get(count, 64)):
        points = WAYS[way](count, seed, frame)
        back = turn(DEGREES * frame, 0.0)  # row vectors: d @ R is R^T applied to each
        began = perf_counter()
        frames.append(
            project_samples(measured.light.integrand, DirectionSet(points.directions @ back, points.weights), MOST)
        )
        times.append(1000 * (perf_counter() - began))
    stack = np.stack(frames)
    powers = np.stack([band_power(frame - exact).sum(axis=1) for frame in frames]).mean(axis=0)
    steps = np.stack([band_power(step).sum(axis=1) for step in np.diff(stack, axis=0)]).mean(axis=0)
    held = band_power(exact).sum(axis=1)
    drawn = len(points.weights)
    return [
        SamplingError(
            measured.name,
            way,
            drawn,
            n,
            float(np.sqrt(powers[:n].sum() / norm)),
            float(np.sqrt(steps[:n].sum() / norm)),
            float(np.sqrt(max(n * n - held[:n].sum() / norm, 0.0) / drawn)),
            float(np.median(times)),
        )
        for n in BANDS
    ]
