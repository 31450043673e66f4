"""What roughness costs: python tests/benchmarks/glossy.py

CPU time of all threads. Goals: the factors of 128 bands in under 5 ms when they are asked for first; a change of roughness in
the window, exact original and error included, in at most 60 ms on a map of 1024 x 512 at roughness 0.25 and more (largest error
and minimum, which are searched for, fill in behind it), and in at most a second at roughness 0.1, whose kernel has 512 bands;
what lights that move cost, within their minute. "x irradiance" is the time over that of the irradiance of the same light in the
same run. Each roughness is shown once, since the window keeps it.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"
os.environ.pop("OPENBLAS_CORETYPE", None)  # may be set to slow numpy down; read when numpy is first imported

import numpy as np
from measure import cpu_milliseconds, machine

from shviewer.analysis.roughness import staircase
from shviewer.benchmark.measuring.measured_lights import measured_light
from shviewer.benchmark.measuring.moving import SAMPLES, WAYS, sampled
from shviewer.benchmark.measuring.moving_texels import noise
from shviewer.benchmark.measuring.moving_texels import sun as moving_sun
from shviewer.harmonics.quadrature import gauss_legendre_rows
from shviewer.harmonics.quantities.glossy import glossy_factors
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.function import FunctionLight
from shviewer.lights.light import Light
from shviewer.viewer.picture import first_picture, prepare
from shviewer.viewer.state import changed, state_of

ROUGHNESS = (0.95, 0.8, 0.6, 0.5, 0.4, 0.3, 0.25, 0.2, 0.15, 0.1)

TOWARDS = np.array([0.36, 0.48, 0.8])


def large_map() -> Light:
    """1024 x 512 texels with a few lamps in a dim room."""
    rng = np.random.default_rng(1)
    texels = rng.random((512, 1024, 3)).astype(np.float32) * 0.2
    for row, column in rng.integers((40, 0), (470, 1000), (6, 2)):
        texels[row : row + 6, column : column + 6] = 80
    return EnvironmentLight(texels, name="map")


def main() -> None:
    print(machine())
    for n_bands in (128, 512):
        gauss_legendre_rows.cache_clear()
        first = cpu_milliseconds(lambda n=n_bands: glossy_factors(0.31, n))
        other = cpu_milliseconds(lambda n=n_bands: glossy_factors(0.32, n))
        print(f"factors of {n_bands} bands: {first:.2f} ms, of the next roughness {other:.2f} ms")
    sun = FunctionLight(lambda d: np.where(d @ TOWARDS > np.cos(np.radians(0.27)), 1000.0, 0.1), "sun")
    for light in (large_map(), find_light("mud_road_puresky"), find_light("green"), find_light("studio"), sun):
        state = state_of(light, n_bands=9)
        prepare(state)
        irradiance = cpu_milliseconds(lambda s=state: prepare(changed(s, quantity="irradiance")))
        prepare(changed(state, quantity="glossy:1"))  # tables that all roughnesses share
        for roughness in ROUGHNESS:
            shown = changed(state, quantity=f"glossy:{roughness}")
            spent = cpu_milliseconds(lambda s=shown: first_picture(s).original.map)
            behind = cpu_milliseconds(lambda s=shown: prepare(s))
            ratio = f"{(spent + behind) / irradiance:.2f} x irradiance"
            print(f"{light.name}, roughness {roughness}: {spent:.0f} ms, all figures {behind:.0f} ms more, {ratio}")
        print(f"{light.name}, bands against roughness: {cpu_milliseconds(lambda s=state: staircase(s.recipe)):.0f} ms")
    print(f"noise and sun: {cpu_milliseconds(lambda: [noise(0), moving_sun(0)]):.0f} ms")
    green = measured_light(find_light("green"))
    for count in SAMPLES:
        spent = cpu_milliseconds(lambda n=count: [sampled(green, way, n, 0) for way in WAYS])
        print(f"frames of {count} samples, all ways: {spent:.0f} ms")


if __name__ == "__main__":
    main()
