"""What a projection costs: python tests/benchmarks/projection.py

Goals: lobes with 16 bands under 1 ms; a 1024 x 512 RGB map with 16 bands under 40 ms. "reading once" is one pass over the
same float32 image by numpy, in the same run; the error is against the float64 image.
"""

from __future__ import annotations

import os
from functools import partial

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from measure import machine, medians

from shviewer.harmonics.projection import project_image, project_product, project_samples, theta_series
from shviewer.harmonics.quadrature import gauss_legendre, jittered
from shviewer.lights.light import built_in_lights, find_light

BANDS = (4, 9, 16, 32, 64)


def images() -> None:
    rng = np.random.default_rng(0)
    for width in (512, 1024, 2048):
        image = rng.gamma(0.3, 1.0, (width // 2, width, 3)).astype(np.float32)
        for n_bands in BANDS:
            times = medians({"project": partial(project_image, image, n_bands), "read": image.sum}, 5)
            print(
                f"image {width:>4} x {width // 2:<4} {n_bands:>3} bands {times['project']:8.2f} ms"
                f" {times['project'] / times['read']:8.1f} x reading once"
            )


def lobes() -> None:
    for name, path in built_in_lights().items():
        if path.suffix == ".toml":
            light = find_light(name)
            times = medians({str(n): partial(light.coefficients, n) for n in BANDS}, 15)
            print(f"{name:<12} closed form:", ", ".join(f"{n} bands {ms:.2f} ms" for n, ms in times.items()))


def sampled() -> None:
    light = find_light("green")
    exact = light.coefficients(16)
    for samples in (10_000, 100_000):
        directions, rule = jittered(samples, 0), gauss_legendre(samples)
        candidates = {
            "jittered": partial(project_samples, light.radiance, directions, 16),
            "gauss-legendre": partial(project_product, light.radiance, rule, 16),
        }
        times = medians(candidates, 5)
        for name, work in candidates.items():
            found = work()
            coefficients = found[0] if isinstance(found, tuple) else found
            error = np.abs(coefficients - exact).max() / np.abs(exact).max()
            print(
                f"{name:<15}{samples:>7} samples, 16 bands {times[name]:8.2f} ms, largest error {error:.1e} of the largest"
            )


def main() -> None:
    print(machine(), "- one thread")
    theta_series.cache_clear()
    lobes()
    images()
    sampled()


if __name__ == "__main__":
    main()
