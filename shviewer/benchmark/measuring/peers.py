"""The same projections by other libraries, where they are installed: the extra `bench`.

All start from the same image, interleaved RGB in float32, or from the same jittered samples, and end with the coefficients of
three channels. Copies and conversions that a peer needs for that are part of its time. To the peers, texels are points at their
centres, weighted by solid angle; so their error against our areas is not their own fault and is not given.

A library sets its number of threads when it is loaded. The rows are therefore measured by another process, with one thread:
    python -m shviewer.benchmark.measuring.peers '{"lights": ["film_studio"], "bands": [9], "budget": 10, "seed": 0}' rows.json
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shviewer.benchmark.measuring.experiments import lat_long_texels
from shviewer.benchmark.measuring.timing import Work, time_interleaved, wall_milliseconds
from shviewer.benchmark.rows.row import Row, not_measured
from shviewer.children import follow_parent, leash
from shviewer.ending import temporary_folder
from shviewer.errors import UsageError
from shviewer.harmonics.basis import Array
from shviewer.harmonics.projection.rows import project_image
from shviewer.harmonics.projection.scattered import project_values
from shviewer.harmonics.quadrature import DirectionSet, column_azimuths, directions_from_angles, jittered, row_angles
from shviewer.lights.find import find_light
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.light import Light

SECTION = "peers"
OURS = "shviewer"
ONE_THREAD = {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL", "RAYON", "VECLIB_MAXIMUM", "BLIS")}
SLOWING = ("OPENBLAS_CORETYPE", "OPENBLAS_L2_SIZE")
"""Environment variables that would slow numpy, and so be unfair to us alone; they are removed."""

SPHERICART_BLOCK = 2**22
"""How many basis values are held at a time."""

SCATTERED_SAMPLES = 10_000
SPHERICART_DEGREES = 87
"""The degree beyond which sphericart's float64 is wrong."""

INSTALL = "pip install 'shviewer[bench]'"

Contest = tuple[str, int | None]
"""The library that projects, and the number of samples; None for the image."""


def ducc(ducc0: Any, image: NDArray[np.float32], n_bands: int, dtype: type[np.floating[Any]]) -> object:
    """ducc0's adjoint synthesis of the weighted image, which does not alias as its analysis does."""
    height, width = image.shape[:2]
    planes = np.empty((3, 1, height, width), dtype)
    solid_angle = LatLongLayout(height, width).solid_angles().astype(dtype)
    np.multiply(np.moveaxis(image, 2, 0)[:, None], solid_angle, out=planes)
    synthesis = partial(ducc0.sht.adjoint_synthesis_2d, spin=0, lmax=n_bands - 1, geometry="F1", nthreads=1)
    return [synthesis(map=plane) for plane in planes]


@cache
def _shtns_plan(shtns: Any, height: int, width: int, n_bands: int) -> Any:
    transform = shtns.sht(n_bands - 1, n_bands - 1, 1, shtns.sht_orthonormal)
    transform.set_grid(height, width, flags=shtns.sht_reg_fast | shtns.SHT_PHI_CONTIGUOUS, polar_opt=0.0)
    return transform


def shtns(library: Any, image: NDArray[np.float32], n_bands: int) -> object:
    transform = _shtns_plan(library, *image.shape[:2], n_bands)
    planes = np.ascontiguousarray(np.moveaxis(image, 2, 0), dtype=np.float64)
    return [transform.analys(plane) for plane in planes]


def pyshtools(expand: Any, image: NDArray[np.float32], n_bands: int) -> object:
    planes = np.ascontiguousarray(np.moveaxis(image, 2, 0), dtype=np.float64)
    return [expand.SHExpandDH(plane, norm=4, csphase=-1, sampling=2, lmax_calc=n_bands - 1) for plane in planes]


@cache
def _sphericart_basis(library: Any, n_bands: int) -> Any:
    return library.SphericalHarmonics(n_bands - 1)


def sphericart(library: Any, image: NDArray[np.float32], n_bands: int, share: int = 1) -> Array:
    """The basis by sphericart and a matrix product, block by block, over every `share`-th block of rows."""
    height, width = image.shape[:2]
    theta, phi = row_angles(height), column_azimuths(width)
    solid_angle = LatLongLayout(height, width).solid_angles()
    step = max(1, SPHERICART_BLOCK // (width * n_bands**2))
    found = np.zeros((n_bands**2, 3))
    for row in range(0, height, step * share):
        rows = slice(row, min(row + step, height))
        directions = directions_from_angles(theta[rows, None], phi).reshape(-1, 3)
        values = (image[rows] * solid_angle[rows, None]).reshape(-1, 3)
        found += _sphericart_basis(library, n_bands).compute(directions).T @ values
    return found


def sphericart_samples(library: Any, samples: DirectionSet, radiance: Array, n_bands: int) -> object:
    """The whole basis matrix by sphericart, then one matrix product."""
    basis = _sphericart_basis(library, n_bands).compute(samples.directions)
    return basis.T @ (radiance * samples.weights[:, None])


def scipy_samples(special: Any, samples: DirectionSet, radiance: Array, n_bands: int) -> object:
    """SciPy's complex harmonics of all degrees and orders; those of m >= 0 hold the real ones."""
    x, y, z = samples.directions.T
    basis = special.sph_harm_y_all(n_bands - 1, n_bands - 1, np.arctan2(np.hypot(x, y), z), np.arctan2(y, x))
    return basis[:, :n_bands].reshape(n_bands**2, -1) @ (radiance * samples.weights[:, None])


Peers = dict[str, tuple[str, Callable[..., object]]]
"""Name -> the module to import, and the function that projects with it."""

IMAGE_PEERS: Peers = {
    "ducc0 f32": ("ducc0", partial(ducc, dtype=np.float32)),
    "ducc0 f64": ("ducc0", partial(ducc, dtype=np.float64)),
    "shtns": ("shtns", shtns),
    "pyshtools": ("pyshtools.expand", pyshtools),
    "sphericart": ("sphericart", sphericart),
}
SAMPLE_PEERS: Peers = {"sphericart": ("sphericart", sphericart_samples), "SciPy": ("scipy.special", scipy_samples)}


def available(peers: Peers, missing: list[str]) -> dict[str, Callable[..., object]]:
    """The functions of the peers that are installed; `missing` gets a line on every other one."""
    found: dict[str, Callable[..., object]] = {}
    for name, (module, project) in peers.items():
        try:
            found[name] = partial(project, import_module(module))
        except ImportError as error:
            missing.append(f"{name}: {error.name or error} is not installed")
    return found


def peer_rows(lights: Sequence[str], bands: Sequence[int], budget: float, seed: int) -> tuple[list[Row], list[str]]:
    """Rows measured by a process with one thread, and lines on what was missing. Lights are named by text.

    UsageError if the process fails.
    """
    request = {"lights": list(lights), "bands": list(bands), "budget": budget, "seed": seed}
    environment = {name: value for name, value in os.environ.items() if name not in SLOWING} | ONE_THREAD
    with temporary_folder() as folder, leash(environment) as (stdin, environment):
        out = folder / "rows.json"  # some peers print on stdout
        command = [sys.executable, "-m", "shviewer.benchmark.measuring.peers", json.dumps(request), str(out)]
        done = subprocess.run(command, stdin=stdin, env=environment, capture_output=True, text=True, check=False)
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["no message"])[-1]
            raise UsageError(f"--peers: measuring them failed: {last}; leave --peers out, or reinstall them: {INSTALL}")
        answer = json.loads(out.read_text(encoding="utf-8"))
    return [Row.from_dict(row) for row in answer["rows"]], [str(line) for line in answer["missing"]]


def measure(lights: Sequence[str], bands: Sequence[int], budget: float, seed: int) -> dict[str, list[Any]]:
    """Measure in this process, with however many threads it has: {"rows": dictionaries, "missing": lines}."""
    missing: list[str] = []
    images, scattered = available(IMAGE_PEERS, missing), available(SAMPLE_PEERS, missing)
    rows: list[Row] = []
    share = budget / max(1, len(lights) * len(bands))
    for number, light in enumerate(map(find_light, lights)):
        samples = jittered(SCATTERED_SAMPLES, seed)
        radiance = light.integrand(samples.directions)
        too_slow: set[Contest] = set()
        for n_bands in bands:
            works = _on_image(light, n_bands, images)
            if number == 0:  # samples are alike for every light
                works |= _on_samples(samples, radiance, n_bands, scattered)
            first: dict[Contest, float] = {}
            for contest, work in works.items():
                where, says = f"{contest[0]}, {light.name}, {n_bands} bands", " with fewer bands"
                if contest not in too_slow:
                    try:
                        first[contest] = wall_milliseconds(work)
                    except Exception as error:  # a peer may raise anything for a size that it does not take
                        missing.append(f"{where}: {type(error).__name__}: {error}")
                        continue
                    if first[contest] <= 1000 * share / 8:
                        continue
                    says = f", one run takes about {first.pop(contest) / 1000:.1g} s"
                    too_slow.add(contest)
                missing.append(f"{where}: too slow for the budget{says}")
                rows.append(not_measured(SECTION, contest[0], light.name, n_bands, contest[1]))
            running = {contest: works[contest] for contest in first}
            for contest, timing in time_interleaved(running, budget=share, warm_up=False).items():
                row = Row(section=SECTION, light=light.name, method=contest[0], n_bands=n_bands, samples=contest[1])
                set_up = max(0.0, first[contest] - timing.milliseconds)
                note = "samples with their radiance" if contest[1] else "image"
                rows.append(replace(row, **timing._asdict(), set_up_milliseconds=set_up, note=note))
    return {"rows": [row.as_dict() for row in rows], "missing": missing}


def _on_samples(
    samples: DirectionSet, radiance: Array, n_bands: int, peers: dict[str, Callable[..., object]]
) -> dict[Contest, Work]:
    """Our projection and the peers' for scattered samples whose radiance is known."""
    if n_bands > SPHERICART_DEGREES:
        return {}
    count = len(samples.weights)
    return {
        (OURS, count): lambda: project_values(samples.directions, radiance * samples.weights[:, None], n_bands),
        **{(name, count): partial(peer, samples, radiance, n_bands) for name, peer in peers.items()},
    }


def _on_image(light: Light, n_bands: int, peers: dict[str, Callable[..., object]]) -> dict[Contest, Work]:
    """Our projection, in both precisions, and the peers' for a lat-long image; empty for another light."""
    texels = lat_long_texels(light)
    if texels is None:
        return {}
    return {
        (OURS, None): lambda: project_image(texels, n_bands),
        (f"{OURS} f32", None): lambda: project_image(texels, n_bands, np.float32),
        **{(name, None): partial(peer, texels, n_bands) for name, peer in peers.items()},
    }


if __name__ == "__main__":
    follow_parent()
    Path(sys.argv[2]).write_text(json.dumps(measure(**json.loads(sys.argv[1]))), encoding="utf-8")
