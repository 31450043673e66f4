"""The extremes of a reconstruction, against the search without bounds that they replace: python tests/benchmarks/extremes.py

The old routine is read out of this repository's history. Milliseconds are the CPU time of one thread, the least of interleaved
runs: "first" makes the grid of a light and compares with it, "again" compares another reconstruction with the same grid. "low"
says how much smaller than the bound each largest error was.

Goal: at most twice the time of the old routine.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import ModuleType

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"

from measure import cpu_milliseconds, machine

from shviewer.analysis.figures import grid_rows
from shviewer.harmonics.extremes.error_grid import ErrorGrid
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.light import Light

OLD = "607b147:shviewer/harmonics/extremes.py"
LIGHTS = (
    "green",
    "hemisphere",
    "sun-sky",
    "studio",
    "film_studio",
    "st_fagans_interior",
    "venice_sunset",
    "mud_road_puresky",
)
BANDS = (3, 5, 9, 16, 32, 64, 128)
REPEATS = 7


def old_routine() -> ModuleType:
    text = subprocess.run(
        ["git", "show", OLD], cwd=Path(__file__).parent, capture_output=True, text=True, check=True
    ).stdout
    module = ModuleType("old_extremes")
    sys.modules[module.__name__] = module  # its dataclasses look it up
    exec(compile(text, OLD, "exec"), vars(module))
    return module


def least(candidates: dict[str, Callable[[], object]]) -> dict[str, float]:
    times: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(REPEATS):
        for name, work in candidates.items():
            times[name].append(cpu_milliseconds(work))
    return {name: min(values) for name, values in times.items()}


def fresh(light: Light) -> None:
    """Forget what a light keeps for its bounds."""
    vars(light).pop("form", None)
    for kept in (light.map._ranges, light.map._bends) if isinstance(light, EnvironmentLight) else ():
        kept.clear()


def _first_before(old: ModuleType, light: Light, rows: int, shown: object) -> object:
    return old.ErrorGrid(light.radiance, light.landmarks(), rows, light.rows).compare(shown)


def _first(light: Light, rows: int, shown: object) -> object:
    fresh(light)
    return ErrorGrid(light.radiance, light.landmarks(), rows, light.rows, light.form).compare(shown)


def main() -> None:
    print(f"{machine()}\nleast of {REPEATS} runs, ms\n")
    print("light                bands   first: old    new  ratio   again: old    new  ratio   old low  new low")
    old = old_routine()
    ratios: dict[str, list[float]] = {"first": [], "again": []}
    for name in sys.argv[1:] or LIGHTS:
        light = find_light(name)
        for n_bands in BANDS:
            shown, rows = light.coefficients(n_bands), grid_rows(n_bands)
            before = old.ErrorGrid(light.radiance, light.landmarks(), rows, light.rows)
            after = ErrorGrid(light.radiance, light.landmarks(), rows, light.rows, light.form)
            was, found = before.compare(shown), after.compare(shown)

            times = least(
                {
                    "old first": partial(_first_before, old, light, rows, shown),
                    "first": partial(_first, light, rows, shown),
                    "old again": partial(before.compare, shown),
                    "again": partial(after.compare, shown),
                }
            )
            line = f"{name:<20} {n_bands:>5}"
            for kind in ("first", "again"):
                ratio = times[kind] / times[f"old {kind}"]
                ratios[kind].append(ratio)
                line += f"   {times[f'old {kind}']:>10.2f} {times[kind]:6.2f} {ratio:6.2f}"
            low = [1 - value / found.max_error_bound for value in (was.max_error, found.max_error)]
            print(f"{line}   {low[0]:7.2%}  {low[1]:7.2%}", flush=True)
    for kind, values in ratios.items():
        print(f"{kind}: mean ratio {sum(values) / len(values):.2f}, largest {max(values):.2f}")


if __name__ == "__main__":
    main()
