"""What projecting samples costs, against sphericart and a matrix product: python tests/benchmarks/sampling.py

Every figure is the CPU time of one thread, the least of interleaved runs, since other programs can only add to it. Both start
from directions, weights and the values of three channels and end with the coefficients. sphericart is run twice: on all
samples at once, and in blocks that fit the cache; the ratio is to the faster of the two. "ns" is per sample and function.
The basis alone is beside sphericart's own, as a ratio to it; "write" is that of writing every value by one multiplication.

Goals: a ratio of at most 1 to sphericart for 2 to 32 bands and 10 000 to a million samples, and of 1.5 for the basis alone; at
most 200 MiB beside a million samples at 16 bands; 10 000 evaluations projected by Gauss-Legendre within 0.5 ms up to 32 bands,
not counting the light itself.

sphericart is one of the extra `bench` (pip install -e '.[bench]'); without it only ours is shown.
"""

from __future__ import annotations

import os
import tracemalloc
from collections.abc import Callable
from functools import partial

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = os.environ["RAYON_NUM_THREADS"] = "1"
os.environ.pop("OPENBLAS_CORETYPE", None)  # may be set to slow numpy down; read when numpy is first imported

import numpy as np
from measure import cpu_milliseconds, machine

from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.projection.rows import project_product
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import DirectionSet, Radiance, gauss_legendre, jittered

BANDS = (2, 3, 4, 5, 6, 7, 8, 9, 12, 16, 24, 32)
SAMPLES = {10_000: 60, 100_000: 15, 1_000_000: 3}
"""How many, and how often each is run."""

MOST_VALUES = 2**26
"""The largest basis that is held: 512 MiB."""
PEER_BLOCK = 2**18
"""Basis values of one block, 2 MiB: about the fastest."""


def least(candidates: dict[str, Callable[[], object]], repeats: int) -> dict[str, float]:
    """Milliseconds of each candidate: A A B B C C A A ..., the least of the second times.

    The first has to fetch memory from the system that another has given back.
    """
    times: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(repeats):
        for name, work in candidates.items():
            work()
            times[name].append(cpu_milliseconds(work))
    return {name: min(values) for name, values in times.items()}


def recorded(values: np.ndarray) -> Radiance:
    """A light that costs nothing: it hands out values in order, once."""
    start = 0

    def radiance(directions: np.ndarray) -> np.ndarray:
        nonlocal start
        start += len(directions)
        return values[start - len(directions) : start]

    return radiance


def sphericart_peer(samples: DirectionSet, values: np.ndarray, n_bands: int, block: int) -> Callable[[], object]:
    from sphericart import SphericalHarmonics

    calculator = SphericalHarmonics(n_bands - 1)

    def project() -> np.ndarray:
        coefficients = np.zeros((n_bands**2, 3))
        for start in range(0, len(values), block):
            rows = slice(start, start + block)
            basis = calculator.compute(samples.directions[rows])
            coefficients += basis.T @ (values[rows] * samples.weights[rows, None])
        return coefficients

    return project


def against_sphericart(count: int, repeats: int) -> None:
    samples = jittered(count, 0)
    values = np.random.default_rng(0).random((len(samples.weights), 3))
    print(f"\n{len(values)} samples; least of {repeats}")
    print(
        "bands   ours ms     ns   sphericart ms     ns   in blocks ms     ns   ratio to the faster",
        "   basis: ns ratio write",
    )
    for n_bands in BANDS:
        if len(values) * n_bands**2 > MOST_VALUES:
            continue
        candidates: dict[str, Callable[[], object]] = {
            "ours": lambda n_bands=n_bands: project_samples(recorded(values), samples, n_bands),
            "basis": lambda n_bands=n_bands: evaluate_basis(samples.directions, n_bands),
            "bound": lambda n_bands=n_bands: np.multiply(
                samples.weights, samples.weights, out=np.empty((n_bands**2, len(values)))
            ),
        }
        try:
            from sphericart import SphericalHarmonics

            candidates["whole"] = sphericart_peer(samples, values, n_bands, len(values))
            candidates["blocks"] = sphericart_peer(samples, values, n_bands, max(64, PEER_BLOCK // n_bands**2))
            candidates["their basis"] = partial(SphericalHarmonics(n_bands - 1).compute, samples.directions)
        except ImportError:
            if n_bands == BANDS[0]:
                print("sphericart is missing")
        times = least(candidates, repeats)
        per_value = 1e6 / (len(values) * n_bands**2)
        line = f"{n_bands:>5} {times['ours']:9.2f} {times['ours'] * per_value:6.2f}"
        if "whole" in times:
            whole, blocks = times["whole"], times["blocks"]
            line += f" {whole:15.2f} {whole * per_value:6.2f} {blocks:14.2f} {blocks * per_value:6.2f}"
            line += f"{times['ours'] / min(whole, blocks):22.2f} {times['basis'] * per_value:12.2f}"
            line += "".join(f"{times[name] / times['their basis']:6.2f}" for name in ("basis", "bound"))
        print(line, flush=True)


def memory() -> None:
    print("\na million samples, 16 bands")
    samples = jittered(1_000_000, 0)
    project_samples(np.abs, jittered(100, 0), 16)
    milliseconds = least({"ours": lambda: project_samples(np.abs, samples, 16)}, 3)["ours"]
    tracemalloc.start()
    project_samples(np.abs, samples, 16)
    peak = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    print(f"{milliseconds:.0f} ms, {peak:.1f} MiB beside the samples (goal: 200)")


def separable() -> None:
    rule = gauss_legendre(10_000)
    values = np.random.default_rng(0).random((len(rule.theta) * rule.n_columns, 3))
    print(f"\nGauss-Legendre, {len(values)} evaluations of a light that costs nothing (goal: 0.5 ms)")
    for n_bands in (3, 9, 16, 32):
        times = least({"ours": lambda n_bands=n_bands: project_product(recorded(values), rule, n_bands)}, 200)
        print(f"{n_bands:>5} bands {times['ours']:6.3f} ms")


def main() -> None:
    print(machine(), "- one thread")
    for count, repeats in SAMPLES.items():
        against_sphericart(count, repeats)
    memory()
    separable()


if __name__ == "__main__":
    main()
