"""Whether functions are as accurate as they say, and the cost of that: python tests/benchmarks/functions.py [SEED ...]

suite   every case of tests/lights/function_suite.py, for each seed (0): the error, what is stated, whether a note says it.
        Goal: within three times what is stated, or a note, in 99 %; no note on smooth ones. Features narrower than the look
        are counted apart: that they may be missed is said with the method of every function.
suns    discs of half-angle 0.27 degrees, 1000 to 1e6 times the sky, in 300 random directions. Goal: all found, to 1e-3.
cost    CPU time of smooth functions, over that of the rule before: Gauss-Legendre of 160 and of 320 rows, compared. With
        the map, as every window and picture needs it, and without. Goal: at most 1 with it.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from functools import partial

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"
sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))

import numpy as np
from lights.function_suite import Disc, direction, discs, judge, suite
from measure import cpu_milliseconds, machine, medians

from shviewer.harmonics.metrics import errors_by_band_count
from shviewer.harmonics.projection.rows import project_product
from shviewer.harmonics.quadrature import gauss_legendre
from shviewer.harmonics.sampling.look import SEEN_DEGREES
from shviewer.lights.function import FunctionLight
from shviewer.lights.lat_long import LatLongMap

N_SUNS = 300


def whole_suite(seed: int) -> None:
    print(f"\nseed {seed}\n{'case':46} {'error':>8} {'stated':>8}")
    verdicts = [(case, judge(case)) for case in suite(seed)]
    for case, verdict in verdicts:
        words = (
            "note"
            if verdict.said
            else "narrower than the look"
            if verdict.silent and case.narrowest < SEEN_DEGREES
            else ""
        )
        wrong = "SILENT" if verdict.silent and not words else "SMOOTH" if case.smooth and verdict.said else words
        print(f"{case.name[:46]:46} {verdict.error:8.1e} {verdict.stated:8.1e} {wrong}")
    seen = [(case, verdict) for case, verdict in verdicts if case.narrowest >= SEEN_DEGREES or not verdict.silent]
    good = sum(not verdict.silent for _, verdict in seen)
    print(
        f"{len(verdicts)} cases; {good} of {len(seen)} within three times what is stated, or noted; "
        f"{len(verdicts) - len(seen)} narrower than the look and missed; "
        f"{sum(verdict.said for _, verdict in verdicts)} notes, {sum(v.said for c, v in verdicts if c.smooth)} on smooth ones"
    )


def suns() -> None:
    rng = np.random.default_rng(1)
    verdicts = [
        judge(discs("sun", 0.1, Disc(direction(rng), 0.27, 0.1 * 10 ** rng.uniform(3, 6)))) for _ in range(N_SUNS)
    ]
    found = sum(verdict.error < 1e-3 for verdict in verdicts)
    within = sum(verdict.error <= 3 * verdict.stated for verdict in verdicts)
    notes = sum(verdict.said for verdict in verdicts)
    worst = max(verdict.error for verdict in verdicts)
    print(
        f"\n{found} of {N_SUNS} suns found, the worst to {worst:.1e}; {within} within three times what is stated; {notes} notes"
    )


def before(function: Callable[[np.ndarray], np.ndarray], with_map: bool) -> None:
    light = FunctionLight(function)
    for rows in (160, 320):
        coefficients, products = project_product(light.radiance, gauss_legendre(2 * rows**2), 128)
        errors_by_band_count(products, coefficients, coefficients)
    if with_map:
        LatLongMap.pole_to_pole(light.rows)


def now(function: Callable[[np.ndarray], np.ndarray], with_map: bool) -> None:
    light = FunctionLight(function)
    light.coefficients(128)
    if with_map:
        _ = light.map


def cost() -> None:
    axes = np.array([[1.0, 0.2, 0], [0, 2, 0.5], [0.3, 0, 1]])
    functions: dict[str, Callable[[np.ndarray], np.ndarray]] = {
        "grey lobe": lambda d: np.exp(3 * d[:, 0]) + d[:, 1],
        "three lobes": lambda d: np.exp(d @ axes),
        "quadratic": lambda d: d**2 + 1,
        "twenty lobes": lambda d: sum(np.exp(k * (d[:, k % 3] - 1)) for k in range(1, 21)),
    }
    print(
        f"\n{'smooth function':16} {'before':>9} {'now':>7} {'ratio':>6}   {'with map':>9} {'now':>7} {'ratio':>6}   CPU ms"
    )
    for name, function in functions.items():
        times = medians(
            {
                f"{when.__name__} {with_map}": partial(when, function, with_map)
                for with_map in (False, True)
                for when in (before, now)
            },
            15,
            cpu_milliseconds,
        )
        old, new, old_map, new_map = times.values()
        print(
            f"{name:16} {old:9.1f} {new:7.1f} {new / old:6.2f}   {old_map:9.1f} {new_map:7.1f} {new_map / old_map:6.2f}"
        )


def main() -> None:
    print(machine(), "- one thread")
    cost()
    suns()
    for seed in map(int, sys.argv[1:] or ["0"]):
        whole_suite(seed)


if __name__ == "__main__":
    main()
