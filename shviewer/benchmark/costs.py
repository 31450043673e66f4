"""What an experiment will take, from a table: so that a run can be cut to a budget before it starts, alike every time.

The figures are seconds of one server core of 2020. A slower machine is noticed while it runs (projection_rows.py).
"""

from __future__ import annotations

from math import ceil, ldexp, log2, sqrt
from time import perf_counter

from shviewer.benchmark.experiments import BEST, Method
from shviewer.harmonics.quadrature import jittered
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.function import FunctionLight
from shviewer.lights.light import Light
from shviewer.lights.lobes import LobeLight

PER_SAMPLE, PER_BASIS_VALUE, PER_GRID_POINT, PER_TEXEL = 25e-9, 0.7e-9, 35e-9, 7e-9
GENERATING = 50e-9
PER_CALL = 0.4e-3
PER_ROW_CUBED = 1.2e-10
"""The nodes of a Gauss-Legendre rule are eigenvalues."""

FUNCTION_POINTS = 820_000
"""What the best way may ask of a function."""


def evaluation_seconds(light: Light) -> float:
    """One direction. A function's is measured, and rounded up to a power of two so that two runs agree."""
    if isinstance(light, LobeLight):
        return (20 + 40 * len(light.lobes)) * 1e-9
    if isinstance(light, EnvironmentLight):
        return 40e-9
    few = jittered(2048, 0).directions
    light.integrand(few)
    start = perf_counter()
    light.integrand(few)
    return ldexp(1.0, ceil(log2(max(1e-9, (perf_counter() - start) / len(few)))))


def run_seconds(method: Method, light: Light, samples: int | None, n_bands: int, evaluation: float) -> float:
    """One projection. `evaluation`: seconds per direction."""
    if samples is None:
        if isinstance(light, EnvironmentLight):
            height, width = light.pixels.shape[:2]
            return PER_CALL + int(height * width) * (
                PER_TEXEL if method.separable or method.name == BEST else _scattered(n_bands)
            )
        if isinstance(light, FunctionLight):
            return FUNCTION_POINTS * (evaluation + PER_GRID_POINT)
        return PER_CALL + 1e-7 * n_bands**2
    if method.separable:
        return PER_CALL + samples * (evaluation + PER_GRID_POINT)
    return PER_CALL + samples * (evaluation + _scattered(n_bands))


def set_up_seconds(method: Method, samples: int | None) -> float:
    """Making the samples once."""
    if samples is None:
        return 0.0
    rows = sqrt(samples / 2)
    return PER_ROW_CUBED * rows * rows * rows if method.separable else GENERATING * samples


def _scattered(n_bands: int) -> float:
    return PER_SAMPLE + PER_BASIS_VALUE * n_bands**2
