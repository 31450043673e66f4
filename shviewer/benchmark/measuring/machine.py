"""The machine and the versions that measurements were made with, and a yardstick of how steady the machine was."""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping, Sequence
from importlib import import_module, metadata
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from shviewer.benchmark.measuring.timing import wall_and_cpu_milliseconds
from shviewer.version import __version__

PACKAGES = ("numpy", "moderngl", "glfw", "Pillow", "OpenEXR", "matplotlib")
PEERS = ("scipy", "ducc0", "shtns", "pyshtools", "sphericart")


def processor() -> str:
    """The model of the processor, if the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def machine_line() -> str:
    """The machine in a few words."""
    return f"{platform.machine()}, {os.cpu_count()} processors, {platform.system()} {platform.release()}"


def machine_record() -> dict[str, Any]:
    """The facts that must be equal before two times can be compared."""
    return {
        "processor": processor(),
        "architecture": platform.machine(),
        "processors": os.cpu_count(),
        "system": f"{platform.system()} {platform.release()}",
        "blas": blas(),
        "blas_threads": blas_threads(),
    }


def versions(packages: Sequence[str] = (*PACKAGES, *PEERS)) -> dict[str, str]:
    """The versions of the program, of Python and of every package installed."""
    found = {"shviewer": __version__, "Python": platform.python_version()}
    for name in packages:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


def blas() -> str:
    """The library that multiplies matrices: its build, and its kernel if threadpoolctl can tell."""
    build: Any = np.show_config(mode="dicts")
    names = build.get("Build Dependencies", {}).get("blas", {}) if isinstance(build, Mapping) else {}
    text = f"{names.get('name', 'unknown')} {names.get('version', '')}".strip()
    kernels = sorted({str(pool.get("architecture")) for pool in _pools() if pool.get("architecture")})
    return f"{text}, {' and '.join(kernels)}" if kernels else text


def blas_threads() -> int | str:
    """The number of its threads if threadpoolctl can tell, else the number that the environment asks for."""
    threads = [int(pool["num_threads"]) for pool in _pools() if pool.get("user_api") == "blas"]
    if threads:
        return max(threads)
    return os.environ.get("OPENBLAS_NUM_THREADS") or os.environ.get("OMP_NUM_THREADS") or "default"


def _pools() -> list[dict[str, Any]]:
    try:
        threadpoolctl = import_module("threadpoolctl")
    except ImportError:
        return []
    return list(threadpoolctl.threadpool_info())


def yardstick() -> list[Worked]:
    """A fixed piece of work of one thread: timed throughout a run, it changes as much as the machine's speed does."""
    values = np.random.default_rng(0).random(50_000)

    def work() -> object:
        return np.sort(np.sin(values))

    work()
    return [Worked(*wall_and_cpu_milliseconds(work)) for _ in range(3)]


class Worked(NamedTuple):
    """The time of a piece of work, in milliseconds: by the clock, and of a processor."""

    wall: float
    cpu: float


def disturbance(worked: Sequence[Worked]) -> float:
    """The time by the clock over that of the processor: 1 where nothing else wanted the processor."""
    cpu = sum(one.cpu for one in worked)
    return sum(one.wall for one in worked) / cpu if cpu else 1.0
